/* The colours of a camera under a lamp, from one photograph of a colour chart. */
#ifndef WEFT_REGISTRATION_COLOUR_CALIBRATION_H
#define WEFT_REGISTRATION_COLOUR_CALIBRATION_H

#include "base/text/lines.h"
#include "btf/session/colour.h"
#include "registration/colour/chart.h"

typedef struct weft_colour_settings {
    weft_chart_kind chart;
    int terms;   /* WEFT_COLOUR_LINEAR_TERMS, WEFT_COLOUR_ROOT_TERMS; 0: those that predict a patch left out better */
    bool linear; /* integer files hold linear values */
} weft_colour_settings;

typedef struct weft_colour_patch {
    const char *name;
    const char *unused;           /* why it was not used; NULL: it was */
    double pixel[2];              /* its centre */
    double camera[3];             /* white being 1 */
    double srgb[3], reference[3]; /* linear */
    double fitted, left_out;      /* CIEDE2000; left_out: by the matrix of the others */
} weft_colour_patch;

typedef struct weft_colour_report {
    weft_colour colour;
    weft_colour_patch patch[WEFT_CHART_PATCHES];
    int used;
    double lamp_range;   /* the lamp's light at the brightest corner of the chart over that at the darkest */
    weft_lines warnings; /* what the user should know */
} weft_colour_report;

/* `path` is a photograph, or a session whose first photograph is of the chart. Residuals are means over the patches
 * that are used. `report` is to be freed with weft_colour_report_free, whatever is returned.
 * Errors: WEFT_BAD_INPUT naming the file where no chart is found; where its white is clipped, or too dark; where fewer
 * than 18 patches can be used; where its greys say that the values are linear and `linear` does not, or the reverse;
 * where the colours are none of the chart, or tell no matrix. WEFT_SYSTEM. */
weft_code weft_colour_calibrate(const char *path, const weft_colour_settings *settings, weft_colour_report *report,
                                weft_error *error);
void weft_colour_report_free(weft_colour_report *report);

/* ---- The matrix of a colour, from patches whose colours are known ---- */

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
