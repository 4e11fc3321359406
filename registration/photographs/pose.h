/* The pose of a photograph below a pixel, against the drawing of the whole target. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_POSE_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_POSE_H

#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"

/* What all photographs of one camera share: the drawing, seen in a photograph that is reduced by averaging squares of
 * `reduction` x `reduction` pixels. The reduced one still shows a place to a hundredth of its pixel. */
typedef struct weft_reduced_sight {
    int reduction;
    weft_sight sight;
} weft_reduced_sight;

/* Chooses the reduction that leaves at most 1600 pixels. `pixels_per_mm`: of a typical photograph, not reduced. The
 * caller frees with weft_reduced_sight_free. Errors: as weft_sight_create. */
weft_code weft_reduced_sight_create(const weft_camera *camera, const weft_target *target, double pixels_per_mm,
                                    weft_reduced_sight *reduced, weft_error *error);
void weft_reduced_sight_free(weft_reduced_sight *reduced);

/* Refines photograph->homography, starting from its pose, and fills point_spread (of the full photograph), correlation
 * and uncertainty_mm; a remark where the drawing is not found. Errors: WEFT_SYSTEM. */
weft_code weft_photographs_pose_refine(const weft_reduced_sight *reduced, const weft_camera *camera,
                                       const weft_light_values *values, weft_photographs_photograph *photograph,
                                       weft_error *error);

#endif
