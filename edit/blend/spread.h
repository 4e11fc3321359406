/* What the ends of a material differ by, spread over the tile that is made of them. Private to the room. */
#ifndef WEFT_EDIT_BLEND_SPREAD_H
#define WEFT_EDIT_BLEND_SPREAD_H

#include "btf/material/gather.h"

/* `tile` is what weft_material_gather made of `from` by `mix`. Adds to a code a field by which the step across the seam
 * becomes what the material has beside it: the mean of the steps of both ends. The field is as smooth as it can be and
 * 0 in the mean, so that edges inside change little. Mip levels get its mean over what they cover.
 *
 * - To each layer, which is linear: that does it under all lights and views at once. Ceilings and floors are widened by
 *   as much as the mean reflectance changes.
 * - To the logarithm of how bright lobes and diffuse term are, by which these are then multiplied.
 *
 * Frames, tables and heights stay. Errors: WEFT_BAD_INPUT for tables that cannot be triangulated, WEFT_SYSTEM. */
weft_code weft_blend_spread(const weft_material *from, const weft_texel_mix *mix, weft_material *tile,
                            weft_error *error);

#endif
