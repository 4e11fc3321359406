/* The reflectance of virtual cloth from any direction, photographed or not. */
#ifndef WEFT_COMPARE_ERROR_BUDGET_CLOTH_H
#define WEFT_COMPARE_ERROR_BUDGET_CLOTH_H

#include "capture/virtual/sample.h"

/* A texel of an opening cut into width x height; row 0 at the top. */
typedef struct weft_cloth_texel {
    int width, height, x, y;
} weft_cloth_texel;

/* pi BRDF cos(theta_light) for a far light and a far camera, the mean over the texel as the plane of the plate shows
 * it, from `paths` places drawn evenly, each with a path of light of its own. `key` decides them: other keys give
 * independent answers. Thread-safe. */
weft_rgb weft_cloth_reflectance(const weft_virtual_sample *sample, const weft_cloth_texel *texel, weft_vec3 light,
                                weft_vec3 view, int paths, uint64_t key);

#endif
