/* The cloth in the opening of the target plate: a weave laid out in tiles. */
#ifndef WEFT_CAPTURE_VIRTUAL_CLOTH_H
#define WEFT_CAPTURE_VIRTUAL_CLOTH_H

#include "capture/virtual/virtual_settings.h"
#include "reflectance/weave/batch.h"

#include <stddef.h>

typedef struct weft_virtual_cloth {
    weft_weave weave;
    weft_woven_table *table; /* of the weave, for batches */
    double opening_mm;
    int tiles_x, tiles_y; /* across the opening: whole, so that the material repeats */
    uint64_t noise_seed;  /* 0 = no noise */
} weft_virtual_cloth;

/* Reads the weave and chooses the tiles where the settings leave them open (weft_weave_whole_tiles).
 * The caller frees with weft_virtual_cloth_free. Errors: those of weft_weave_read; `warning` as there. */
weft_code weft_virtual_cloth_read(const char *path, const weft_virtual_settings *settings, uint64_t seed,
                                  weft_virtual_cloth *cloth, char warning[WEFT_MESSAGE_SIZE], weft_error *error);
void weft_virtual_cloth_free(weft_virtual_cloth *cloth);

/* The point of the weave at a point of the plate inside the opening, mm. Pure. */
weft_weave_point weft_virtual_cloth_locate(const weft_virtual_cloth *cloth, double x_mm, double y_mm);

#endif
