#include "capture/synthetic/scene.h"

#include "capture/virtual/ground_truth.h"

#include <string.h>

weft_code weft_synthetic_content_read(const char *name, double opening_mm, uint64_t seed,
                                      weft_synthetic_content *content, char warning[WEFT_MESSAGE_SIZE],
                                      weft_error *error)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.rig.opening_mm = opening_mm;
    *content = (weft_synthetic_content){.opening_mm = opening_mm, .is_checker = strcmp(name, "checker") == 0};
    warning[0] = '\0';
    return content->is_checker ? WEFT_OK
                               : weft_virtual_sample_read(name, &settings, seed, &content->cloth, warning, error);
}

void weft_synthetic_content_free(weft_synthetic_content *content)
{
    if (!content->is_checker)
        weft_virtual_sample_free(&content->cloth);
}

/* ---- The checker ---- */

static const double gloss = 0.15, gloss_exponent = 40, gloss_diffuse = 0.2;

static int check_of(double opening_mm, double at_mm)
{
    double at = floor((at_mm / opening_mm + 0.5) * WEFT_SYNTHETIC_CHECKS);
    return (int)weft_clamp(at, 0, WEFT_SYNTHETIC_CHECKS - 1);
}

static double check_grey(int number)
{
    return 0.10 + 0.75 * (number % 7) / 6;
}

weft_rgb weft_synthetic_checker(double opening_mm, double x_mm, double y_mm, weft_vec3 light, weft_vec3 view)
{
    int i = check_of(opening_mm, x_mm), j = check_of(opening_mm, y_mm);
    if (i != 1 || j != 2)
        return (weft_rgb){check_grey(5 * i + 3 * j), check_grey(3 * i + 5 * j), check_grey(2 * i + 6 * j)};
    double half = fmax(weft_unit(weft_add(light, view)).z, 0);
    double value = gloss_diffuse + gloss * (gloss_exponent + 8) / 8 * pow(half, gloss_exponent);
    return (weft_rgb){value, value, value};
}

/* ---- Shading ---- */

static weft_rgb times(weft_rgb colour, double scale)
{
    return (weft_rgb){colour.r * scale, colour.g * scale, colour.b * scale};
}

static void shade_deep(const weft_synthetic_content *content, const weft_synthetic_glance *g, weft_rgb *shade)
{
    weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
    int count = weft_virtual_sample_see(&content->cloth, g->x_mm, g->y_mm, g->toward_camera, g->key, g->index, vertex);
    for (int i = 0; i < g->light_count; i++)
        shade[i] = weft_stitch_sample_light(content->cloth.deep, vertex, count, g->toward_light[i]);
}

static void shade_flat(const weft_synthetic_content *content, const weft_synthetic_glance *g, weft_rgb *shade)
{
    const weft_virtual_cloth *cloth = &content->cloth.flat;
    weft_weave_point point = weft_virtual_cloth_locate(cloth, g->x_mm, g->y_mm);
    for (int i = 0; i < g->light_count; i++) {
        weft_rgb brdf = weft_weave_brdf(&cloth->weave, &point, g->toward_light[i], g->toward_camera);
        shade[i] = times(brdf, WEFT_PI * g->toward_light[i].z);
    }
}

static void shade_checker(const weft_synthetic_content *content, const weft_synthetic_glance *g, weft_rgb *shade)
{
    for (int i = 0; i < g->light_count; i++) {
        weft_vec3 light = g->toward_light[i];
        shade[i] = times(weft_synthetic_checker(content->opening_mm, g->x_mm, g->y_mm, light, g->toward_camera),
                         fmax(light.z, 0));
    }
}

void weft_synthetic_content_shade(const weft_synthetic_content *content, const weft_synthetic_glance *glance,
                                  weft_rgb shade[WEFT_SYNTHETIC_LIGHTS])
{
    if (content->is_checker)
        shade_checker(content, glance, shade);
    else if (content->cloth.deep)
        shade_deep(content, glance, shade);
    else
        shade_flat(content, glance, shade);
}

/* ---- Truth ---- */

static weft_rgb checker_truth(const weft_synthetic_content *content, int size, int x, int y, weft_vec3 light,
                              weft_vec3 camera)
{
    enum { SIDE = 8 };
    double pitch_mm = content->opening_mm / size;
    weft_rgb sum = {0, 0, 0};
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x_mm = (x + (i % SIDE + 0.5) / SIDE) * pitch_mm - content->opening_mm / 2;
        double y_mm = content->opening_mm / 2 - (y + (i / SIDE + 0.5) / SIDE) * pitch_mm;
        weft_vec3 at = {x_mm, y_mm, 0}, toward = weft_unit(weft_subtract(light, at));
        weft_rgb value =
            weft_synthetic_checker(content->opening_mm, x_mm, y_mm, toward, weft_unit(weft_subtract(camera, at)));
        value = times(value, fmax(toward.z, 0) / (SIDE * SIDE));
        sum = (weft_rgb){sum.r + value.r, sum.g + value.g, sum.b + value.b};
    }
    return sum;
}

weft_rgb weft_synthetic_content_truth(const weft_synthetic_content *content, int size, int x, int y, weft_vec3 light,
                                      weft_vec3 camera)
{
    return content->is_checker ? checker_truth(content, size, x, y, light, camera)
                               : weft_truth_reflectance(&content->cloth, size, x, y, light, camera);
}
