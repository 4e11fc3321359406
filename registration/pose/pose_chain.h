/* From the pose that the rig predicts to the one the photographs show: markers, then the drawn target. */
#ifndef WEFT_REGISTRATION_POSE_POSE_CHAIN_H
#define WEFT_REGISTRATION_POSE_POSE_CHAIN_H

#include "registration/pose/markers.h"
#include "registration/pose/refine.h"

/* What a pose rests on in the end. */
typedef enum weft_pose_source {
    WEFT_POSE_FAILED,  /* nothing: the view cannot be used */
    WEFT_POSE_MARKERS, /* the markers' corners: the refinement failed */
    WEFT_POSE_DRAWING  /* refined against the drawn target */
} weft_pose_source;

typedef struct weft_pose_limits {
    double tolerance_mm;      /* how far from the predicted pose a view may lie, RMS over the opening */
    double least_correlation; /* of the photograph with its prediction */
} weft_pose_limits;

typedef struct weft_view_pose {
    weft_pose_source source;
    bool from_markers;          /* the refinement started from the markers, not from the predicted pose */
    int marker_count;           /* markers seen */
    double marker_rms_px;       /* reprojection of the corners that agree */
    weft_homography homography; /* plate mm to undistorted pixels */
    weft_point_spread point_spread;
    double correlation;    /* 0 where the refinement never ran */
    double uncertainty_mm; /* standard error of positions in the opening; of the markers: their reprojection error */
    double shift_mm;       /* against the predicted pose, RMS over the opening */
    char remark[160];      /* why it failed, or fell back; empty when all went well */
} weft_view_pose;

/* Whether markers are enough to start from: two of them at least agree, near where the rig predicted them. Pure. */
bool weft_markers_trusted(const weft_marker_start *markers, const weft_homography *predicted, double opening_mm,
                          const weft_pose_limits *limits);

/* Finds the pose in `photograph` ([height][width], linear, vignetting removed, NaN where unknown). `point_spread` is
 * the guess the refinement starts from. A pose that cannot be found is a result, not an error. Errors: WEFT_SYSTEM. */
weft_code weft_pose_find(const weft_sight *sight, const weft_target *target, const float *photograph,
                         const weft_homography *predicted, weft_point_spread point_spread,
                         const weft_pose_limits *limits, weft_view_pose *pose, weft_error *error);

/* What it rests on in words, "rig, markers, drawing" and the like. Static text. */
const char *weft_pose_source_name(const weft_view_pose *pose);

#endif
