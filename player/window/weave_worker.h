/* Derives what follows from a changed weave in a thread of its own, the latest weave first, so that the thread that
 * draws never waits for it. Functions are for the drawing thread. */
#ifndef WEFT_PLAYER_WINDOW_WEAVE_WORKER_H
#define WEFT_PLAYER_WINDOW_WEAVE_WORKER_H

#include "player/texture/weave_texels.h"

#include <stdbool.h>

typedef struct weft_weave_worker weft_weave_worker;

/* `start`: a weave with its specular scale, from which the first change is taken. Errors: WEFT_SYSTEM. The caller frees
 * with weft_weave_worker_free, which waits for what runs. */
weft_code weft_weave_worker_create(const weft_weave *start, weft_weave_worker **result, weft_error *error);
void weft_weave_worker_free(weft_weave_worker *worker);

/* Wants this weave, and no longer those before it. Errors: WEFT_SYSTEM. */
weft_code weft_weave_worker_ask(weft_weave_worker *worker, const weft_weave *weave, weft_error *error);

/* *ready: there is news of the weave asked for last, or of one before it; the caller then owns *texels. First the
 * specular scale is estimated (weft_weave_specular_scale_batch, as its ratio to the one before); *exact: it is
 * weft_weave_specular_scale of the weave asked for last, and no more will come. Errors: of the worker. */
weft_code weft_weave_worker_take(weft_weave_worker *worker, weft_weave_texels *texels, bool *ready, bool *exact,
                                 weft_error *error);

#endif
