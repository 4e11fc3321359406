#include "player/weave_texture.h"

#include "btf/direction.h"
#include "reflectance/weave_table.h"

#include <math.h>
#include <stdlib.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT };

static const weft_texture_format float_format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};

void weft_weave_mean_tabulate(const weft_weave *weave, weft_rgb mean[WEFT_UBO81_COUNT][WEFT_UBO81_COUNT])
{
    /* The mean is reciprocal: half of the table is enough. */
#pragma omp parallel for schedule(dynamic, 1)
    for (int view = 0; view < DIRECTIONS; view++) {
        for (int light = 0; light <= view; light++) {
            mean[view][light] = weft_weave_mean_brdf(weave, weft_direction_of_angles(weft_ubo81_angles(light)),
                                                     weft_direction_of_angles(weft_ubo81_angles(view)));
            mean[light][view] = mean[view][light];
        }
    }
}

static weft_code upload_mean(const weft_weave *weave, GLuint *texture, weft_error *error)
{
    weft_rgb(*mean)[DIRECTIONS] = malloc(sizeof *mean * DIRECTIONS);
    float(*rgba)[4] = malloc(sizeof *rgba * DIRECTIONS * DIRECTIONS);
    weft_code code = WEFT_OK;
    if (!mean || !rgba) {
        code = weft_fail_memory(error, "mean of a weave", sizeof *rgba * DIRECTIONS * DIRECTIONS);
    } else {
        weft_weave_mean_tabulate(weave, mean);
        for (int i = 0; i < DIRECTIONS * DIRECTIONS; i++) {
            weft_rgb value = mean[i / DIRECTIONS][i % DIRECTIONS];
            rgba[i][0] = (float)value.r;
            rgba[i][1] = (float)value.g;
            rgba[i][2] = (float)value.b;
            rgba[i][3] = 1;
        }
        code = weft_gl_texture(float_format, DIRECTIONS, DIRECTIONS, 0, rgba, texture, error);
    }
    free(mean);
    free(rgba);
    return code;
}

static weft_code upload_table(const weft_weave *weave, weft_weave_texture *t, weft_error *error)
{
    int width, height;
    weft_weave_table(weave, NULL, &width, &height);
    float *rgba = calloc((size_t)width * (size_t)height, 4 * sizeof *rgba);
    if (!rgba)
        return weft_fail_memory(error, "weave", (size_t)width * (size_t)height * 4 * sizeof *rgba);
    weft_weave_table(weave, rgba, &width, &height);
    t->table_texels = width * height;
    weft_code code = weft_gl_texture(float_format, width, height, 0, rgba, &t->table, error);
    free(rgba);
    return code;
}

static weft_code upload_directions(weft_direction_texture *texture, weft_error *error)
{
    weft_vec3 direction[DIRECTIONS];
    for (int i = 0; i < DIRECTIONS; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    weft_direction_map map = {0};
    weft_code code = weft_direction_map_add(&map, direction, NULL, DIRECTIONS, error);
    if (code == WEFT_OK)
        code = weft_direction_texture_upload(&map, texture, error);
    weft_direction_map_free(&map);
    return code;
}

weft_code weft_weave_texture_upload(const weft_weave *weave, const weft_weave_layout *layout, weft_weave_texture *t,
                                    weft_error *error)
{
    double tiles_u = layout->tiles_u, tiles_v = layout->tiles_v;
    *t = (weft_weave_texture){.layout = *layout};
    if (!(tiles_u > 0) || !(tiles_v > 0) || !isfinite(tiles_u) || !isfinite(tiles_v))
        return weft_fail(error, WEFT_BAD_USAGE, "a material of %g x %g tiles cannot be shown", tiles_u, tiles_v);
    WEFT_TRY(upload_table(weave, t, error));
    WEFT_TRY(upload_mean(weave, &t->mean, error));
    return upload_directions(&t->directions, error);
}

void weft_weave_texture_free(weft_weave_texture *t)
{
    glDeleteTextures(1, &t->table);
    glDeleteTextures(1, &t->mean);
    weft_direction_texture_free(&t->directions);
    *t = (weft_weave_texture){0};
}

size_t weft_weave_texture_bytes(const weft_weave_texture *t)
{
    return 16 * ((size_t)t->table_texels + DIRECTIONS * DIRECTIONS);
}

void weft_weave_texture_bind(const weft_weave_texture *t, GLuint program)
{
    weft_gl_bind(program, "weave_table", 0, GL_TEXTURE_2D, t->table);
    weft_gl_bind(program, "weave_mean", 1, GL_TEXTURE_2D, t->mean);
    weft_direction_texture_bind(&t->directions, program, 2);
    weft_gl_set_int(program, "opaque", 1);
    weft_gl_set_vec2(program, "weave_tiles", t->layout.tiles_u, t->layout.tiles_v);
    weft_gl_set_vec2(program, "weave_corner", t->layout.corner_u, t->layout.corner_v);
}
