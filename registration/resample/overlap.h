/* How much of a quadrangle lies in a pixel. */
#ifndef WEFT_REGISTRATION_RESAMPLE_OVERLAP_H
#define WEFT_REGISTRATION_RESAMPLE_OVERLAP_H

#include "btf/session/camera.h"

/* Area of the intersection of a convex quadrangle with the unit square centred at the pixel (x, y), by clipping one
 * side after the other (Sutherland & Hodgman 1974). Pure. */
double weft_overlap_area(const weft_pixel corner[4], int x, int y);

#endif
