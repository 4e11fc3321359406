/* What can be seen of a seam. Private to the room. */
#ifndef WEFT_EDIT_BLEND_SEAM_H
#define WEFT_EDIT_BLEND_SEAM_H

#include "btf/material/gather.h"
#include "edit/blend/blend.h"
#include "edit/blend/pictures.h"

/* Measures the pictures of a tile, repeated, against those of the material that it is made of. `mix` [height][width] of
 * the tile; NULL for the material as it is. Errors: WEFT_SYSTEM. */
weft_code weft_seam_measure(const weft_blend_pictures *material, const weft_blend_pictures *tile,
                            const weft_texel_mix *mix, weft_seam *seam, weft_error *error);

#endif
