#include "player/raw/stream.h"

#include <stdlib.h>

enum { MAX_BLOCK_ROWS = 16 };

static const size_t block_bytes = (size_t)64 << 20;

/* What is read at once, and one texel of it turned into what is shown. */
typedef struct block {
    int rows;
    weft_half *sample;
    uint8_t *mask;
    float *opacity, *value;
} block;

typedef struct stream {
    weft_dataset *dataset;
    const weft_raw_images *images;
    const weft_raw_sink *sink;
    weft_raw_levels *samples, *opacity;
    block block;
    bool opaque;
} stream;

static weft_code block_create(const weft_dataset_layout *layout, block *b, weft_error *error)
{
    size_t row = (size_t)layout->width * (size_t)layout->image_count, rows = block_bytes / (row * 7);
    b->rows = rows < 1 ? 1 : rows > MAX_BLOCK_ROWS ? MAX_BLOCK_ROWS : (int)rows;
    size_t block_size = row * (size_t)b->rows;
    b->sample = malloc(block_size * 3 * sizeof *b->sample);
    b->mask = malloc(block_size);
    b->opacity = malloc((size_t)layout->width * (size_t)layout->view_count * (size_t)b->rows * sizeof *b->opacity);
    b->value = malloc((size_t)layout->image_count * 3 * sizeof *b->value);
    if (b->sample && b->mask && b->opacity && b->value)
        return WEFT_OK;
    return weft_fail_memory(error, "samples", block_size * 7);
}

static weft_code stream_create(const weft_raw_plan *plan, stream *s, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(s->dataset);
    WEFT_TRY(weft_raw_levels_create(plan, WEFT_RAW_SAMPLES, layout->width, layout->height, s->sink->strip,
                                    s->sink->context, &s->samples, error));
    if (plan->tiles[WEFT_RAW_OPACITY].count > 0)
        WEFT_TRY(weft_raw_levels_create(plan, WEFT_RAW_OPACITY, layout->width, layout->height, s->sink->strip,
                                        s->sink->context, &s->opacity, error));
    return block_create(layout, &s->block, error);
}

static void stream_free(stream *s)
{
    weft_raw_levels_free(s->samples);
    weft_raw_levels_free(s->opacity);
    free(s->block.sample);
    free(s->block.mask);
    free(s->block.opacity);
    free(s->block.value);
}

/* ---- Rows ---- */

static weft_code push_samples(stream *s, int first, int y, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(s->dataset);
    int count = layout->image_count;
    float *row = weft_raw_levels_row(s->samples, y);
    for (int x = 0; x < layout->width; x++, row += 3 * (size_t)count) {
        size_t at = ((size_t)(y - first) * (size_t)layout->width + (size_t)x) * (size_t)count;
        weft_raw_texel_fill(s->images, layout, x, y, s->block.sample + 3 * at, s->block.mask + at, s->block.value);
        for (int i = 0; i < count; i++) {
            for (int c = 0; c < 3; c++)
                row[c * (size_t)count + (size_t)i] = s->block.value[3 * i + c];
        }
    }
    return weft_raw_levels_push(s->samples, y, error);
}

/* Views that are left out of the directions have no tile either. */
static weft_code push_opacity(stream *s, int first, int y, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(s->dataset);
    size_t views = (size_t)layout->view_count, width = (size_t)layout->width;
    const float *opacity = s->block.opacity + (size_t)(y - first) * width * views;
    float *row = weft_raw_levels_row(s->opacity, y);
    for (size_t x = 0; x < width; x++, opacity += views, row += views) {
        size_t tile = 0;
        for (size_t v = 0; v < views; v++) {
            if (s->images->first_of_view[v] < s->images->first_of_view[v + 1])
                row[tile++] = opacity[v];
            s->opaque &= opacity[v] >= 1;
        }
        while (tile < views)
            row[tile++] = 1;
    }
    return weft_raw_levels_push(s->opacity, y, error);
}

static weft_code push_block(stream *s, int first, int rows, weft_error *error)
{
    int width = weft_dataset_get_layout(s->dataset)->width;
    WEFT_TRY(weft_dataset_read_block(s->dataset, 0, first, width, rows, s->block.sample, s->block.mask, error));
    for (int y = first; y < first + rows; y++)
        WEFT_TRY(push_samples(s, first, y, error));
    if (!s->opacity)
        return WEFT_OK;
    WEFT_TRY(weft_dataset_read_opacity(s->dataset, first, rows, s->block.opacity, error));
    for (int y = first; y < first + rows; y++)
        WEFT_TRY(push_opacity(s, first, y, error));
    return WEFT_OK;
}

static weft_code push_all(stream *s, const weft_progress *progress, weft_error *error)
{
    int height = weft_dataset_get_layout(s->dataset)->height;
    for (int first = 0; first < height; first += s->block.rows) {
        int rows = first + s->block.rows <= height ? s->block.rows : height - first;
        weft_progress_report(progress, "loading samples", first, height);
        WEFT_TRY(push_block(s, first, rows, error));
    }
    weft_progress_report(progress, "loading samples", height, height);
    return s->sink->end(s->sink->context, s->opaque, error);
}

/* ---- Heights ---- */

/* The views that have a tile, in the order of the tiles. */
static int tiled_views(const weft_raw_images *images, const weft_dataset_layout *layout, weft_vec3 *view)
{
    int count = 0;
    for (int v = 0; v < images->view_count; v++)
        if (images->first_of_view[v] < images->first_of_view[v + 1])
            view[count++] = layout->view[v];
    return count;
}

/* For those of the views that have usable images; a plane is one height for all. A dataset of near lights has none. */
static weft_code make_relief(weft_dataset *dataset, const weft_raw_images *images, weft_relief_map *relief,
                             weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_dataset_heights heights;
    double size_mm[2];
    *relief = (weft_relief_map){0};
    WEFT_TRY(weft_dataset_read_surface(dataset, &heights, error));
    if (!heights.value)
        return WEFT_OK;
    weft_vec3 *view = malloc((size_t)layout->view_count * sizeof *view);
    weft_dataset_size_mm(layout, size_mm);
    weft_height_field field =
        weft_height_field_of(heights.value, heights.width, heights.height, size_mm[0], size_mm[1]);
    weft_code code =
        view ? weft_relief_map_make(&field, view, tiled_views(images, layout, view), heights.level_count, relief, error)
             : weft_fail_memory(error, "views", (size_t)layout->view_count * sizeof *view);
    free(view);
    weft_dataset_heights_free(&heights);
    return code;
}

/* ---- All of it ---- */

static weft_code begin(weft_dataset *dataset, const weft_raw_images *images, const weft_raw_plan *plan,
                       const weft_raw_sink *sink, weft_error *error)
{
    weft_direction_map map = {0};
    weft_relief_map relief = {0};
    weft_code code = weft_raw_images_map(images, weft_dataset_get_layout(dataset), &map, error);
    if (code == WEFT_OK)
        code = make_relief(dataset, images, &relief, error);
    if (code == WEFT_OK)
        code = sink->begin(sink->context, plan, &map, &relief, error);
    weft_direction_map_free(&map);
    weft_relief_map_free(&relief);
    return code;
}

weft_code weft_raw_stream(weft_dataset *dataset, const weft_raw_limits *limits, const weft_progress *progress,
                          const weft_raw_sink *sink, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_raw_images images = {0};
    weft_raw_plan plan;
    stream s = {.dataset = dataset, .images = &images, .sink = sink, .opaque = true};
    WEFT_TRY(weft_raw_plan_make(layout, weft_dataset_has_opacity(dataset), weft_dataset_path(dataset), limits, &plan,
                                error));
    weft_code code = weft_raw_images_find(dataset, &images, error);
    if (code == WEFT_OK)
        code = begin(dataset, &images, &plan, sink, error);
    if (code == WEFT_OK)
        code = stream_create(&plan, &s, error);
    if (code == WEFT_OK)
        code = push_all(&s, progress, error);
    stream_free(&s);
    weft_raw_images_free(&images);
    return code;
}
