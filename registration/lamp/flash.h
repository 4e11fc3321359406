/* A lamp that is fixed to the camera: where it sits, and how its light falls off beside its beam. */
#ifndef WEFT_REGISTRATION_LAMP_FLASH_H
#define WEFT_REGISTRATION_LAMP_FLASH_H

#include "btf/session/camera.h"

/* Coefficients of u, v, u^2, u v, v^2. */
enum { WEFT_BEAM_TERMS = 5 };

/* In the frame of the camera: x right, y down, z forward. */
typedef struct weft_flash {
    double place_mm[3];
    double beam[WEFT_BEAM_TERMS];
} weft_flash;

/* Logarithm of what the flash sends towards the place (x, y) of the plate, over what it sends straight ahead:
 *     beam[0] u + beam[1] v + beam[2] u^2 + beam[3] u v + beam[4] v^2,
 * u and v being the tangents, right and down, of the direction in which the flash sees the place. To second order
 * cos^n has beam[2] = beam[4] = -n / 2. 0 without a beam. Pure. */
double weft_flash_log_beam(const weft_flash *flash, const weft_pose *pose, double x, double y);

#endif
