#include "player/raw_texture.h"

#include "player/raw_fill.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BORDER = 1, MAX_BLOCK_ROWS = 16 };

static const weft_texture_format half_format = {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
static const weft_texture_format packed_format = {GL_RGB9_E5, GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV};

/* Rows of all images on their way from the file to the texture. A level keeps its last even row until the odd one
 * comes; both together make a row of the next level. */
typedef struct stream {
    weft_raw_texture *texture;
    int image_count, view_count, level_count;
    int width[WEFT_MIP_LEVELS], height[WEFT_MIP_LEVELS];
    float *row[WEFT_MIP_LEVELS]; /* [width][image_count][4] being filled */
    float *kept[WEFT_MIP_LEVELS];
    void *strip; /* one row of one column of tiles, all layers, as uploaded */
} stream;

/* ---- Formats ---- */

static uint32_t pack_shared_exponent(const float rgb[3])
{
    /* EXT_texture_shared_exponent: 9 bits each, exponent bias 15. */
    float largest = 0, clamped[3];
    for (int c = 0; c < 3; c++) {
        clamped[c] = rgb[c] > 0 ? fminf(rgb[c], 65408) : 0;
        largest = fmaxf(largest, clamped[c]);
    }
    int exponent;
    frexpf(largest, &exponent);
    exponent = largest > 0 && exponent > -15 ? exponent : -15;
    if (lrintf(ldexpf(largest, 9 - exponent)) == 512)
        exponent++;
    uint32_t bits = (uint32_t)(exponent + 15) << 27;
    for (int c = 0; c < 3; c++)
        bits |= (uint32_t)lrintf(ldexpf(clamped[c], 9 - exponent)) << 9 * c;
    return bits;
}

static void store_texel(const stream *s, size_t at, const float value[4])
{
    if (s->texture->packed) {
        ((uint32_t *)s->strip)[at] = pack_shared_exponent(value);
        return;
    }
    weft_half *texel = (weft_half *)s->strip + 4 * at;
    for (int c = 0; c < 4; c++)
        texel[c] = weft_half_of_float(value[c]);
}

/* ---- Rows ---- */

/* The row of one column of tiles in all layers, with the borders at its ends. */
static void fill_strip(const stream *s, int width, const float *row, int column)
{
    int columns = s->texture->columns, layers = s->texture->layers;
    const float nothing[4] = {0};
    for (int layer = 0; layer < layers; layer++) {
        int image = layer * columns + column;
        for (int x = -BORDER; x < width + BORDER; x++) {
            size_t source = (size_t)((x + width) % width) * (size_t)s->image_count + (size_t)image;
            store_texel(s, (size_t)layer * (size_t)(width + 2 * BORDER) + (size_t)(x + BORDER),
                        image < s->image_count ? row + 4 * source : nothing);
        }
    }
}

static void upload_strip(const stream *s, int level, int y, int column)
{
    const weft_texture_format *format = s->texture->packed ? &packed_format : &half_format;
    weft_mip_area area = s->texture->layout.area[level - s->texture->skipped_levels];
    int x = column * s->texture->layout.width + area.x - BORDER, width = area.width + 2 * BORDER;
    int layers = s->texture->layers;
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, area.y + y, 0, width, 1, layers, format->layout, format->type, s->strip);
    if (y == 0)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, area.y + area.height, 0, width, 1, layers, format->layout,
                        format->type, s->strip);
    if (y == area.height - 1)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, area.y - 1, 0, width, 1, layers, format->layout, format->type,
                        s->strip);
}

/* Mean of the two rows (or one, at an odd edge) and of pairs of texels along them. */
static void halve(const stream *s, int level, const float *upper, const float *lower, float *result)
{
    size_t texel_size = (size_t)s->image_count * 4;
    for (int x = 0; x < s->width[level + 1]; x++) {
        size_t left = (size_t)(2 * x) * texel_size;
        size_t right = 2 * x + 1 < s->width[level] ? left + texel_size : left;
        for (size_t i = 0; i < texel_size; i++)
            result[(size_t)x * texel_size + i] =
                (upper[left + i] + upper[right + i] + lower[left + i] + lower[right + i]) / 4;
    }
}

/* Takes row y of a level, standing in s->row[level]. */
static void push_row(stream *s, int level, int y)
{
    if (level >= s->texture->skipped_levels) {
        for (int column = 0; column < s->texture->columns; column++) {
            fill_strip(s, s->width[level], s->row[level], column);
            upload_strip(s, level, y, column);
        }
    }
    if (level + 1 >= s->level_count)
        return;
    bool last = y == s->height[level] - 1;
    if (y % 2 == 0 && !last) {
        float *swap = s->kept[level];
        s->kept[level] = s->row[level];
        s->row[level] = swap;
        return;
    }
    const float *lower = s->row[level], *upper = y % 2 ? s->kept[level] : lower;
    halve(s, level, upper, lower, s->row[level + 1]);
    push_row(s, level + 1, y / 2);
}

static weft_code stream_create(const weft_dataset_layout *layout, weft_raw_texture *texture, stream *s,
                               weft_error *error)
{
    *s = (stream){.texture = texture, .image_count = layout->image_count, .view_count = layout->view_count};
    s->level_count = texture->skipped_levels + texture->layout.level_count;
    int width = layout->width, height = layout->height, level = 0;
    do {
        size_t size = (size_t)width * (size_t)layout->image_count * 4;
        s->width[level] = width;
        s->height[level] = height;
        s->row[level] = calloc(size, sizeof(float));
        s->kept[level] = calloc(size, sizeof(float));
        if (!s->row[level] || !s->kept[level])
            return weft_fail_memory(error, "rows of samples", size * sizeof(float));
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    } while (++level < s->level_count);
    size_t strip = (size_t)(layout->width + 2 * BORDER) * (size_t)texture->layers;
    s->strip = calloc(strip, 4 * sizeof(weft_half));
    return s->strip ? WEFT_OK : weft_fail_memory(error, "rows of samples", strip * 4 * sizeof(weft_half));
}

static void stream_free(stream *s)
{
    for (int level = 0; level < WEFT_MIP_LEVELS; level++) {
        free(s->row[level]);
        free(s->kept[level]);
    }
    free(s->strip);
}

/* ---- Reading ---- */

/* Some rows of the dataset as they lie in the file. */
typedef struct block {
    int rows;
    weft_half *sample;
    uint8_t *mask;
    float *opacity, *value;
} block;

static weft_code block_create(const weft_dataset_layout *layout, block *b, weft_error *error)
{
    const size_t largest = (size_t)64 << 20;
    size_t row = (size_t)layout->width * (size_t)layout->image_count;
    size_t rows = largest / (row * 7);
    b->rows = rows < 1 ? 1 : rows > MAX_BLOCK_ROWS ? MAX_BLOCK_ROWS : (int)rows;
    b->sample = malloc(row * (size_t)b->rows * 3 * sizeof *b->sample);
    b->mask = malloc(row * (size_t)b->rows);
    b->opacity = malloc((size_t)layout->width * (size_t)layout->view_count * (size_t)b->rows * sizeof *b->opacity);
    b->value = malloc((size_t)layout->image_count * 3 * sizeof *b->value);
    if (b->sample && b->mask && b->opacity && b->value)
        return WEFT_OK;
    return weft_fail_memory(error, "samples", row * (size_t)b->rows * 7);
}

static void block_free(block *b)
{
    free(b->sample);
    free(b->mask);
    free(b->opacity);
    free(b->value);
}

static void fill_row(stream *s, const weft_raw_images *images, const weft_dataset_layout *layout, const block *b,
                     int first, int y)
{
    for (int x = 0; x < layout->width; x++) {
        size_t texel = (size_t)(y - first) * (size_t)layout->width + (size_t)x;
        size_t at = texel * (size_t)layout->image_count;
        weft_raw_texel_fill(images, layout, x, y, b->sample + 3 * at, b->mask + at, b->value);
        float *result = s->row[0] + (size_t)x * (size_t)layout->image_count * 4;
        for (int i = 0; i < layout->image_count; i++) {
            memcpy(result + 4 * i, b->value + 3 * i, 3 * sizeof(float));
            float opacity = b->opacity[texel * (size_t)layout->view_count + (size_t)layout->view_of_image[i]];
            s->texture->opaque &= opacity >= 1;
            result[4 * i + 3] = opacity;
        }
    }
}

static weft_code stream_rows(weft_dataset *dataset, const weft_raw_images *images, stream *s, block *b,
                             const weft_progress *progress, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    for (int first = 0; first < layout->height; first += b->rows) {
        int rows = first + b->rows <= layout->height ? b->rows : layout->height - first;
        weft_progress_report(progress, "loading samples", first, layout->height);
        WEFT_TRY(weft_dataset_read_block(dataset, 0, first, layout->width, rows, b->sample, b->mask, error));
        WEFT_TRY(weft_dataset_read_opacity(dataset, first, rows, b->opacity, error));
        for (int y = first; y < first + rows; y++) {
            fill_row(s, images, layout, b, first, y);
            push_row(s, 0, y);
        }
    }
    weft_progress_report(progress, "loading samples", layout->height, layout->height);
    return weft_gl_check("uploading samples", error);
}

static weft_code upload_samples(weft_dataset *dataset, const weft_raw_images *images, const weft_progress *progress,
                                weft_raw_texture *texture, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    stream s = {0};
    block b = {0};
    weft_code code = stream_create(layout, texture, &s, error);
    if (code == WEFT_OK)
        code = block_create(layout, &b, error);
    if (code == WEFT_OK)
        code = stream_rows(dataset, images, &s, &b, progress, error);
    block_free(&b);
    stream_free(&s);
    return code;
}

/* ---- The texture ---- */

/* Tiles side by side until the images fit into the layers there are. */
static size_t texel_total(const weft_dataset_layout *layout, weft_raw_texture *t)
{
    int layers = weft_gl_max_layers();
    t->columns = (layout->image_count + layers - 1) / layers;
    t->layers = (layout->image_count + t->columns - 1) / t->columns;
    return (size_t)t->layout.width * (size_t)t->layout.height * (size_t)t->columns * (size_t)t->layers;
}

static weft_code choose_levels(const weft_dataset_layout *layout, const char *path, size_t half_limit, size_t limit,
                               weft_raw_texture *t, weft_error *error)
{
    int count = weft_mip_level_count(layout->width, layout->height);
    int width = layout->width, height = layout->height;
    for (int skipped = 0; skipped < count; skipped++) {
        t->skipped_levels = skipped;
        t->layout = weft_mip_layout_of(width, height, count - skipped, BORDER);
        size_t texels = texel_total(layout, t);
        t->packed = texels * 8 > half_limit;
        bool fits = t->layout.width <= weft_gl_max_size() / t->columns && t->layout.height <= weft_gl_max_size();
        if (fits && texels * (t->packed ? 4 : 8) <= limit)
            return WEFT_OK;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' has too many images for graphics memory: %d", path,
                     layout->image_count);
}

static weft_code make_texture(weft_raw_texture *t, weft_error *error)
{
    WEFT_TRY(weft_gl_texture(t->packed ? packed_format : half_format, t->layout.width * t->columns, t->layout.height,
                             t->layers, NULL, &t->sample, error));
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return WEFT_OK;
}

static weft_code upload_directions(const weft_raw_images *images, const weft_dataset_layout *layout,
                                   weft_direction_texture *texture, weft_error *error)
{
    weft_direction_map map = {0};
    weft_code code = weft_raw_images_map(images, layout, &map, error);
    if (code == WEFT_OK)
        code = weft_direction_texture_upload(&map, texture, error);
    weft_direction_map_free(&map);
    return code;
}

weft_code weft_raw_texture_upload(weft_dataset *dataset, size_t half_limit, size_t limit, const weft_progress *progress,
                                  weft_raw_texture *texture, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    *texture = (weft_raw_texture){.opaque = true};
    WEFT_TRY(choose_levels(layout, weft_dataset_path(dataset), half_limit, limit, texture, error));
    weft_raw_images images = {0};
    weft_code code = weft_raw_images_find(dataset, &images, error);
    if (code == WEFT_OK)
        code = upload_directions(&images, layout, &texture->directions, error);
    if (code == WEFT_OK)
        code = make_texture(texture, error);
    if (code == WEFT_OK)
        code = upload_samples(dataset, &images, progress, texture, error);
    weft_raw_images_free(&images);
    return code;
}

void weft_raw_texture_free(weft_raw_texture *t)
{
    glDeleteTextures(1, &t->sample);
    weft_direction_texture_free(&t->directions);
    *t = (weft_raw_texture){0};
}

size_t weft_raw_texture_bytes(const weft_raw_texture *t)
{
    size_t texels = (size_t)t->layout.width * (size_t)t->layout.height * (size_t)t->columns * (size_t)t->layers;
    return texels * (t->packed ? 4 : 8);
}

void weft_raw_texture_bind(const weft_raw_texture *t, GLuint program)
{
    float area[WEFT_MIP_LEVELS][4];
    for (int level = 0; level < t->layout.level_count; level++) {
        weft_mip_area a = t->layout.area[level];
        memcpy(area[level], (float[4]){(float)a.x, (float)a.y, (float)a.width, (float)a.height}, sizeof area[level]);
    }
    weft_gl_bind(program, "raw_sample", 0, GL_TEXTURE_2D_ARRAY, t->sample);
    weft_direction_texture_bind(&t->directions, program, 1);
    weft_gl_set_int(program, "level_count", t->layout.level_count);
    weft_gl_set_int(program, "opaque", t->opaque || t->packed);
    glUniform2i(glGetUniformLocation(program, "raw_tiles"), t->columns, t->layout.width);
    weft_gl_set_vec2(program, "raw_atlas_size", (double)t->layout.width * t->columns, t->layout.height);
    glUniform4fv(glGetUniformLocation(program, "level_area"), t->layout.level_count, area[0]);
}
