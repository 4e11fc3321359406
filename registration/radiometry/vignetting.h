/* Vignetting that the calibration of the camera does not know, from the white patches. In a steep view they lie at
 * different distances from the axis of the camera, at the same distance from the middle of the plate: so a lamp that is
 * brighter in its middle does not pass for vignetting. */
#ifndef WEFT_REGISTRATION_RADIOMETRY_VIGNETTING_H
#define WEFT_REGISTRATION_RADIOMETRY_VIGNETTING_H

#include "registration/radiometry/radiometry.h"

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
