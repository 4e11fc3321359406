/* The steps of a light path that do not depend on where its rays are traced. Pure functions, private to the room. */
#ifndef WEFT_GEOMETRY_LIGHT_PATH_STEP_H
#define WEFT_GEOMETRY_LIGHT_PATH_STEP_H

#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>

/* Where a ray that leaves the surface at a place starts, so that it does not meet it again. */
weft_vec3 weft_path_ray_start(const weft_tile_mesh *mesh, weft_vec3 at, weft_vec3 normal);

/* A direction whose density is the cosine to the normal over pi, from a point of [0, 1)^2; `tangent` is unit and
 * perpendicular to the normal. */
weft_vec3 weft_path_cosine_direction(weft_vec3 normal, weft_vec3 tangent, const double point[2]);

/* Carries throughput over a reflection into such a direction: times f pi. False where hardly anything is left. */
bool weft_path_reflect(weft_rgb f, weft_rgb *throughput);

#endif
