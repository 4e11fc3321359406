#include "compress/hold_out/measured_texels.h"

#include "base/integers.h"
#include "compress/compress.h"
#include "compress/hold_out/texel_subset.h"
#include "compress/run/memory.h"

#include <math.h>
#include <stdlib.h>

/* Components learn from 512 texels, which are to be there. */
enum {
    SIDE = 12,
    SPREAD_SIDE = 16,
    COMPONENTS_SIDE = 24,
    SURFACE_SIDE = 64,
    ASKED_SIDE = 48,
    BLOCK_SIDE = 64,
    SQUARE_SIDE = 4
};

/* Of the subset, at most; of one with a surface, whose texels see each other, and of those of its texels that are
 * asked for. */
static const long most_samples = 1L << 22, most_samples_with_surface = 1L << 25, most_samples_asked = 1L << 23;

void weft_measured_texels_free(weft_measured_texels *texels)
{
    weft_texel_subset_free(&texels->subset);
    weft_texel_subset_free(&texels->alone);
    free(texels->level);
    *texels = (weft_measured_texels){0};
}

const weft_texel_subset *weft_measured_texels_fitted(const weft_measured_texels *texels)
{
    return texels->alone.samples ? &texels->alone : &texels->subset;
}

long weft_measured_texels_count(const weft_measured_texels *texels)
{
    const weft_dataset_layout *layout = &texels->subset.layout;
    const weft_texel_block *asked = &texels->asked;
    return asked->width > 0 ? (long)asked->width * asked->height : (long)layout->width * layout->height;
}

/* ---- How many ---- */

static int side_of(int most_side, long most, int image_count)
{
    int side = most_side;
    while (side > 1 && (long)side * side * image_count > most)
        side--;
    return side;
}

static int side_of_squares(const weft_dataset_layout *layout, const weft_compress_options *options)
{
    int side = side_of(options->component_count > 0 ? COMPONENTS_SIDE : SIDE, most_samples, layout->image_count);
    return side > SQUARE_SIDE ? side - side % SQUARE_SIDE : side;
}

int weft_measured_texels_spread_side(const weft_dataset_layout *layout, const weft_compress_options *options)
{
    return side_of(options->component_count > 0 ? COMPONENTS_SIDE : SPREAD_SIDE, most_samples, layout->image_count);
}

int weft_hold_out_surface_side(int image_count)
{
    return side_of(SURFACE_SIDE, most_samples_with_surface, image_count);
}

/* ---- Which ---- */

static int fewest_kept(const weft_splits *splits)
{
    int fewest = splits->image_count;
    for (int s = 0; s < splits->count; s++) {
        const uint8_t *held = weft_splits_held(splits, s);
        int kept = 0;
        for (int i = 0; i < splits->image_count; i++)
            kept += held[i] == 0;
        fewest = kept < fewest ? kept : fewest;
    }
    return fewest;
}

static bool fits_neighbours(const weft_dataset_layout *layout, const weft_compress_options *options,
                            const weft_splits *splits)
{
    weft_dataset_layout others = *layout;
    int lobes;
    others.image_count = fewest_kept(splits);
    return weft_compress_plan(&others, options, &lobes) == WEFT_COMPRESS_SPARSE;
}

bool weft_measures_spread_texels(const weft_dataset *dataset, const weft_compress_options *options,
                                 const weft_splits *splits)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    bool has_others = weft_larger(layout->width, layout->height) > side_of_squares(layout, options);
    bool has_levels = weft_smaller(layout->width, layout->height) >= 4;
    return has_others && has_levels && options->memory_bytes == 0 && layout->distance != WEFT_NEAR &&
           !weft_dataset_has_surface(dataset) && !fits_neighbours(layout, options, splits);
}

/* ---- Reading ---- */

weft_code weft_measured_texels_read_spread(weft_dataset *dataset, const weft_compress_options *options,
                                           weft_measured_texels *texels, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    *texels = (weft_measured_texels){.spacing = 1, .neighbours = 1};
    return weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_SCATTERED,
                                  weft_measured_texels_spread_side(layout, options), &texels->subset, error);
}

/* The last level that has texels; all of them are spread over the dataset. */
static void find_levels(const weft_dataset_layout *whole, weft_measured_texels *texels)
{
    int count = texels->subset.layout.width * texels->subset.layout.height, last = 0;
    for (int i = 0; i < count; i++)
        last = texels->level[i] != WEFT_TEXEL_SUBSET_NO_LEVEL ? weft_larger(last, texels->level[i]) : last;
    texels->neighbours = 1 << last;
    texels->spacing = fmax(1, (double)weft_smaller(whole->width, whole->height) / (2 * texels->neighbours));
}

weft_code weft_measured_texels_read_levels(weft_dataset *dataset, const weft_compress_options *options,
                                           weft_measured_texels *texels, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int singles = options->component_count > 0 ? weft_measured_texels_spread_side(layout, options) : 0;
    *texels = (weft_measured_texels){0};
    WEFT_TRY(weft_texel_subset_read_levels(dataset, singles, &texels->subset, &texels->level, error));
    const weft_dataset_layout *read = &texels->subset.layout;
    int rows = weft_smaller(singles, layout->height);
    texels->asked = (weft_texel_block){0, rows, read->width, read->height - rows};
    find_levels(layout, texels);
    return WEFT_OK;
}

/* That a square of the dataset and, where lobes are fitted, a copy of its middle are within the limit. */
static weft_code require_memory(const weft_dataset *dataset, const weft_compress_options *options, int side,
                                int copied_side, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    const uint64_t sample_bytes = 3 * sizeof(weft_half) + 1;
    uint64_t read = (uint64_t)weft_smaller(side, weft_smaller(layout->width, layout->height)),
             copied = (uint64_t)copied_side;
    weft_memory_budget budget = weft_memory_budget_begin(options->memory_bytes);
    return weft_memory_budget_require(&budget,
                                      sample_bytes * (uint64_t)layout->image_count * (read * read + copied * copied),
                                      weft_dataset_path(dataset), "the images that are held out", error);
}

/* Lobes need no neighbours: those that are asked for are fitted alone. */
static weft_code read_with_surface(weft_dataset *dataset, const weft_compress_options *options,
                                   weft_measured_texels *texels, weft_error *error)
{
    int images = weft_dataset_get_layout(dataset)->image_count;
    bool has_components = options->component_count > 0;
    int side = has_components ? side_of(ASKED_SIDE, most_samples_asked, images) : COMPONENTS_SIDE;
    int read_side = weft_hold_out_surface_side(images);
    WEFT_TRY(require_memory(dataset, options, read_side, has_components ? 0 : side, error));
    WEFT_TRY(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, read_side, &texels->subset, error));
    texels->asked = weft_texel_subset_middle(&texels->subset, side);
    return has_components ? WEFT_OK : weft_texel_subset_crop(&texels->subset, &texels->asked, &texels->alone, error);
}

/* Small squares; under near lights single texels. */
static weft_code read_squares(weft_dataset *dataset, const weft_compress_options *options, weft_measured_texels *texels,
                              weft_error *error)
{
    const weft_dataset_layout *whole = weft_dataset_get_layout(dataset), *read = &texels->subset.layout;
    weft_texel_subset_kind kind =
        whole->distance == WEFT_NEAR ? WEFT_TEXEL_SUBSET_REGULAR : WEFT_TEXEL_SUBSET_SMALL_PATCHES;
    WEFT_TRY(weft_texel_subset_read(dataset, kind, side_of_squares(whole, options), &texels->subset, error));
    texels->spacing = sqrt((double)whole->width * whole->height / ((double)read->width * read->height));
    return WEFT_OK;
}

weft_code weft_measured_texels_read(weft_dataset *dataset, const weft_compress_options *options,
                                    const weft_splits *splits, weft_measured_texels *texels, weft_error *error)
{
    *texels = (weft_measured_texels){.spacing = 1};
    if (fits_neighbours(weft_dataset_get_layout(dataset), options, splits))
        WEFT_TRY(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, BLOCK_SIDE, &texels->subset, error));
    else if (weft_dataset_has_surface(dataset))
        WEFT_TRY(read_with_surface(dataset, options, texels, error));
    else
        WEFT_TRY(read_squares(dataset, options, texels, error));
    texels->neighbours = texels->subset.neighbours;
    return WEFT_OK;
}
