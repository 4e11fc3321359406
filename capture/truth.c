#include "capture/truth.h"

/* ---- Which shots ---- */

static bool same_view(const weft_shot *a, const weft_shot *b)
{
    return a->view.theta_rad == b->view.theta_rad && a->view.phi_rad == b->view.phi_rad;
}

/* The first shot of the view after the one of `shot`. Plans are ordered by view. */
static int next_view(const weft_session *session, int shot)
{
    int next = shot + 1;
    while (next < session->shot_count && same_view(&session->shot[shot], &session->shot[next]))
        next++;
    return next;
}

int weft_truth_choose(const weft_session *session, int image_count, int *shots)
{
    /* Prime to every usual number of lights, so that the lights of successive views run through all of them. */
    const int light_step = 37;
    int chosen = 0;
    bool any = true;
    for (int round = 0; any && chosen < image_count; round++) {
        any = false;
        for (int first = 0, view = 0; first < session->shot_count && chosen < image_count; view++) {
            int next = next_view(session, first), lights = next - first;
            if (round < lights) {
                shots[chosen++] = first + (int)(((long)view * light_step + round) % lights);
                any = true;
            }
            first = next;
        }
    }
    return chosen;
}

/* ---- Reflectance ---- */

weft_rgb weft_truth_reflectance(const weft_virtual_cloth *cloth, int size, int x, int y, weft_vec3 light,
                                weft_vec3 camera)
{
    enum { SAMPLES = 8 };
    double pitch_mm = cloth->opening_mm / size;
    weft_rgb sum = {0, 0, 0};
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double x_mm = (x + (i % SAMPLES + 0.5) / SAMPLES) * pitch_mm - cloth->opening_mm / 2;
        double y_mm = cloth->opening_mm / 2 - (y + (i / SAMPLES + 0.5) / SAMPLES) * pitch_mm;
        weft_vec3 at = {x_mm, y_mm, 0};
        weft_vec3 toward_light = weft_unit(weft_subtract(light, at));
        weft_vec3 toward_camera = weft_unit(weft_subtract(camera, at));
        weft_weave_point point = weft_virtual_cloth_locate(cloth, x_mm, y_mm);
        weft_rgb brdf = weft_weave_brdf(&cloth->weave, &point, toward_light, toward_camera);
        sum = (weft_rgb){sum.r + brdf.r * toward_light.z, sum.g + brdf.g * toward_light.z,
                         sum.b + brdf.b * toward_light.z};
    }
    double mean = WEFT_PI / (SAMPLES * SAMPLES);
    return (weft_rgb){sum.r * mean, sum.g * mean, sum.b * mean};
}
