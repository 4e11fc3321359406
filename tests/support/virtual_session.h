/* A session of the virtual rig and its ground truth, taken as `weft capture` takes them. */
#ifndef WEFT_TESTS_VIRTUAL_SESSION_H
#define WEFT_TESTS_VIRTUAL_SESSION_H

#include "capture/capture.h"
#include "capture/virtual/ground_truth.h"

typedef struct virtual_session {
    weft_capture_request capture;
    weft_virtual_request rig;
    weft_truth_request truth;
} virtual_session;

/* Opens the rig, takes the photographs that are missing and writes the truth. `summary` is filled on failure, too. */
weft_code virtual_session_take(const virtual_session *request, const volatile sig_atomic_t *stop,
                               const weft_progress *progress, weft_capture_summary *summary, weft_error *error);

/* Rehearses it. */
weft_code virtual_session_rehearse(const virtual_session *request, weft_capture_rehearsal *rehearsal,
                                   weft_error *error);

#endif
