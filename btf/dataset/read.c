#include "btf/dataset/hdf5.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct texel_block {
    int x, y, width, height;
} texel_block;

static weft_code read_slab(const weft_dataset *dataset, hid_t object, const char *name, texel_block block, int rank,
                           hsize_t per_texel, hid_t memory_type, void *buffer, weft_error *error)
{
    const hsize_t start[4] = {(hsize_t)block.y, (hsize_t)block.x, 0, 0};
    const hsize_t count[4] = {(hsize_t)block.height, (hsize_t)block.width, per_texel, 3};
    hid_t space = H5Dget_space(object), memory = H5Screate_simple(rank, count, NULL);
    bool done = space >= 0 && memory >= 0 &&
                H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                H5Dread(object, memory_type, memory, space, dataset->transfer, buffer) >= 0;
    weft_code code = WEFT_OK;
    if (!done)
        code = weft_fail(error, WEFT_DAMAGED, "'%s': cannot read '%s' of %d x %d texels at (%d, %d): %s", dataset->path,
                         name, block.width, block.height, block.x, block.y, weft_hdf5_cause());
    H5Sclose(memory);
    H5Sclose(space);
    return code;
}

static weft_code check_block(const weft_dataset *dataset, texel_block block, weft_error *error)
{
    const weft_dataset_layout *layout = &dataset->layout;
    if (block.x < 0 || block.y < 0 || block.width < 1 || block.height < 1 || block.width > layout->width - block.x ||
        block.height > layout->height - block.y)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s': block of %d x %d texels at (%d, %d), there are only %d x %d",
                         dataset->path, block.width, block.height, block.x, block.y, layout->width, layout->height);
    return WEFT_OK;
}

static bool is_infinite_or_nan(weft_half half)
{
    return (half & 0x7c00) == 0x7c00;
}

static bool all_finite(const weft_half *samples, size_t count)
{
    unsigned bad = 0;
    for (size_t i = 0; i < count; i++)
        bad |= is_infinite_or_nan(samples[i]);
    return !bad;
}

/* Masked samples that are not finite become 0, so that a weight of 0 is enough to ignore them. */
static weft_code clear_masked(const weft_dataset *dataset, texel_block block, weft_half *samples, const uint8_t *mask,
                              weft_error *error)
{
    size_t images = (size_t)dataset->layout.image_count;
    size_t count = (size_t)block.width * (size_t)block.height * images;
    for (size_t i = 0; i < count; i++) {
        weft_half *rgb = samples + 3 * i;
        if (all_finite(rgb, 3))
            continue;
        int texel = (int)(i / images);
        if (!mask[i])
            return weft_fail(error, WEFT_BAD_INPUT,
                             "'%s': texel (%d, %d), image %zu: a valid sample is not finite (%g, %g, %g)",
                             dataset->path, block.x + texel % block.width, block.y + texel / block.width, i % images,
                             weft_float_of_half(rgb[0]), weft_float_of_half(rgb[1]), weft_float_of_half(rgb[2]));
        memset(rgb, 0, 3 * sizeof *rgb);
    }
    return WEFT_OK;
}

/* Samples that are saturated and nothing else become 0: nobody says that they are lower bounds. */
static void clear_saturated(const weft_dataset *dataset, texel_block block, weft_half *samples, const uint8_t *mask)
{
    size_t count = (size_t)block.width * (size_t)block.height * (size_t)dataset->layout.image_count;
    for (size_t i = 0; i < count; i++) {
        if (mask[i] == WEFT_MASK_SATURATED)
            memset(samples + 3 * i, 0, 3 * sizeof *samples);
    }
}

static weft_code read_mask(const weft_dataset *dataset, texel_block block, uint8_t *mask, weft_error *error)
{
    hsize_t images = (hsize_t)dataset->layout.image_count;
    return read_slab(dataset, dataset->mask, "mask", block, 3, images, H5T_NATIVE_UINT8, mask, error);
}

static weft_code read_samples(const weft_dataset *dataset, texel_block block, weft_half *samples, const uint8_t *mask,
                              weft_error *error)
{
    size_t images = (size_t)dataset->layout.image_count;
    size_t count = (size_t)block.width * (size_t)block.height * images;
    WEFT_TRY(read_slab(dataset, dataset->samples, "samples", block, 4, images, dataset->half, samples, error));
    if (all_finite(samples, 3 * count))
        return WEFT_OK;
    if (mask)
        return clear_masked(dataset, block, samples, mask, error);
    uint8_t *own_mask = malloc(count);
    if (!own_mask)
        return weft_fail_memory(error, "mask", count);
    weft_code code = read_mask(dataset, block, own_mask, error);
    if (code == WEFT_OK)
        code = clear_masked(dataset, block, samples, own_mask, error);
    free(own_mask);
    return code;
}

weft_code weft_dataset_read_block(weft_dataset *dataset, int x, int y, int width, int height, weft_half *samples,
                                  uint8_t *mask, weft_error *error)
{
    texel_block block = {x, y, width, height};
    WEFT_TRY(check_block(dataset, block, error));
    /* Where HDF5 knows threads, each has its own setting. */
    weft_hdf5_quiet();
    if (mask)
        WEFT_TRY(read_mask(dataset, block, mask, error));
    if (samples)
        WEFT_TRY(read_samples(dataset, block, samples, mask, error));
    if (samples && mask && !dataset->has_bounds)
        clear_saturated(dataset, block, samples, mask);
    return WEFT_OK;
}

weft_code weft_dataset_read_opacity(weft_dataset *dataset, int y, int height, float *opacity, weft_error *error)
{
    const weft_dataset_layout *layout = &dataset->layout;
    texel_block block = {0, y, layout->width, height};
    WEFT_TRY(check_block(dataset, block, error));
    size_t views = (size_t)layout->view_count, count = (size_t)layout->width * (size_t)height * views;
    if (dataset->opacity < 0) {
        for (size_t i = 0; i < count; i++)
            opacity[i] = 1;
        return WEFT_OK;
    }
    WEFT_TRY(read_slab(dataset, dataset->opacity, "opacity", block, 3, views, H5T_NATIVE_FLOAT, opacity, error));
    for (size_t i = 0; i < count; i++) {
        if (!(opacity[i] >= 0 && opacity[i] <= 1))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': opacity of view %zu is %g in row %d, must be 0 to 1",
                             dataset->path, i % views, opacity[i], y + (int)(i / views) / layout->width);
    }
    return WEFT_OK;
}

bool weft_dataset_has_opacity(const weft_dataset *dataset)
{
    return dataset->opacity >= 0;
}

bool weft_dataset_has_heights(const weft_dataset *dataset)
{
    return dataset->heights >= 0;
}

static weft_code read_height_values(const weft_dataset *dataset, weft_dataset_heights *heights, weft_error *error)
{
    if (H5Dread(dataset->heights, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, dataset->transfer, heights->value) < 0)
        return weft_fail(error, WEFT_DAMAGED, "'%s': cannot read 'height': %s", dataset->path, weft_hdf5_cause());
    return weft_dataset_heights_check(&dataset->layout, heights, dataset->path, WEFT_BAD_INPUT, error);
}

weft_code weft_dataset_read_heights(weft_dataset *dataset, weft_dataset_heights *heights, weft_error *error)
{
    *heights = (weft_dataset_heights){0};
    if (dataset->heights < 0)
        return WEFT_OK;
    weft_hdf5_quiet();
    size_t count = (size_t)dataset->heights_width * (size_t)dataset->heights_height;
    *heights = (weft_dataset_heights){dataset->heights_width, dataset->heights_height, dataset->heights_levels,
                                      malloc(count * sizeof *heights->value)};
    weft_code code = heights->value ? read_height_values(dataset, heights, error)
                                    : weft_fail_memory(error, "heights", count * sizeof *heights->value);
    if (code != WEFT_OK)
        weft_dataset_heights_free(heights);
    return code;
}

static weft_code plane_as_heights(const weft_dataset_layout *layout, weft_dataset_heights *plane, weft_error *error)
{
    double texels = fabs(layout->plane_mm) / layout->texel_pitch_mm;
    int levels = texels > 1 ? 1 + (int)ceil(log2(texels)) : 1;
    *plane = (weft_dataset_heights){1, 1, levels, malloc(sizeof *plane->value)};
    if (!plane->value)
        return weft_fail_memory(error, "plane", sizeof *plane->value);
    plane->value[0] = (float)layout->plane_mm;
    return WEFT_OK;
}

bool weft_dataset_has_surface(const weft_dataset *dataset)
{
    const weft_dataset_layout *layout = &dataset->layout;
    return layout->distance == WEFT_FAR && (weft_dataset_has_heights(dataset) || layout->plane_mm != 0);
}

weft_code weft_dataset_read_surface(weft_dataset *dataset, weft_dataset_heights *surface, weft_error *error)
{
    *surface = (weft_dataset_heights){0};
    if (!weft_dataset_has_surface(dataset))
        return WEFT_OK;
    return weft_dataset_has_heights(dataset) ? weft_dataset_read_heights(dataset, surface, error)
                                             : plane_as_heights(&dataset->layout, surface, error);
}

void weft_dataset_heights_free(weft_dataset_heights *heights)
{
    free(heights->value);
    *heights = (weft_dataset_heights){0};
}

bool weft_dataset_has_frames(const weft_dataset *dataset)
{
    return dataset->frames >= 0;
}

weft_code weft_dataset_read_frames(weft_dataset *dataset, int y, int height, float *frames, weft_error *error)
{
    static const float surface[6] = {0, 0, 1, 1, 0, 0};
    const weft_dataset_layout *layout = &dataset->layout;
    texel_block block = {0, y, layout->width, height};
    WEFT_TRY(check_block(dataset, block, error));
    size_t count = (size_t)layout->width * (size_t)height;
    for (size_t i = 0; dataset->frames < 0 && i < count; i++)
        memcpy(frames + 6 * i, surface, sizeof surface);
    if (dataset->frames < 0)
        return WEFT_OK;
    WEFT_TRY(read_slab(dataset, dataset->frames, "frame", block, 4, 2, H5T_NATIVE_FLOAT, frames, error));
    return weft_dataset_frames_check(frames, count, y, layout->width, dataset->path, WEFT_BAD_INPUT, error);
}
