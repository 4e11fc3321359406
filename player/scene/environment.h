/* An environment map as distant lights.
 *
 * The sphere is cut into 48 regions, each time the one whose light spreads most: the largest power times variance of
 * direction (Viriyothai and Debevec, Variance Minimization Light Probe Sampling, 2009), at the median of its longer
 * side (Debevec, A Median Cut Algorithm for Light Probe Sampling, 2005). A light from the centroid of each is what a
 * moving picture is lit with. Each region is cut on into 128 parts of equal power: at rest, a frame takes one part
 * of every region (player/draw/lighting.h), so that the mean of 128 frames is lit by all 6144. Pure: no OpenGL. */
#ifndef WEFT_PLAYER_SCENE_ENVIRONMENT_H
#define WEFT_PLAYER_SCENE_ENVIRONMENT_H

#include "base/picture/image.h"
#include "base/vector.h"

enum { WEFT_ENVIRONMENT_REGIONS = 48, WEFT_ENVIRONMENT_SMOOTH_REGIONS = 6, WEFT_ENVIRONMENT_PARTS = 128 };

typedef struct weft_distant_light {
    weft_vec3 direction; /* of the world, unit, toward the light */
    float irradiance[3]; /* on a surface that faces it, over pi */
} weft_distant_light;

typedef struct weft_environment {
    int region_count;
    weft_distant_light region[WEFT_ENVIRONMENT_REGIONS];
    /* [part][region]; parts that follow each other lie far apart within their region. Each has the irradiance of a
     * whole region: it stands for all of it in its frame. */
    weft_distant_light part[WEFT_ENVIRONMENT_PARTS][WEFT_ENVIRONMENT_REGIONS];
} weft_environment;

/* The frame that takes a part of each region. Numbers of parts that follow each other lie beside each other, those of
 * frames far apart. */
int weft_environment_frame_of(int part);

/* `image` holds radiance on the sphere by longitude and latitude: the top row is the world's +z, the middle column +y,
 * and x = +1 lies a quarter to the right of it. Negative and non-finite values count as 0, those above 1e30 as that.
 * region_count: WEFT_ENVIRONMENT_REGIONS, or fewer for a map without small bright lights.
 * Errors: WEFT_BAD_INPUT for a map that is black or not twice as wide as high; WEFT_SYSTEM. */
weft_code weft_environment_of_image(const weft_image *image, int region_count, weft_environment *environment,
                                    weft_error *error);

#endif
