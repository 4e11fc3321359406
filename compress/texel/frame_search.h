/* The frame of a texel, found by fits of its grey samples: three channels with frames of their own would take thrice
 * the time and three frames to store. Private to the room. */
#ifndef WEFT_COMPRESS_TEXEL_FRAME_SEARCH_H
#define WEFT_COMPRESS_TEXEL_FRAME_SEARCH_H

#include "compress/fit/fit.h"
#include "compress/options/options.h"

/* A fit of the grey samples and its T. */
typedef struct weft_grey_fit {
    weft_fit fit;
    double *table; /* [view_count] */
    bool turns;    /* its frame was turned */
} weft_grey_fit;

/* The starts of a texel in the frame of the surface and in the given one. */
typedef struct weft_frame_starts {
    bool found;
    weft_starts surface, given;
} weft_frame_starts;

/* Room for the fits of a thread, and what the last search found. */
typedef struct weft_frame_search {
    double *tables;
    weft_frame_starts starts[2];                                  /* without T, with T */
    weft_finalist surface[WEFT_FINALISTS], given[WEFT_FINALISTS]; /* begun in the frame of the surface, the given one */
    weft_finalist bare[WEFT_FINALISTS];                           /* begun from shapes that were found without T */
    weft_grey_fit best, other;                                    /* what is to be begun from, and another minimum */
    bool has_other;
} weft_frame_search;

/* Errors: WEFT_SYSTEM. The caller frees, also after a failure. */
weft_code weft_frame_search_create(int view_count, weft_frame_search *search, weft_error *error);
void weft_frame_search_free(weft_frame_search *search);

typedef struct weft_frame_request {
    weft_frame_choice choice;
    const weft_frame *given; /* NULL where there is none */
    weft_fit_options options;
    int most_lobes; /* that any request for this texel asks for */
} weft_frame_request;

/* Forgets the starts of the last texel. */
void weft_frame_search_forget(weft_frame_search *search);

/* Finds the fit whose frame the texel is to have, search->best, and search->other where the search has ended in a
 * second minimum so far. The tables of both are those of the search. */
void weft_frame_search_run(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                           weft_fit_workspace *workspace, const weft_frame_request *request);

/* Finds search->other after a run with the same request, if a start was left unrefined; returns whether there is one.
 */
bool weft_frame_search_other(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                             weft_fit_workspace *workspace, const weft_frame_request *request);

#endif
