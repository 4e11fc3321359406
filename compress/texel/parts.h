/* What the sources of a texel's fit share. Private to compress/texel. */
#ifndef WEFT_COMPRESS_TEXEL_PARTS_H
#define WEFT_COMPRESS_TEXEL_PARTS_H

#include "compress/fit/kernels.h"
#include "compress/texel/frame_search.h"
#include "compress/texel/texel.h"

struct weft_texel_fitter {
    const weft_texel_source *source;
    const weft_fit_kernels *kernels;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    weft_frame_search search;
    double *table;  /* [2][view_count] T of one channel; then room */
    int *seen;      /* [view_count] valid samples */
    float *decoded; /* [view_count] T of one channel as it will be read */
    weft_error_tally *tally;
    /* The texel as it is stored, and as it will be read: */
    int16_t frame[3];
    weft_packed packed[WEFT_CHANNELS];
    weft_fit as_read[WEFT_CHANNELS];
    uint8_t *code; /* [channel][view_count] of T */
};

/* T of a channel is the mean of the others in views without any valid sample. Lowers its code where the model, whose
 * lobes were fitted to the others and may be of any size there, would be far brighter than in the nearest view with
 * samples. */
void weft_texel_limit_unseen(weft_texel_fitter *fitter, int channel);

/* Compares the texel as it will be read with its samples; `tallied`: also for the percentiles. */
weft_error_sums weft_texel_measure(weft_texel_fitter *fitter, bool tallied);

#endif
