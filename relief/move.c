#include "relief/move.h"

#include "base/integers.h"
#include "btf/dataset/write_blocks.h"
#include "reflectance/relief/relief.h"

#include <math.h>
#include <stdlib.h>

/* From a place to where a view saw it: the texel up and to the left of that, and the shares of the next ones. */
typedef struct shift {
    int x, y;
    float right, down;
} shift;

typedef struct moving {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    const weft_move *move;
    shift *shift;                  /* [view_count] */
    int left, right, above, below; /* texels around a block that are read with it */
} moving;

/* ---- Shifts ---- */

/* To a thousandth of a texel: what stands still needs no neighbour, which may be masked. */
static double rounded(double texels)
{
    return round(1024 * texels) / 1024;
}

static shift shift_of(const moving *work, weft_vec3 view)
{
    const weft_dataset_layout *layout = work->layout;
    const float one = 1;
    double size_mm[2];
    weft_real slope[2];
    weft_dataset_size_mm(layout, size_mm);
    weft_height_field field = weft_height_field_of(&one, 1, 1, size_mm[0], size_mm[1]);
    weft_relief_slope(&field, view, slope);
    double x = rounded(-work->move->plane_mm * (double)slope[0] * layout->width),
           y = rounded(work->move->plane_mm * (double)slope[1] * layout->height); /* rows count downwards */
    return (shift){(int)floor(x), (int)floor(y), (float)(x - floor(x)), (float)(y - floor(y))};
}

static weft_code find_shifts(moving *work, weft_error *error)
{
    size_t views = (size_t)work->layout->view_count;
    work->shift = calloc(views, sizeof *work->shift);
    if (!work->shift)
        return weft_fail_memory(error, "views", views * sizeof *work->shift);
    for (size_t view = 0; view < views; view++) {
        shift s = work->shift[view] = shift_of(work, work->layout->view[view]);
        work->left = weft_larger(work->left, -s.x);
        work->right = weft_larger(work->right, s.x + 1);
        work->above = weft_larger(work->above, -s.y);
        work->below = weft_larger(work->below, s.y + 1);
    }
    return WEFT_OK;
}

/* ---- Reading ---- */

/* Texels with all of their images, from a place that may lie beyond the border. */
typedef struct region {
    int x, y, width, height;
    weft_half *samples;
    uint8_t *mask;
} region;

static void free_region(region *r)
{
    free(r->samples);
    free(r->mask);
}

static weft_code allocate_region(const moving *work, region *r, weft_error *error)
{
    size_t count = (size_t)r->width * (size_t)r->height * (size_t)work->layout->image_count;
    r->samples = calloc(3 * count, sizeof *r->samples);
    r->mask = calloc(count, 1);
    return r->samples && r->mask ? WEFT_OK : weft_fail_memory(error, "texels", 7 * count);
}

static int wrapped(int index, int count)
{
    return ((index % count) + count) % count;
}

/* Whether a texel is known, which is then that of `x` and `y` in the dataset. */
static bool find_texel(const moving *work, int *x, int *y)
{
    const weft_dataset_layout *layout = work->layout;
    bool inside = *x >= 0 && *y >= 0 && *x < layout->width && *y < layout->height;
    *x = wrapped(*x, layout->width);
    *y = wrapped(*y, layout->height);
    return inside || work->move->repeats;
}

static weft_code read_row(const moving *work, int row, region *r, weft_error *error)
{
    size_t images = (size_t)work->layout->image_count, first = (size_t)row * (size_t)r->width;
    for (int i = 0, count; i < r->width; i += count) {
        int x = r->x + i, y = r->y + row;
        weft_half *samples = r->samples + 3 * (first + (size_t)i) * images;
        uint8_t *mask = r->mask + (first + (size_t)i) * images;
        count = 1;
        if (find_texel(work, &x, &y)) {
            count = weft_smaller(r->width - i, work->layout->width - x);
            WEFT_TRY(weft_dataset_read_block(work->dataset, x, y, count, 1, samples, mask, error));
            continue;
        }
        for (size_t k = 0; k < images; k++)
            mask[k] = WEFT_MASK_MISSING;
    }
    return WEFT_OK;
}

static weft_code read_region(const moving *work, region *r, weft_error *error)
{
    WEFT_TRY(allocate_region(work, r, error));
    for (int row = 0; row < r->height; row++)
        WEFT_TRY(read_row(work, row, r, error));
    return WEFT_OK;
}

/* ---- Moving ---- */

static float share_of(const shift *s, int corner)
{
    return (corner & 1 ? s->right : 1 - s->right) * (corner & 2 ? s->down : 1 - s->down);
}

static void move_sample(const moving *work, const region *from, int x, int y, int image, weft_half *to, uint8_t *mask)
{
    const shift *s = &work->shift[work->layout->view_of_image[image]];
    size_t images = (size_t)work->layout->image_count;
    float sum[3] = {0};
    *mask = 0;
    for (int corner = 0; corner < 4; corner++) {
        float share = share_of(s, corner);
        size_t column = (size_t)(x + s->x + (corner & 1) - from->x), row = (size_t)(y + s->y + (corner >> 1) - from->y);
        size_t at = (row * (size_t)from->width + column) * images + (size_t)image;
        if (!(share > 0))
            continue;
        *mask |= from->mask[at];
        for (size_t c = 0; c < 3; c++)
            sum[c] += share * weft_float_of_half(from->samples[3 * at + c]);
    }
    for (size_t c = 0; c < 3; c++)
        to[c] = *mask ? 0 : weft_half_of_float(sum[c]);
}

static void move_texels(const moving *work, const region *from, region *to)
{
    int images = work->layout->image_count;
#pragma omp parallel for schedule(dynamic)
    for (int texel = 0; texel < to->width * to->height; texel++) {
        size_t at = (size_t)texel * (size_t)images;
        for (int i = 0; i < images; i++)
            move_sample(work, from, to->x + texel % to->width, to->y + texel / to->width, i,
                        to->samples + 3 * (at + (size_t)i), to->mask + at + (size_t)i);
    }
}

static weft_code move_block(const moving *work, int x, int y, int width, int height, weft_dataset_block_writer *writer,
                            weft_error *error)
{
    region to = {.x = x, .y = y, .width = width, .height = height};
    region from = {.x = x - work->left,
                   .y = y - work->above,
                   .width = width + work->left + work->right,
                   .height = height + work->above + work->below};
    weft_code code = allocate_region(work, &to, error);
    if (code == WEFT_OK)
        code = read_region(work, &from, error);
    if (code == WEFT_OK) {
        move_texels(work, &from, &to);
        code = weft_dataset_block_writer_put(writer, x, y, width, height, to.samples, to.mask, error);
    }
    free_region(&from);
    free_region(&to);
    return code;
}

static weft_code move_blocks(const moving *work, weft_dataset_block_writer *writer, const weft_progress *progress,
                             weft_error *error)
{
    static const char step[] = "moving texels";
    const weft_dataset_layout *layout = work->layout;
    int width, height;
    weft_dataset_block_size(layout, &width, &height);
    for (int y = 0; y < layout->height; y += height) {
        weft_progress_report(progress, step, y, layout->height);
        for (int x = 0; x < layout->width; x += width)
            WEFT_TRY(move_block(work, x, y, weft_smaller(width, layout->width - x),
                                weft_smaller(height, layout->height - y), writer, error));
    }
    weft_progress_report(progress, step, layout->height, layout->height);
    return WEFT_OK;
}

/* ---- What lies beside the samples ---- */

/* Beyond the border cloth is taken to go on as it is there. */
static float opacity_at(const moving *work, const float *opacity, int x, int y, size_t view)
{
    const weft_dataset_layout *layout = work->layout;
    int nearest_x = weft_smaller(weft_larger(x, 0), layout->width - 1),
        nearest_y = weft_smaller(weft_larger(y, 0), layout->height - 1);
    if (!find_texel(work, &x, &y)) {
        x = nearest_x;
        y = nearest_y;
    }
    return opacity[((size_t)y * (size_t)layout->width + (size_t)x) * (size_t)layout->view_count + view];
}

static void move_opacity_of_texel(const moving *work, const float *opacity, int x, int y, float *to)
{
    for (size_t view = 0; view < (size_t)work->layout->view_count; view++) {
        const shift *s = &work->shift[view];
        to[view] = 0;
        for (int corner = 0; corner < 4; corner++)
            to[view] += share_of(s, corner) *
                        opacity_at(work, opacity, x + s->x + (corner & 1), y + s->y + (corner >> 1), view);
        to[view] = fminf(to[view], 1);
    }
}

static weft_code move_opacity(const moving *work, weft_dataset_block_writer *writer, weft_error *error)
{
    const weft_dataset_layout *layout = work->layout;
    size_t texels = (size_t)layout->width * (size_t)layout->height, views = (size_t)layout->view_count;
    if (!weft_dataset_has_opacity(work->dataset))
        return WEFT_OK;
    float *opacity = malloc(2 * texels * views * sizeof *opacity);
    if (!opacity)
        return weft_fail_memory(error, "opacity", 2 * texels * views * sizeof *opacity);
    weft_code code = weft_dataset_read_opacity(work->dataset, 0, layout->height, opacity, error);
    float *moved = opacity + texels * views;
    for (size_t texel = 0; code == WEFT_OK && texel < texels; texel++)
        move_opacity_of_texel(work, opacity, (int)(texel % (size_t)layout->width), (int)(texel / (size_t)layout->width),
                              moved + texel * views);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_put_opacity(writer, moved, error);
    free(opacity);
    return code;
}

static weft_code keep_frames(const moving *work, weft_dataset_block_writer *writer, weft_error *error)
{
    size_t count = 6 * (size_t)work->layout->width * (size_t)work->layout->height;
    if (!weft_dataset_has_frames(work->dataset))
        return WEFT_OK;
    float *frames = malloc(count * sizeof *frames);
    if (!frames)
        return weft_fail_memory(error, "frames", count * sizeof *frames);
    weft_code code = weft_dataset_read_frames(work->dataset, 0, work->layout->height, frames, error);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_put_frames(writer, frames, error);
    free(frames);
    return code;
}

/* ---- The whole ---- */

static weft_code fill(moving *work, weft_dataset_block_writer *writer, const weft_progress *progress, weft_error *error)
{
    WEFT_TRY(find_shifts(work, error));
    WEFT_TRY(move_blocks(work, writer, progress, error));
    WEFT_TRY(move_opacity(work, writer, error));
    WEFT_TRY(keep_frames(work, writer, error));
    return work->move->heights ? weft_dataset_block_writer_put_heights(writer, work->move->heights, error) : WEFT_OK;
}

static weft_code check(const weft_dataset *dataset, const char *output, weft_error *error)
{
    if (weft_dataset_get_layout(dataset)->distance == WEFT_NEAR)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has near lights and views, whose texels cannot be moved",
                         weft_dataset_path(dataset));
    return weft_derived_dataset_check(dataset, output, "moved texels would replace it: give another one with -o",
                                      error);
}

weft_code weft_relief_move(weft_dataset *dataset, const weft_move *move, const char *output, json_t *made,
                           const weft_progress *progress, weft_error *error)
{
    moving work = {.dataset = dataset, .layout = weft_dataset_get_layout(dataset), .move = move};
    weft_dataset_layout layout = *work.layout;
    weft_dataset_block_writer *writer = NULL;
    layout.plane_mm = 0;
    weft_code code = check(dataset, output, error);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_create(output, &layout, &writer, error);
    if (code == WEFT_OK)
        code = fill(&work, writer, progress, error);
    free(work.shift);
    if (code == WEFT_OK)
        return weft_derived_dataset_finish(writer, work.layout, "relief", made, error);
    weft_dataset_block_writer_abandon(writer);
    json_decref(made);
    return code;
}
