#include "capture/virtual/ground_truth.h"

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

weft_rgb weft_truth_reflectance(const weft_virtual_sample *sample, int size, int x, int y, weft_vec3 light,
                                weft_vec3 camera)
{
    enum { SAMPLES = 8 };
    double pitch_mm = sample->opening_mm / size;
    weft_rgb sum = {0, 0, 0};
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double x_mm = (x + (i % SAMPLES + 0.5) / SAMPLES) * pitch_mm - sample->opening_mm / 2;
        double y_mm = sample->opening_mm / 2 - (y + (i / SAMPLES + 0.5) / SAMPLES) * pitch_mm;
        weft_vec3 at = {x_mm, y_mm, 0};
        weft_rgb value = weft_virtual_sample_reflect(sample, x_mm, y_mm, weft_unit(weft_subtract(light, at)),
                                                     weft_unit(weft_subtract(camera, at)),
                                                     (uint64_t)y * (uint64_t)size + (uint64_t)x, (uint32_t)i);
        sum = weft_rgb_add(sum, value);
    }
    return weft_rgb_scale(sum, 1.0 / (SAMPLES * SAMPLES));
}
