/* How well colours are those of a chart, before anything is known of tone, exposure and lamp. */
#ifndef WEFT_REGISTRATION_COLOUR_PLAIN_MATRIX_H
#define WEFT_REGISTRATION_COLOUR_PLAIN_MATRIX_H

#include "registration/colour/chart.h"

/* The share of the variance of `reference` that the 3 x 3 matrix of least squares explains by `light`: 1 where it
 * explains all. 0 where it explains nothing, or the light is of fewer than three colours. Pure. */
double weft_plain_matrix_agreement(const weft_chart_colours *light, const weft_chart_colours *reference);

#endif
