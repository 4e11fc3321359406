/* The pixels of a photograph, in proportion to light. */
#ifndef WEFT_REGISTRATION_LAMP_READ_H
#define WEFT_REGISTRATION_LAMP_READ_H

#include "base/status.h"
#include "registration/lamp/tone.h"

#include <stdint.h>

/* A sample that has reached this is clipped. */
enum { WEFT_HAND_FULL_SCALE = 65535 };

typedef struct weft_light_values {
    int width, height;
    uint16_t *samples; /* [height][width][3] light, WEFT_HAND_FULL_SCALE where the file's value is clipped */
    float *grey;       /* [height][width] mean of the channels, 1 at full scale; NaN where one is clipped */
} weft_light_values;

/* Reads an image file of width x height pixels. Its values are decoded by `tone`; those of `clipped_at` and more are
 * clipped. The caller frees with weft_light_values_free. Errors: WEFT_BAD_INPUT naming the file; WEFT_SYSTEM for
 * memory. Thread-safe. */
weft_code weft_light_values_read(const char *path, int width, int height, const weft_tone_curve *tone, float clipped_at,
                                 weft_light_values *values, weft_error *error);
void weft_light_values_free(weft_light_values *values);

#endif
