/* How far off the camera will be in the poses of a plan, as far as a calibration of the axes knows. */
#ifndef WEFT_REGISTRATION_AXES_EXPECTATION_H
#define WEFT_REGISTRATION_AXES_EXPECTATION_H

#include "registration/axes/calibration.h"

/* Standard deviations of a pose: of where the sample is taken to be, root mean square over the opening along the plate,
 * and of the direction it is seen from. */
typedef struct weft_expected_pose {
    weft_turns turns;
    double model_texels;   /* because the axes are known so well */
    double scatter_texels; /* because they stand a little differently every time */
    double texels;         /* of both */
    double direction_rad;  /* of both */
} weft_expected_pose;

typedef struct weft_expectation {
    int poses;
    double median_texels;
    weft_expected_pose worst; /* by texels */
    double direction_rad;     /* the largest */
} weft_expectation;

/* The turns that a rig takes a view up with, judged by those of a series: what turned in the series turns, phi of the
 * camera before phi of the sample. False where it cannot be seen so. Pure. */
bool weft_axes_turns_like(const weft_axes_shot *shot, int count, weft_angles view, weft_turns *turns);

/* Of one pose: the covariance of the fit through the derivatives of the pose, by differences. Infinite where the camera
 * does not see the opening. Pure. */
weft_expected_pose weft_axes_expect_pose(const weft_axes_fit *fit, const weft_rig_poses *nominal, double opening_mm,
                                         int texels, const weft_turns *turns);

/* Of several. Errors: WEFT_SYSTEM for memory. */
weft_code weft_axes_expect(const weft_axes_fit *fit, const weft_rig_poses *nominal, double opening_mm, int texels,
                           const weft_turns *turns, int count, weft_expectation *expectation, weft_error *error);

#endif
