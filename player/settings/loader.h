/* Reading in a thread of its own, while pictures are drawn: a load reads and decodes in the background and hands what
 * is to be uploaded to the thread that draws, which takes it in slices of some milliseconds between frames.
 *
 * One load runs at a time, in the order they were started (HDF5 is not thread-safe). Functions are for the drawing
 * thread unless they take a weft_load. */
#ifndef WEFT_PLAYER_SETTINGS_LOADER_H
#define WEFT_PLAYER_SETTINGS_LOADER_H

#include "base/progress.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct weft_loader weft_loader;
typedef struct weft_load weft_load; /* one that runs, as its reader sees it */

typedef struct weft_load_steps {
    /* In the background. */
    weft_code (*read)(void *data, weft_load *load, weft_error *error);
    /* Afterwards, in the drawing thread, unless reading failed or was cancelled. */
    weft_code (*show)(void *data, weft_error *error);
    /* Always, once, last, in the drawing thread. */
    void (*release)(void *data);
} weft_load_steps;

/* Errors: WEFT_SYSTEM. The caller frees with weft_loader_free. */
weft_code weft_loader_create(weft_loader **result, weft_error *error);
/* Cancels all loads and waits for the one that runs to notice. */
void weft_loader_free(weft_loader *loader);

/* Starts a load after those before it; cancels earlier ones of the same slot. `data` is released also on failure.
 * Errors: WEFT_SYSTEM. */
weft_code weft_loader_start(weft_loader *loader, int slot, const weft_load_steps *steps, void *data, weft_error *error);

/* Cancels the loads of a slot. */
void weft_loader_cancel(weft_loader *loader, int slot);

/* Does what loads have handed over, at least one piece and for about budget_s. *shown: one of them is finished. Errors:
 * that of a load; call again for the others. */
weft_code weft_loader_poll(weft_loader *loader, double budget_s, bool *shown, weft_error *error);

/* Waits for the next thing to do and does it; *some: there was one, and there may be more. Errors: that of a load. */
weft_code weft_loader_wait(weft_loader *loader, const weft_progress *progress, bool *some, weft_error *error);

/* Share of the load that runs, 0..1; -1 where nothing is left to do. */
double weft_loader_progress(weft_loader *loader);

/* ---- For readers, in the background ---- */

/* `run` is called in the drawing thread, unless the load is cancelled or failed before; `release` always, once. */
typedef struct weft_load_piece {
    weft_code (*run)(void *data, weft_error *error);
    void (*release)(void *data);
    void *data;
    size_t bytes;
} weft_load_piece;

/* Hands over a piece; waits while more than 64 MiB of them lie there. Errors: WEFT_SYSTEM once the load is cancelled:
 * the reader returns that; the piece is released here. */
weft_code weft_load_post(weft_load *load, weft_load_piece piece, weft_error *error);

/* Waits so long; false as soon as the load is cancelled. */
bool weft_load_rest(weft_load *load, double rest_s);

/* Tells how far the load is. */
weft_progress weft_load_progress(weft_load *load);

#endif
