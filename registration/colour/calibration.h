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

#endif
