/* Taking the photographs of a session with a rig that the caller has opened. */
#ifndef WEFT_CAPTURE_CAPTURE_H
#define WEFT_CAPTURE_CAPTURE_H

#include "base/progress.h"
#include "btf/session/camera_list.h"
#include "capture/rig.h"

#include <signal.h>

/* ---- A session before its first photograph: what follows from a plan and a rig ---- */

/* The session that `rig` takes by `plan` ("ubo81" or a CSV file, see capture/plan.h) in `folder`; nothing of it is on
 * disk. Of one of several cameras, it has the shots that are for this camera, and lies in a folder of its own in
 * `folder`. The caller frees with weft_session_free. Errors: WEFT_BAD_INPUT naming the file of the plan, or that of the
 * poses where they are of another lens or put the camera below the plate; WEFT_SYSTEM. */
weft_code weft_session_of_plan(const char *folder, const char *plan, const weft_rig *rig, weft_session *session,
                               weft_error *error);

/* Bytes that a photograph of the session takes on disk, rounded up. Pure. */
uint64_t weft_photograph_bytes(const weft_session *session);

/* Shots of the session that are not taken. Pure. */
int weft_session_missing(const weft_session *session);

/* ---- Opening a session to take photographs in it: a new one, or one that was left unfinished ---- */

/* A session that this process alone may write to. */
typedef struct weft_held_session {
    weft_session session;
    int lock;           /* descriptor */
    int next_viewpoint; /* viewpoints seen so far */
    int damaged;        /* shots of the journal with a problem: to be taken again */
} weft_held_session;

/* Creates the folder and session.json of `wanted`, or opens what is there after checking that it is the same session
 * (plan, camera, set-up, sample and settings), and checks it (capture/session_check.h): shots with a problem count as
 * not taken. The caller frees with weft_held_session_release. Errors: WEFT_BAD_INPUT where the folder holds something
 * else or another session; WEFT_SYSTEM where another process takes photographs in it. */
weft_code weft_session_hold(const weft_session *wanted, const weft_progress *progress, weft_held_session *held,
                            weft_error *error);
void weft_held_session_release(weft_held_session *held);

/* ---- The folder that the sessions of several cameras lie in (btf/session/camera_list.h) ---- */

/* The cameras of a rig; none where it has one without a name. Pure. */
weft_camera_list weft_camera_list_of(const weft_rig *rig);

/* Makes the folder and writes the list, or checks that the list there is the same. Errors: WEFT_BAD_INPUT where the
 * folder holds something else or was begun with other cameras; WEFT_SYSTEM. */
weft_code weft_camera_folder_prepare(const char *folder, const weft_camera_list *list, weft_error *error);

/* Removes what a process left that died while it wrote the list. Whoever holds the session of the first camera is
 * alone. */
void weft_camera_folder_sweep(const char *folder);

/* ---- Taking the photographs ---- */

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
