#include "player/draw/resting.h"

/* Any four frames in a row lie well apart along a pixel. */
static const double longest_pixel = 4;

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
        .longest_pixel = longest_pixel,
        .frame = frame,
        .neighbours_differ = true,
    };
}
