/* Components evaluated (btf/material/components.h has the equation): the values at images become square maps, and a
 * pair of directions reads sixteen of their nodes. GLSL twin: reflectance/components/components.glsl. */
#ifndef WEFT_REFLECTANCE_COMPONENTS_COMPONENTS_H
#define WEFT_REFLECTANCE_COMPONENTS_COMPONENTS_H

#include "base/vector.h"
#include "btf/material/components.h"
#include "reflectance/relief/material_relief.h"

/* The half vector of a light and a view above the horizon, unit; the normal where they are opposite. */
static inline weft_vec3 weft_half_vector(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 sum = weft_add(light, view);
    return weft_length(sum) > (weft_real)1e-6 ? weft_unit(sum) : weft_vec3_of(0, 0, 1);
}

/* The maps of all components. `components` stays the caller's and must outlive them. Immutable, so that any number of
 * threads may evaluate. */
typedef struct weft_component_maps {
    const weft_components *components;
    float *node; /* [view node][light node][layer][3] B_k, or B_k g^(1 / exponent), times the scale of the layer */
    float *node_of_view; /* [stored view][light node][layer][3] the same for each stored view by itself; NULL unless
                            weft_component_maps_keep_views */
} weft_component_maps;

/* l_z is taken as at least this where it is the base of a power. */
#define WEFT_LEAST_COSINE 0.015625

/* What a map over the half vector is divided by: g(l, v)^(1 / exponent) (btf/material/components.h); 1 of maps over the
 * light. Pure. */
weft_real weft_components_divisor(const weft_components *components, weft_vec3 light, weft_vec3 half_vector);

/* Computes the maps. The caller frees them with weft_component_maps_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_component_maps_create(const weft_components *components, weft_component_maps *maps, weft_error *error);
void weft_component_maps_free(weft_component_maps *maps);

/* Computes the maps of the stored views by themselves, too. The maps stay the caller's to free, also on failure.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_component_maps_keep_views(weft_component_maps *maps, weft_error *error);

/* B_k of all components, factor [component_count][3], for light and view in the frame of the surface; 0 where one of
 * them is not above the horizon. Thread-safe. */
void weft_component_factors(const weft_component_maps *maps, weft_vec3 light, weft_vec3 view, float *factor);

/* The same for stored view number `view`, from its own map: not smoothed over the views around it. The maps have those
 * of the views. Thread-safe. */
void weft_component_factors_of_view(const weft_component_maps *maps, weft_vec3 light, int view, float *factor);

/* Reflectance times cosine of texel (x, y) of a level as the first `count` components give it (a multiple of 4; at most
 * component_count), from the factors of the light and the view, which is above the horizon: decoded, at least the floor
 * of each channel times l_z, and at most the upper bound times min(1, l_z / least_cosine): the channels of kriged maps
 * are scaled down alike, others by themselves. Thread-safe. */
weft_rgb weft_components_texel(const weft_components *components, int count, const float *factor, int level, int x,
                               int y, weft_real light_z);

/* The same at texture coordinates (u, v), repeated (docs/reference/weft-format.md, 3.5): coefficients are interpolated
 * between texels and levels, bilinear and trilinear, and then evaluated; level >= 0 may be fractional. The floor and
 * the ceiling are those of the nearest texel of the finer level. */
weft_rgb weft_components_sample(const weft_components *components, int count, const float *factor, weft_real level,
                                weft_real u, weft_real v, weft_real light_z);

/* The same of `maps` for light and view, through the heights of the material on the levels where they count: the
 * components are evaluated as each of the three stored views around `view` has them, where it saw the surface point,
 * and blended by visibility. `relief` may be empty; else `maps` have those of the views. Thread-safe. */
weft_rgb weft_components_sample_through(const weft_component_maps *maps, const weft_material_relief *relief, int count,
                                        weft_real level, weft_real u, weft_real v, weft_vec3 light, weft_vec3 view);

#endif
