#include "capture/virtual/cloth.h"

#include "capture/virtual/random.h"

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
    weft_weave_layout layout = weft_weave_whole_tiles(&cloth->weave);
    cloth->tiles_x = (int)(settings->tiles_x > 0 ? settings->tiles_x : layout.tiles_u);
    cloth->tiles_y = (int)(settings->tiles_y > 0 ? settings->tiles_y : layout.tiles_v);
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

weft_weave_point weft_virtual_cloth_locate(const weft_virtual_cloth *cloth, double x_mm, double y_mm)
{
    double u = (x_mm / cloth->opening_mm + 0.5) * cloth->tiles_x;
    double v = (y_mm / cloth->opening_mm + 0.5) * cloth->tiles_y;
    return weft_weave_locate(&cloth->weave, u, v, cloth->noise_seed);
}
