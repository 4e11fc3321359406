/* One texel of the material: frame, lobes and T of its three channels, packed, and measured against its samples. */
#ifndef WEFT_COMPRESS_TEXEL_TEXEL_H
#define WEFT_COMPRESS_TEXEL_TEXEL_H

#include "compress/fit/error_tally.h"
#include "compress/texel/candidate.h"
#include "compress/texel/frame_search.h"
#include "compress/texel/pack.h"

/* What a thread needs for that. Texels are fitted independently: starting from the left neighbour saved a tenth of the
 * time on smooth materials but left 8 % more median error on real cloth, whose neighbours differ. */
typedef struct weft_texel_fitter weft_texel_fitter;

/* Where the samples are and what they mean. */
typedef struct weft_texel_source {
    const weft_dataset_layout *layout;
    const uint8_t *held_out;
    weft_fit_options options;
    bool light_table; /* fit S(l), where lights have labels */
    weft_sample_weights weights;
    weft_frame_choice frames;
    const weft_material
        *given; /* WEFT_FRAMES_GIVEN: has the frames; WEFT_FRAMES_FITTED: begin there too, may be NULL */
    /* Each texel has the smallest model (compress/texel/model_ladder.h) whose RMSE over the rms of its samples is at
     * most this; the whole of `options` where none is. 0: the whole everywhere. */
    double target_error;
    const weft_judgement *judgement; /* not NULL: nothing is fitted and stored, these candidates are measured */
} weft_texel_source;

/* What happened to some texels. */
typedef struct weft_texel_counts {
    long texels, empty, turned, second_start;
    long missed;       /* texels that no model brings to the target */
    long held;         /* texels that were held to WEFT_BRIGHTEST_MULTIPLE */
    long stepped_down; /* texels that a smaller model serves better */
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
 * border. Its extent goes to x0..y1. Pure. */
int weft_texel_group(const weft_dataset_layout *layout, int level, int x, int y, int extent[4]);

/* Stores one packed channel: T `code` [view_count] and S `light_code` [light_count], NULL where there is none. */
void weft_texel_store(weft_material *material, int level, int x, int y, int channel, const weft_packed *packed,
                      const uint8_t *code, const uint8_t *light_code);

#endif
