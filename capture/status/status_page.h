/* A page that tells, while photographs are taken, how it goes: how many, how long still, how steady the lamp is, and
 * what was repeated. It is rewritten when a viewpoint is over. */
#ifndef WEFT_CAPTURE_STATUS_STATUS_PAGE_H
#define WEFT_CAPTURE_STATUS_STATUS_PAGE_H

#include "btf/session/session.h"

/* What has happened so far. */
typedef struct weft_status_counts {
    int taken, total; /* photographs: those there now, and all of the plan */
    int taken_now;    /* by this run, in `seconds` */
    double seconds;
    int damaged, timeouts, disturbed; /* see weft_capture_summary */
} weft_status_counts;

typedef struct weft_status_page weft_status_page;

/* `status` is NULL where `folder` is: every function below then does nothing. `camera` names one of several, for the
 * title; NULL: there is one. Borrows session and camera. Errors: WEFT_SYSTEM. */
weft_code weft_status_page_begin(const char *folder, const weft_session *session, const char *camera,
                                 weft_status_page **status, weft_error *error);

/* Notes the photograph of a shot: the first one of a viewpoint is shown, and the lamp is measured on the white patches
 * of each, where they do not clip and the light stands at most 60 degrees from the zenith. `white` is what they show
 * above the black level, in raw values. Writes the page when a viewpoint was over. Errors: WEFT_SYSTEM. */
weft_code weft_status_page_note(weft_status_page *status, int shot, const weft_shot_record *record, double white,
                                const uint16_t *samples, const weft_status_counts *counts, weft_error *error);

/* Writes the page a last time, with why the run ended early (NULL: it did not), and frees. Errors: WEFT_SYSTEM. */
weft_code weft_status_page_end(weft_status_page *status, const weft_status_counts *counts, const char *why,
                               weft_error *error);

/* ---- The page over the status pages of several cameras: the share of each, and what became of it ---- */

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
