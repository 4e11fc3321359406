/* A session before its first photograph: what follows from a plan and a rig. */
#ifndef WEFT_CAPTURE_PLANNED_SESSION_H
#define WEFT_CAPTURE_PLANNED_SESSION_H

#include "capture/rig.h"

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

#endif
