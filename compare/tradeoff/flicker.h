/* Flicker: how much more the brightness of a place goes up and down than once, while a light sweeps across it. */
#ifndef WEFT_COMPARE_TRADEOFF_FLICKER_H
#define WEFT_COMPARE_TRADEOFF_FLICKER_H

#include "evaluate/model.h"

#include <stddef.h>

/* What a series of `count` values goes up and down in all, and what it would if it rose once to its largest value and
 * then fell. Adds to both. Pure. */
typedef struct weft_flicker {
    double moved, needed;
} weft_flicker;
void weft_flicker_add(const double *value, int count, weft_flicker *flicker);

/* moved / needed - 1: 0 for a highlight that comes and goes once, 1 where the brightness goes up and down twice as far.
 * 0 where nothing moves. Pure. */
double weft_flicker_excess(const weft_flicker *flicker);

/* Of a model of any kind: at 16 places, seen from 30 degrees in four directions, a light passes from 65 degrees on the
 * side of the eye through the normal and the mirror direction to 65 degrees, in steps of 2.5 degrees, finer than
 * directions are photographed. Values are reflectance times cosine, the mean of the channels. A value that is not known
 * is left out. Errors: those of weft_model_brdf. */
weft_code weft_flicker_measure(weft_model *model, double *excess, weft_error *error);

#endif
