#include "player/texture/relief_map.h"

#include <math.h>
#include <stdlib.h>

static weft_code allocate(weft_relief_map *map, weft_error *error)
{
    size_t places = (size_t)map->width * (size_t)map->height, views = (size_t)map->view_count;
    map->share = malloc(places * sizeof *map->share);
    map->seen = malloc(places * views);
    map->slope = malloc(2 * views * sizeof *map->slope);
    return map->share && map->seen && map->slope ? WEFT_OK : weft_fail_memory(error, "heights", places * views);
}

static void fill(const weft_height_field *field, const weft_vec3 *view, weft_relief_map *map)
{
    size_t places = (size_t)field->width * (size_t)field->height;
    float range = field->high - field->low, scale = range > 0 ? 65535 / range : 0;
    for (size_t i = 0; i < places; i++)
        map->share[i] = (uint16_t)lroundf((field->value[i] - field->low) * scale);
#pragma omp parallel for schedule(dynamic)
    for (int v = 0; v < map->view_count; v++) {
        weft_real slope[2];
        weft_relief_slope(field, view[v], slope);
        map->slope[2 * v] = (float)slope[0];
        map->slope[2 * v + 1] = (float)slope[1];
        weft_relief_see(field, view[v], map->seen + (size_t)v * places);
    }
}

weft_code weft_relief_map_make(const weft_height_field *field, const weft_vec3 *view, int view_count, int level_count,
                               weft_relief_map *map, weft_error *error)
{
    *map = (weft_relief_map){.width = field->width,
                             .height = field->height,
                             .view_count = view_count,
                             .level_count = level_count,
                             .range_mm = {(double)field->low, (double)field->high},
                             .size_mm = {field->width_mm, field->height_mm}};
    weft_code code = allocate(map, error);
    if (code == WEFT_OK)
        fill(field, view, map);
    else
        weft_relief_map_free(map);
    return code;
}

void weft_relief_map_free(weft_relief_map *map)
{
    free(map->share);
    free(map->seen);
    free(map->slope);
    *map = (weft_relief_map){0};
}

/* ---- On the graphics card ---- */

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
