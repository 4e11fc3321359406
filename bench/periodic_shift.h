/* By how much one periodic image is another, displaced. */
#ifndef WEFT_BENCH_PERIODIC_SHIFT_H
#define WEFT_BENCH_PERIODIC_SHIFT_H

#include "base/status.h"

/* In pixels to the right and upward (row 0 is the top row), to 1/128. */
typedef struct periodic_shift {
    double right, up;
    double correlation; /* of the images there, without their means */
} periodic_shift;

/* The displacement, at most half the image each way, at which `moved` correlates best with `image`, both
 * [height][width]. Errors: WEFT_SYSTEM. */
weft_code periodic_shift_find(const double *image, const double *moved, int width, int height, periodic_shift *shift,
                              weft_error *error);

#endif
