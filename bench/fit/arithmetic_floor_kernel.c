#include "base/lanes.h"

/* Enough chains to hide the latency of a multiply-add, few enough to stay in sixteen registers. */
enum { CHAINS = 12 };

float WEFT_KERNEL(execute_multiply_adds)(double count);

float WEFT_KERNEL(execute_multiply_adds)(double count)
{
    lanes chain[CHAINS], factor = lanes_of(0.999f), term = lanes_of(0.001f), sum = lanes_of(0);
    for (int i = 0; i < CHAINS; i++)
        chain[i] = lanes_of((float)i);
    /* The optimiser must not know them. */
    __asm__ volatile("" : "+m"(factor), "+m"(term));
    for (long rounds = (long)(count / (CHAINS * LANES)) + 1; rounds > 0; rounds--) {
        for (int i = 0; i < CHAINS; i++)
            chain[i] = chain[i] * factor + term;
    }
    for (int i = 0; i < CHAINS; i++)
        sum += chain[i];
    return lanes_sum(sum);
}
