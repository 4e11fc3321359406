/* Search for the arguments at which a model errs most: random points, then evolution strategies from the worst of them.
 * No gradient is used; a given number of evaluations gives the same answer every time. */
#ifndef WEFT_BENCH_NUMERICS_SEARCH_H
#define WEFT_BENCH_NUMERICS_SEARCH_H

#include "bench/numerics/domain.h"
#include "bench/numerics/measure.h"

typedef struct numerics_worst {
    double size;
    double argument[NUMERICS_MAX_ARGUMENTS];
} numerics_worst;

typedef struct numerics_found {
    numerics_worst random; /* over the random points alone */
    double median;         /* of the error over these, where it is not 0 */
    numerics_worst search; /* over all */
    numerics_worst broken; /* size = how many values were NaN, infinite or negative, and where the last was */
    long evaluations, jumps;
} numerics_found;

/* Coordinates that are held at one share of their range; where there are any, the other arguments keep away from the
 * limits of the model. */
typedef struct numerics_hold {
    int count, coordinate[3];
    double share;
} numerics_hold;

numerics_found numerics_search(const numerics_set *set, numerics_id id, numerics_objective objective,
                               numerics_hold hold, long evaluations);

#endif
