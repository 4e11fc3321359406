/* The four texels around a place of a dataset that repeats. */
#ifndef WEFT_EVALUATE_TEXELS_AROUND_H
#define WEFT_EVALUATE_TEXELS_AROUND_H

#include "btf/dataset/dataset.h"

typedef struct weft_texels_around {
    int x[4], y[4];
    double weight[4]; /* bilinear; their sum is 1 */
} weft_texels_around;

/* Row 0 is the top row (v near 1). Pure. */
weft_texels_around weft_texels_around_place(const weft_dataset_layout *layout, weft_real u, weft_real v);

#endif
