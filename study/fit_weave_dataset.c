#include "study/fit_weave_dataset.h"

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

/* Whole tiles in the middle of the material. */
static weft_texel_window whole_tiles(const weft_dataset_layout *layout, const weft_fit_weave_source *source)
{
    double width = fmin(source->tiles_x * source->tile.tile.width, layout->width);
    double height = fmin(source->tiles_y * source->tile.tile.height, layout->height);
    return (weft_texel_window){(layout->width - width) / 2, (layout->height - height) / 2, width, height};
}

weft_code weft_fit_weave_to_dataset(weft_dataset *dataset, weft_weave *weave, const weft_progress *progress,
                                    weft_fit_weave_source *source, weft_fit_weave_report *report, weft_error *error)
{
    weft_mean_brdf mean;
    WEFT_TRY(find_tile(dataset, weave, progress, source, error));
    weft_texel_window window = whole_tiles(weft_dataset_get_layout(dataset), source);
    WEFT_TRY(weft_mean_brdf_of(dataset, source->tiled ? &window : NULL, progress, &mean, error));
    weft_code code = weft_fit_weave(&mean, weave, progress, report, error);
    weft_mean_brdf_free(&mean);
    return code;
}
