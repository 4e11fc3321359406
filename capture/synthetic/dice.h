/* Random numbers of one synthetic photograph, in the order in which they are asked for. */
#ifndef WEFT_CAPTURE_SYNTHETIC_DICE_H
#define WEFT_CAPTURE_SYNTHETIC_DICE_H

#include "capture/virtual/random.h"

enum { WEFT_DICE_CHANCES = 4096 }; /* random numbers of a photograph */

typedef struct weft_dice {
    uint64_t seed, next;
} weft_dice;

/* Those of a photograph; what all share has negative ones. */
static inline weft_dice weft_dice_of(uint64_t seed, int photograph)
{
    return (weft_dice){seed, (uint64_t)photograph * WEFT_DICE_CHANCES};
}

/* Uniform in [low, high). */
static inline double weft_dice_between(weft_dice *d, double low, double high)
{
    return low + (high - low) * weft_random_uniform(d->seed, WEFT_RANDOM_HAND, d->next++);
}

/* Normal, with a mean of 0. */
static inline double weft_dice_normal(weft_dice *d, double deviation)
{
    return deviation * weft_random_normal(d->seed, WEFT_RANDOM_HAND, d->next++);
}

#endif
