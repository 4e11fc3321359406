/* The coefficients of all texels of a dataset. */
#ifndef WEFT_COMPRESS_COMPONENTS_PROJECTION_H
#define WEFT_COMPRESS_COMPONENTS_PROJECTION_H

#include "base/progress.h"
#include "compress/components/factorisation.h"
#include "compress/run/block_reader.h"
#include "compress/run/checkpoint.h"
#include "compress/run/memory.h"

/* Freed with weft_projection_free. */
typedef struct weft_projection {
    int width, height, component_count;
    float *coefficient; /* [height][width][component_count] */
    float *brightest;   /* [height][width] the largest valid sample of the texel, reflectance times cosine; 0 without */
    float *floor;       /* [height][width][3] weft_floor_of_texel */
    long masked;        /* samples */
    long empty;         /* texels without any */
    long block_count, resumed_block_count; /* resumed: taken from the checkpoint */
    weft_block_reader_times times;
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
 * is NULL then, and elsewhere the maps may be. Errors: those of reading; WEFT_BAD_USAGE where the budget does not
 * suffice; those of compress/components/kept_blocks.h; WEFT_SYSTEM. */
weft_code weft_projection_make(weft_dataset *dataset, const weft_component_images *images,
                               const weft_projector *projector, const weft_factorisation *components,
                               const weft_component_maps *maps, const weft_projection_job *job,
                               weft_projection *projection, weft_error *error);
void weft_projection_free(weft_projection *projection);

#endif
