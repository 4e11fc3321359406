/* The inner loops of making images of a file of Bonn, compiled for every instruction set. Private to
 * import/bonn/images.c. */
#ifndef WEFT_IMPORT_BONN_PRODUCT_H
#define WEFT_IMPORT_BONN_PRODUCT_H

#include "base/processor.h"
#include "import/bonn/matrix.h"

/* Images whose products are added up together; there is a place for as many in `values`. */
enum { WEFT_BONN_TOGETHER = 4 };

typedef struct weft_bonn_kernels {
    /* values [row_count, up to a multiple of WEFT_BONN_TOGETHER][WEFT_BONN_BLOCK] = row [row_count][component_count]
     * times texels [component_count][WEFT_BONN_BLOCK]; texels and values begin at multiples of 64 bytes. */
    void (*multiply)(const float *const *row, int row_count, const float *texels, int component_count, float *values);
    /* Of a whole number of eights. */
    void (*widen)(const weft_half *half, size_t count, float *single);
} weft_bonn_kernels;

#define WEFT_DECLARE_BONN_KERNELS(set) extern const weft_bonn_kernels weft_bonn_kernels_##set
#define WEFT_DECLARE_BONN_KERNELS_OF(set) WEFT_DECLARE_BONN_KERNELS(set)

WEFT_FOR_EACH_SET(WEFT_DECLARE_BONN_KERNELS);

#endif
