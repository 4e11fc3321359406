/* One texel of the material: frame, lobes and T of its three channels, packed, and measured against its samples. */
#ifndef WEFT_COMPRESS_TEXEL_TEXEL_H
#define WEFT_COMPRESS_TEXEL_TEXEL_H

#include "compress/fit/error_tally.h"
#include "compress/options/options.h"
#include "compress/texel/pack.h"

/* What a thread needs for that. Texels are fitted independently: starting from the left neighbour saved a tenth of the
 * time on smooth materials but left 8 % more median error on real cloth, whose neighbours differ. */
typedef struct weft_texel_fitter weft_texel_fitter;

/* Where the samples are and what they mean. */
typedef struct weft_texel_source {
    const weft_dataset_layout *layout;
    const uint8_t *held_out;
    weft_fit_options options;
    weft_sample_weights weights;
    const weft_material *given; /* has frames from which the search of frames begins, too; NULL: there are none */
} weft_texel_source;

/* What happened to some texels. */
typedef struct weft_texel_counts {
    long texels, empty;
    weft_error_sums sums;
} weft_texel_counts;

/* `source` must outlive the fitter. Errors: WEFT_SYSTEM. */
weft_code weft_texel_fitter_create(const weft_texel_source *source, weft_texel_fitter **result, weft_error *error);
void weft_texel_fitter_free(weft_texel_fitter *fitter);

/* Histogram of the errors of all texels so far; the caller merges it away. */
weft_error_tally *weft_texel_fitter_tally(weft_texel_fitter *fitter);

/* Fits texel (x, y) of a level from the sums of samples over its group of texels (see weft_samples_gather) and writes
 * it into the material. Thread-safe for distinct texels and fitters. */
void weft_texel_fit(weft_texel_fitter *fitter, weft_material *material, int level, int x, int y, const float *sum,
                    const float *count, weft_texel_counts *counts);

/* Number of texels of level 0 in the group of texel (x, y) of a level: 4^level inside, fewer at the right and lower
 * border. Its extent goes to x0, y0, x1, y1. Pure. */
int weft_texel_group(const weft_dataset_layout *layout, int level, int x, int y, int extent[4]);

/* The ceiling of a texel whose brightest sample, cosine included, is r, whose brightest sample without it is f, and
 * whose highest light has that cosine; 0 for a texel without light. Pure.
 *
 * A lobe may be far brighter between its samples, or beyond them, than any of them. The ceiling c bounds f, and with it
 * r = f cos <= c, by what the samples allow: WEFT_BRIGHTEST_MULTIPLE times the brightest r, as it would be under the
 * highest light. To multiply the brightest f would not do: a sample at grazing light has a large f and next to no r,
 * and noise more so, and several times that f would glare under a light from above. No sample is cut: where the
 * brightest f is above that bound it is the ceiling. */
double weft_texel_ceiling(double r, double f, double cosine);

/* Stores one packed channel: T `code` [view_count], NULL where there is none. */
void weft_texel_store(weft_material *material, int level, int x, int y, int channel, const weft_packed *packed,
                      const uint8_t *code);

#endif
