/* The scratch file of a dataset writer: whole images, put in any order, taken back as strips of texels.
 * It has no name, so nothing is left of it however the program ends. Private to btf/. */
#ifndef WEFT_BTF_DATASET_SCRATCH_H
#define WEFT_BTF_DATASET_SCRATCH_H

#include "base/half.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct weft_scratch {
    const char *path; /* of the dataset, for messages; not owned */
    int descriptor;   /* -1 where none is open */
    int width, height;
    bool *present; /* [image_count] */
} weft_scratch;

/* Creates the file in the folder of `path` and reserves its disk space. Errors: WEFT_SYSTEM. */
weft_code weft_scratch_create(const char *path, int width, int height, int image_count, weft_scratch *scratch,
                              weft_error *error);
void weft_scratch_free(weft_scratch *scratch);

/* samples [height][width][3], mask [height][width] or NULL. Samples under a mask become 0. Thread-safe for distinct
 * images. Errors: WEFT_BAD_INPUT for a valid sample that is not finite, WEFT_SYSTEM. */
weft_code weft_scratch_put(weft_scratch *scratch, int image, const weft_half *samples, const uint8_t *mask,
                           weft_error *error);

/* Texels [x, x + width) x [y, y + height) of an image: samples [height][width][3], mask [height][width]. An image never
 * put is all WEFT_MASK_MISSING. Errors: WEFT_SYSTEM. */
weft_code weft_scratch_take(const weft_scratch *scratch, int image, int x, int y, int width, int height,
                            weft_half *samples, uint8_t *mask, weft_error *error);

#endif
