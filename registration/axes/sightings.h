/* The target in the photographs of a series. */
#ifndef WEFT_REGISTRATION_AXES_SIGHTINGS_H
#define WEFT_REGISTRATION_AXES_SIGHTINGS_H

#include "base/progress.h"
#include "btf/session/session.h"
#include "registration/axes/fit.h"

typedef struct weft_axes_sightings {
    int count;
    weft_axes_shot *shot; /* [count] one for each place of camera and sample, of at most WEFT_AXES_MOST */
    int photographs;      /* taken */
} weft_axes_sightings;

enum { WEFT_AXES_MOST = 200 };

/* Finds the target in the photographs of a session by its drawing: one shot for each viewpoint of the camera, the mean
 * of its photographs; where there are more than WEFT_AXES_MOST, so many, evenly spread. What cannot be used says why.
 * The caller frees with weft_axes_sightings_free. Errors: WEFT_BAD_INPUT for a session without photographs, or whose
 * axes are not known; WEFT_SYSTEM. Uses OpenMP. */
weft_code weft_axes_sightings_read(const weft_session *session, const weft_progress *progress,
                                   weft_axes_sightings *sightings, weft_error *error);
void weft_axes_sightings_free(weft_axes_sightings *sightings);

#endif
