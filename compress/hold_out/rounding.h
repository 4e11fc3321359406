/* What it costs that the numbers of a material are rounded to be stored. */
#ifndef WEFT_COMPRESS_HOLD_OUT_ROUNDING_H
#define WEFT_COMPRESS_HOLD_OUT_ROUNDING_H

#include "btf/material/material.h"

/* Moves every stored number of level 0 by one step, up or down at random: half floats, codes of tables, frames,
 * coefficients of components, whose steps are what their codes lie apart where they were rounded, and their values at
 * the images. A number that was rounded is off by up to half a step, evenly: a standard error of 1 / sqrt(12) steps. So
 * what this does to a prediction is sqrt(12) times what rounding did, as far as a prediction is linear in so small a
 * change. (`weft compress` rounds the sharpest lobes first and fits the rest again, which makes up for some of it: the
 * figure is an upper one.) 0 stays 0, and no sign changes. Deterministic. */
void weft_material_move_by_steps(weft_material *material);

#endif
