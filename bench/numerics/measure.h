/* The error of one evaluation, against binary128 on the same numbers. */
#ifndef WEFT_BENCH_NUMERICS_MEASURE_H
#define WEFT_BENCH_NUMERICS_MEASURE_H

#include "bench/numerics/models.h"

/* What a search looks for. */
typedef enum numerics_objective {
    NUMERICS_RELATIVE, /* to the value, or to a thousandth of the size that values of the model have here */
    NUMERICS_ABSOLUTE,
    NUMERICS_GROWTH, /* of rounding: the error over what one rounding of each argument and of the result does to the
                        exact value. A formula that loses no digits of its own stays at a few */
    NUMERICS_OBJECTIVES
} numerics_objective;

typedef struct numerics_error {
    double size[NUMERICS_OBJECTIVES];
    bool broken; /* NaN, infinite or negative */
    bool jump;   /* the exact function jumps within rounding of the arguments, and the value is that of the other side:
                    all errors are 0 */
} numerics_error;

/* Of a value that the set has computed for these arguments (`count` numbers). */
numerics_error numerics_error_of_value(const numerics_set *set, numerics_id id, const double *argument, int count,
                                       numerics_value value, bool with_growth);

/* Evaluates and compares. */
numerics_error numerics_error_at(const numerics_set *set, numerics_id id, const double *argument, int count,
                                 bool with_growth);

#endif
