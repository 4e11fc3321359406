/* The axes of a rig out of photographs of the target that they took it to. */
#ifndef WEFT_REGISTRATION_AXES_CALIBRATION_H
#define WEFT_REGISTRATION_AXES_CALIBRATION_H

#include "base/progress.h"
#include "base/text/lines.h"
#include "btf/session/poses_file.h"
#include "btf/session/session.h"
#include "registration/axes/fit.h"

/* ---- The target in the photographs of a series ---- */

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

/* ---- The axes ---- */

enum { WEFT_AXES_FEWEST = 8, WEFT_AXES_FOLDS = 5 };

typedef struct weft_axes_report {
    weft_axes_fit fit; /* of all shots that are used */
    weft_poses_file file;
    int used;
    weft_lines found;        /* of each axis, for the user */
    weft_lines undetermined; /* what stays as specified, and why */
} weft_axes_report;

/* Adjusts home and lines, then what else makes the shots more probable: scale, unevenness and wobble of each joint,
 * and, where `free_lens`, the lens. A term is taken if it lowers minus twice the log probability by more than its
 * numbers times log(6 shots) (Schwarz 1978), the best first.
 *
 * The line of a joint is free if its turns have three values that differ by half a degree; of fewer it is held as
 * `nominal` has it. Shots whose own place is three times as far off as is usual, and more than 0.3 pixels, are left
 * out, the worst first.
 *
 * What is held out in turn is a fifth of the shots each: the terms are those of all, their numbers are not.
 *
 * `report` is to be freed with weft_axes_report_free, whatever is returned. Errors: WEFT_BAD_INPUT for fewer than
 * WEFT_AXES_FEWEST shots that can be used, or where no axis turns; WEFT_SYSTEM. */
weft_code weft_axes_calibrate(weft_axes_shot *shot, int count, const weft_rig_poses *nominal, bool free_lens,
                              weft_axes_report *report, weft_error *error);
void weft_axes_report_free(weft_axes_report *report);

/* ---- How far off the camera will be in the poses of a plan, as far as a calibration of the axes knows ---- */

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
