/* The lamp in the hand: a bright ball or a bright disc, so that its shadows are soft and its mirror image has a size.
 * Pure functions. Lengths in mm. */
#ifndef WEFT_CAPTURE_SYNTHETIC_LAMP_H
#define WEFT_CAPTURE_SYNTHETIC_LAMP_H

#include "base/vector.h"

#include <stdbool.h>

typedef struct weft_synthetic_lamp {
    weft_vec3 at;
    weft_vec3 axis; /* unit; where a disc faces. It shines as paper does, with the cosine to its axis */
    bool is_disc;   /* else a ball, which shines alike all round */
    double radius_mm;
    double intensity_cd; /* along the axis */
    weft_rgb colour;     /* 1, 1, 1: white */
} weft_synthetic_lamp;

/* Illuminance in lux of a level plane at a point, as if nothing stood between. The lamp is small against its distance.
 */
double weft_synthetic_lamp_illuminance(const weft_synthetic_lamp *lamp, weft_vec3 point);

/* The candelas that it sends toward a point. */
double weft_synthetic_lamp_toward(const weft_synthetic_lamp *lamp, weft_vec3 point);

/* A place on the face that a point sees, `disc` in the unit disc. */
weft_vec3 weft_synthetic_lamp_place(const weft_synthetic_lamp *lamp, weft_vec3 point, const double disc[2]);

/* The distance along a ray to the lamp; negative where it does not lie on the ray. Its luminance is that of
 * weft_synthetic_lamp_luminance, cd/m^2. */
double weft_synthetic_lamp_meet(const weft_synthetic_lamp *lamp, weft_vec3 from, weft_vec3 along);
double weft_synthetic_lamp_luminance(const weft_synthetic_lamp *lamp);

#endif
