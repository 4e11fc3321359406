#include "edit/tile/tile.h"

#include "edit/tile/search_steps.h"

#include <math.h>

/* Two tiles of four texels. */
enum { LEAST_TEXELS = 8 };

static weft_code check_dataset(const weft_dataset *dataset, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    const char *path = weft_dataset_path(dataset);
    if (layout->distance == WEFT_NEAR)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' has near lights and views: its tiles were seen from different directions", path);
    if (layout->width < LEAST_TEXELS || layout->height < LEAST_TEXELS)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d x %d texels, too few for a tile: %d x %d are wanted", path,
                         layout->width, layout->height, LEAST_TEXELS, LEAST_TEXELS);
    return WEFT_OK;
}

static weft_code find_tile(const weft_tile_pictures *pictures, const weft_dataset *dataset, const weft_weave *weave,
                           weft_tile_report *report, weft_error *error)
{
    const char *path = weft_dataset_path(dataset);
    WEFT_TRY(weft_tile_period_find(pictures, path, report, error));
    WEFT_TRY(weft_tile_period_refine(pictures, &report->tile, error));
    if (!weave)
        return WEFT_OK;
    return weft_tile_phase_find(pictures, weft_dataset_get_layout(dataset), path, weave, report, error);
}

weft_code weft_tile_find(weft_dataset *dataset, const weft_weave *weave, const weft_progress *progress,
                         weft_tile_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_tile_pictures pictures;
    *report = (weft_tile_report){0};
    WEFT_TRY(check_dataset(dataset, error));
    WEFT_TRY(weft_tile_pictures_read(dataset, progress, &pictures, error));
    weft_code code = find_tile(&pictures, dataset, weave, report, error);
    report->picture_count = pictures.count;
    weft_tile_pictures_free(&pictures);
    WEFT_TRY(code);
    report->width_mm = report->tile.width * layout->texel_pitch_mm;
    report->height_mm = report->tile.height * layout->texel_pitch_mm;
    report->tiles_x = layout->width / report->tile.width;
    report->tiles_y = layout->height / report->tile.height;
    return WEFT_OK;
}

static double tiles_across(int size, double tile)
{
    const double whole_within = 0.01;
    double tiles = size / tile;
    return fabs(tiles - round(tiles)) < whole_within ? round(tiles) : tiles;
}

weft_weave_layout weft_tile_layout(const weft_tile *tile, const weft_dataset_layout *material)
{
    weft_weave_layout layout = {.tiles_u = tiles_across(material->width, tile->width),
                                .tiles_v = tiles_across(material->height, tile->height)};
    double lowest = layout.tiles_v - tile->top / tile->height; /* of the corners at the left, from below */
    layout.corner_u = tile->left / tile->width;
    layout.corner_v = lowest - floor(lowest);
    return layout;
}
