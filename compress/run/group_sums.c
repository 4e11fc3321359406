#include "compress/run/group_sums.h"

#include <string.h>

/* Forgets the samples that do not count. */
static long drop_masked(const uint8_t *mask, const uint8_t *held_out, size_t image_count, float *group)
{
    long masked = 0;
    float *count = group + 3 * image_count;
    for (size_t i = 0; i < image_count; i++) {
        int held = held_out && held_out[i];
        masked += mask[i] && !held;
        if (!mask[i] && !held)
            continue;
        count[i] = 0;
        memset(group + 3 * i, 0, 3 * sizeof *group);
    }
    return masked;
}

long weft_group_of_texel(const weft_half *samples, const uint8_t *mask, const uint8_t *held_out, size_t image_count,
                         float *group)
{
    WEFT_DISPATCH(weft_group_convert)(samples, 3 * image_count, group);
    unsigned any = held_out != NULL;
    for (size_t i = 0; i < image_count; i++) {
        group[3 * image_count + i] = 1;
        any |= mask[i];
    }
    return any ? drop_masked(mask, held_out, image_count, group) : 0;
}

void weft_group_add(const float *from, size_t image_count, float *to)
{
    WEFT_DISPATCH(weft_group_accumulate)(from, 4 * image_count, to);
}
