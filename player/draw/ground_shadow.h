/* What a mesh hides of a distant light from the level ground that it stands on: a picture of the ground, summed over
 * directions of the light. It does not depend on the camera, so that it is kept from frame to frame. */
#ifndef WEFT_PLAYER_DRAW_GROUND_SHADOW_H
#define WEFT_PLAYER_DRAW_GROUND_SHADOW_H

#include "base/vector.h"
#include "player/gl/gl.h"

/* Directions that make a whole sum, at full detail. */
enum { WEFT_GROUND_DIRECTIONS = 256 };

/* Zeroed, it has no directions. */
typedef struct weft_ground_shadow {
    GLuint buffer, depth, hidden; /* hidden: how many directions the mesh hides */
    int side;                     /* of the picture, texels */
    int count, whole;             /* directions summed, and in a whole sum */
    double light[3];              /* what light it is of, in the user's own terms */
    weft_vec3 middle;             /* of the ground that the sum covers, a square */
    double half_side;
} weft_ground_shadow;

void weft_ground_shadow_free(weft_ground_shadow *shadow);

/* Begins a sum without any direction over the square of 2 x half_side about `middle`. detail: share of all texels
 * along a side, and of all directions (weft_player_shadow_detail). Errors: WEFT_SYSTEM. */
weft_code weft_ground_shadow_clear(weft_ground_shadow *shadow, weft_vec3 middle, double half_side, double detail,
                                   weft_error *error);

/* The number of directions at this detail. Pure. */
int weft_ground_shadow_directions(double detail);

/* Between the two, what is drawn by `program`, which is in use then and has its clip_of_world, casts its shadow along
 * one more direction: unit, toward the light, above the horizon. Triangles over each other count once. The framebuffer,
 * viewport and blending in use before are the caller's to restore. */
void weft_ground_shadow_begin(weft_ground_shadow *shadow, weft_vec3 light, GLuint program);
void weft_ground_shadow_end(weft_ground_shadow *shadow);

#endif
