#include "registration/photographs/steps.h"

#include <stdio.h>
#include <string.h>

int weft_photographs_darker_of_pair(const weft_photograph_set *set, int photograph)
{
    for (int i = 0; i < set->pair_count; i++) {
        if (set->pair[i].bright == photograph)
            return set->pair[i].dark;
    }
    return -1;
}

/* A darker may have a darker itself, which is left out first. */
static void leave_out_darker_of(weft_photograph_set *set, int bright)
{
    int dark = weft_photographs_darker_of_pair(set, bright);
    if (dark < 0 || !weft_photographs_used(&set->photograph[bright]))
        return;
    leave_out_darker_of(set, dark);
    weft_photographs_photograph *darker = &set->photograph[dark];
    if (!weft_photographs_used(darker))
        return;
    darker->is_darker_of_pair = true;
    snprintf(darker->remark, sizeof darker->remark,
             "it is '%.100s' with less exposure, used for the tone curve and for what is clipped there",
             set->photograph[bright].name);
}

void weft_photographs_leave_out_darker(weft_photograph_set *set)
{
    for (int i = 0; i < set->pair_count; i++)
        leave_out_darker_of(set, set->pair[i].bright);
}

long weft_photographs_fill_saturated(const weft_half *darker, const uint8_t *darker_mask, size_t count,
                                     weft_half *texel, uint8_t *mask)
{
    long filled = 0;
    for (size_t i = 0; i < count; i++) {
        if (mask[i] != WEFT_MASK_SATURATED || darker_mask[i] != 0)
            continue;
        memcpy(texel + 3 * i, darker + 3 * i, 3 * sizeof *texel);
        mask[i] = 0;
        filled++;
    }
    return filled;
}
