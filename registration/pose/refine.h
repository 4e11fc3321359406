/* Refinement of a homography against the drawn target: the predicted photograph is drawn anew under every estimate and
 * compared with the one that was taken, pixel by pixel, so that no photograph is ever resampled and the warp that is
 * left goes to the identity. Gauss-Newton on the correlation of the two, in the manner of Evangelidis & Psarakis 2008
 * ("ECC"), extended by a smooth lighting gradient, stray light and the point spread of the lens as further unknowns.
 *
 * Measured against cv::findTransformECC in the same loop (drawing anew, lighting removed by a wide Gaussian, four
 * rounds) on the tests' plates with noise, defocus and a gradient, RMS texels of 64 at tilts 0, 30, 60, 75: 0.006 0.005
 * 0.012 0.016 there, 0.001 0.001 0.004 0.008 here, in about a tenth of the time. */
#ifndef WEFT_REGISTRATION_POSE_REFINE_H
#define WEFT_REGISTRATION_POSE_REFINE_H

#include "registration/pose/prediction.h"

/* An estimate and how good it is. */
typedef struct weft_refinement {
    weft_homography homography; /* plate mm to undistorted pixels */
    weft_point_spread point_spread;
    bool converged; /* the last step moved the plate by less than 0.005 pixel */
    int iterations;
    double correlation;    /* of the photograph with the prediction, both without their smooth parts, -1..1 */
    double uncertainty_mm; /* standard error of positions in the opening, RMS, from the residual */
} weft_refinement;

/* Improves `refinement` (in: homography and point spread; out: everything). `photograph` [height][width] is linear, of
 * any brightness, vignetting removed; values that are not finite are left out. `blur_px` > 0 compares both sides
 * blurred by a Gaussian of that deviation, which widens the reach to about two of it. A
 * failure to converge is no error. Errors: WEFT_SYSTEM for memory. Uses OpenMP. */
weft_code weft_refinement_run(const weft_sight *sight, const float *photograph, double blur_px,
                              weft_refinement *refinement, weft_error *error);

/* What one photograph says of the bend of the plate, beside what it says of everything else: the change x of the bend
 * that it asks for has information . x = gradient, in units of the variance of its pixels. x is in mm at the distance
 * weft_bend_unit_mm from the origin: of xx, xy, yy. */
typedef struct weft_bend_evidence {
    double information[3][3], gradient[3];
} weft_bend_evidence;

double weft_bend_unit_mm(const weft_sight *sight);

/* Weighs the bend of `sight` in a photograph whose refinement has run; makes one more step of the refinement. The
 * evidence is zero where the photograph says nothing. Errors: WEFT_SYSTEM. Uses OpenMP. */
weft_code weft_refinement_weigh_bend(const weft_sight *sight, const float *photograph, weft_refinement *refinement,
                                     weft_bend_evidence *evidence, weft_error *error);

#endif
