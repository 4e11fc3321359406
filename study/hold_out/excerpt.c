#include "study/hold_out/excerpt.h"

#include "base/integers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Which texels ---- */

/* Columns and rows of the excerpt lie `stride` apart from the first one on; a scattered texel is moved inside its cell
 * of width / columns by height / rows. */
typedef struct texel_choice {
    weft_excerpt_kind kind;
    int width, height; /* of the dataset */
    int columns, rows, stride, first_x, first_y;
} texel_choice;

static texel_choice choose_texels(const weft_dataset_layout *layout, weft_excerpt_kind kind, int side)
{
    texel_choice choice = {.kind = kind,
                           .width = layout->width,
                           .height = layout->height,
                           .columns = weft_smaller(side, layout->width),
                           .rows = weft_smaller(side, layout->height),
                           .stride = 1};
    if (kind == WEFT_EXCERPT_REGULAR)
        choice.stride = weft_smaller(layout->width / choice.columns, layout->height / choice.rows);
    choice.first_x = (layout->width - (choice.columns - 1) * choice.stride - 1) / 2;
    choice.first_y = (layout->height - (choice.rows - 1) * choice.stride - 1) / 2;
    return choice;
}

/* A place in the cell `index` of `count` that `texels` are cut into; `at` from 0 to below 1. */
static int place_in_cell(int index, int count, int texels, double at)
{
    int from = (int)((long)texels * index / count), to = (int)((long)texels * (index + 1) / count);
    return from + (int)(at * (to - from));
}

/* Place in the dataset of texel (i, j) of the excerpt. Scattered ones follow the additive sequence whose steps are the
 * powers of 1 / 1.32472, the plastic number: it fills a square evenly and has no period. */
static void place_of_texel(const texel_choice *choice, int i, int j, int *x, int *y)
{
    double number = (double)j * choice->columns + i + 1;
    *x = choice->first_x + i * choice->stride;
    *y = choice->first_y + j * choice->stride;
    if (choice->kind == WEFT_EXCERPT_SCATTERED) {
        *x = place_in_cell(i, choice->columns, choice->width, fmod(0.7548776662466927 * number, 1));
        *y = place_in_cell(j, choice->rows, choice->height, fmod(0.5698402909980532 * number, 1));
    }
}

/* ---- Layouts ---- */

/* From the centre of the dataset to that of the excerpt, mm. */
static weft_vec3 offset_of(const texel_choice *choice, double pitch)
{
    double x = choice->first_x + 0.5 - 0.5 * choice->width - (0.5 - 0.5 * choice->columns) * choice->stride;
    double y = 0.5 * choice->height - choice->first_y - 0.5 - (0.5 * choice->rows - 0.5) * choice->stride;
    return weft_vec3_of(pitch * x, pitch * y, 0);
}

static weft_code make_layout(const weft_dataset_layout *source, const texel_choice *choice, weft_dataset_layout *layout,
                             weft_error *error)
{
    *layout = (weft_dataset_layout){.width = choice->columns,
                                    .height = choice->rows,
                                    .image_count = source->image_count,
                                    .view_count = source->view_count,
                                    .values = source->values,
                                    .distance = source->distance,
                                    .texel_pitch_mm = source->texel_pitch_mm * choice->stride,
                                    .texel_aspect = source->texel_aspect};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    bool is_near = source->distance == WEFT_NEAR;
    weft_vec3 offset = is_near ? offset_of(choice, source->texel_pitch_mm) : weft_vec3_of(0, 0, 0);
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

/* ---- Reading ---- */

static weft_code read_samples(weft_dataset *dataset, const texel_choice *choice, weft_excerpt *excerpt,
                              weft_error *error)
{
    size_t images = (size_t)excerpt->layout.image_count;
    size_t texels = (size_t)choice->columns * (size_t)choice->rows;
    excerpt->samples = malloc(3 * texels * images * sizeof *excerpt->samples);
    excerpt->mask = malloc(texels * images);
    if (!excerpt->samples || !excerpt->mask)
        return weft_fail_memory(error, "samples", 7 * texels * images);
    if (choice->kind == WEFT_EXCERPT_BLOCK)
        return weft_dataset_read_block(dataset, choice->first_x, choice->first_y, choice->columns, choice->rows,
                                       excerpt->samples, excerpt->mask, error);
    for (size_t texel = 0; texel < texels; texel++) {
        int x, y;
        place_of_texel(choice, (int)(texel % (size_t)choice->columns), (int)(texel / (size_t)choice->columns), &x, &y);
        WEFT_TRY(weft_dataset_read_block(dataset, x, y, 1, 1, excerpt->samples + 3 * texel * images,
                                         excerpt->mask + texel * images, error));
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

weft_code weft_excerpt_read(weft_dataset *dataset, weft_excerpt_kind kind, int side, weft_excerpt *excerpt,
                            weft_error *error)
{
    const weft_dataset_layout *source = weft_dataset_get_layout(dataset);
    texel_choice choice = choose_texels(source, kind, side);
    *excerpt = (weft_excerpt){.window = {choice.first_x, choice.first_y, source->width, source->height}};
    weft_dataset_size_mm(source, excerpt->whole_mm);
    weft_code code = make_layout(source, &choice, &excerpt->layout, error);
    if (code == WEFT_OK)
        code = read_samples(dataset, &choice, excerpt, error);
    if (code == WEFT_OK && weft_dataset_has_opacity(dataset))
        code = read_numbers(dataset, &choice, weft_dataset_read_opacity, (size_t)source->view_count, &excerpt->opacity,
                            error);
    if (code == WEFT_OK && weft_dataset_has_frames(dataset))
        code = read_numbers(dataset, &choice, weft_dataset_read_frames, 6, &excerpt->frames, error);
    if (code == WEFT_OK && kind == WEFT_EXCERPT_BLOCK)
        code = weft_dataset_read_surface(dataset, &excerpt->surface, error);
    if (code != WEFT_OK)
        weft_excerpt_free(excerpt);
    return code;
}

void weft_excerpt_free(weft_excerpt *excerpt)
{
    weft_dataset_layout_free(&excerpt->layout);
    free(excerpt->samples);
    free(excerpt->mask);
    free(excerpt->opacity);
    free(excerpt->frames);
    weft_dataset_heights_free(&excerpt->surface);
    *excerpt = (weft_excerpt){0};
}

/* ---- A part ---- */

weft_texel_block weft_excerpt_middle(const weft_excerpt *excerpt, int side)
{
    const weft_dataset_layout *layout = &excerpt->layout;
    int width = weft_smaller(side, layout->width), height = weft_smaller(side, layout->height);
    return (weft_texel_block){(layout->width - width) / 2, (layout->height - height) / 2, width, height};
}

/* Of `each` bytes a texel; NULL of NULL. */
static weft_code crop_array(const weft_excerpt *excerpt, const weft_texel_block *block, size_t each, const void *whole,
                            void **result, weft_error *error)
{
    size_t row = (size_t)block->width * each, bytes = row * (size_t)block->height;
    if (!whole)
        return WEFT_OK;
    *result = malloc(bytes);
    if (!*result)
        return weft_fail_memory(error, "texels", bytes);
    for (int y = 0; y < block->height; y++) {
        size_t first = (size_t)(block->y + y) * (size_t)excerpt->layout.width + (size_t)block->x;
        memcpy((char *)*result + (size_t)y * row, (const char *)whole + first * each, row);
    }
    return WEFT_OK;
}

static weft_code crop(const weft_excerpt *excerpt, const weft_texel_block *block, weft_excerpt *result,
                      weft_error *error)
{
    size_t images = (size_t)excerpt->layout.image_count, views = (size_t)excerpt->layout.view_count;
    const texel_choice choice = {.width = excerpt->layout.width,
                                 .height = excerpt->layout.height,
                                 .columns = block->width,
                                 .rows = block->height,
                                 .stride = 1};
    void *samples = NULL, *mask = NULL, *opacity = NULL, *frames = NULL;
    weft_code code = make_layout(&excerpt->layout, &choice, &result->layout, error);
    if (code == WEFT_OK)
        code = crop_array(excerpt, block, 3 * images * sizeof(weft_half), excerpt->samples, &samples, error);
    if (code == WEFT_OK)
        code = crop_array(excerpt, block, images, excerpt->mask, &mask, error);
    if (code == WEFT_OK)
        code = crop_array(excerpt, block, views * sizeof(float), excerpt->opacity, &opacity, error);
    if (code == WEFT_OK)
        code = crop_array(excerpt, block, 6 * sizeof(float), excerpt->frames, &frames, error);
    result->samples = samples;
    result->mask = mask;
    result->opacity = opacity;
    result->frames = frames;
    return code;
}

weft_code weft_excerpt_crop(const weft_excerpt *excerpt, const weft_texel_block *block, weft_excerpt *result,
                            weft_error *error)
{
    *result = (weft_excerpt){.window = excerpt->window};
    result->window.x += block->x;
    result->window.y += block->y;
    weft_code code = crop(excerpt, block, result, error);
    if (code != WEFT_OK)
        weft_excerpt_free(result);
    return code;
}

/* ---- The surface ---- */

bool weft_excerpt_has_surface(const weft_excerpt *excerpt)
{
    return excerpt->surface.value != NULL;
}

weft_code weft_excerpt_give_heights(const weft_excerpt *excerpt, weft_material *material, weft_error *error)
{
    const weft_dataset_heights *surface = &excerpt->surface;
    weft_material_heights *heights;
    WEFT_TRY(weft_material_heights_create(surface->value, surface->width, surface->height, surface->level_count,
                                          excerpt->whole_mm, &heights, error));
    weft_material_take_heights(material, heights);
    return WEFT_OK;
}

/* The places above the texels of the block. */
static weft_code crop_surface(const weft_excerpt *excerpt, weft_dataset_heights *cropped, weft_error *error)
{
    const weft_dataset_heights *whole = &excerpt->surface;
    const weft_predicted_window *window = &excerpt->window;
    int across = whole->width / window->whole_width, down = whole->height / window->whole_height;
    *cropped = (weft_dataset_heights){.width = across * excerpt->layout.width,
                                      .height = down * excerpt->layout.height,
                                      .level_count = whole->level_count};
    size_t row = (size_t)cropped->width;
    cropped->value = malloc(row * (size_t)cropped->height * sizeof *cropped->value);
    if (!cropped->value)
        return weft_fail_memory(error, "heights", row * (size_t)cropped->height * sizeof *cropped->value);
    for (size_t y = 0; y < (size_t)cropped->height; y++)
        memcpy(cropped->value + y * row,
               whole->value + ((size_t)(down * window->y) + y) * (size_t)whole->width + (size_t)(across * window->x),
               row * sizeof *cropped->value);
    return WEFT_OK;
}

/* A dataset refuses what lies further from it than it is wide. */
static bool is_too_deep(const weft_excerpt *excerpt)
{
    double size_mm[2], most = 0;
    weft_dataset_size_mm(&excerpt->layout, size_mm);
    for (size_t i = 0; i < (size_t)excerpt->surface.width * (size_t)excerpt->surface.height; i++)
        most = fmax(most, fabs((double)excerpt->surface.value[i]));
    return most > fmin(size_mm[0], size_mm[1]);
}

static weft_code put_surface(const weft_excerpt *excerpt, weft_dataset_writer *writer, weft_error *error)
{
    weft_dataset_heights cropped;
    weft_code code = crop_surface(excerpt, &cropped, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_put_heights(writer, &cropped, error);
    weft_dataset_heights_free(&cropped);
    return code;
}

/* ---- Without some images ---- */

/* The images and views that are kept, by their number in the excerpt. */
typedef struct kept_images {
    int image_count, view_count;
    int *image, *view; /* [image_count], [view_count] */
    int *view_index;   /* by view of the excerpt: its place among those that are kept, or -1 */
} kept_images;

static void free_kept(kept_images *kept)
{
    free(kept->image);
    free(kept->view);
    free(kept->view_index);
}

static weft_code find_kept(const weft_dataset_layout *layout, const uint8_t *held_out, kept_images *kept,
                           weft_error *error)
{
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    *kept = (kept_images){.image = calloc(images, sizeof *kept->image),
                          .view = calloc(views, sizeof *kept->view),
                          .view_index = calloc(views, sizeof *kept->view_index)};
    if (!kept->image || !kept->view || !kept->view_index)
        return weft_fail_memory(error, "images", (images + 2 * views) * sizeof *kept->image);
    for (int i = 0; i < layout->image_count; i++) {
        if (held_out[i])
            continue;
        kept->image[kept->image_count++] = i;
        kept->view_index[layout->view_of_image[i]] = 1;
    }
    for (int view = 0; view < layout->view_count; view++) {
        if (kept->view_index[view])
            kept->view[kept->view_count] = view;
        kept->view_index[view] = kept->view_index[view] ? kept->view_count++ : -1;
    }
    return WEFT_OK;
}

static weft_code make_kept_layout(const weft_dataset_layout *source, const kept_images *kept,
                                  weft_dataset_layout *layout, weft_error *error)
{
    *layout = *source;
    layout->image_count = kept->image_count;
    layout->view_count = kept->view_count;
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int i = 0; i < kept->image_count; i++) {
        layout->light[i] = source->light[kept->image[i]];
        layout->view_of_image[i] = kept->view_index[source->view_of_image[kept->image[i]]];
    }
    for (int view = 0; view < kept->view_count; view++)
        layout->view[view] = source->view[kept->view[view]];
    const double *weight = source->figure[WEFT_IMAGE_WEIGHT];
    if (!weight)
        return WEFT_OK;
    WEFT_TRY(weft_dataset_layout_allocate_figure(layout, WEFT_IMAGE_WEIGHT, error));
    for (int i = 0; i < kept->image_count; i++)
        layout->figure[WEFT_IMAGE_WEIGHT][i] = weight[kept->image[i]];
    return WEFT_OK;
}

static weft_code put_images(const weft_excerpt *excerpt, const kept_images *kept, weft_dataset_writer *writer,
                            weft_error *error)
{
    size_t texels = (size_t)excerpt->layout.width * (size_t)excerpt->layout.height;
    size_t images = (size_t)excerpt->layout.image_count;
    weft_half *samples = malloc(3 * texels * sizeof *samples);
    uint8_t *mask = malloc(texels);
    weft_code code = samples && mask ? WEFT_OK : weft_fail_memory(error, "image", 7 * texels);
    for (int i = 0; code == WEFT_OK && i < kept->image_count; i++) {
        for (size_t texel = 0; texel < texels; texel++) {
            size_t at = texel * images + (size_t)kept->image[i];
            memcpy(samples + 3 * texel, excerpt->samples + 3 * at, 3 * sizeof *samples);
            mask[texel] = excerpt->mask[at];
        }
        code = weft_dataset_writer_put_image(writer, i, samples, mask, error);
    }
    free(samples);
    free(mask);
    return code;
}

static weft_code put_opacity(const weft_excerpt *excerpt, const kept_images *kept, weft_dataset_writer *writer,
                             weft_error *error)
{
    size_t texels = (size_t)excerpt->layout.width * (size_t)excerpt->layout.height;
    size_t views = (size_t)kept->view_count, all = (size_t)excerpt->layout.view_count;
    float *opacity = malloc(texels * views * sizeof *opacity);
    if (!opacity)
        return weft_fail_memory(error, "opacity", texels * views * sizeof *opacity);
    for (size_t i = 0; i < texels * views; i++)
        opacity[i] = excerpt->opacity[i / views * all + (size_t)kept->view[i % views]];
    weft_code code = weft_dataset_writer_put_opacity(writer, opacity, error);
    free(opacity);
    return code;
}

static weft_code put_all(const weft_excerpt *excerpt, const kept_images *kept, weft_dataset_writer *writer,
                         weft_error *error)
{
    WEFT_TRY(put_images(excerpt, kept, writer, error));
    if (excerpt->opacity)
        WEFT_TRY(put_opacity(excerpt, kept, writer, error));
    return excerpt->frames ? weft_dataset_writer_put_frames(writer, excerpt->frames, error) : WEFT_OK;
}

/* A plane is one height, which is not cropped. */
static bool is_plane(const weft_dataset_heights *surface)
{
    return surface->width == 1 && surface->height == 1;
}

static weft_code write_kept(const weft_excerpt *excerpt, const kept_images *kept, bool with_surface, const char *path,
                            weft_error *error)
{
    weft_dataset_layout layout = {0};
    weft_dataset_writer *writer = NULL;
    weft_code code = make_kept_layout(&excerpt->layout, kept, &layout, error);
    if (with_surface && is_plane(&excerpt->surface))
        layout.plane_mm = (double)excerpt->surface.value[0];
    if (code == WEFT_OK)
        code = weft_dataset_writer_create(path, &layout, &writer, error);
    if (code == WEFT_OK)
        code = put_all(excerpt, kept, writer, error);
    if (code == WEFT_OK && with_surface && !is_plane(&excerpt->surface))
        code = put_surface(excerpt, writer, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_finish(writer, NULL, error);
    else
        weft_dataset_writer_abandon(writer);
    weft_dataset_layout_free(&layout);
    return code;
}

static weft_code write_and_open(const weft_excerpt *excerpt, const uint8_t *held_out, bool with_surface,
                                const char *path, weft_dataset **result, weft_error *error)
{
    kept_images kept;
    weft_code code = find_kept(&excerpt->layout, held_out, &kept, error);
    if (code == WEFT_OK)
        code = write_kept(excerpt, &kept, with_surface, path, error);
    if (code == WEFT_OK) {
        code = weft_dataset_open(path, result, error);
        unlink(path);
    }
    free_kept(&kept);
    return code;
}

weft_code weft_excerpt_write(const weft_excerpt *excerpt, const uint8_t *held_out, const char *path,
                             weft_dataset **result, weft_error *error)
{
    return write_and_open(excerpt, held_out, false, path, result, error);
}

weft_code weft_excerpt_write_with_surface(const weft_excerpt *excerpt, const uint8_t *held_out, const char *path,
                                          weft_dataset **result, weft_error *error)
{
    bool has_surface = weft_excerpt_has_surface(excerpt) && !is_too_deep(excerpt);
    return write_and_open(excerpt, held_out, has_surface, path, result, error);
}
