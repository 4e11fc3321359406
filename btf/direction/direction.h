/* Directions on the hemisphere and the samplings made of them. */
#ifndef WEFT_BTF_DIRECTION_DIRECTION_H
#define WEFT_BTF_DIRECTION_DIRECTION_H

#include "base/vector.h"

/* theta from the normal (z), phi from x toward y. */
typedef struct weft_angles {
    weft_real theta_rad, phi_rad;
} weft_angles;

enum { WEFT_UBO81_COUNT = 81, WEFT_UBO151_COUNT = 151 };

/* (sin theta cos phi, sin theta sin phi, cos theta), unit. Pure. */
weft_vec3 weft_direction_of_angles(weft_angles angles);

/* Inverse of weft_direction_of_angles; phi in [0, 2 pi), 0 for the pole. Pure. */
weft_angles weft_angles_of_direction(weft_vec3 direction);

/* The hemisphere sampling of the Bonn and UTIA sets: 1, 6, 12, 18, 20, 24 directions at theta
 * 0, 15, 30, 45, 60, 75 degrees, each ring equally spaced from phi = 0.
 * index in [0, WEFT_UBO81_COUNT). Pure. */
weft_angles weft_ubo81_angles(int index);

/* That of the first dome of Bonn (UBO2014): 1, 6, 12, 12, 12, 18, 18, 24, 24, 24 directions at theta 0, 11, 23.5, 30,
 * 37.5, 45, 52.5, 60, 67.5, 75 degrees, from phi = 0, 15, 0, 15, 0, 0, 7.5, 0, 7.5, 0. index in [0,
 * WEFT_UBO151_COUNT). Pure. */
weft_angles weft_ubo151_angles(int index);

/* Rings of ubo81: theta 0, 15, 30, 45, 60, 75 degrees. */
enum { WEFT_RING_COUNT = 6 };

/* Index in [0, WEFT_RING_COUNT) of the ring of ubo81 nearest to an elevation. Pure. */
int weft_ubo81_ring(weft_real theta_rad);

static inline weft_real weft_rad_of_deg(weft_real deg)
{
    return deg * (WEFT_PI / 180);
}

static inline weft_real weft_deg_of_rad(weft_real rad)
{
    return rad * (180 / WEFT_PI);
}

#endif
