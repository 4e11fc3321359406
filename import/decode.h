/* From the file of a photograph to samples of a dataset. */
#ifndef WEFT_IMPORT_DECODE_H
#define WEFT_IMPORT_DECODE_H

#include "base/picture/colour_claim.h"
#include "import/plausibility.h"
#include "weft/import.h"

#include <stddef.h>

/* What all photographs of a collection share. */
typedef struct weft_decoding {
    int source_width, source_height;    /* pixels */
    int width, height;                  /* texels */
    const weft_import_options *options; /* not owned */
    weft_distance distance;
    double pixel_pitch_mm; /* of the photograph; near light only */
} weft_decoding;

/* The file of a photograph, turned as a viewer shows it. */
typedef struct weft_shown_photograph {
    weft_image image;
    weft_image_kind kind;
    weft_colour_claim claim;
} weft_shown_photograph;

/* The caller frees photograph->image. Thread-safe. Errors: as of weft_picture_read. */
weft_code weft_shown_photograph_read(const char *path, weft_shown_photograph *photograph, weft_error *error);

/* What became of a photograph. */
typedef struct weft_decoded {
    size_t saturated; /* texels that are masked as such */
    size_t missing;   /* texels of which the file lacks a pixel */
    double sum;       /* of the others: of all channels */
    size_t outside;   /* texels that are not, and have colours outside sRGB */
    bool has_more;    /* the file holds more pictures than the one that was read */
    weft_photograph_light light;
    weft_claim_kind claim;
    char words[200]; /* what the file says of its colours; "" where there is nothing to tell */
} weft_decoded;

/* Decodes one photograph (weft_import says how) into samples [height][width][3] and mask [height][width]; spoils its
 * pixels. `path` is for messages. Thread-safe. Errors: WEFT_BAD_INPUT naming the file: of another size, NaN or infinite
 * values; WEFT_SYSTEM. */
weft_code weft_photograph_decode(const weft_decoding *decoding, const char *path, const weft_photograph *photograph,
                                 weft_shown_photograph *shown, weft_half *samples, uint8_t *mask, weft_decoded *decoded,
                                 weft_error *error);

#endif
