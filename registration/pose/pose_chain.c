#include "registration/pose/pose_chain.h"

#include <math.h>
#include <stdio.h>

/* Distance on the plate between where two homographies put the same pixels, mm, RMS over the opening. */
static double homography_distance_mm(const weft_homography *a, const weft_homography *b, double opening_mm)
{
    enum { grid = 5 };
    weft_homography inverse = weft_homography_inverse(b);
    double sum = 0;
    for (int i = 0; i < grid * grid; i++) {
        double x = opening_mm * ((i % grid) / (grid - 1.0) - 0.5), y = opening_mm * ((i / grid) / (grid - 1.0) - 0.5);
        weft_pixel seen = weft_homography_apply(a, x, y), back = weft_homography_apply(&inverse, seen.x, seen.y);
        sum += (back.x - x) * (back.x - x) + (back.y - y) * (back.y - y);
    }
    return sqrt(sum / (grid * grid));
}

/* Deviations of the blur under which the two are compared, pixels, coarse to fine; the markers are close enough for the
 * sharp picture alone. */
static const double blur_from_prediction[] = {4, 1.5, 0}, blur_from_markers[] = {0};

static weft_code refine_through(const weft_sight *sight, const float *photograph, const double *blur, int blur_count,
                                weft_refinement *refinement, weft_error *error)
{
    for (int i = 0; i < blur_count; i++)
        WEFT_TRY(weft_refinement_run(sight, photograph, blur[i], refinement, error));
    return WEFT_OK;
}

/* Says in `remark` why a refinement cannot be accepted; true where it can. */
static bool acceptable(const weft_refinement *refinement, double shift_mm, const weft_pose_limits *limits, char *remark,
                       size_t size)
{
    if (!(refinement->correlation >= limits->least_correlation))
        snprintf(remark, size, "the target is not visible: correlation with its drawing %.2f, below %.2f",
                 refinement->correlation, limits->least_correlation);
    else if (!refinement->converged)
        snprintf(remark, size, "the refinement did not settle in %d steps", refinement->iterations);
    else if (!(shift_mm <= limits->tolerance_mm))
        snprintf(remark, size, "found %.1f mm from its place in the rig file; at most %.1f mm is accepted", shift_mm,
                 limits->tolerance_mm);
    else
        return true;
    return false;
}

static void accept_drawing(const weft_refinement *refinement, weft_view_pose *pose)
{
    pose->source = WEFT_POSE_DRAWING;
    pose->homography = refinement->homography;
    pose->point_spread = refinement->point_spread;
    pose->uncertainty_mm = refinement->uncertainty_mm;
    pose->remark[0] = 0;
}

/* Tries to refine from one start. */
static weft_code try_start(const weft_sight *sight, const float *photograph, const weft_homography *start,
                           bool from_markers, const weft_homography *predicted, weft_point_spread point_spread,
                           const weft_pose_limits *limits, weft_view_pose *pose, weft_error *error)
{
    weft_refinement refinement = {.homography = *start, .point_spread = point_spread};
    const double *blur = from_markers ? blur_from_markers : blur_from_prediction;
    int blur_count = from_markers ? 1 : (int)(sizeof blur_from_prediction / sizeof *blur_from_prediction);
    WEFT_TRY(refine_through(sight, photograph, blur, blur_count, &refinement, error));
    pose->from_markers = from_markers;
    pose->correlation = refinement.correlation;
    pose->shift_mm = homography_distance_mm(&refinement.homography, predicted, sight->opening_mm);
    if (acceptable(&refinement, pose->shift_mm, limits, pose->remark, sizeof pose->remark))
        accept_drawing(&refinement, pose);
    return WEFT_OK;
}

/* Nothing better than the markers: keep them and say so (`pose->remark` says why already). */
static void fall_back(const weft_sight *sight, const weft_marker_start *markers, const weft_homography *predicted,
                      weft_view_pose *pose)
{
    pose->source = WEFT_POSE_MARKERS;
    pose->from_markers = true;
    pose->homography = markers->homography;
    pose->shift_mm = homography_distance_mm(&markers->homography, predicted, sight->opening_mm);
    double px_per_mm = sqrt(fabs(markers->homography.m[0][0] * markers->homography.m[1][1] -
                                 markers->homography.m[0][1] * markers->homography.m[1][0])) /
                       fabs(markers->homography.m[2][2]);
    pose->uncertainty_mm = px_per_mm > 0 ? markers->rms_px / px_per_mm : 0;
}

bool weft_markers_trusted(const weft_marker_start *markers, const weft_homography *predicted, double opening_mm,
                          const weft_pose_limits *limits)
{
    enum { trusted_corners = 8 };
    return markers->corners >= trusted_corners &&
           homography_distance_mm(&markers->homography, predicted, opening_mm) <= limits->tolerance_mm;
}

weft_code weft_pose_find(const weft_sight *sight, const weft_target *target, const float *photograph,
                         const weft_homography *predicted, weft_point_spread point_spread,
                         const weft_pose_limits *limits, weft_view_pose *pose, weft_error *error)
{
    weft_marker_start markers;
    *pose = (weft_view_pose){.source = WEFT_POSE_FAILED};
    WEFT_TRY(weft_markers_locate(sight, target, photograph, predicted, &markers, error));
    pose->marker_count = markers.found;
    pose->marker_rms_px = markers.rms_px;
    bool trusted = weft_markers_trusted(&markers, predicted, sight->opening_mm, limits);
    if (trusted)
        WEFT_TRY(try_start(sight, photograph, &markers.homography, true, predicted, point_spread, limits, pose, error));
    if (pose->source == WEFT_POSE_FAILED)
        WEFT_TRY(try_start(sight, photograph, predicted, false, predicted, point_spread, limits, pose, error));
    if (pose->source == WEFT_POSE_FAILED && trusted)
        fall_back(sight, &markers, predicted, pose);
    return WEFT_OK;
}

const char *weft_pose_source_name(const weft_view_pose *pose)
{
    switch (pose->source) {
    case WEFT_POSE_DRAWING:
        return pose->from_markers ? "rig, markers, drawing" : "rig, drawing";
    case WEFT_POSE_MARKERS:
        return "rig, markers";
    case WEFT_POSE_FAILED:
        break;
    }
    return "nothing";
}
