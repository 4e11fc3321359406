/* A material made of the texels of another. */
#ifndef WEFT_BTF_MATERIAL_GATHER_H
#define WEFT_BTF_MATERIAL_GATHER_H

#include "btf/material/material.h"

enum { WEFT_MIX_TEXELS = 4 };

/* A texel of the new material: a mean of texels of level 0 of the other, the heaviest first. */
typedef struct weft_texel_mix {
    struct {
        int x, y;
        float weight; /* >= 0; all sum to 1 */
    } part[WEFT_MIX_TEXELS];
} weft_texel_mix;

/* Makes a material of width x height texels: texel (x, y) of level 0 is mix [height][width] of `from`.
 *
 * - Components are linear: they are mixed by the weights, and mip levels are the means of what they cover. A ceiling is
 * the largest of those mixed under it, a floor the smallest.
 * - Heights move with their texels, and are mixed as components are.
 * - All else is no linear code: a texel is the heaviest part alone. One of level k is moved as far as the texel of
 * level 0 at its centre is, to a whole texel, so that a level that was fitted stays fitted.
 *
 * Errors of levels and metadata are those of `from`. Without mip levels there, there are none here. Errors:
 * WEFT_BAD_USAGE for a size out of range or a material that cannot be written, WEFT_SYSTEM. The caller frees with
 * weft_material_free. */
weft_code weft_material_gather(const weft_material *from, int width, int height, const weft_texel_mix *mix,
                               weft_material *result, weft_error *error);

#endif
