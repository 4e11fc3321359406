/* Photographs of one view under one light that differ in exposure alone. The darker one tells the tone curve, and what
 * the brighter one has clipped. It is no image of its own: what is held out of a dataset must not be in it twice. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_EXPOSURE_PAIRS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_EXPOSURE_PAIRS_H

#include "btf/dataset/dataset.h"
#include "registration/photographs/photographs.h"

/* Leaves out the darker one of every pair of which both are used, with a remark. */
void weft_photographs_leave_out_darker(weft_photograph_set *set);

/* The next darker photograph of what `photograph` shows; -1: none. */
int weft_photographs_darker_of_pair(const weft_photograph_set *set, int photograph);

/* Takes the texels [count][3] that are masked as saturated alone from a darker photograph, where that knows them.
 * Returns how many. Pure. */
long weft_photographs_fill_saturated(const weft_half *darker, const uint8_t *darker_mask, size_t count,
                                     weft_half *texel, uint8_t *mask);

#endif
