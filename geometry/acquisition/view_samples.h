/* The samples of all texels in one view, gathered until their noise is low enough. Private to this folder. */
#ifndef WEFT_GEOMETRY_ACQUISITION_VIEW_SAMPLES_H
#define WEFT_GEOMETRY_ACQUISITION_VIEW_SAMPLES_H

#include "btf/direction/frame.h"
#include "geometry/acquisition/acquisition.h"
#include "geometry/light/illumination.h"

/* Paths come in batches of so many that are independent of each other, which is how the noise is known. */
enum { WEFT_BATCH_PATHS = 16 };

/* One texel in one view. */
typedef struct weft_texel_samples {
    int batches;
    long hits;            /* paths that met the cloth */
    double squares;       /* sum over batches, lights and channels of squared batch means */
    double variance;      /* of one batch, summed over lights and channels */
    weft_frame_sum frame; /* over the paths that met the cloth */
} weft_texel_samples;

typedef struct weft_view_samples {
    const weft_acquisition_options *options;  /* not owned */
    weft_real tile_width, tile_height, plane; /* plane: where the texels lie, height in the tile */
    int light_count;
    weft_texel_samples *texel; /* [height][width] */
    float *sum;                /* [height][width][light_count][3] of batch means */
    int *wanted;               /* [height][width] batches each texel is to have */
} weft_view_samples;

/* Errors: WEFT_SYSTEM. The caller frees with weft_view_samples_free. */
weft_code weft_view_samples_create(const weft_tile_mesh *mesh, int light_count, const weft_acquisition_options *options,
                                   weft_view_samples *samples, weft_error *error);
void weft_view_samples_free(weft_view_samples *samples);

/* Starts over and gathers all samples of a view: a few batches everywhere, then as many more as each texel's share of
 * the noise asks for (Neyman's allocation: in proportion to the standard deviation). `number` of the view keeps its
 * random numbers apart. Errors: WEFT_SYSTEM. */
weft_code weft_view_samples_gather(weft_view_samples *samples, const weft_illumination *illumination, weft_vec3 view,
                                   int number, weft_error *error);

/* Estimated standard error of the means, RMS over the view, relative to their RMS; 0 where nothing is seen. */
double weft_view_samples_noise(const weft_view_samples *samples);

#endif
