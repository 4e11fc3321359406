/* A start from the fiducial markers of the target. */
#ifndef WEFT_REGISTRATION_POSE_MARKERS_H
#define WEFT_REGISTRATION_POSE_MARKERS_H

#include "registration/pose/prediction.h"

typedef struct weft_marker_start {
    int found;                  /* markers of the target seen */
    int corners;                /* corners that agree on the homography; 0: there is none */
    double rms_px;              /* of the reprojection of those */
    weft_homography homography; /* plate mm to undistorted pixels */
} weft_marker_start;

/* Looks for the markers in a front view made from `photograph` ([height][width], linear) with the homography that the
 * rig predicts: there they are upright, square and large at every tilt, and a rig is far closer than a marker's width.
 * Their corners are then carried back to the photograph. Too few markers are no error. Errors: WEFT_SYSTEM. */
weft_code weft_markers_locate(const weft_sight *sight, const weft_target *target, const float *photograph,
                              const weft_homography *predicted, weft_marker_start *start, weft_error *error);

#endif
