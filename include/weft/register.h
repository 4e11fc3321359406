/* Registration: a session of photographs becomes a dataset. */
#ifndef WEFT_REGISTER_H
#define WEFT_REGISTER_H

#include "weft/progress.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_register_options {
    int width, height;         /* texels of the opening of the target; 0: 64 */
    bool allow_unfinished;     /* register a session whose plan is not complete */
    const char *report_folder; /* write a report with pictures there; NULL: none */
    const char *colour;        /* colours of the camera, from `weft colour`; of several cameras, a folder with a
                                  CAMERA.json each; NULL: those in the session, if any */
} weft_register_options;

typedef struct weft_register_report {
    int camera_count;
    int photograph_count, used_count;      /* of the session; in the dataset */
    int viewpoint_count, registered_count; /* of the session; whose pose was found */
} weft_register_report;

/* Finds the pose of the camera for every view, rectifies the photographs, calibrates them by the white patches of the
 * target, and writes the dataset `output` atomically: reflectance times cosine, linear
 * (docs/reference/registration.md). Photographs that cannot be used are masked WEFT_MASK_MISSING. `options`, `progress`
 * and `report` may be NULL. Uses OpenMP; about 600 MB of memory. One thread at a time may read or write datasets.
 * Errors: WEFT_BAD_INPUT for a session that cannot be read, or is unfinished (unless allowed), or where nothing can be
 * used; WEFT_MISSING; WEFT_SYSTEM; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_register(const char *session, const char *output, const weft_register_options *options,
                                 const weft_progress *progress, weft_register_report *report, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
