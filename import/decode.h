/* From the file of a photograph to samples of a dataset. */
#ifndef WEFT_IMPORT_DECODE_H
#define WEFT_IMPORT_DECODE_H

#include "import/collection.h"

#include <stddef.h>

/* What all photographs of a collection share. */
typedef struct weft_decoding {
    int source_width, source_height; /* pixels */
    int width, height;               /* texels */
    double saturated_at;             /* encoded, integer images only */
    bool linear;                     /* integer images hold linear values */
    weft_distance distance;
    double pixel_pitch_mm; /* of the photograph; near light only */
} weft_decoding;

/* Decodes one photograph (weft_import says how) into samples [height][width][3] and mask [height][width]; *saturated is
 * the number of masked texels. Thread-safe. Errors: WEFT_BAD_INPUT naming the file: unreadable, of another size, NaN or
 * infinite values. */
weft_code weft_photograph_decode(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                                 weft_half *samples, uint8_t *mask, size_t *saturated, weft_error *error);

#endif
