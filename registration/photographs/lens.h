/* One lens, the shape of the sheet and a pose for every photograph, from the corners of the markers. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_LENS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_LENS_H

#include "registration/lamp/photograph.h"
#include "registration/pose/opencv_bridge.h"
#include "registration/pose/plate_view.h"

/* ---- Bundle adjustment: least squares of the reprojection over what all views share, and a pose for each ---- */

/* What all views share. k1 and k2 are the radial terms of the lens; the bend of the sheet has three. */
enum {
    WEFT_BUNDLE_FOCAL_LENGTH,
    WEFT_BUNDLE_MIDDLE_X,
    WEFT_BUNDLE_MIDDLE_Y,
    WEFT_BUNDLE_K1,
    WEFT_BUNDLE_K2,
    WEFT_BUNDLE_BEND,
    WEFT_BUNDLE_SHARED = WEFT_BUNDLE_BEND + 3
};

typedef struct weft_bundle {
    weft_camera camera;
    weft_bend bend;
    weft_pose *pose; /* [count] of the views, of the caller */
    double squares;  /* sum of squared residuals, pixels^2 */
    /* Of focal length, pixels, and middle, k1, k2; of the bend in mm at 100 mm from the middle. 0: not estimated. */
    double standard_error[WEFT_BUNDLE_SHARED];
    /* F statistic of the bend, three degrees of freedom, each photograph counting as one observation; 0: not known. */
    double bend_score;
} weft_bundle;

/* Improves camera, bend and poses of `found`, which are the start; `terms` has a bit 1 << WEFT_BUNDLE_... for each
 * shared term that is estimated, the others stay. The ratio of fx to fy stays. Errors: WEFT_SYSTEM for memory. Uses
 * OpenMP. */
weft_code weft_bundle_adjust(const weft_corner_view *view, int count, unsigned terms, weft_bundle *found,
                             weft_error *error);

/* How far off the corners of a view are under pose number `pose`, RMS. Pure. */
double weft_bundle_rms_px(const weft_bundle *bundle, int pose, const weft_corner_view *view);

/* ---- The lens of a folder of photographs ---- */

/* What is known of a lens before any photograph is looked at. */
typedef enum weft_lens_knowledge {
    WEFT_LENS_UNKNOWN,    /* everything is estimated */
    WEFT_LENS_FOCAL_ONLY, /* the focal length as written is right; k1 is estimated: few views cannot determine more */
    WEFT_LENS_KNOWN       /* only poses are estimated */
} weft_lens_knowledge;

/* Standard errors under the scatter of the corners; 0 for what is not estimated. */
typedef struct weft_lens_errors {
    double focal_px, k1, k2;
} weft_lens_errors;

/* How a lens became known. */
typedef struct weft_lens_estimate {
    weft_camera camera; /* no vignetting */
    weft_lens_knowledge knowledge;
    weft_lens_errors errors;
    weft_bend bend;           /* of the sheet; zeros where it is flat, or the photographs cannot tell */
    double bend_error_mm;     /* standard error at 100 mm from the middle */
    double assumed_error_deg; /* largest of weft_lens_assumed_error */
    int distinct_views;       /* whose directions differ by 10 degrees and more */
    double rms_px;            /* of all corners used */
} weft_lens_estimate;

/* Estimates the lens from photographs of width x height pixels, or takes `known` where it is not NULL, and the bend of
 * the sheet, where that is significant; fills pose and corner_rms_px of every photograph that is used. One whose
 * corners do not fit gets a remark. Where too few distinct views tell a lens, the focal length that the camera wrote is
 * believed. Errors: WEFT_BAD_INPUT where no lens fits, or where the photographs cannot tell it and no focal length is
 * written; WEFT_SYSTEM. */
weft_code weft_lens_estimate_from(weft_photographs_photograph *photograph, int count, int width, int height,
                                  const weft_camera *known, weft_lens_estimate *lens, weft_error *error);

/* Where one lens explains the corners badly and two explain them well: gives the photographs of the lens that took
 * fewer a remark. Poses and corner_rms_px are those of `one`. Errors: WEFT_SYSTEM. */
weft_code weft_lens_leave_out_second(const weft_lens_estimate *one, weft_photographs_photograph *photograph, int count,
                                     int *left_out, weft_error *error);

/* Standard error of the direction of the camera in a photograph that is used, degrees, from what of the lens is
 * assumed, not measured: where the focal length is as the camera wrote it, it errs by 1.5 %, and the axis passes the
 * middle of the picture by 0.7 % of the longer side in x and in y. The pose is found anew under each. 0 where the lens
 * is measured. Errors: WEFT_SYSTEM. */
weft_code weft_lens_assumed_error(const weft_lens_estimate *lens, const weft_photographs_photograph *photograph,
                                  double *deg, weft_error *error);

/* Largest less smallest height of a sheet that is bent, mm: 0 where it is flat. Pure. */
double weft_lens_bow_mm(const weft_bend *bend, const weft_target *target);

/* Squared distance from the axis of the farthest corner of a photograph, in focal lengths. Pure. */
double weft_lens_corner_radius_squared(const weft_camera *camera);

#endif
