/* How many rows of texels to read from a dataset at once. */
#ifndef WEFT_BTF_DATASET_ROWS_AT_ONCE_H
#define WEFT_BTF_DATASET_ROWS_AT_ONCE_H

#include "btf/dataset/dataset.h"

/* As many rows as hold about 64 MiB of samples: chunks span several rows, and each should be read once. At least 1.
 * Pure. */
static inline int weft_band_height(const weft_dataset_layout *layout)
{
    size_t row = (size_t)layout->width * (size_t)layout->image_count * 3 * sizeof(weft_half);
    size_t rows = ((size_t)64 << 20) / row;
    return rows < 1 ? 1 : rows > (size_t)layout->height ? layout->height : (int)rows;
}

#endif
