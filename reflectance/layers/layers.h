/* Linear layers evaluated (btf/material/layers.h has the equation): the values at images become square maps, and a pair
 * of directions reads sixteen of their nodes. GLSL twin: reflectance/layers/layers.glsl. */
#ifndef WEFT_REFLECTANCE_LAYERS_LAYERS_H
#define WEFT_REFLECTANCE_LAYERS_LAYERS_H

#include "btf/material/layers.h"
#include "reflectance/relief/material_relief.h"

/* The maps of all layers. `layers` stays the caller's and must outlive them. Immutable, so that any number of threads
 * may evaluate. */
typedef struct weft_layer_maps {
    const weft_layers *layers;
    float *node; /* [view node][light node][layer][3] B_k, or B_k (l . h)^1 or 2, times the scale of the layer */
    float *node_of_view; /* [stored view][light node][layer][3] the same for each stored view by itself; NULL unless
                            weft_layer_maps_keep_views */
} weft_layer_maps;

/* l . h is taken as at least this where a map is divided by it: below, light and view both graze from opposite sides.
 */
#define WEFT_LEAST_INCIDENCE 0.0625

/* What a map is divided by where its kind is that of half vectors: (l . h) or (l . h)^2; 1 of the others. Pure. */
weft_real weft_layers_divisor(weft_layers_kind kind, weft_vec3 light, weft_vec3 half_vector);

/* Computes the maps. The caller frees them with weft_layer_maps_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_layer_maps_create(const weft_layers *layers, weft_layer_maps *maps, weft_error *error);
void weft_layer_maps_free(weft_layer_maps *maps);

/* Computes the maps of the stored views by themselves, too. The maps stay the caller's to free, also on failure.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_layer_maps_keep_views(weft_layer_maps *maps, weft_error *error);

/* B_k of all layers, factor [layer_count][3], for light and view in the frame of the surface; 0 where one of them is
 * not above the horizon. Thread-safe. */
void weft_layer_factors(const weft_layer_maps *maps, weft_vec3 light, weft_vec3 view, float *factor);

/* The same for stored view number `view`, from its own map: not smoothed over the views around it. The maps have those
 * of the views. Thread-safe. */
void weft_layer_factors_of_view(const weft_layer_maps *maps, weft_vec3 light, int view, float *factor);

/* Reflectance times cosine of texel (x, y) of a level as the first `count` layers give it (a multiple of 4; at most
 * layer_count), from the factors of the light and the view, which is above the horizon: held to the floor .. the
 * ceiling. Thread-safe. */
weft_rgb weft_layers_texel(const weft_layers *layers, int count, const float *factor, int level, int x, int y,
                           weft_real light_z);

/* The same at texture coordinates (u, v), repeated (docs/reference/weft-format.md, 3.5): coefficients are interpolated
 * between texels and levels, bilinear and trilinear, and then evaluated; level >= 0 may be fractional. The floor and
 * the ceiling are those of the nearest texel of the finer level. */
weft_rgb weft_layers_sample(const weft_layers *layers, int count, const float *factor, weft_real level, weft_real u,
                            weft_real v, weft_real light_z);

/* The same of `maps` for light and view, through the heights of the material on the levels where they count: the
 * layers are evaluated as each of the three stored views around `view` has them, where it saw the surface point, and
 * blended by visibility. `relief` may be empty; else `maps` have those of the views. Thread-safe. */
weft_rgb weft_layers_sample_through(const weft_layer_maps *maps, const weft_material_relief *relief, int count,
                                    weft_real level, weft_real u, weft_real v, weft_vec3 light, weft_vec3 view);

#endif
