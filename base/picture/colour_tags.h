/* What the file of a picture says of its colours, and what follows. */
#ifndef WEFT_BASE_PICTURE_COLOUR_TAGS_H
#define WEFT_BASE_PICTURE_COLOUR_TAGS_H

#include "base/picture/exif.h"
#include "base/picture/image.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_colour_tags {
    uint8_t *profile; /* ICC; NULL: none */
    size_t profile_size;
    bool has_cicp;   /* of PNG; of HEIF that has no profile */
    uint8_t cicp[4]; /* ITU-T H.273: primaries, transfer, matrix; whether the range is full */
    bool says_srgb;  /* PNG: a chunk sRGB */
    bool has_primaries;
    double primaries[8];   /* of EXR and PNG: x, y of red, green, blue and white */
    double gamma;          /* of PNG: the power that decodes; 0: not said */
    bool is_uncalibrated;  /* Exif: not sRGB; cameras say so of Adobe RGB */
    bool is_grey;          /* one channel */
    bool is_float, is_raw; /* half or float samples; camera raw */
    int turned_as;         /* of HEIF: the Exif orientation by which its decoder turns the picture; 0: it does not */
    bool has_more;         /* pictures than the first, which is the one that is read */
    int bits;              /* of a sample in memory */
    char model[16];        /* of what is neither RGB nor grey: "CMYK", "CIELAB" */
} weft_colour_tags;

/* Reads a picture and what its file says, in one go: some formats take seconds to open. Any but `path` may be NULL;
 * without `image` the pixels are not read. `image` and `kind` are as of weft_image_read; the caller frees the tags with
 * weft_colour_tags_free. Errors: as of weft_image_read. Thread-safe. */
weft_code weft_picture_read(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                            weft_colour_tags *tags, weft_error *error);

void weft_colour_tags_free(weft_colour_tags *tags);

#ifdef __cplusplus
}
#endif
#endif
