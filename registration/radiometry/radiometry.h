/* From raw values to reflectance: how much light fell on the sample, measured on the white reference patches round it.
 */
#ifndef WEFT_REGISTRATION_RADIOMETRY_RADIOMETRY_H
#define WEFT_REGISTRATION_RADIOMETRY_RADIOMETRY_H

#include "btf/session/session.h"
#include "registration/pose/prediction.h"

/* The pixels of the reference patches under one pose, away from their borders by the point spread of the lens. */
typedef struct weft_reference_pixels {
    int count[WEFT_TARGET_REFERENCE_COUNT];
    int32_t *pixel[WEFT_TARGET_REFERENCE_COUNT];    /* [count] indices into the photograph */
    weft_pixel centre[WEFT_TARGET_REFERENCE_COUNT]; /* mean place on the plate, mm */
} weft_reference_pixels;

/* The white level of a photograph: the raw value above black, per second of exposure and without vignetting, of a
 * perfect white diffuser at the origin lit along its normal by the same light. */
typedef struct weft_white {
    double level[3];
    int patches;         /* reference patches it was measured on; 0: not measured */
    double disagreement; /* largest relative difference of a used patch from their mean */
} weft_white;

/* Irradiance at a point of the plate (mm) from a point light of unit power at `light` (mm), relative to that at the
 * origin lit along the normal from the same distance: cos(theta) (|light| / r)^2, r the distance from the light to the
 * point and theta the angle to the normal of the plate there. Pure. */
double weft_relative_irradiance(weft_vec3 light, const weft_bend *bend, double x_mm, double y_mm);

/* The caller frees with weft_reference_pixels_free. Errors: WEFT_SYSTEM. */
weft_code weft_reference_pixels_find(const weft_sight *sight, const weft_target *target,
                                     const weft_homography *homography, weft_point_spread point_spread,
                                     weft_reference_pixels *reference, weft_error *error);
void weft_reference_pixels_free(weft_reference_pixels *reference);

/* How a photograph was taken. */
typedef struct weft_exposure {
    int black_level, full_scale;
    double exposure_s;
    weft_vec3 light; /* place of the light as driven, mm */
} weft_exposure;

/* Pure. */
weft_exposure weft_exposure_of(const weft_session *session, int shot);

/* What a patch tells of the light: the white level as below, from it alone. */
typedef struct weft_patch_level {
    double level[3];
    int patch, pixels;
} weft_patch_level;

/* Fills `level` with the patches that are seen, not saturated and not dark, and returns how many there are. Pure. */
int weft_patch_levels(const weft_sight *sight, const weft_target *target, const weft_reference_pixels *reference,
                      const uint16_t *samples, const weft_exposure *exposure,
                      weft_patch_level level[WEFT_TARGET_REFERENCE_COUNT]);

/* Measures the white level in `samples` [height][width][3]. Patches that are unseen or saturated are left out, and so
 * is one that differs from the median of three or more by over a tenth (a shadow or a stain on it). Pure. */
weft_white weft_white_measure(const weft_sight *sight, const weft_target *target,
                              const weft_reference_pixels *reference, const uint16_t *samples,
                              const weft_exposure *exposure);

/* Turns resampled raw values above black, texel [height][width][3], into reflectance times cosine in place:
 * pi BRDF cos(theta_light) with theta_light that of the far direction of the light, the same for all texels; the
 * nearness of the light and the bend of the plate are taken out. Pure. */
void weft_reflectance_of_raw(const weft_white *white, const weft_exposure *exposure, const weft_bend *bend,
                             double opening_mm, int width, int height, float *texel);

/* Vignetting that the calibration of the camera does not know, from the white patches. In a steep view they lie at
 * different distances from the axis of the camera, at the same distance from the middle of the plate: so a lamp that is
 * brighter in its middle does not pass for vignetting. */

/* Response beside the declared one: exp(r2 q + r4 q^2), q = min(r^2, reach), r as in weft_camera.vignetting. */
typedef struct weft_vignetting {
    double r2, r4;
    double reach;          /* r^2 of the outermost patch seen: nothing is known beyond */
    double standard_error; /* of the logarithm of the response at the reach against the axis */
    int photographs;       /* it was found in */
} weft_vignetting;

/* Sums over photographs; starts at zero. Logarithms of the levels of patches, without their mean in a photograph, by
 * q and q^2. */
typedef struct weft_vignetting_sums {
    double matrix[2][2], right[2], squares, reach;
    int patches, photographs;
} weft_vignetting_sums;

/* Adds a photograph; one in which a patch lies in shadow is left out. Pure but for the sums. */
void weft_vignetting_add(const weft_sight *sight, const weft_target *target, const weft_reference_pixels *reference,
                         const uint16_t *samples, const weft_exposure *exposure, weft_vignetting_sums *sums);

/* The vignetting that fits best, under the prior that it is moderate. None where nothing was added. Pure. */
weft_vignetting weft_vignetting_solve(const weft_vignetting_sums *sums);

/* Takes it out of the photographs to come. */
void weft_vignetting_apply(const weft_vignetting *vignetting, weft_sight *sight);

#endif
