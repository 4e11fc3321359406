/* Whether a session is sound: what its folder holds against what its journal and its plan say. */
#ifndef WEFT_CAPTURE_SESSION_CHECK_H
#define WEFT_CAPTURE_SESSION_CHECK_H

#include "base/progress.h"
#include "btf/session/camera_list.h"

typedef enum weft_session_problem_kind {
    WEFT_PROBLEM_MISSING,   /* a photograph that the journal names is gone */
    WEFT_PROBLEM_DAMAGED,   /* a photograph of other bytes than the journal says, or that cannot be read */
    WEFT_PROBLEM_DUPLICATE, /* a photograph with the bytes of another shot, which was taken before it: the camera handed
                           over an old one, for its noise repeats nothing */
    WEFT_PROBLEM_UNEXPECTED, /* a file that belongs to no shot of the plan */
    WEFT_PROBLEM_KINDS
} weft_session_problem_kind;

/* "missing", "damaged", "duplicate", "unexpected". */
extern const char *const weft_session_problem_name[WEFT_PROBLEM_KINDS];

typedef struct weft_session_problem {
    weft_session_problem_kind kind;
    int shot;   /* which is to be taken again; -1 for an unexpected file and for a frame of the sensor */
    int frame;  /* of the sensor, to be taken again; -1 for others */
    char *text; /* one line that names the file and what is wrong; owned */
} weft_session_problem;

typedef struct weft_session_problems {
    int count;
    weft_session_problem *problem; /* [count] those of frames of the sensor, of shots in the order of the plan, then
                                  unexpected files; owned */
} weft_session_problems;

/* Reads every photograph and frame that the journal names: a shot that was never taken is no problem, and counts in
 * session->record. A hidden file is unexpected only where a capture leaves it that is killed. Parallel (OpenMP).
 * The caller frees with weft_session_problems_free. Errors: WEFT_SYSTEM for memory; a problem is none. */
weft_code weft_session_check(const weft_session *session, const weft_progress *progress,
                             weft_session_problems *problems, weft_error *error);
void weft_session_problems_free(weft_session_problems *problems);

/* Adds what lies in the folder of several cameras and is neither their list nor a session of theirs. Errors:
 * WEFT_SYSTEM. */
weft_code weft_camera_folder_check(const char *folder, const weft_camera_list *list, weft_session_problems *problems,
                                   weft_error *error);

#endif
