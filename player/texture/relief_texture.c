#include "player/texture/relief_texture.h"

#include <stdlib.h>

/* Filtered and repeated, as the material is. */
static weft_code make_map(weft_texture_format format, int width, int height, int components, const void *data,
                          GLuint *texture, weft_error *error)
{
    GLenum target = components > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    weft_code code = weft_gl_texture(format, width, height, components, data, texture, error);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    WEFT_TRY(code);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_REPEAT);
    return WEFT_OK;
}

static weft_code upload_heights(const weft_relief_map *map, GLuint *texture, weft_error *error)
{
    const weft_texture_format half = {GL_R16F, GL_RED, GL_FLOAT};
    size_t places = (size_t)map->width * (size_t)map->height;
    float *share = malloc(places * sizeof *share);
    if (!share)
        return weft_fail_memory(error, "heights", places * sizeof *share);
    for (size_t i = 0; i < places; i++)
        share[i] = (float)map->share[i] / 65535;
    weft_code code = make_map(half, map->width, map->height, 0, share, texture, error);
    free(share);
    return code;
}

weft_code weft_relief_texture_upload(const weft_relief_map *map, weft_relief_texture *t, weft_error *error)
{
    const weft_texture_format byte = {GL_R8, GL_RED, GL_UNSIGNED_BYTE}, pair = {GL_RG32F, GL_RG, GL_FLOAT};
    size_t places = (size_t)map->width * (size_t)map->height, views = (size_t)map->view_count;
    *t = (weft_relief_texture){.level_count = map->level_count, .bytes = places * (2 + views) + 8 * views};
    if (map->width == 0)
        return WEFT_OK;
    for (int i = 0; i < 2; i++) {
        t->range_mm[i] = map->range_mm[i];
        t->size_mm[i] = map->size_mm[i];
    }
    WEFT_TRY(upload_heights(map, &t->height, error));
    WEFT_TRY(make_map(byte, map->width, map->height, map->view_count, map->seen, &t->seen, error));
    return weft_gl_texture(pair, map->view_count, 1, 0, map->slope, &t->slope, error);
}

void weft_relief_texture_free(weft_relief_texture *t)
{
    glDeleteTextures(3, (const GLuint[]){t->height, t->seen, t->slope});
    *t = (weft_relief_texture){0};
}

void weft_relief_texture_bind(const weft_relief_texture *t, GLuint program, int unit)
{
    if (t->height == 0)
        return;
    weft_gl_bind(program, "relief_height", unit, GL_TEXTURE_2D, t->height);
    weft_gl_bind(program, "relief_seen", unit + 1, GL_TEXTURE_2D_ARRAY, t->seen);
    weft_gl_bind(program, "relief_slope", unit + 2, GL_TEXTURE_2D, t->slope);
    weft_gl_set_vec2(program, "relief_range", t->range_mm[0], t->range_mm[1]);
    weft_gl_set_vec2(program, "relief_size", t->size_mm[0], t->size_mm[1]);
    weft_gl_set_float(program, "relief_levels", t->level_count);
}
