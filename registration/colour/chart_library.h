/* OpenCV's finder of colour charts (its module mcc), loaded when the first chart is looked for: it brings OpenCV's
 * networks with it. */
#ifndef WEFT_REGISTRATION_COLOUR_CHART_LIBRARY_H
#define WEFT_REGISTRATION_COLOUR_CHART_LIBRARY_H

#include "base/status.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_CHART_SIGHTINGS = 3 };

/* Where a chart may lie: the corners of its patches, within a fifth of a patch, in the order of the finder. */
typedef struct weft_chart_sighting {
    double corner[4][2]; /* origin at the centre of the top left pixel */
} weft_chart_sighting;

/* What the module weft_chart_library.so does. */
typedef struct weft_chart_library {
    /* Looks for a chart of 14 x 10 patches (is_sg) or 6 x 4 in rgb [height][width][3]. Errors: WEFT_SYSTEM. */
    weft_code (*find)(const uint8_t *rgb, int width, int height, int is_sg,
                      weft_chart_sighting sighting[WEFT_CHART_SIGHTINGS], int *count, weft_error *error);
} weft_chart_library;

/* What the module exports under this name. */
extern const weft_chart_library weft_chart_library_table;

#ifdef __cplusplus
}
#endif
#endif
