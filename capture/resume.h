/* Opening a session to take photographs in it: a new one, or one that was left unfinished. */
#ifndef WEFT_CAPTURE_RESUME_H
#define WEFT_CAPTURE_RESUME_H

#include "base/progress.h"
#include "btf/session/camera_list.h"
#include "capture/rig.h"

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

/* A folder that holds something no capture has left there is refused: hidden files are locks and temporary files.
 * Errors: WEFT_BAD_INPUT, WEFT_SYSTEM. */
weft_code weft_refuse_unexpected_files(const char *folder, weft_error *error);

/* ---- The folder that the sessions of several cameras lie in (btf/session/camera_list.h) ---- */

/* The cameras of a rig; none where it has one without a name. Pure. */
weft_camera_list weft_camera_list_of(const weft_rig *rig);

/* Makes the folder and writes the list, or checks that the list there is the same. Errors: WEFT_BAD_INPUT where the
 * folder holds something else or was begun with other cameras; WEFT_SYSTEM. */
weft_code weft_camera_folder_prepare(const char *folder, const weft_camera_list *list, weft_error *error);

/* Removes what a process left that died while it wrote the list. Whoever holds the session of the first camera is
 * alone. */
void weft_camera_folder_sweep(const char *folder);

#endif
