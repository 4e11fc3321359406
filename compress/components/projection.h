/* The coefficients of all texels of a dataset. */
#ifndef WEFT_COMPRESS_COMPONENTS_PROJECTION_H
#define WEFT_COMPRESS_COMPONENTS_PROJECTION_H

#include "base/progress.h"
#include "btf/material/components.h"
#include "compress/components/factorisation.h"
#include "compress/run/block_reader.h"
#include "compress/run/checkpoint.h"
#include "compress/run/memory.h"

/* Freed with weft_projection_free. */
typedef struct weft_projection {
    int width, height, component_count;
    float *coefficient; /* [height][width][component_count] */
    float *brightest;   /* [height][width] the largest valid sample of the texel, reflectance times cosine; 0 without */
    float *floor;       /* [height][width][3] what all but 2 % of the valid samples of the texel reach */
    long masked;        /* samples */
    long empty;         /* texels without any */
} weft_projection;

/* How to go about it; no part of it changes a bit of the result. */
typedef struct weft_projection_job {
    const weft_memory_budget *budget;
    weft_checkpoint *checkpoint; /* whose unread records are the first blocks, and which gets the others; NULL: none */
    const weft_log *log;         /* hears how many there were */
    const weft_progress *progress;
} weft_projection_job;

/* Reads the dataset once, block by block, the next one while the present one is worked on, and nothing else may use it
 * meanwhile. Texels of near images are projected by what the maps make of the components for each of them: `projector`
 * is NULL then. Errors: those of reading; WEFT_BAD_USAGE where the budget does not
 * suffice; those of weft_checkpoint_append; WEFT_BAD_INPUT for a checkpoint of other blocks; WEFT_SYSTEM. */
weft_code weft_projection_make(weft_dataset *dataset, const weft_component_images *images,
                               const weft_projector *projector, const weft_factorisation *components,
                               const weft_component_maps *maps, const weft_projection_job *job,
                               weft_projection *projection, weft_error *error);
void weft_projection_free(weft_projection *projection);

/* ---- Coefficients as they are stored ---- */

/* Fills the levels of `components` and takes the size of a step into components->scale. The texels of a level are the
 * means of those of the level before, by what they cover of level 0. Linear components (exponent 1) have the mean
 * coefficients: where nothing is masked these are exactly the coefficients of the mean samples. Coded ones are decoded
 * at up to 512 of the images, averaged in linear light, coded again and projected on `factor` [component][length], what
 * the maps make of the components there (compress/components/model.h); the root mean of squares is not the mean of
 * roots. The ceiling of a square is WEFT_BRIGHTEST_MULTIPLE times the largest sample under it. The floor of a square is
 * the least of the floors of its texels, each the mean of those that it covers. Where `components` are twice those of
 * the projection, the second half, of the same values and scales as the first, takes what rounding left of the
 * coefficients, in steps 254 times as fine. `projection` is used up. Errors: WEFT_SYSTEM. */
weft_code weft_components_fill_levels(weft_projection *projection, const weft_component_images *images,
                                      const float *factor, weft_components *components, weft_error *error);

#endif
