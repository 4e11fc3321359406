/* What lies in the opening of the target plate: a weave, flat in the plane of the plate, or a stitch, whose yarns reach
 * up to that plane and which goes on below the plate. */
#ifndef WEFT_CAPTURE_VIRTUAL_SAMPLE_H
#define WEFT_CAPTURE_VIRTUAL_SAMPLE_H

#include "capture/virtual/virtual_settings.h"
#include "geometry/light/stitch_sample.h"
#include "reflectance/weave/batch.h"

#include <stddef.h>

/* ---- The cloth in the opening of the target plate: a weave laid out in tiles. ---- */

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

typedef struct weft_virtual_sample {
    double opening_mm;
    weft_virtual_cloth flat;  /* empty where the sample has depth */
    weft_stitch_sample *deep; /* NULL where it is flat */
} weft_virtual_sample;

/* Reads NAME.stitch as a stitch and any other file as a weave. The tiles of a stitch have their own size; the lower
 * left corner of one is that of the opening. The caller frees with weft_virtual_sample_free. Errors: those of
 * weft_virtual_cloth_read and weft_stitch_sample_read; WEFT_BAD_INPUT for settings that a stitch cannot follow. */
weft_code weft_virtual_sample_read(const char *path, const weft_virtual_settings *settings, uint64_t seed,
                                   weft_virtual_sample *sample, char warning[WEFT_MESSAGE_SIZE], weft_error *error);
void weft_virtual_sample_free(weft_virtual_sample *sample);

/* Owned by the sample. */
const char *weft_virtual_sample_name(const weft_virtual_sample *sample);

/* Where a ray through a point of the opening, mm from its centre, and toward `view` leads in a sample with depth: as
 * weft_stitch_sample_see. */
int weft_virtual_sample_see(const weft_virtual_sample *sample, double x_mm, double y_mm, weft_vec3 view, uint64_t key,
                            uint32_t index, weft_seen_vertex *vertex);

/* pi BRDF cos(theta_light) at a point of the opening, mm from its centre, toward `view` under a far light toward
 * `light`, both unit. Of a sample with depth it is what one path of light says, `index` of the sequence `key`.
 * Thread-safe. */
weft_rgb weft_virtual_sample_reflect(const weft_virtual_sample *sample, double x_mm, double y_mm, weft_vec3 light,
                                     weft_vec3 view, uint64_t key, uint32_t index);

#endif
