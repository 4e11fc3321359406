/* The colour models of the files of Bonn: what three channels say of linear RGB. */
#ifndef WEFT_IMPORT_BONN_COLOUR_H
#define WEFT_IMPORT_BONN_COLOUR_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/* By their numbers in the files. */
typedef enum weft_bonn_model {
    WEFT_BONN_RGB = 0,
    WEFT_BONN_YUV = 1,
    WEFT_BONN_LAB = 2, /* not read */
    WEFT_BONN_PCA = 3, /* three axes of colour about a mean */
    WEFT_BONN_YCOCG = 4,
    WEFT_BONN_SUM = 5,          /* the sum of the channels, and what share of it green and blue are */
    WEFT_BONN_MEAN = 6,         /* not read */
    WEFT_BONN_LOG_Y = 9,        /* log Y, U, V */
    WEFT_BONN_LOG_YUV = 10,     /* log Y; U and V by a logarithm on either side of 0 */
    WEFT_BONN_LOG_Y_RATIO = 11, /* log Y, U / Y, V / Y */
    WEFT_BONN_LOG_RGB = 12
} weft_bonn_model;

typedef struct weft_bonn_colour {
    int model; /* a weft_bonn_model */
    float mean[3], axis[3][3];
} weft_bonn_colour;

/* Errors: WEFT_BAD_INPUT for a model that is not read, or a mean and axes that are no numbers. */
weft_code weft_bonn_colour_check(const weft_bonn_colour *colour, const char *path, weft_error *error);

/* Linear RGB in place: channels [3][stride], of which the first `count` of each are looked at. Values above 1 and below
 * 0 stay what they are. Pure. */
void weft_bonn_colour_restore(const weft_bonn_colour *colour, float *channels, size_t stride, size_t count);

#endif
