#include "player/raw/stream.h"

#include <stdlib.h>

/* Below this cosine of the light a sample says little about the reflectance and much about the noise. */
static const float smallest_cosine = 0.05f;

static const size_t block_bytes = (size_t)64 << 20;

static int rows_of_block(const weft_dataset_layout *layout)
{
    size_t row = (size_t)layout->width * (size_t)layout->image_count * 7;
    size_t rows = block_bytes / row;
    return rows < 1 ? 1 : rows > 16 ? 16 : (int)rows;
}

/* True once every image has a valid sample. */
static bool mark_usable(const uint8_t *mask, size_t texels, weft_raw_images *images)
{
    for (size_t t = 0; t < texels; t++) {
        for (int i = 0; i < images->image_count; i++)
            images->usable[i] |= mask[t * (size_t)images->image_count + (size_t)i] == 0;
    }
    for (int i = 0; i < images->image_count; i++) {
        if (!images->usable[i])
            return false;
    }
    return true;
}

static weft_code read_masks(weft_dataset *dataset, weft_raw_images *images, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int rows = rows_of_block(layout);
    size_t row_size = (size_t)layout->width * (size_t)layout->image_count;
    uint8_t *mask = malloc(row_size * (size_t)rows);
    if (!mask)
        return weft_fail_memory(error, "masks", row_size * (size_t)rows);
    weft_code code = WEFT_OK;
    bool all_usable = false;
    for (int y = 0; code == WEFT_OK && !all_usable && y < layout->height; y += rows) {
        int count = y + rows <= layout->height ? rows : layout->height - y;
        code = weft_dataset_read_block(dataset, 0, y, layout->width, count, NULL, mask, error);
        if (code == WEFT_OK)
            all_usable = mark_usable(mask, (size_t)layout->width * (size_t)count, images);
    }
    free(mask);
    return code;
}

static weft_code allocate(const weft_dataset_layout *layout, weft_raw_images *images, weft_error *error)
{
    size_t count = (size_t)layout->image_count;
    *images = (weft_raw_images){.image_count = layout->image_count, .view_count = layout->view_count};
    images->usable = calloc(count, sizeof *images->usable);
    images->order = calloc(count, sizeof *images->order);
    images->first_of_view = calloc((size_t)layout->view_count + 1, sizeof *images->first_of_view);
    images->direction = calloc(count, sizeof *images->direction);
    if (images->usable && images->order && images->first_of_view && images->direction)
        return WEFT_OK;
    return weft_fail_memory(error, "images", count * sizeof *images->direction);
}

/* Counting sort of the usable images by view. */
static void sort_by_view(const weft_dataset_layout *layout, weft_raw_images *images)
{
    int *first = images->first_of_view;
    for (int i = 0; i < images->image_count; i++)
        first[layout->view_of_image[i] + 1] += images->usable[i];
    for (int v = 0; v < images->view_count; v++)
        first[v + 1] += first[v];
    /* Filling moves every start to the next one; moving them back restores them. */
    for (int i = 0; i < images->image_count; i++) {
        if (images->usable[i])
            images->order[first[layout->view_of_image[i]]++] = i;
    }
    for (int v = images->view_count; v > 0; v--)
        first[v] = first[v - 1];
    first[0] = 0;
}

weft_code weft_raw_images_find(weft_dataset *dataset, weft_raw_images *images, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    WEFT_TRY(allocate(layout, images, error));
    WEFT_TRY(read_masks(dataset, images, error));
    for (int i = 0; i < images->image_count; i++)
        images->direction[i] = weft_dataset_light_direction(layout, i, layout->width / 2, layout->height / 2);
    sort_by_view(layout, images);
    if (images->first_of_view[images->view_count] == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no valid sample", weft_dataset_path(dataset));
    return WEFT_OK;
}

void weft_raw_images_free(weft_raw_images *images)
{
    free(images->usable);
    free(images->order);
    free(images->first_of_view);
    free(images->direction);
    *images = (weft_raw_images){0};
}

/* ---- Directions ---- */

static weft_code add_views(const weft_raw_images *images, const weft_dataset_layout *layout, weft_vec3 *direction,
                           int *label, weft_direction_map *map, weft_error *error)
{
    int count = 0;
    for (int v = 0; v < images->view_count; v++) {
        if (images->first_of_view[v] == images->first_of_view[v + 1])
            continue;
        direction[count] = weft_dataset_view_direction(layout, v, layout->width / 2, layout->height / 2);
        label[count] = count + 1;
        count++;
    }
    return weft_direction_map_add(map, direction, label, count, error);
}

static weft_code add_lights(const weft_raw_images *images, int view, weft_vec3 *direction, int *label,
                            weft_direction_map *map, weft_error *error)
{
    int count = 0;
    for (int k = images->first_of_view[view]; k < images->first_of_view[view + 1]; k++) {
        direction[count] = images->direction[images->order[k]];
        label[count++] = images->order[k];
    }
    return count > 0 ? weft_direction_map_add(map, direction, label, count, error) : WEFT_OK;
}

weft_code weft_raw_images_map(const weft_raw_images *images, const weft_dataset_layout *layout, weft_direction_map *map,
                              weft_error *error)
{
    size_t largest = (size_t)images->image_count + (size_t)images->view_count;
    weft_vec3 *direction = calloc(largest, sizeof *direction);
    int *label = calloc(largest, sizeof *label);
    weft_code code = WEFT_OK;
    if (!direction || !label)
        code = weft_fail_memory(error, "directions", largest * sizeof *direction);
    if (code == WEFT_OK)
        code = add_views(images, layout, direction, label, map, error);
    for (int v = 0; code == WEFT_OK && v < images->view_count; v++)
        code = add_lights(images, v, direction, label, map, error);
    free(direction);
    free(label);
    return code;
}

/* ---- Samples ---- */

static float reflectance_scale(const weft_dataset_layout *layout, int image, int x, int y)
{
    if (layout->values == WEFT_REFLECTANCE)
        return 1;
    float cosine = (float)weft_dataset_light_direction(layout, image, x, y).z;
    return 1 / (cosine > smallest_cosine ? cosine : smallest_cosine);
}

/* The valid image of a view, which has one, whose light is nearest to that of `image`. */
static int nearest_valid(const weft_raw_images *images, int view, int image, const uint8_t *mask)
{
    int nearest = -1;
    weft_real best = -2;
    for (int k = images->first_of_view[view]; k < images->first_of_view[view + 1]; k++) {
        int candidate = images->order[k];
        weft_real cosine = weft_dot(images->direction[candidate], images->direction[image]);
        if (mask[candidate] == 0 && cosine > best) {
            best = cosine;
            nearest = candidate;
        }
    }
    return nearest;
}

static bool has_valid(const weft_raw_images *images, int view, const uint8_t *mask)
{
    for (int k = images->first_of_view[view]; k < images->first_of_view[view + 1]; k++) {
        if (mask[images->order[k]] == 0)
            return true;
    }
    return false;
}

/* The view nearest to `view` in which texel (x, y) has a valid sample: itself if it may be; -1: none. */
static int nearest_seen(const weft_raw_images *images, const weft_dataset_layout *layout, int view, int x, int y,
                        const uint8_t *mask)
{
    if (has_valid(images, view, mask))
        return view;
    weft_vec3 direction = weft_dataset_view_direction(layout, view, x, y);
    int nearest = -1;
    weft_real best = -2;
    for (int v = 0; v < images->view_count; v++) {
        weft_real cosine = weft_dot(weft_dataset_view_direction(layout, v, x, y), direction);
        if (cosine > best && has_valid(images, v, mask)) {
            best = cosine;
            nearest = v;
        }
    }
    return nearest;
}

/* Fills the masked images of a view from the view `source`, which has a valid one. */
static void fill_view(const weft_raw_images *images, int view, int source, const uint8_t *mask, float *value)
{
    for (int k = images->first_of_view[view]; k < images->first_of_view[view + 1]; k++) {
        int image = images->order[k];
        if (mask[image] == 0)
            continue;
        int from = nearest_valid(images, source, image, mask);
        for (int c = 0; c < 3; c++)
            value[3 * image + c] = value[3 * from + c];
    }
}

void weft_raw_texel_fill(const weft_raw_images *images, const weft_dataset_layout *layout, int x, int y,
                         const weft_half *sample, const uint8_t *mask, float *value)
{
    int count = images->image_count, invalid = 0;
    for (int i = 0; i < count; i++) {
        float scale = mask[i] == 0 ? reflectance_scale(layout, i, x, y) : 0;
        for (int c = 0; c < 3; c++)
            value[3 * i + c] = mask[i] == 0 ? scale * weft_float_of_half(sample[3 * i + c]) : 0;
        invalid += mask[i] != 0;
    }
    for (int view = 0; invalid > 0 && view < images->view_count; view++) {
        int source = nearest_seen(images, layout, view, x, y, mask);
        if (source >= 0)
            fill_view(images, view, source, mask, value);
    }
}
