/* Corners that something crosses: a pin, its shadow or the edge of another one. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_STRAYS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_STRAYS_H

#include "registration/lamp/photograph.h"

/* Takes out of the photograph the corners that lie more than `reach_px` from where the others put them: one plane, seen
 * through the lens. Where more than a quarter are off, nothing is taken out: then the photograph is wrong, not a
 * few markers. *dropped receives how many were taken out. Errors: WEFT_SYSTEM. */
weft_code weft_strays_drop(const weft_camera *camera, double reach_px, weft_photographs_photograph *photograph,
                           int *dropped, weft_error *error);

#endif
