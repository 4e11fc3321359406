/* What docs/notes/numerics.md claims of every model: the bounds that the bench and its test hold, and from which the
 * page is made. */
#ifndef WEFT_BENCH_NUMERICS_CLAIMS_H
#define WEFT_BENCH_NUMERICS_CLAIMS_H

#include "bench/numerics/measure.h"

typedef struct numerics_claim {
    const char *name;
    double in_double, in_float, in_lanes, in_glsl; /* largest relative error; 0: not computed there */
    double growth_double, growth_float; /* largest growth of rounding; 0: set by the tolerance of an integral */
    long cost;                          /* of an evaluation, in those of a cheap model */
    const char *extreme;                /* where it is worst, and what the code does there */
} numerics_claim;

/* The claims of a model. */
const numerics_claim *numerics_claim_of(numerics_id id);

/* The bound of an objective in a set, 0 where none is claimed. */
double numerics_bound(const numerics_set *set, numerics_id id, numerics_objective objective);

/* A regime in which single precision comes to its end: coordinates of the unit cube (of the arguments named) that go
 * from a good end to a bad one together. */
typedef struct numerics_regime {
    numerics_id id;
    const char *what;
    const char *argument[3]; /* NULL after the last */
    double from, to;         /* share of the coordinate */
    double first, last;      /* what it stands for there; logarithmic between */
} numerics_regime;

extern const numerics_regime numerics_regimes[];
extern const int numerics_regime_count;

#endif
