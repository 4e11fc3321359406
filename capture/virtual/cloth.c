#include "capture/virtual/cloth.h"

#include "capture/virtual/random.h"

static const double cells_across = 12;

/* How far a layout is from square cells and from `cells_across`; 0 is perfect. */
static double layout_error(const weft_weave *weave, int tiles_x, int tiles_y)
{
    double cells_x = tiles_x * weave->tile_width, cells_y = tiles_y * weave->tile_height;
    double stretch = log(cells_x / cells_y), size = log(sqrt(cells_x * cells_y) / cells_across);
    return 4 * stretch * stretch + size * size;
}

static void choose_tiles(weft_virtual_cloth *cloth)
{
    double best = INFINITY;
    for (int y = 1; y <= cells_across; y++) {
        for (int x = 1; x <= cells_across; x++) {
            double candidate = layout_error(&cloth->weave, x, y);
            if (candidate < best) {
                best = candidate;
                cloth->tiles_x = x;
                cloth->tiles_y = y;
            }
        }
    }
}

weft_code weft_virtual_cloth_read(const char *path, const weft_virtual_settings *settings, uint64_t seed,
                                  weft_virtual_cloth *cloth, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *cloth = (weft_virtual_cloth){.opening_mm = settings->rig.opening_mm};
    WEFT_TRY(weft_weave_read(path, NULL, 0, &cloth->weave, warning, error));
    weft_code code = weft_woven_table_create(&cloth->weave, &cloth->table, error);
    if (code != WEFT_OK) {
        weft_virtual_cloth_free(cloth);
        return code;
    }
    choose_tiles(cloth);
    if (settings->tiles_x > 0)
        cloth->tiles_x = (int)settings->tiles_x;
    if (settings->tiles_y > 0)
        cloth->tiles_y = (int)settings->tiles_y;
    if (settings->cloth_noise > 0)
        cloth->noise_seed = weft_random_bits(seed, WEFT_RANDOM_CLOTH, 0) | 1;
    return WEFT_OK;
}

void weft_virtual_cloth_free(weft_virtual_cloth *cloth)
{
    weft_woven_table_free(cloth->table);
    weft_weave_free(&cloth->weave);
    *cloth = (weft_virtual_cloth){0};
}

weft_weave_layout weft_virtual_cloth_layout(const weft_virtual_cloth *cloth, double tiles_u, double tiles_v)
{
    if (tiles_u > 0 && tiles_v > 0)
        return (weft_weave_layout){.tiles_u = tiles_u, .tiles_v = tiles_v};
    if (cloth->weave.layout.tiles_u > 0)
        return cloth->weave.layout;
    return (weft_weave_layout){.tiles_u = cloth->tiles_x, .tiles_v = cloth->tiles_y};
}

weft_weave_point weft_virtual_cloth_locate(const weft_virtual_cloth *cloth, double x_mm, double y_mm)
{
    double u = (x_mm / cloth->opening_mm + 0.5) * cloth->tiles_x;
    double v = (y_mm / cloth->opening_mm + 0.5) * cloth->tiles_y;
    return weft_weave_locate(&cloth->weave, u, v, cloth->noise_seed);
}
