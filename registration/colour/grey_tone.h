/* The tone curve of a photograph, from the row of greys of a chart. */
#ifndef WEFT_REGISTRATION_COLOUR_GREY_TONE_H
#define WEFT_REGISTRATION_COLOUR_GREY_TONE_H

#include "registration/colour/chart.h"

#include <stdbool.h>

enum { WEFT_GREY_TONE_TERMS = 2, WEFT_GREY_TONE_FEWEST = 4 };

/* light = decoded exp(sum over k of term[k] (2 e - 1)^(k + 1)), for the encoded value e that sRGB decodes to `decoded`:
 * the form that lamps and tone curve of photographs by hand are found with (registration/lamp/lamp.h). */
typedef struct weft_grey_tone {
    double term[WEFT_GREY_TONE_TERMS];
} weft_grey_tone;

/* Light of a value that sRGB has decoded. Pure. */
double weft_grey_tone_light(const weft_grey_tone *tone, double decoded);

/* Finds the curve of least squares from the greys that are used: one curve, and the gain of each channel. False where
 * fewer than WEFT_GREY_TONE_FEWEST are used, or they tell no curve. Pure. */
bool weft_grey_tone_find(const weft_chart_colours *decoded, const weft_chart_colours *reference,
                         const bool used[WEFT_CHART_PATCHES], weft_grey_tone *tone);

/* How far greys are from growing with light: RMS of the logarithms of light over reference about their mean in each
 * channel, of the greys that are used. Black is left out: stray light, and a black level that is a little off, move it
 * far. At least one grey must be used. Pure. */
double weft_grey_misfit(const weft_chart_colours *light, const weft_chart_colours *reference,
                        const bool used[WEFT_CHART_PATCHES]);

#endif
