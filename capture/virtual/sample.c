#include "capture/virtual/sample.h"

#include "capture/virtual/random.h"

#include <string.h>

static void free_cloth(weft_virtual_cloth *cloth)
{
    weft_woven_table_free(cloth->table);
    weft_weave_free(&cloth->weave);
    *cloth = (weft_virtual_cloth){0};
}

static weft_code read_cloth(const char *path, const weft_virtual_settings *settings, uint64_t seed,
                            weft_virtual_cloth *cloth, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *cloth = (weft_virtual_cloth){.opening_mm = settings->rig.opening_mm};
    WEFT_TRY(weft_weave_read(path, NULL, 0, &cloth->weave, warning, error));
    weft_code code = weft_woven_table_create(&cloth->weave, &cloth->table, error);
    if (code != WEFT_OK) {
        free_cloth(cloth);
        return code;
    }
    weft_weave_layout layout = weft_weave_whole_tiles(&cloth->weave);
    cloth->tiles_x = (int)(settings->tiles_x > 0 ? settings->tiles_x : layout.tiles_u);
    cloth->tiles_y = (int)(settings->tiles_y > 0 ? settings->tiles_y : layout.tiles_v);
    if (settings->cloth_noise > 0)
        cloth->noise_seed = weft_random_bits(seed, WEFT_RANDOM_CLOTH, 0) | 1;
    return WEFT_OK;
}

weft_weave_point weft_virtual_cloth_locate(const weft_virtual_cloth *cloth, double x_mm, double y_mm)
{
    double u = (x_mm / cloth->opening_mm + 0.5) * cloth->tiles_x;
    double v = (y_mm / cloth->opening_mm + 0.5) * cloth->tiles_y;
    return weft_weave_locate(&cloth->weave, u, v, cloth->noise_seed);
}

static bool is_stitch(const char *path)
{
    static const char ending[] = ".stitch";
    size_t length = strlen(path), tail = sizeof ending - 1;
    return length >= tail && strcmp(path + length - tail, ending) == 0;
}

weft_code weft_virtual_sample_read(const char *path, const weft_virtual_settings *settings, uint64_t seed,
                                   weft_virtual_sample *sample, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *sample = (weft_virtual_sample){.opening_mm = settings->rig.opening_mm};
    if (!is_stitch(path))
        return read_cloth(path, settings, seed, &sample->flat, warning, error);
    warning[0] = '\0';
    if (settings->tiles_x > 0 || settings->tiles_y > 0)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': the tiles of a stitch have a size in mm, so that tiles_x and tiles_y must be 0", path);
    return weft_stitch_sample_read(path, (int)settings->bounces, &sample->deep, error);
}

void weft_virtual_sample_free(weft_virtual_sample *sample)
{
    free_cloth(&sample->flat);
    weft_stitch_sample_free(sample->deep);
    *sample = (weft_virtual_sample){0};
}

const char *weft_virtual_sample_name(const weft_virtual_sample *sample)
{
    return sample->deep ? weft_stitch_sample_stitch(sample->deep)->name : sample->flat.weave.name;
}

int weft_virtual_sample_see(const weft_virtual_sample *sample, double x_mm, double y_mm, weft_vec3 view, uint64_t key,
                            uint32_t index, weft_seen_vertex *vertex)
{
    double half = sample->opening_mm / 2;
    return weft_stitch_sample_see(sample->deep, x_mm + half, y_mm + half, view, key, index, vertex);
}

/* ---- The checker ---- */

static int check_of(double opening_mm, double at_mm)
{
    enum { CHECKS = 4 };
    double at = floor((at_mm / opening_mm + 0.5) * CHECKS);
    return (int)weft_clamp(at, 0, CHECKS - 1);
}

static double check_grey(int number)
{
    return 0.10 + 0.75 * (number % 7) / 6;
}

/* pi BRDF. */
static weft_rgb reflect_from_checker(double opening_mm, double x_mm, double y_mm, weft_vec3 light, weft_vec3 view)
{
    const double gloss = 0.15, exponent = 40, diffuse = 0.2;
    int i = check_of(opening_mm, x_mm), j = check_of(opening_mm, y_mm);
    if (i != 1 || j != 2)
        return (weft_rgb){check_grey(5 * i + 3 * j), check_grey(3 * i + 5 * j), check_grey(2 * i + 6 * j)};
    double half = fmax(weft_unit(weft_add(light, view)).z, 0);
    double value = diffuse + gloss * (exponent + 8) / 8 * pow(half, exponent);
    return (weft_rgb){value, value, value};
}

/* ---- Shading ---- */

static void shade_deep(const weft_virtual_sample *sample, double x_mm, double y_mm, const weft_vec3 *light, int count,
                       weft_vec3 view, uint64_t key, uint32_t index, weft_rgb *shade)
{
    weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
    int vertices = weft_virtual_sample_see(sample, x_mm, y_mm, view, key, index, vertex);
    for (int i = 0; i < count; i++)
        shade[i] = weft_stitch_sample_light(sample->deep, vertex, vertices, light[i]);
}

static void shade_flat(const weft_virtual_cloth *cloth, double x_mm, double y_mm, const weft_vec3 *light, int count,
                       weft_vec3 view, weft_rgb *shade)
{
    weft_weave_point point = weft_virtual_cloth_locate(cloth, x_mm, y_mm);
    for (int i = 0; i < count; i++)
        shade[i] = weft_rgb_scale(weft_weave_brdf(&cloth->weave, &point, light[i], view), WEFT_PI * light[i].z);
}

void weft_virtual_sample_shade(const weft_virtual_sample *sample, double x_mm, double y_mm, const weft_vec3 *light,
                               int count, weft_vec3 view, uint64_t key, uint32_t index, weft_rgb *shade)
{
    if (sample->deep)
        shade_deep(sample, x_mm, y_mm, light, count, view, key, index, shade);
    else if (!sample->is_checker)
        shade_flat(&sample->flat, x_mm, y_mm, light, count, view, shade);
    for (int i = 0; sample->is_checker && i < count; i++)
        shade[i] =
            weft_rgb_scale(reflect_from_checker(sample->opening_mm, x_mm, y_mm, light[i], view), fmax(light[i].z, 0));
}

weft_rgb weft_virtual_sample_reflect(const weft_virtual_sample *sample, double x_mm, double y_mm, weft_vec3 light,
                                     weft_vec3 view, uint64_t key, uint32_t index)
{
    weft_rgb shade;
    weft_virtual_sample_shade(sample, x_mm, y_mm, &light, 1, view, key, index, &shade);
    return shade;
}
