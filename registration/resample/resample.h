/* From raw pixels to texels in one step: every texel is a weighted sum of raw pixels, with weights that hold the
 * projective warp, the lens distortion, the average over the texel's square and the vignetting. Made once for a pose,
 * applied to all photographs that share it. */
#ifndef WEFT_REGISTRATION_RESAMPLE_RESAMPLE_H
#define WEFT_REGISTRATION_RESAMPLE_RESAMPLE_H

#include "base/status.h"
#include "btf/session/camera.h"
#include "registration/pose/plate_view.h"

#include <stdbool.h>
#include <stdint.h>

/* Texel (0, 0) is the top left one of the opening (x = -opening/2, y = +opening/2); [height][width]. */
typedef struct weft_resampler {
    int width, height;
    long *first;    /* [height x width + 1] of its taps; a texel without taps is not seen */
    int32_t *pixel; /* [taps] index of the pixel in the photograph */
    float *weight;  /* [taps] */
    float *sum;     /* [height x width] of the weights, to take the black level away */
} weft_resampler;

/* What a photograph is resampled under. */
typedef struct weft_resampling {
    const weft_camera *camera;
    const float *inverse_vignetting; /* [camera height][width]; 0: a pixel that counts for nothing; NULL: none */
    weft_homography homography;      /* plate mm to undistorted pixels */
    weft_bend bend;                  /* of the plate */
    double opening_mm;
    double point_spread_px; /* reach of the point spread of the lens beyond a pixel's own square */
    bool fill;              /* texels that are not seen take the nearest place that is */
} weft_resampling;

/* Weights by area, as in conservative remapping (Jones 1999): a pixel counts as much of a texel as its square covers of
 * the texel's quadrangle in the photograph, computed exactly. A pixel is itself an average over its square, so nothing
 * is interpolated, no weight is negative and none rings at a glint. Beside the frame only pixels count whose square,
 * and the point spread around it, lies in the opening, so that the bright print does not leak in. A texel of which less
 * than a quarter is seen so has no taps, or, where texels are filled, those of its square moved inward until all of it
 * is seen. The caller frees with weft_resampler_free. Errors: WEFT_BAD_INPUT for a size that is not positive;
 * WEFT_SYSTEM.
 */
weft_code weft_resampler_create(const weft_resampling *resampling, int width, int height, weft_resampler *resampler,
                                weft_error *error);
void weft_resampler_free(weft_resampler *resampler);

/* Resamples one photograph ([height][width][3] raw values) into texel [height][width][3] = weighted sum of (raw -
 * black), and mask [height][width] of WEFT_MASK_ bits: MISSING where the texel is not seen, SATURATED where a raw value
 * that contributes has reached `full_scale`. Thread-safe. */
void weft_resampler_apply(const weft_resampler *resampler, const uint16_t *samples, int black_level, int full_scale,
                          float *texel, uint8_t *mask);

/* The same of a merged bracket (registration/radiometry/bracket.h): `value` [height][width][3] above black, INFINITY
 * where all its photographs clipped, and `variance` of each. MISSING and SATURATED as above, DARK where the standard
 * error of a texel, in its mean over the channels, is not below its value. Thread-safe. */
void weft_resampler_apply_merged(const weft_resampler *resampler, const float *value, const float *variance,
                                 float *texel, uint8_t *mask);

/* ---- How much of a quadrangle lies in a pixel ---- */

/* Area of the intersection of a convex quadrangle with the unit square centred at the pixel (x, y), by clipping one
 * side after the other (Sutherland & Hodgman 1974). Pure. */
double weft_overlap_area(const weft_pixel corner[4], int x, int y);

#endif
