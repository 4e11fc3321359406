#include "compress/hold_out/texel_subset.h"

#include "base/integers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Which texels ---- */

/* Columns and rows of the subset lie `stride` apart from the first one on; a scattered texel is moved inside its cell
 * of width / columns by height / rows, and so is a square. */
typedef struct texel_choice {
    weft_texel_subset_kind kind;
    int square_side;   /* of neighbours; 0 where there are no squares */
    int width, height; /* of the dataset */
    int columns, rows, stride, first_x, first_y;
} texel_choice;

static texel_choice choose_texels(const weft_dataset_layout *layout, weft_texel_subset_kind kind, int side)
{
    texel_choice choice = {.kind = kind,
                           .width = layout->width,
                           .height = layout->height,
                           .columns = weft_smaller(side, layout->width),
                           .rows = weft_smaller(side, layout->height),
                           .stride = 1};
    if (kind == WEFT_TEXEL_SUBSET_PATCHES || kind == WEFT_TEXEL_SUBSET_SMALL_PATCHES)
        choice.square_side = kind == WEFT_TEXEL_SUBSET_PATCHES ? 16 : 4;
    if (kind == WEFT_TEXEL_SUBSET_REGULAR)
        choice.stride = weft_smaller(layout->width / choice.columns, layout->height / choice.rows);
    choice.first_x = (layout->width - (choice.columns - 1) * choice.stride - 1) / 2;
    choice.first_y = (layout->height - (choice.rows - 1) * choice.stride - 1) / 2;
    return choice;
}

/* Column or row of the dataset for the `index`-th of `count`, where squares of so many texels along a `side` lie `at`
 * from 0 to below 1 in their cells. */
static int place_in_square(int index, int count, int texels, int side, double at)
{
    int squares = (count + side - 1) / side, square = index / side;
    int from = (int)((long)texels * square / squares), to = (int)((long)texels * (square + 1) / squares);
    return count == texels ? index : from + (int)(at * (to - from - side + 1)) + index % side;
}

static void place_of_square(const texel_choice *choice, int i, int j, int *x, int *y)
{
    int side = choice->square_side, across = (choice->columns + side - 1) / side;
    double number = (double)(j / side) * across + i / side + 1;
    *x = place_in_square(i, choice->columns, choice->width, side, weft_scattered_number(0, number));
    *y = place_in_square(j, choice->rows, choice->height, side, weft_scattered_number(1, number));
}

/* Place in the dataset of texel (i, j) of the subset. */
static void place_of_texel(const texel_choice *choice, int i, int j, int *x, int *y)
{
    *x = choice->first_x + i * choice->stride;
    *y = choice->first_y + j * choice->stride;
    if (choice->kind == WEFT_TEXEL_SUBSET_SCATTERED)
        weft_scattered_texel(choice->columns, choice->rows, choice->width, choice->height, i, j, x, y);
    if (choice->square_side > 0)
        place_of_square(choice, i, j, x, y);
}

static int neighbours_of(const texel_choice *choice)
{
    if (choice->kind == WEFT_TEXEL_SUBSET_BLOCK)
        return weft_larger(choice->columns, choice->rows);
    return weft_larger(choice->square_side, 1);
}

/* ---- Layouts ---- */

/* From the centre of the dataset to that of the subset, mm. */
static weft_vec3 offset_of(const texel_choice *choice, double pitch)
{
    double x = choice->first_x + 0.5 - 0.5 * choice->width - (0.5 - 0.5 * choice->columns) * choice->stride;
    double y = 0.5 * choice->height - choice->first_y - 0.5 - (0.5 * choice->rows - 0.5) * choice->stride;
    return weft_vec3_of(pitch * x, pitch * y, 0);
}

weft_code weft_texel_subset_make_layout(const weft_dataset_layout *source, int columns, int rows, int stride,
                                        weft_vec3 offset, weft_dataset_layout *layout, weft_error *error)
{
    *layout = (weft_dataset_layout){.width = columns,
                                    .height = rows,
                                    .image_count = source->image_count,
                                    .view_count = source->view_count,
                                    .values = source->values,
                                    .distance = source->distance,
                                    .texel_pitch_mm = source->texel_pitch_mm * stride,
                                    .texel_aspect = source->texel_aspect};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int image = 0; image < source->image_count; image++) {
        layout->light[image] = weft_subtract(source->light[image], offset);
        layout->view_of_image[image] = source->view_of_image[image];
    }
    for (int view = 0; view < source->view_count; view++)
        layout->view[view] = weft_subtract(source->view[view], offset);
    if (source->figure[WEFT_IMAGE_WEIGHT]) {
        WEFT_TRY(weft_dataset_layout_allocate_figure(layout, WEFT_IMAGE_WEIGHT, error));
        memcpy(layout->figure[WEFT_IMAGE_WEIGHT], source->figure[WEFT_IMAGE_WEIGHT],
               (size_t)source->image_count * sizeof *source->figure[WEFT_IMAGE_WEIGHT]);
    }
    return WEFT_OK;
}

static weft_code make_layout(const weft_dataset_layout *source, const texel_choice *choice, weft_dataset_layout *layout,
                             weft_error *error)
{
    bool is_near = source->distance == WEFT_NEAR;
    weft_vec3 offset = is_near ? offset_of(choice, source->texel_pitch_mm) : weft_vec3_of(0, 0, 0);
    return weft_texel_subset_make_layout(source, choice->columns, choice->rows, choice->stride, offset, layout, error);
}

/* ---- Reading ---- */

static weft_code read_samples(weft_dataset *dataset, const texel_choice *choice, weft_texel_subset *subset,
                              weft_error *error)
{
    size_t images = (size_t)subset->layout.image_count;
    size_t texels = (size_t)choice->columns * (size_t)choice->rows;
    subset->samples = malloc(3 * texels * images * sizeof *subset->samples);
    subset->mask = malloc(texels * images);
    if (!subset->samples || !subset->mask)
        return weft_fail_memory(error, "samples", 7 * texels * images);
    if (choice->kind == WEFT_TEXEL_SUBSET_BLOCK)
        return weft_dataset_read_block(dataset, choice->first_x, choice->first_y, choice->columns, choice->rows,
                                       subset->samples, subset->mask, error);
    for (size_t texel = 0; texel < texels; texel++) {
        int x, y;
        place_of_texel(choice, (int)(texel % (size_t)choice->columns), (int)(texel / (size_t)choice->columns), &x, &y);
        WEFT_TRY(weft_dataset_read_block(dataset, x, y, 1, 1, subset->samples + 3 * texel * images,
                                         subset->mask + texel * images, error));
    }
    return WEFT_OK;
}

typedef weft_code read_rows(weft_dataset *dataset, int y, int height, float *values, weft_error *error);

/* What a dataset keeps beside its samples: `each` numbers a texel. */
static weft_code read_numbers(weft_dataset *dataset, const texel_choice *choice, read_rows *read, size_t each,
                              float **numbers, weft_error *error)
{
    size_t row_floats = (size_t)choice->width * each;
    float *row = malloc(row_floats * sizeof *row);
    *numbers = malloc((size_t)choice->columns * (size_t)choice->rows * each * sizeof **numbers);
    weft_code code = row && *numbers ? WEFT_OK : weft_fail_memory(error, "rows", row_floats * sizeof *row);
    for (int j = 0, held = -1; code == WEFT_OK && j < choice->rows; j++) {
        for (int i = 0; code == WEFT_OK && i < choice->columns; i++) {
            int x, y;
            place_of_texel(choice, i, j, &x, &y);
            if (y != held)
                code = read(dataset, y, 1, row, error);
            held = y;
            size_t texel = (size_t)j * (size_t)choice->columns + (size_t)i;
            if (code == WEFT_OK)
                memcpy(*numbers + texel * each, row + (size_t)x * each, each * sizeof *row);
        }
    }
    free(row);
    return code;
}

weft_code weft_texel_subset_read(weft_dataset *dataset, weft_texel_subset_kind kind, int side,
                                 weft_texel_subset *subset, weft_error *error)
{
    const weft_dataset_layout *source = weft_dataset_get_layout(dataset);
    texel_choice choice = choose_texels(source, kind, side);
    *subset = (weft_texel_subset){.window = {choice.first_x, choice.first_y, source->width, source->height},
                                  .neighbours = neighbours_of(&choice)};
    weft_dataset_size_mm(source, subset->whole_mm);
    weft_code code = make_layout(source, &choice, &subset->layout, error);
    if (code == WEFT_OK)
        code = read_samples(dataset, &choice, subset, error);
    if (code == WEFT_OK && weft_dataset_has_opacity(dataset))
        code = read_numbers(dataset, &choice, weft_dataset_read_opacity, (size_t)source->view_count, &subset->opacity,
                            error);
    if (code == WEFT_OK && weft_dataset_has_frames(dataset))
        code = read_numbers(dataset, &choice, weft_dataset_read_frames, 6, &subset->frames, error);
    if (code == WEFT_OK && kind == WEFT_TEXEL_SUBSET_BLOCK)
        code = weft_dataset_read_surface(dataset, &subset->surface, error);
    if (code != WEFT_OK)
        weft_texel_subset_free(subset);
    return code;
}

void weft_texel_subset_free(weft_texel_subset *subset)
{
    weft_dataset_layout_free(&subset->layout);
    free(subset->samples);
    free(subset->mask);
    free(subset->opacity);
    free(subset->frames);
    weft_dataset_heights_free(&subset->surface);
    *subset = (weft_texel_subset){0};
}

/* ---- A part ---- */

weft_texel_block weft_texel_subset_middle(const weft_texel_subset *subset, int side)
{
    const weft_dataset_layout *layout = &subset->layout;
    int width = weft_smaller(side, layout->width), height = weft_smaller(side, layout->height);
    return (weft_texel_block){(layout->width - width) / 2, (layout->height - height) / 2, width, height};
}

/* Of `each` bytes a texel; NULL of NULL. */
static weft_code crop_array(const weft_texel_subset *subset, const weft_texel_block *block, size_t each,
                            const void *whole, void **result, weft_error *error)
{
    size_t row = (size_t)block->width * each, bytes = row * (size_t)block->height;
    if (!whole)
        return WEFT_OK;
    *result = malloc(bytes);
    if (!*result)
        return weft_fail_memory(error, "texels", bytes);
    for (int y = 0; y < block->height; y++) {
        size_t first = (size_t)(block->y + y) * (size_t)subset->layout.width + (size_t)block->x;
        memcpy((char *)*result + (size_t)y * row, (const char *)whole + first * each, row);
    }
    return WEFT_OK;
}

static weft_code crop(const weft_texel_subset *subset, const weft_texel_block *block, weft_texel_subset *result,
                      weft_error *error)
{
    size_t images = (size_t)subset->layout.image_count, views = (size_t)subset->layout.view_count;
    const texel_choice choice = {.width = subset->layout.width,
                                 .height = subset->layout.height,
                                 .columns = block->width,
                                 .rows = block->height,
                                 .stride = 1};
    void *samples = NULL, *mask = NULL, *opacity = NULL, *frames = NULL;
    weft_code code = make_layout(&subset->layout, &choice, &result->layout, error);
    if (code == WEFT_OK)
        code = crop_array(subset, block, 3 * images * sizeof(weft_half), subset->samples, &samples, error);
    if (code == WEFT_OK)
        code = crop_array(subset, block, images, subset->mask, &mask, error);
    if (code == WEFT_OK)
        code = crop_array(subset, block, views * sizeof(float), subset->opacity, &opacity, error);
    if (code == WEFT_OK)
        code = crop_array(subset, block, 6 * sizeof(float), subset->frames, &frames, error);
    result->samples = samples;
    result->mask = mask;
    result->opacity = opacity;
    result->frames = frames;
    return code;
}

weft_code weft_texel_subset_crop(const weft_texel_subset *subset, const weft_texel_block *block,
                                 weft_texel_subset *result, weft_error *error)
{
    *result = (weft_texel_subset){.window = subset->window, .neighbours = subset->neighbours};
    result->window.x += block->x;
    result->window.y += block->y;
    weft_code code = crop(subset, block, result, error);
    if (code != WEFT_OK)
        weft_texel_subset_free(result);
    return code;
}

/* ---- The surface ---- */

bool weft_texel_subset_is_masked(const weft_texel_subset *subset)
{
    const weft_dataset_layout *layout = &subset->layout;
    size_t count = (size_t)layout->width * (size_t)layout->height * (size_t)layout->image_count, masked = 0;
    while (masked < count && subset->mask[masked])
        masked++;
    return masked == count;
}

bool weft_texel_subset_has_surface(const weft_texel_subset *subset)
{
    return subset->surface.value != NULL;
}

weft_code weft_texel_subset_give_heights(const weft_texel_subset *subset, weft_material *material, weft_error *error)
{
    const weft_dataset_heights *surface = &subset->surface;
    weft_material_heights *heights;
    WEFT_TRY(weft_material_heights_create(surface->value, surface->width, surface->height, surface->level_count,
                                          subset->whole_mm, &heights, error));
    weft_material_take_heights(material, heights);
    return WEFT_OK;
}

/* ---- Scattered ---- */

/* Its steps are the powers of 1 / 1.32472, the plastic number. */
double weft_scattered_number(int axis, double number)
{
    static const double step[2] = {0.7548776662466927, 0.5698402909980532};
    return fmod(step[axis] * number, 1);
}

/* A place in the cell `index` of `count` that `texels` are cut into; `at` from 0 to below 1. */
static int place_in_cell(int index, int count, int texels, double at)
{
    int from = (int)((long)texels * index / count), to = (int)((long)texels * (index + 1) / count);
    return from + (int)(at * (to - from));
}

void weft_scattered_texel(int columns, int rows, int width, int height, int i, int j, int *x, int *y)
{
    double number = (double)j * columns + i + 1;
    *x = place_in_cell(i, columns, width, weft_scattered_number(0, number));
    *y = place_in_cell(j, rows, height, weft_scattered_number(1, number));
}
