/* The file of `weft calibrate`: where a rig truly stands, and how well that is known (docs/reference/poses-format.md).
 */
#ifndef WEFT_BTF_SESSION_POSES_FILE_H
#define WEFT_BTF_SESSION_POSES_FILE_H

#include "base/status.h"
#include "btf/session/lens.h"
#include "btf/session/rig_poses.h"

/* Standard errors of a joint; 0: held as specified. */
typedef struct weft_joint_error {
    double direction_rad, point_mm; /* root mean square of the two components across the line */
    double scale, uneven_rad, wobble_rad;
} weft_joint_error;

typedef struct weft_poses_file {
    weft_rig_poses poses;
    weft_joint_error error[WEFT_JOINTS];
    double home_rotation_rad, home_translation_mm; /* standard errors, the largest of the components */
    double lens_error[WEFT_LENS_PARAMETERS];       /* 0: held */
    double scatter_rad, scatter_mm; /* standard deviation a component by which the plate differs from shot to shot */
    double point_px;                /* standard deviation a coordinate of a point seen, within one shot */
    double rms_px, held_out_rms_px; /* distances of points from where the poses put them, in shots fitted and not */
} weft_poses_file;

/* Writes atomically. `undetermined` are sentences on what the shots do not tell. Errors: WEFT_BAD_INPUT
 * naming a number that is not finite; WEFT_SYSTEM; WEFT_BAD_USAGE where the path names no file. */
weft_code weft_poses_write(const char *path, const weft_poses_file *file, const weft_lens_photograph *shot,
                           int shot_count, const char *const *undetermined, int undetermined_count, weft_error *error);

/* Reads what can be computed with. Errors: WEFT_BAD_INPUT naming the file and the field or value that cannot be;
 * WEFT_SYSTEM. Thread-safe. */
weft_code weft_poses_read(const char *path, weft_poses_file *file, weft_error *error);

#endif
