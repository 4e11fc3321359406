#include "player/raw_texture.h"

#include <stdlib.h>
#include <string.h>

enum { BORDER = WEFT_RAW_BORDER };

static const weft_texture_format half_format = {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
static const weft_texture_format packed_format = {GL_RGB9_E5, GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV};

static const weft_texture_format *format_of(const weft_raw_texture *t)
{
    return t->plan.packed ? &packed_format : &half_format;
}

weft_raw_limits weft_raw_texture_limits(void)
{
    const size_t mebibyte = (size_t)1 << 20;
    return (weft_raw_limits){512 * mebibyte, 1000 * mebibyte, weft_gl_max_size(), weft_gl_max_layers()};
}

/* ---- Filling ---- */

weft_code weft_raw_texture_begin(const weft_raw_plan *plan, const weft_direction_map *directions, weft_raw_texture *t,
                                 weft_error *error)
{
    *t = (weft_raw_texture){.plan = *plan};
    WEFT_TRY(weft_direction_texture_upload(directions, &t->directions, error));
    WEFT_TRY(weft_gl_texture(*format_of(t), plan->layout.width * plan->columns, plan->layout.height, plan->layers, NULL,
                             &t->sample, error));
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return WEFT_OK;
}

static void put_row(const weft_raw_texture *t, const weft_raw_strip *strip, int y)
{
    const weft_texture_format *format = format_of(t);
    weft_mip_area area = t->plan.layout.area[strip->level];
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, strip->column * t->plan.layout.width + area.x - BORDER, area.y + y, 0,
                    area.width + 2 * BORDER, 1, t->plan.layers, format->layout, format->type, strip->texels);
}

weft_code weft_raw_texture_put(const weft_raw_texture *t, const weft_raw_strip *strip, weft_error *error)
{
    int height = t->plan.layout.area[strip->level].height;
    glBindTexture(GL_TEXTURE_2D_ARRAY, t->sample);
    put_row(t, strip, strip->y);
    if (strip->y == 0)
        put_row(t, strip, height);
    if (strip->y == height - 1)
        put_row(t, strip, -1);
    return weft_gl_check("uploading samples", error);
}

/* ---- At once ---- */

static weft_code begin(void *context, const weft_raw_plan *plan, weft_direction_map *directions, weft_error *error)
{
    return weft_raw_texture_begin(plan, directions, context, error);
}

static weft_code put(void *context, const weft_raw_strip *strip, weft_error *error)
{
    weft_code code = weft_raw_texture_put(context, strip, error);
    free(strip->texels);
    return code;
}

static weft_code end(void *context, bool opaque, weft_error *error)
{
    (void)error;
    weft_raw_texture *t = context;
    t->opaque = opaque;
    return WEFT_OK;
}

weft_code weft_raw_texture_upload(weft_dataset *dataset, const weft_raw_limits *limits, const weft_progress *progress,
                                  weft_raw_texture *texture, weft_error *error)
{
    *texture = (weft_raw_texture){0};
    const weft_raw_sink sink = {texture, begin, put, end};
    return weft_raw_stream(dataset, limits, progress, &sink, error);
}

void weft_raw_texture_free(weft_raw_texture *t)
{
    glDeleteTextures(1, &t->sample);
    weft_direction_texture_free(&t->directions);
    *t = (weft_raw_texture){0};
}

size_t weft_raw_texture_bytes(const weft_raw_texture *t)
{
    size_t texels =
        (size_t)t->plan.layout.width * (size_t)t->plan.layout.height * (size_t)t->plan.columns * (size_t)t->plan.layers;
    return texels * (t->plan.packed ? 4 : 8);
}

void weft_raw_texture_bind(const weft_raw_texture *t, GLuint program)
{
    float area[WEFT_MIP_LEVELS][4];
    for (int level = 0; level < t->plan.layout.level_count; level++) {
        weft_mip_area a = t->plan.layout.area[level];
        memcpy(area[level], (float[4]){(float)a.x, (float)a.y, (float)a.width, (float)a.height}, sizeof area[level]);
    }
    weft_gl_bind(program, "raw_sample", 0, GL_TEXTURE_2D_ARRAY, t->sample);
    weft_direction_texture_bind(&t->directions, program, 1);
    weft_gl_set_int(program, "level_count", t->plan.layout.level_count);
    weft_gl_set_int(program, "opaque", t->opaque || t->plan.packed);
    glUniform2i(glGetUniformLocation(program, "raw_tiles"), t->plan.columns, t->plan.layout.width);
    weft_gl_set_vec2(program, "raw_atlas_size", (double)t->plan.layout.width * t->plan.columns, t->plan.layout.height);
    glUniform4fv(glGetUniformLocation(program, "level_area"), t->plan.layout.level_count, area[0]);
}
