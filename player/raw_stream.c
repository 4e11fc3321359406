#include "player/raw_stream.h"

#include "player/raw_fill.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BORDER = WEFT_RAW_BORDER, MAX_BLOCK_ROWS = 16 };

/* Rows of all images on their way from the file to the sink. A level keeps its last even row until the odd one comes;
 * both together make a row of the next level. */
typedef struct stream {
    const weft_raw_plan *plan;
    const weft_raw_sink *sink;
    int image_count, level_count;
    int width[WEFT_MIP_LEVELS], height[WEFT_MIP_LEVELS];
    float *row[WEFT_MIP_LEVELS]; /* [width][image_count][4] being filled */
    float *kept[WEFT_MIP_LEVELS];
    bool opaque;
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

static void store_texel(const weft_raw_plan *plan, void *texels, size_t at, const float value[4])
{
    if (plan->packed) {
        ((uint32_t *)texels)[at] = pack_shared_exponent(value);
        return;
    }
    weft_half *texel = (weft_half *)texels + 4 * at;
    for (int c = 0; c < 4; c++)
        texel[c] = weft_half_of_float(value[c]);
}

static size_t bytes_per_texel(const weft_raw_plan *plan)
{
    return plan->packed ? sizeof(uint32_t) : 4 * sizeof(weft_half);
}

/* ---- Rows ---- */

/* The row of one column of tiles in all layers, with the borders at its ends. */
static void fill_strip(const stream *s, int width, const float *row, weft_raw_strip *strip)
{
    const float nothing[4] = {0};
    for (int layer = 0; layer < s->plan->layers; layer++) {
        int image = layer * s->plan->columns + strip->column;
        for (int x = -BORDER; x < width + BORDER; x++) {
            size_t source = (size_t)((x + width) % width) * (size_t)s->image_count + (size_t)image;
            store_texel(s->plan, strip->texels, (size_t)layer * (size_t)(width + 2 * BORDER) + (size_t)(x + BORDER),
                        image < s->image_count ? row + 4 * source : nothing);
        }
    }
}

static weft_code give_strips(const stream *s, int level, int y, weft_error *error)
{
    int width = s->width[level];
    for (int column = 0; column < s->plan->columns; column++) {
        weft_raw_strip strip = {level - s->plan->skipped_levels, column, y, 0, NULL};
        strip.bytes = (size_t)(width + 2 * BORDER) * (size_t)s->plan->layers * bytes_per_texel(s->plan);
        strip.texels = malloc(strip.bytes);
        if (!strip.texels)
            return weft_fail_memory(error, "rows of samples", strip.bytes);
        fill_strip(s, width, s->row[level], &strip);
        WEFT_TRY(s->sink->strip(s->sink->context, &strip, error));
    }
    return WEFT_OK;
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
static weft_code push_row(stream *s, int level, int y, weft_error *error)
{
    if (level >= s->plan->skipped_levels)
        WEFT_TRY(give_strips(s, level, y, error));
    if (level + 1 >= s->level_count)
        return WEFT_OK;
    bool last = y == s->height[level] - 1;
    if (y % 2 == 0 && !last) {
        float *swap = s->kept[level];
        s->kept[level] = s->row[level];
        s->row[level] = swap;
        return WEFT_OK;
    }
    const float *lower = s->row[level], *upper = y % 2 ? s->kept[level] : lower;
    halve(s, level, upper, lower, s->row[level + 1]);
    return push_row(s, level + 1, y / 2, error);
}

static weft_code stream_create(const weft_dataset_layout *layout, const weft_raw_plan *plan, const weft_raw_sink *sink,
                               stream *s, weft_error *error)
{
    *s = (stream){.plan = plan, .sink = sink, .image_count = layout->image_count, .opaque = true};
    s->level_count = plan->skipped_levels + plan->layout.level_count;
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
    return WEFT_OK;
}

static void stream_free(stream *s)
{
    for (int level = 0; level < WEFT_MIP_LEVELS; level++) {
        free(s->row[level]);
        free(s->kept[level]);
    }
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
            s->opaque &= opacity >= 1;
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
            WEFT_TRY(push_row(s, 0, y, error));
        }
    }
    weft_progress_report(progress, "loading samples", layout->height, layout->height);
    return s->sink->end(s->sink->context, s->opaque, error);
}

static weft_code stream_samples(weft_dataset *dataset, const weft_raw_images *images, const weft_raw_plan *plan,
                                const weft_raw_sink *sink, const weft_progress *progress, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    stream s = {0};
    block b = {0};
    weft_code code = stream_create(layout, plan, sink, &s, error);
    if (code == WEFT_OK)
        code = block_create(layout, &b, error);
    if (code == WEFT_OK)
        code = stream_rows(dataset, images, &s, &b, progress, error);
    block_free(&b);
    stream_free(&s);
    return code;
}

/* ---- The plan ---- */

/* Tiles side by side until the images fit into the layers there are. */
static size_t texel_total(int image_count, int most_layers, weft_raw_plan *plan)
{
    plan->columns = (image_count + most_layers - 1) / most_layers;
    plan->layers = (image_count + plan->columns - 1) / plan->columns;
    return (size_t)plan->layout.width * (size_t)plan->layout.height * (size_t)plan->columns * (size_t)plan->layers;
}

static weft_code make_plan(const weft_dataset_layout *layout, const char *path, const weft_raw_limits *limits,
                           weft_raw_plan *plan, weft_error *error)
{
    int count = weft_mip_level_count(layout->width, layout->height);
    int width = layout->width, height = layout->height;
    for (int skipped = 0; skipped < count; skipped++) {
        plan->skipped_levels = skipped;
        plan->layout = weft_mip_layout_of(width, height, count - skipped, BORDER);
        size_t texels = texel_total(layout->image_count, limits->layers, plan);
        plan->packed = texels * 8 > limits->half_bytes;
        bool fits = plan->layout.width <= limits->size / plan->columns && plan->layout.height <= limits->size;
        if (fits && texels * (plan->packed ? 4 : 8) <= limits->bytes)
            return WEFT_OK;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' has too many images for graphics memory: %d", path,
                     layout->image_count);
}

static weft_code begin(const weft_raw_images *images, const weft_dataset_layout *layout, const weft_raw_plan *plan,
                       const weft_raw_sink *sink, weft_error *error)
{
    weft_direction_map map = {0};
    weft_code code = weft_raw_images_map(images, layout, &map, error);
    if (code == WEFT_OK)
        code = sink->begin(sink->context, plan, &map, error);
    weft_direction_map_free(&map);
    return code;
}

weft_code weft_raw_stream(weft_dataset *dataset, const weft_raw_limits *limits, const weft_progress *progress,
                          const weft_raw_sink *sink, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_raw_plan plan;
    WEFT_TRY(make_plan(layout, weft_dataset_path(dataset), limits, &plan, error));
    weft_raw_images images = {0};
    weft_code code = weft_raw_images_find(dataset, &images, error);
    if (code == WEFT_OK)
        code = begin(&images, layout, &plan, sink, error);
    if (code == WEFT_OK)
        code = stream_samples(dataset, &images, &plan, sink, progress, error);
    weft_raw_images_free(&images);
    return code;
}
