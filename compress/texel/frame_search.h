/* The frame of a texel, found by fits of its grey samples: three channels with frames of their own would take thrice
 * the time and three frames to store. Private to compress/texel. */
#ifndef WEFT_COMPRESS_TEXEL_FRAME_SEARCH_H
#define WEFT_COMPRESS_TEXEL_FRAME_SEARCH_H

#include "compress/fit/fit.h"

/* A fit of the grey samples and its T. */
typedef struct weft_grey_fit {
    weft_fit fit;
    double *table; /* [view_count] */
    bool turns;    /* its frame was turned */
} weft_grey_fit;

/* Room for the fits of a thread. */
typedef struct weft_frame_search {
    double *tables;
    weft_finalist surface[WEFT_FINALISTS], given[WEFT_FINALISTS]; /* begun in the frame of the surface, the given one */
    weft_finalist bare[WEFT_FINALISTS];                           /* begun from shapes that were found without T */
} weft_frame_search;

/* Errors: WEFT_SYSTEM. The caller frees, also after a failure. */
weft_code weft_frame_search_create(int view_count, weft_frame_search *search, weft_error *error);
void weft_frame_search_free(weft_frame_search *search);

/* The fit whose frame the texel is to have: begun in the frame of the surface and in the given one (NULL: there is
 * none), turned from there where that helps. Its table is the search's until the next run. */
weft_grey_fit weft_frame_search_run(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                                    weft_fit_workspace *workspace, const weft_fit_options *options,
                                    const weft_frame *given);

#endif
