/* Datasets of synthetic texels, for tests of everything that reads one. A failure ends the test. */
#ifndef WEFT_TESTS_SYNTHETIC_DATASET_H
#define WEFT_TESTS_SYNTHETIC_DATASET_H

#include "btf/dataset/dataset.h"

/* Fills samples [image_count][3] and masks [image_count] (zeroed) of texel (x, y). */
typedef void synthetic_fill(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask);

/* Writes a dataset texel by texel; samples become half floats. */
void synthetic_dataset_write(const char *path, const weft_dataset_layout *layout, synthetic_fill *fill);

/* Opens what must open. */
weft_dataset *synthetic_dataset_open(const char *path);

#endif
