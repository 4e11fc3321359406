#include "compress/weave_fit/fit_weave.h"

#include <math.h>
#include <stdio.h>

/* Part of a tile that may be missing at the edge of the material. */
static const double missing = 0.02;

static weft_code find_tile(weft_dataset *dataset, const weft_weave *weave, const weft_progress *progress,
                           weft_fit_weave_source *source, weft_error *error)
{
    weft_error why;
    *source = (weft_fit_weave_source){0};
    weft_code code = weft_tile_find(dataset, weave, progress, &source->tile, &why);
    if (code == WEFT_BAD_INPUT) {
        snprintf(source->why_whole, sizeof source->why_whole, "%s", why.message);
        return WEFT_OK;
    }
    if (code != WEFT_OK) {
        *error = why;
        return code;
    }
    source->tiles_x = (int)(source->tile.tiles_x + missing);
    source->tiles_y = (int)(source->tile.tiles_y + missing);
    source->tiled = source->tiles_x > 0 && source->tiles_y > 0;
    if (!source->tiled)
        snprintf(source->why_whole, sizeof source->why_whole, "'%s' holds %.2f x %.2f tiles of the weave, none whole",
                 weft_dataset_path(dataset), source->tile.tiles_x, source->tile.tiles_y);
    return WEFT_OK;
}

/* Of the material, at each edge: of texels beside the frame a registration sees the inner part, or nothing. */
static const double edge = 1.0 / 16;

/* What is left out at either end of an axis: the edge, as far as one tile remains. */
static double margin_of(int size, double tile)
{
    return fmax(0, fmin(edge * size, (size - tile) / 2));
}

/* The middle of the material, in which every place of the tile counts alike. */
static weft_texel_window window_of(const weft_dataset_layout *layout, const weft_tile *tile)
{
    double x = margin_of(layout->width, tile->width), y = margin_of(layout->height, tile->height);
    return (weft_texel_window){.left = x,
                               .top = y,
                               .width = layout->width - 2 * x,
                               .height = layout->height - 2 * y,
                               .period_x = tile->width,
                               .period_y = tile->height};
}

weft_code weft_fit_weave_to_dataset(weft_dataset *dataset, weft_weave *weave, const weft_progress *progress,
                                    weft_fit_weave_source *source, weft_fit_weave_report *report, weft_error *error)
{
    weft_mean_brdf mean;
    WEFT_TRY(find_tile(dataset, weave, progress, source, error));
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_texel_window window = window_of(layout, &source->tile.tile);
    weave->layout = source->tiled ? weft_tile_layout(&source->tile.tile, layout) : (weft_weave_layout){0};
    WEFT_TRY(weft_mean_brdf_of(dataset, source->tiled ? &window : NULL, progress, &mean, error));
    weft_code code = weft_fit_weave(&mean, weave, progress, report, error);
    weft_mean_brdf_free(&mean);
    return code;
}
