/* Taking the photographs of a session. */
#ifndef WEFT_CAPTURE_CAPTURE_H
#define WEFT_CAPTURE_CAPTURE_H

#include "base/progress.h"
#include "capture/setup.h"

#include <signal.h>

typedef struct weft_capture_summary {
    int shot_count;
    int found;   /* photographs that were there already */
    int damaged; /* of the journal, taken again */
    int taken;
    int exposures;                   /* including those repeated for a better exposure */
    int timeouts;                    /* exposures that the camera did not deliver, repeated */
    double seconds;                  /* of taking photographs */
    char warning[WEFT_MESSAGE_SIZE]; /* of the weave file; empty if all is well */
} weft_capture_summary;

/* Takes every photograph of the plan that the session does not hold yet, then writes the ground truth. Every photograph
 * appears under its final name when it is complete and then in the journal, so that the same call goes on wherever the
 * process died. `stop` (may be NULL) is read between shots: when it is not 0, the shot in flight is completed and the
 * call returns. Parallel (OpenMP); the photographs are the same bytes for any number of threads. Errors: WEFT_BAD_INPUT
 * for plan, sample or a session that is another one; WEFT_SYSTEM for a device that fails for good, a full disk, too
 * little space to begin with, or a stop ("stopped, N of M photographs ..."). What was taken stays. */
weft_code weft_capture_run(const weft_capture_request *request, const volatile sig_atomic_t *stop,
                           const weft_progress *progress, weft_capture_summary *summary, weft_error *error);

/* What a capture would do. */
typedef struct weft_capture_rehearsal {
    int shot_count, view_count, driven_aside; /* lights that step aside for the camera */
    uint64_t bytes;                           /* of disk */
    double seconds_per_photograph;            /* measured on one photograph */
    char warning[WEFT_MESSAGE_SIZE];
} weft_capture_rehearsal;

/* Plans, takes one photograph in memory and writes nothing. Errors: as weft_capture_run. */
weft_code weft_capture_rehearse(const weft_capture_request *request, weft_capture_rehearsal *rehearsal,
                                weft_error *error);

#endif
