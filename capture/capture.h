/* Taking the photographs of a session with a rig that the caller has opened. */
#ifndef WEFT_CAPTURE_CAPTURE_H
#define WEFT_CAPTURE_CAPTURE_H

#include "btf/session/camera_list.h"
#include "capture/resume.h"
#include "capture/rig.h"

#include <signal.h>

typedef struct weft_capture_request {
    const char *folder; /* of the session */
    const char *plan;   /* "ubo81" or a CSV file, see capture/plan.h */
    int brackets;       /* photographs of a shot beyond the first, where it shows highlights or shadows badly: 0 to
                           WEFT_SESSION_MAX_BRACKETS */
    const char *status; /* folder of a page that tells how it goes (capture/status/status_page.h); NULL: none */
    weft_colour colour; /* of the camera under the lamp, for registration; terms 0: not known */
} weft_capture_request;

typedef struct weft_capture_summary {
    int found;   /* photographs that were there already */
    int damaged; /* of the journal, taken again */
    int taken;
    int bracketed;  /* photographs beyond the first of their shot */
    int exposures;  /* including those repeated for a better exposure */
    int timeouts;   /* exposures that the camera did not deliver, repeated */
    int disturbed;  /* photographs during which the stage did not keep its pose, repeated */
    double seconds; /* of taking photographs */
} weft_capture_summary;

/* A session in which this process alone takes photographs: one for each camera of the rig. */
typedef struct weft_capture {
    weft_rig *rig; /* borrowed: of the first camera */
    int camera_count;
    weft_held_session held[WEFT_CAMERAS_MAX]; /* [camera_count] */
    int brackets;
    const char *status; /* borrowed */
    weft_capture_summary summary;
} weft_capture;

/* Reads the plan and creates the session, or opens the one that was begun with the same plan and the same rig. A rig of
 * several cameras, of which `rig` is the first, has a session for each in a folder of its name. Takes no photograph.
 * The caller ends with weft_capture_end. Errors: WEFT_BAD_INPUT for the plan or a session that is another one;
 * WEFT_SYSTEM where another process takes photographs in it, or the disk has too little space. */
weft_code weft_capture_begin(const weft_capture_request *request, weft_rig *rig, const weft_progress *progress,
                             weft_capture *capture, weft_error *error);
void weft_capture_end(weft_capture *capture);

/* Takes every photograph of the plan that the session does not hold yet, and counts in capture->summary. Every
 * photograph appears under its final name when it is complete and then in the journal, so that a new capture goes on
 * wherever the process died. `stop` (may be NULL) is read between shots: when it is not 0, the shot in flight is
 * completed and the call returns. What several cameras see of one light in one pose of the stage is taken together. A
 * camera that fails loses that photograph, and after three failures in a row is left out; the others go on, and the
 * call fails in the end, naming it. Parallel (OpenMP); the photographs are the same bytes for any number of threads.
 * Errors: WEFT_SYSTEM for a device that fails for good, a full disk, or a stop ("stopped, N of M photographs ...").
 * What was taken stays. */
weft_code weft_capture_take(weft_capture *capture, const volatile sig_atomic_t *stop, const weft_progress *progress,
                            weft_error *error);

/* What a capture would do, with one camera of the rig. */
typedef struct weft_capture_rehearsal {
    int shot_count, view_count, driven_aside; /* lights that step aside for the camera */
    uint64_t bytes;                           /* of disk, at most */
    double seconds_per_photograph;            /* as the rig says, or measured on one photograph */
    weft_stage_estimate stage;                /* all 0 where the stage does not know */
    int *order;                               /* [shot_count] numbers of the shots as they would be taken, owned */
    weft_session session;                     /* that would be begun; nothing of it is on disk */
} weft_capture_rehearsal;

/* Plans and writes nothing. Takes one photograph in memory, unless the rig says how long one takes. The caller frees
 * with weft_capture_rehearsal_free. Errors: those of the plan and of the rig. */
weft_code weft_capture_rehearse(const weft_capture_request *request, weft_rig *rig, weft_capture_rehearsal *rehearsal,
                                weft_error *error);
void weft_capture_rehearsal_free(weft_capture_rehearsal *rehearsal);

#endif
