#include "registration/photographs/twin.h"

#include <stdio.h>
#include <string.h>

int weft_photographs_darker_twin(const weft_hand *hand, int photograph)
{
    for (int i = 0; i < hand->pair_count; i++) {
        if (hand->pair[i].bright == photograph)
            return hand->pair[i].dark;
    }
    return -1;
}

/* A twin may have a twin itself, which is left out first. */
static void leave_out_twin_of(weft_hand *hand, int bright)
{
    int dark = weft_photographs_darker_twin(hand, bright);
    if (dark < 0 || !weft_photographs_used(&hand->photograph[bright]))
        return;
    leave_out_twin_of(hand, dark);
    weft_photographs_photograph *twin = &hand->photograph[dark];
    if (!weft_photographs_used(twin))
        return;
    twin->is_twin = true;
    snprintf(twin->remark, sizeof twin->remark,
             "it is '%.100s', darker: it tells the tone curve, and what is clipped there",
             hand->photograph[bright].name);
}

void weft_photographs_leave_out_twins(weft_hand *hand)
{
    for (int i = 0; i < hand->pair_count; i++)
        leave_out_twin_of(hand, hand->pair[i].bright);
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
