/* What a camera wrote beside the pixels of a photograph (Exif 2.3). */
#ifndef WEFT_BASE_PICTURE_EXIF_H
#define WEFT_BASE_PICTURE_EXIF_H

#include "base/status.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A number that the file does not say is 0. */
typedef struct weft_exif {
    int width, height; /* pixels as they are read, before the orientation turns them */
    bool is_float;     /* half or float samples; else integers */
    bool is_linear;    /* that, or camera raw; of others nothing is known */
    int bits;          /* of a sample */
    int orientation;   /* how the picture is shown: 1 as stored, 3, 6 or 8 turned; 1 where nothing is said */
    double exposure_s, f_number, iso;
    double focal_length_mm;
    double focal_length_35mm; /* of the same view on film of 36 mm x 24 mm */
} weft_exif;

/* Reads the head of an image file of any format that OpenImageIO knows; the pixels are not read. Errors: WEFT_BAD_INPUT
 * naming the file where it is no image. Thread-safe. */
weft_code weft_exif_read(const char *path, weft_exif *exif, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
