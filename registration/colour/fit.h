/* The matrix of a colour, from patches whose colours are known. */
#ifndef WEFT_REGISTRATION_COLOUR_FIT_H
#define WEFT_REGISTRATION_COLOUR_FIT_H

#include "btf/session/colour.h"
#include "registration/colour/chart.h"

/* What a chart shows, and what it should. */
typedef struct weft_chart_light {
    weft_chart_colours decoded; /* in proportion to light, or, with has_tone, decoded by sRGB's curve */
    weft_chart_colours reference;
    bool used[WEFT_CHART_PATCHES];
    bool has_tone; /* the tone curve is to be found from the greys (grey_tone.h) */
} weft_chart_light;

typedef struct weft_colour_fit {
    int terms;
    double matrix[3][WEFT_COLOUR_ROOT_TERMS]; /* rows sum to 1 */
    double white[3];                          /* light of a perfect white diffuser in the middle of the chart */
    double slope[2];                          /* of the logarithm of the lamp's light, per half width of the chart,
                                                 to the right and down */
    weft_chart_colours camera;                /* of every patch, used or not: its light over white and lamp */
    weft_chart_colours srgb;                  /* the same, as the matrix makes it */
    double difference[WEFT_CHART_PATCHES];    /* CIEDE2000 of it to the reference */
} weft_colour_fit;

/* Fits matrix, white and slope to the patches that are used, less patch `but` (-1: to all of them). Minimises
 *     sum over patches of w |J (matrix term(light / (white exp(slope x))) - reference)|^2
 * where J is the metric of CIEDE2000 at the reference and w = 1 / (1 + (difference / 2)^2): a patch that is far off, by
 * a stain or by glare, hardly counts. The colour of the white is that of the four
 * lightest greys, without the highest and the lowest. Errors: WEFT_BAD_INPUT naming `path` where too few greys are used
 * or the equations are singular. */
weft_code weft_colour_fit_run(const weft_chart_light *chart, int terms, int but, const char *path, weft_colour_fit *fit,
                              weft_error *error);

#endif
