/* The inner loop of relief/features.h, for every instruction set. */
#include "relief/features.h"

#include "relief/eight.h"

WEFT_DECLARE_FEATURE_KERNEL(WEFT_INSTRUCTION_SET);

void WEFT_KERNEL(weft_feature_project)(const float *value, const float *component, int length, float *result)
{
    eight even = {0}, odd = {0};
    int i = 0;
    for (; i + 1 < length; i += 2) {
        even += value[i] * eight_load(component + WEFT_FEATURES * i);
        odd += value[i + 1] * eight_load(component + WEFT_FEATURES * (i + 1));
    }
    if (i < length)
        even += value[i] * eight_load(component + WEFT_FEATURES * i);
    eight_store(result, even + odd);
}
