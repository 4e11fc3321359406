/* Several virtual cameras: evenly spaced on a ring about the zenith, which carries all of them. It tilts and turns as a
 * whole, by less than the space between two: so each camera takes the views of one sector of phi. All functions are
 * pure; with one camera there is no ring. */
#ifndef WEFT_CAPTURE_VIRTUAL_RING_H
#define WEFT_CAPTURE_VIRTUAL_RING_H

#include "capture/virtual/world.h"

/* Which camera takes a view. */
int weft_virtual_ring_camera(const weft_virtual_world *world, weft_angles view);

/* From where camera `other` sees while that of `world` stands at `view`. */
weft_angles weft_virtual_ring_view(const weft_virtual_world *world, weft_angles view, int other);

/* Whether one of the other cameras stands between the light (plate frame) and the sample, while that of `world` stands
 * at `view`. At the zenith there is room for one only. */
bool weft_virtual_ring_shadows(const weft_virtual_world *world, weft_angles view, weft_vec3 light);

#endif
