/* What all texels share of linear layers, without what a reach does not read of it. Private to study/prune. */
#ifndef WEFT_STUDY_PRUNE_IMAGES_H
#define WEFT_STUDY_PRUNE_IMAGES_H

#include "study/prune/reach.h"

/* Marks the images whose view is within an angle of that of a pair of the reach, and whose light, or half vector,
 * whatever the maps are of, of that of the same pair: kept [image_count]. Errors: WEFT_SYSTEM. */
weft_code weft_prune_find_images(const weft_reach *reach, const weft_layers *layers, double margin_rad, bool *kept,
                                 int *kept_count, weft_error *error);

/* Gives every image that is not kept the values of the kept one that is nearest: of its own view, else of the nearest
 * view. Copies take next to no room in the file. */
void weft_prune_fill_images(const bool *kept, weft_layers *layers);

/* A copy with the first `count` layers alone, a multiple of 4. The caller frees it. Errors: WEFT_SYSTEM. */
weft_code weft_prune_copy_layers(const weft_layers *from, int count, weft_layers **copy, weft_error *error);

#endif
