/* An environment map as distant lights.
 *
 * The sphere is cut into 48 regions, each time the one whose light spreads most: the largest power times variance of
 * direction (Viriyothai and Debevec, Variance Minimization Light Probe Sampling, 2009), at the median of its longer
 * side (Debevec, A Median Cut Algorithm for Light Probe Sampling, 2005). Interactive frames are lit from
 * the centroid of each region. Each region is cut further into 128 strata of equal power. A converging frame takes one
 * stratum of every region (player/draw/lighting.h), so the mean of 128 frames is lit by all 6144. Pure: no OpenGL. */
#ifndef WEFT_PLAYER_SCENE_ENVIRONMENT_H
#define WEFT_PLAYER_SCENE_ENVIRONMENT_H

#include "base/picture/image.h"
#include "base/vector.h"

enum { WEFT_ENVIRONMENT_REGIONS = 48, WEFT_ENVIRONMENT_SMOOTH_REGIONS = 6, WEFT_ENVIRONMENT_STRATA = 128 };

typedef struct weft_distant_light {
    weft_vec3 direction; /* of the world, unit, toward the light */
    float irradiance[3]; /* on a surface that faces it, over pi */
} weft_distant_light;

typedef struct weft_environment {
    int region_count;
    weft_distant_light region[WEFT_ENVIRONMENT_REGIONS];
    /* [stratum][region]; successive strata lie far apart within their region. Each has the irradiance of the whole
     * region, which it represents in its frame. */
    weft_distant_light stratum[WEFT_ENVIRONMENT_STRATA][WEFT_ENVIRONMENT_REGIONS];
} weft_environment;

/* The frame that takes this stratum of each region. Successive strata lie beside each other, successive frames take
 * strata far apart. */
int weft_environment_frame_of_stratum(int stratum);

/* `image` holds radiance on the sphere by longitude and latitude: the top row is the world's +z, the middle column +y,
 * and x = +1 lies a quarter to the right of it. Negative and non-finite values count as 0, those above 1e30 as that.
 * region_count: WEFT_ENVIRONMENT_REGIONS, or fewer for a map without small bright lights.
 * Errors: WEFT_BAD_INPUT for a map that is black or not twice as wide as high; WEFT_SYSTEM. */
weft_code weft_environment_of_image(const weft_image *image, int region_count, weft_environment *environment,
                                    weft_error *error);

#endif
