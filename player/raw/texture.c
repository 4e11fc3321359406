#include "player/raw/texture.h"

#include <stdlib.h>

enum { BLOCK = WEFT_RAW_BLOCK };

static const weft_texture_format *format_of(const weft_raw_tiles *tiles)
{
    static const weft_texture_format format[WEFT_RAW_FORMATS] = {
        [WEFT_RAW_HALF] = {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT},
        [WEFT_RAW_SHARED_EXPONENT] = {GL_RGB9_E5, GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV},
        [WEFT_RAW_BC6H] = {GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT, 0, 0},
        [WEFT_RAW_EIGHT_BITS] = {GL_R8, GL_RED, GL_UNSIGNED_BYTE}};
    return &format[tiles->format];
}

weft_raw_limits weft_raw_texture_limits(weft_raw_format format)
{
    const size_t mebibyte = (size_t)1 << 20;
    return (weft_raw_limits){.half_bytes = 512 * mebibyte,
                             .bytes = 1000 * mebibyte,
                             .size = weft_gl_max_size(),
                             .layers = weft_gl_max_layers(),
                             .has_bc6h = weft_gl_has_bc6h(),
                             .format = format};
}

/* ---- Filling ---- */

static weft_code make_part(weft_raw_texture *t, int part, weft_error *error)
{
    const weft_raw_tiles *tiles = &t->plan.tiles[part];
    if (tiles->count == 0)
        return WEFT_OK;
    WEFT_TRY(weft_gl_texture(*format_of(tiles), t->plan.layout.width * tiles->columns, t->plan.layout.height,
                             tiles->layers, NULL, &t->part[part], error));
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return WEFT_OK;
}

weft_code weft_raw_texture_begin(const weft_raw_plan *plan, const weft_direction_map *directions,
                                 const weft_relief_map *relief, weft_raw_texture *t, weft_error *error)
{
    *t = (weft_raw_texture){.plan = *plan};
    WEFT_TRY(weft_direction_texture_upload(directions, &t->directions, error));
    WEFT_TRY(weft_relief_texture_upload(relief, &t->relief, error));
    for (int part = 0; part < WEFT_RAW_PARTS; part++)
        WEFT_TRY(make_part(t, part, error));
    return WEFT_OK;
}

weft_code weft_raw_texture_put(const weft_raw_texture *t, const weft_raw_strip *strip, weft_error *error)
{
    const weft_raw_tiles *tiles = &t->plan.tiles[strip->part];
    const weft_texture_format *format = format_of(tiles);
    weft_mip_area area = t->plan.layout.area[strip->level];
    int x = strip->column * t->plan.layout.width + area.x, y = area.y + BLOCK * strip->row;
    int width = (int)(strip->bytes / weft_raw_block_bytes(tiles->format)) / tiles->layers * BLOCK;
    glBindTexture(GL_TEXTURE_2D_ARRAY, t->part[strip->part]);
    if (format->layout == 0)
        glCompressedTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, y, 0, width, BLOCK, tiles->layers, format->internal,
                                  (GLsizei)strip->bytes, strip->texels);
    else
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, y, 0, width, BLOCK, tiles->layers, format->layout, format->type,
                        strip->texels);
    return weft_gl_check("uploading samples", error);
}

/* ---- At once ---- */

static weft_code begin(void *context, const weft_raw_plan *plan, weft_direction_map *directions,
                       weft_relief_map *relief, weft_error *error)
{
    return weft_raw_texture_begin(plan, directions, relief, context, error);
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
    glDeleteTextures(WEFT_RAW_PARTS, t->part);
    weft_direction_texture_free(&t->directions);
    weft_relief_texture_free(&t->relief);
    *t = (weft_raw_texture){0};
}

size_t weft_raw_texture_bytes(const weft_raw_texture *t)
{
    return weft_raw_plan_bytes(&t->plan, t->plan.tiles[WEFT_RAW_SAMPLES].format);
}

static void set_tiles(const weft_raw_texture *t, int part, GLuint program, const char *shape, const char *size)
{
    const weft_raw_tiles *tiles = &t->plan.tiles[part];
    int width = t->plan.layout.width;
    glUniform2i(weft_gl_uniform(program, shape), tiles->layers, width);
    weft_gl_set_vec2(program, size, (double)width * tiles->columns, t->plan.layout.height);
}

void weft_raw_texture_bind(const weft_raw_texture *t, GLuint program)
{
    float area[WEFT_MIP_LEVELS][4];
    weft_mip_layout_areas(&t->plan.layout, area);
    /* A sampler needs a texture even where it is never fetched. */
    int opacity = t->opaque ? WEFT_RAW_SAMPLES : WEFT_RAW_OPACITY;
    weft_gl_bind(program, "raw_sample", 0, GL_TEXTURE_2D_ARRAY, t->part[WEFT_RAW_SAMPLES]);
    weft_direction_texture_bind(&t->directions, program, 1);
    weft_gl_bind(program, "raw_opacity", 3, GL_TEXTURE_2D_ARRAY, t->part[opacity]);
    weft_gl_set_int(program, "level_count", t->plan.layout.level_count);
    set_tiles(t, WEFT_RAW_SAMPLES, program, "raw_tiles", "raw_atlas_size");
    set_tiles(t, opacity, program, "opacity_tiles", "opacity_atlas_size");
    weft_relief_texture_bind(&t->relief, program, 4);
    glUniform4fv(weft_gl_uniform(program, "level_area"), t->plan.layout.level_count, area[0]);
}
