/* Coefficients as they are stored: whole numbers, mip levels, ceilings and floors. */
#ifndef WEFT_COMPRESS_COMPONENTS_LEVELS_H
#define WEFT_COMPRESS_COMPONENTS_LEVELS_H

#include "btf/material/components.h"
#include "compress/components/projection.h"

/* Fills the levels of `components` and takes the size of a step into components->scale. A texel of a level has the mean
 * coefficients of the texels of level 0 that it covers: where nothing is masked these are exactly the coefficients of
 * the mean samples. The ceiling of a square is WEFT_BRIGHTEST_MULTIPLE times the largest sample under it. The
 * floor of a square is the least of the floors of its texels, each the mean of those that it covers. Where `components`
 * are twice those of the projection, the second half, of the same values and scales as the first, takes what rounding
 * left of the coefficients, in steps 254 times as fine. `projection` is used up. */
void weft_components_fill_levels(weft_projection *projection, weft_components *components);

#endif
