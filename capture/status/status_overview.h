/* The page over the status pages of several cameras: the share of each, and what became of it. */
#ifndef WEFT_CAPTURE_STATUS_STATUS_OVERVIEW_H
#define WEFT_CAPTURE_STATUS_STATUS_OVERVIEW_H

#include "capture/status/status_page.h"

/* The folder of the camera's own page has its name. */
typedef struct weft_status_share {
    const char *camera;
    weft_status_counts counts;
    const char *failure; /* its last one; NULL: none */
    bool left_out;       /* for the rest of the run */
} weft_status_share;

/* Writes `folder`/index.html, anew. `why` tells why the run ended; NULL: it goes on, or took all. Not thread-safe.
 * Errors: WEFT_SYSTEM. */
weft_code weft_status_overview_write(const char *folder, const char *sample, const weft_status_share *share, int count,
                                     const char *why, weft_error *error);

#endif
