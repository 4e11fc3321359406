#include "player/draw/resting.h"

static double radical_inverse(int index, int base)
{
    double result = 0, digit = 1;
    for (; index > 0; index /= base) {
        digit /= base;
        result += digit * (index % base);
    }
    return result;
}

weft_sampling weft_sampling_at_rest(int frame)
{
    return (weft_sampling){
        .shift_x = frame > 0 ? radical_inverse(frame, 2) - 0.5 : 0,
        .shift_y = frame > 0 ? radical_inverse(frame, 3) - 0.5 : 0,
        .frame = frame,
    };
}
