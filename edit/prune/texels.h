/* A material without the mip levels and texels that no pixel of a reach reads. Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_TEXELS_H
#define WEFT_EDIT_PRUNE_TEXELS_H

#include "edit/prune/reach.h"

/* Takes the finest levels away that are not reached, as long as the material keeps its proportions, and the coarsest.
 * Every other texel that is not reached becomes a copy of the nearest in its row that is, and rows without any of the
 * nearest row: copies take next to no room in the file. The reach then is that of the new levels; *finer and *coarser
 * are how many are gone. Errors: WEFT_SYSTEM. */
weft_code weft_prune_texels(weft_reach *reach, weft_material *material, int *finer, int *coarser, weft_error *error);

/* Rounds the diffuse terms to 5 bits of mantissa, a 64th of themselves. Of a material with components they are read by
 * players alone that do not know components. */
void weft_prune_round_diffuse(weft_material *material);

/* The maps of what is seen (btf/material/seen.h) of the material as it is now. Errors: WEFT_SYSTEM. */
weft_code weft_prune_note_seen(const weft_reach *reach, int finer, int coarser, weft_material *material,
                               weft_error *error);

#endif
