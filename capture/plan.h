/* The plan: which photographs to take, in which order, and where the light must step aside for the camera. */
#ifndef WEFT_CAPTURE_PLAN_H
#define WEFT_CAPTURE_PLAN_H

#include "btf/session/session.h"

typedef struct weft_plan {
    int shot_count;
    weft_shot *shot; /* [shot_count], owned */
} weft_plan;

/* "ubo81" or "ubo151" (all pairs of the 81 or 151 directions), or the path of a CSV file with the columns
 * theta_light_deg, phi_light_deg, theta_view_deg and phi_view_deg. Shots of one view follow each other, so that the
 * camera axes move once for each view; views and lights keep their order. light_driven is light. The caller frees with
 * weft_plan_free. Errors: WEFT_BAD_INPUT "FILE:LINE: ..." also where two shots would have photographs of the same name.
 */
weft_code weft_plan_read(const char *name, weft_plan *plan, weft_error *error);

void weft_plan_free(weft_plan *plan);

/* Drives every light that is closer to its view than `half_angle_rad` (half the angle that the camera covers, seen from
 * the sample) to the nearest direction that is not, at most 89 degrees from the zenith; where all are equally near, to
 * the one toward the zenith. Deterministic. */
void weft_plan_avoid_camera(weft_plan *plan, double half_angle_rad);

/* The free direction nearest to `light`, as above. Pure. */
weft_angles weft_light_beside_camera(weft_angles light, weft_angles view, double half_angle_rad);

#endif
