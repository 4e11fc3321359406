/* The patches of a chart in a photograph. */
#ifndef WEFT_REGISTRATION_COLOUR_PATCHES_H
#define WEFT_REGISTRATION_COLOUR_PATCHES_H

#include "registration/colour/chart.h"
#include "registration/colour/shot.h"

typedef struct weft_chart_patch {
    double light[3]; /* mean of the middle of the patch, as in the shot */
    double clipped;  /* share of its pixels that are clipped in a channel */
    double pixel[2]; /* its centre */
} weft_chart_patch;

/* Finds the chart, whichever way up it lies, and measures its patches: of the pixels of the middle half of a patch, in
 * each channel, the mean without the lowest and the highest fifth (glare, dust, a scratch). Errors: WEFT_BAD_INPUT
 * naming `path` where no chart is found, or one that is mirrored or covered; WEFT_SYSTEM. */
weft_code weft_chart_find(const weft_chart_shot *shot, const char *path, weft_chart_kind kind,
                          weft_chart_patch patch[WEFT_CHART_PATCHES], weft_error *error);

#endif
