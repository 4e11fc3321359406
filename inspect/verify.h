/* Checks that need all the bytes of a file, beyond what its reader refuses. */
#ifndef WEFT_INSPECT_VERIFY_H
#define WEFT_INSPECT_VERIFY_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/session/camera_list.h"

#include <jansson.h>

/* Every valid sample finite, every opacity in 0..1. Puts the counts into description["verified"]. */
weft_code weft_verify_dataset(weft_dataset *dataset, const weft_progress *progress, json_t *description,
                              weft_error *error);

/* Every photograph of the journal whole, and nothing else there (capture/session_check.h). Puts the counts into
 * description["verified"] and the faults, where there are any, into description["faults"]. Errors: WEFT_BAD_INPUT with
 * the fault, or how many there are of each kind; WEFT_SYSTEM. */
weft_code weft_verify_session(const weft_session *session, const weft_progress *progress, json_t *description,
                              weft_error *error);

/* The same of the sessions of several cameras, [list->count], and of what lies beside them in `folder`.
 * description["cameras"] holds the description of each; description["faults"] receives those of all. */
weft_code weft_verify_cameras(const char *folder, const weft_session *sessions, const weft_camera_list *list,
                              const weft_progress *progress, json_t *description, weft_error *error);

#endif
