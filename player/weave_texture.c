#include "player/weave_texture.h"

#include "btf/direction.h"

#include <math.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT };

static const weft_texture_format float_format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};

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

weft_code weft_weave_texture_upload(const weft_weave_texels *texels, const weft_weave_layout *layout,
                                    weft_weave_texture *t, weft_error *error)
{
    double tiles_u = layout->tiles_u, tiles_v = layout->tiles_v;
    GLuint table = 0, mean = 0;
    if (!(tiles_u > 0) || !(tiles_v > 0) || !isfinite(tiles_u) || !isfinite(tiles_v))
        return weft_fail(error, WEFT_BAD_USAGE, "a material of %g x %g tiles cannot be shown", tiles_u, tiles_v);
    if (!t->directions.simplex)
        WEFT_TRY(upload_directions(&t->directions, error));
    WEFT_TRY(weft_gl_texture(float_format, texels->width, texels->height, 0, texels->table, &table, error));
    weft_code code = weft_gl_texture(float_format, DIRECTIONS, DIRECTIONS, 0, texels->mean, &mean, error);
    if (code != WEFT_OK) {
        glDeleteTextures(1, &table);
        return code;
    }
    glDeleteTextures(1, &t->table);
    glDeleteTextures(1, &t->mean);
    *t = (weft_weave_texture){table, mean, texels->width * texels->height, t->directions, *layout};
    return WEFT_OK;
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
    return t->table ? 16 * ((size_t)t->table_texels + DIRECTIONS * DIRECTIONS) : 0;
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
