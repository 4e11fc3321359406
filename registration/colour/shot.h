/* The photograph of a chart: its values in proportion to light. */
#ifndef WEFT_REGISTRATION_COLOUR_SHOT_H
#define WEFT_REGISTRATION_COLOUR_SHOT_H

#include "base/picture/image.h"

#include <stdbool.h>

typedef struct weft_chart_shot {
    weft_image light; /* in proportion to light, 1 at full scale; of a file with a tone curve, as if that were sRGB's */
    bool has_tone;    /* an integer file that was not said to be linear: its tone curve is still to be found */
    float clipped_at; /* value of `light` from which one is clipped */
    bool is_scaled;   /* 1 is what the sensor holds; floats may have any scale */
} weft_chart_shot;

/* Reads a photograph of any kind that Weft reads, or the first photograph taken of a session, above black and without
 * the vignetting of the session's camera. `linear`: integer files hold linear values. The caller frees with
 * weft_image_free(&shot->light). Errors: WEFT_BAD_INPUT naming the file; WEFT_SYSTEM. */
weft_code weft_chart_shot_read(const char *path, bool linear, weft_chart_shot *shot, weft_error *error);

#endif
