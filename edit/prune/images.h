/* What all texels share of components, without what a reach does not read of it. Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_IMAGES_H
#define WEFT_EDIT_PRUNE_IMAGES_H

#include "edit/prune/reach.h"

/* Marks the images whose view is within an angle of that of a pair of the reach, and whose light, or half vector,
 * whatever the maps are of, of that of the same pair: kept [image_count]. Errors: WEFT_SYSTEM. */
weft_code weft_prune_find_images(const weft_reach *reach, const weft_components *components, double margin_rad,
                                 bool *kept, int *kept_count, weft_error *error);

/* Gives every image that is not kept the values of the kept one that is nearest: of its own view, else of the nearest
 * view. Copies take next to no room in the file. */
void weft_prune_fill_images(const bool *kept, weft_components *components);

/* A copy with the first `count` components alone, a multiple of 4. The caller frees it. Errors: WEFT_SYSTEM. */
weft_code weft_prune_copy_components(const weft_components *from, int count, weft_components **copy, weft_error *error);

#endif
