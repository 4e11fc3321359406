#include "reflectance/weave/batch.h"
#include "reflectance/weave/direction_sequence.h"

#include <stdlib.h>

enum { PAIRS = 4096, DIMENSIONS = 4 };

typedef struct direction_pairs {
    weft_vec3 light[PAIRS], view[PAIRS];
    weft_real value[PAIRS];
} direction_pairs;

static void spread(direction_pairs *pairs)
{
    double step[DIMENSIONS];
    recurrence_steps(DIMENSIONS, step);
    for (int k = 0; k < PAIRS; k++) {
        pairs->light[k] = cosine_weighted(recurrence_at(step[0], k + 1), recurrence_at(step[1], k + 1));
        pairs->view[k] = cosine_weighted(recurrence_at(step[2], k + 1), recurrence_at(step[3], k + 1));
    }
}

weft_code weft_weave_specular_scale_batch(const weft_weave *weave, weft_real *scale, weft_error *error)
{
    direction_pairs *pairs = malloc(sizeof *pairs);
    double sum = 0;
    if (!pairs)
        return weft_fail_memory(error, "directions", sizeof *pairs);
    spread(pairs);
    weft_code code = weft_weave_mean_specular_batch(weave, PAIRS, pairs->light, pairs->view, pairs->value, error);
    for (int k = 0; code == WEFT_OK && k < PAIRS; k++)
        sum += (double)pairs->value[k];
    *scale = sum > 0 ? (weft_real)(PAIRS / (sum * (double)WEFT_PI)) : 0;
    free(pairs);
    return code;
}
