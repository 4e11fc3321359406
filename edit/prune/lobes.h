/* A material without the lobes that are never seen. Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_LOBES_H
#define WEFT_EDIT_PRUNE_LOBES_H

#include "edit/prune/reach.h"

/* Takes every lobe of a texel away whose value, BRDF times pi, is at most `least` in all three channels for all
 * directions of the reach; and the last lobes of all texels where no texel has them any more. *count receives how many
 * lobes of texels are gone. */
void weft_prune_lobes(const weft_reach *reach, double least, weft_material *material, long *count);

/* The largest value that a lobe takes for a light and a view of the reach, from the ranges of the products of their
 * coordinates: coefficient holds Cx, Cy, Cz, N. Pure. */
double weft_lobe_bound(const weft_reach *reach, const weft_frame *frame, const double coefficient[4]);

#endif
