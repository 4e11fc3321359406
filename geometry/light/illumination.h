/* Light in a stitch: what endless cloth sends toward a view under distant lights, directly and after bounces between
 * its yarns.
 *
 * A path starts where a view ray first meets the cloth and goes on by directions drawn with the cosine of the normal
 * (Kajiya 1986); at each of its vertices every light is looked for, so that one path serves all lights. The normal of
 * the triangles is used throughout: with that and a symmetric reflectance, light is neither made nor lost, and
 * exchanging light and view changes nothing. After the first vertex, a place sees the lights that the middle of its
 * triangle sees, which is found once (visibility computed beforehand, as by Heidrich et al. 2000 and Daubert et al.
 * 2001, section 4), unless `exact` asks for a shadow ray each. */
#ifndef WEFT_GEOMETRY_LIGHT_ILLUMINATION_H
#define WEFT_GEOMETRY_LIGHT_ILLUMINATION_H

#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>

enum { WEFT_ILLUMINATION_MAX_LIGHTS = 4096, WEFT_ILLUMINATION_MAX_BOUNCES = 256 };

typedef struct weft_illumination_options {
    int bounces;        /* 0: direct light only */
    bool exact;         /* shadow rays at every vertex of a path */
    bool uniform_light; /* one more light after the others: radiance 1 from everywhere, met by paths that leave the
                           cloth */
} weft_illumination_options;

typedef struct weft_illumination weft_illumination;

/* Prepares the light of `light` [light_count], unit directions toward the lights, on a mesh of the stitch. Copies the
 * lights and keeps references to stitch and mesh, which must stay. The caller frees with weft_illumination_free.
 * Errors: WEFT_BAD_USAGE for counts out of range, WEFT_SYSTEM. */
weft_code weft_illumination_create(const weft_stitch *stitch, const weft_tile_mesh *mesh, const weft_vec3 *light,
                                   int light_count, const weft_illumination_options *options,
                                   weft_illumination **result, weft_error *error);
void weft_illumination_free(weft_illumination *illumination);

/* What a view ray sees first. */
typedef struct weft_first_hit {
    weft_vec3 at, normal, tangent; /* in the tile; interpolated normal; direction of the fibres */
    int yarn;
} weft_first_hit;

/* Follows path `index` of the sequence `key` from the view ray that passes through `place` and ends at the cloth; the
 * camera lies toward `view`. Adds radiance toward the view, for lights whose irradiance across their direction is pi,
 * to radiance [light_count][3]: BRDF x pi x cosine. False where the ray meets no cloth. `first` may be NULL.
 * Thread-safe; the same arguments give the same numbers. */
bool weft_illumination_path(const weft_illumination *illumination, weft_vec3 place, weft_vec3 view, uint64_t key,
                            uint32_t index, float (*radiance)[3], weft_first_hit *first);

#endif
