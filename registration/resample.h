/* From raw pixels to texels in one step: every texel is a weighted sum of raw pixels, with weights that hold the
 * projective warp, the lens distortion, the average over the texel's square, the pixel's own square taken out again,
 * and the vignetting. Made once for a pose, applied to all photographs that share it. */
#ifndef WEFT_REGISTRATION_RESAMPLE_H
#define WEFT_REGISTRATION_RESAMPLE_H

#include "btf/camera.h"
#include "btf/status.h"

#include <stdint.h>

/* Texel (0, 0) is the top left one of the opening (x = -opening/2, y = +opening/2); [height][width]. */
typedef struct weft_resampler {
    int width, height;
    long *first;    /* [height x width + 1] of its taps; a texel without taps is not seen whole */
    int32_t *pixel; /* [taps] index of the pixel in the photograph */
    float *weight;  /* [taps] */
    float *sum;     /* [height x width] of the weights, to take the black level away */
} weft_resampler;

/* Weights for the photographs of `camera` under `homography` (plate mm to undistorted pixels). Every texel is averaged
 * over points at most a pixel apart, at least 3 x 3; the photograph is interpolated between pixels by the cubic of
 * Catmull & Rom (1974), which reproduces polynomials of second degree, after the smear of the pixel's square (variance
 * 1/12 an axis) is undone to second order: f = p - laplacian(p) / 24. `extra_variance` (pixels^2 an axis) is undone
 * likewise. `inverse_vignetting` [height][width] of the photograph; NULL: none. The caller frees with
 * weft_resampler_free. Errors: WEFT_BAD_INPUT for a size that is not positive; WEFT_SYSTEM. */
weft_code weft_resampler_create(const weft_camera *camera, const float *inverse_vignetting,
                                const weft_homography *homography, double opening_mm, int width, int height,
                                double extra_variance, weft_resampler *resampler, weft_error *error);
void weft_resampler_free(weft_resampler *resampler);

/* Resamples one photograph ([height][width][3] raw values) into texel [height][width][3] = weighted sum of (raw -
 * black), and mask [height][width] of WEFT_MASK_ bits: MISSING where the texel is not seen, SATURATED where a raw value
 * that contributes has reached `full_scale`. Thread-safe. */
void weft_resampler_apply(const weft_resampler *resampler, const uint16_t *samples, int black_level, int full_scale,
                          float *texel, uint8_t *mask);

#endif
