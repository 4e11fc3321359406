/* What stands on the sheet or over it: balls, a pin, fingers. All are capsules: what lies within a radius of a line
 * between two points. Pure functions. Lengths in mm. */
#ifndef WEFT_CAPTURE_SYNTHETIC_SOLID_H
#define WEFT_CAPTURE_SYNTHETIC_SOLID_H

#include "base/vector.h"

#include <stdbool.h>

typedef struct weft_synthetic_solid {
    weft_vec3 a, b; /* equal: a ball */
    double radius_mm;
    bool is_mirror;
    weft_rgb reflectance; /* of a mirror, else diffuse */
} weft_synthetic_solid;

/* The distance along a ray to where it enters a solid, and the unit normal there; negative where it does not. */
double weft_synthetic_solid_meet(const weft_synthetic_solid *solid, weft_vec3 from, weft_vec3 along, weft_vec3 *normal);

/* The distance between the lines from p to q and from the solid's a to its b (Ericson 2005, section 5.1.9). */
double weft_synthetic_solid_distance(const weft_synthetic_solid *solid, weft_vec3 p, weft_vec3 q);

/* Whether it hides p from q. */
static inline bool weft_synthetic_solid_hides(const weft_synthetic_solid *solid, weft_vec3 p, weft_vec3 q)
{
    return weft_synthetic_solid_distance(solid, p, q) < solid->radius_mm;
}

#endif
