/* What the file of a picture says of its colours, and what follows. */
#ifndef WEFT_BASE_PICTURE_COLOUR_TAGS_H
#define WEFT_BASE_PICTURE_COLOUR_TAGS_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_colour_tags {
    uint8_t *profile; /* ICC; NULL: none */
    size_t profile_size;
    bool has_primaries;
    double primaries[8];   /* of EXR: x, y of red, green, blue and white */
    double gamma;          /* of PNG: the power that decodes; 0: not said */
    bool is_uncalibrated;  /* Exif: not sRGB; cameras say so of Adobe RGB */
    bool is_grey;          /* one channel */
    bool is_float, is_raw; /* half or float samples; camera raw */
    bool has_more;         /* pictures than the first, which is the one that is read */
    int bits;              /* of a sample in memory */
    char model[16];        /* of what is neither RGB nor grey: "CMYK", "CIELAB" */
} weft_colour_tags;

/* Reads the head of an image file. The caller frees with weft_colour_tags_free. Errors: WEFT_BAD_INPUT naming a file
 * that is no image; WEFT_SYSTEM. Thread-safe. */
weft_code weft_colour_tags_read(const char *path, weft_colour_tags *tags, weft_error *error);
void weft_colour_tags_free(weft_colour_tags *tags);

#ifdef __cplusplus
}
#endif
#endif
