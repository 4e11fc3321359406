#include "compress/components/dots.h"

#include "base/processor.h"

WEFT_FOR_EACH_SET(WEFT_DECLARE_DOTS);

void weft_dots(const float *const *a, int a_count, const float *const *b, int b_count, size_t length, float *result)
{
    WEFT_DISPATCH(weft_dots)(a, a_count, b, b_count, length, result);
}
