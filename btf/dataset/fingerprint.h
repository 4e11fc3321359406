/* By what a dataset is recognised: a material keeps the fingerprint of the one it was made from, and an interrupted
 * fit that of the one it was reading. */
#ifndef WEFT_BTF_DATASET_FINGERPRINT_H
#define WEFT_BTF_DATASET_FINGERPRINT_H

#include "btf/dataset/dataset.h"

typedef struct weft_dataset_fingerprint {
    uint32_t layout;  /* CRC-32 of sizes, conventions, texel pitch, lights and views; not of the provenance */
    uint32_t samples; /* CRC-32 of samples and masks of 16 texels spread over the material */
} weft_dataset_fingerprint;

/* Eight hexadecimal digits and a NUL. */
enum { WEFT_CHECKSUM_TEXT = 9 };
void weft_checksum_print(uint32_t checksum, char text[WEFT_CHECKSUM_TEXT]);

/* Reads a few megabytes at most for the usual 81 x 81 images. Not thread-safe. Errors: those of
 * weft_dataset_read_block. */
weft_code weft_dataset_fingerprint_take(weft_dataset *dataset, weft_dataset_fingerprint *fingerprint,
                                        weft_error *error);

/* Compares with {"dataset": {"layout": "HEX", "samples": "HEX"}} in the metadata of a material, which need not have it.
 * `warning` becomes a sentence where they differ, or where the metadata say that the material was cut to tile ("tile",
 * edit/blend/blend.h); else "". Errors: as above. */
weft_code weft_dataset_fingerprint_compare(weft_dataset *dataset, const char *metadata, char warning[WEFT_MESSAGE_SIZE],
                                           weft_error *error);

#endif
