/* The pixels of a photograph, in proportion to light. */
#ifndef WEFT_REGISTRATION_LAMP_READ_H
#define WEFT_REGISTRATION_LAMP_READ_H

#include "base/picture/exif.h"
#include "base/status.h"
#include "registration/lamp/tone.h"

#include <stdint.h>

/* A sample that has reached this is clipped. */
enum { WEFT_PHOTOGRAPHS_FULL_SCALE = 65535 };

/* What a file's values are good for, 0..1 of its range. */
typedef struct weft_file_range {
    float clipped_at; /* one that has reached it is clipped */
    float dark_at; /* light below that of it is too dark to be read: five steps of the file, so that one step is a fifth
                      of the value. The samples here have 65535 steps, so floats count as 16 bits */
} weft_file_range;

weft_file_range weft_file_range_of(const weft_exif *exif, double clipped_at);

typedef struct weft_light_values {
    int width, height;
    uint16_t *samples; /* [height][width][3] light, WEFT_PHOTOGRAPHS_FULL_SCALE where the file's value is clipped */
    float *grey;       /* [height][width] mean of the channels, 1 at full scale; NaN where one is clipped */
    float dark;        /* light below it is too dark to be read; 1 at full scale */
} weft_light_values;

/* Reads an image file of width x height pixels. Its values are decoded by `tone`. The caller frees with
 * weft_light_values_free. Errors: WEFT_BAD_INPUT naming the file; WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_light_values_read(const char *path, int width, int height, const weft_tone_curve *tone,
                                 weft_file_range range, weft_light_values *values, weft_error *error);
void weft_light_values_free(weft_light_values *values);

#endif
