/* The ways to fit a texel that the bench compares: ours, and those of general solvers where they were installed when
 * the bench was built. All minimise the same sum of squares over the same samples in the upright frame. */
#ifndef WEFT_BENCH_FIT_METHOD_H
#define WEFT_BENCH_FIT_METHOD_H

#include "bench/fit/texels.h"

typedef enum method {
    METHOD_FAST,      /* ours: joint, T eliminated, from nothing */
    METHOD_WARM,      /* the same, from the neighbouring texel as along a row */
    METHOD_REFERENCE, /* ours: the paper's alternation in plain double */
    METHOD_CERES_JOINT,
    METHOD_CERES_ALTERNATION,
    METHOD_MINPACK_JOINT,
    METHOD_MINPACK_ALTERNATION,
    METHOD_COUNT
} method;

#define ALTERNATION_THRESHOLD 0.1 /* mean change of T that ends the alternation: the paper's */
#define ALTERNATION_ROUNDS 20

/* What a thread of the bench works with. */
typedef struct bench {
    texel_source *source;
    weft_fit_options options;
    weft_fit_workspace *workspace;
    problem plain;           /* its code may be exchanged */
    double *table;           /* [view_count] */
    weft_fit neighbour;      /* where METHOD_WARM starts */
    double *neighbour_table; /* [view_count] */
} bench;

typedef struct outcome {
    double microseconds; /* processor time of the thread */
    double passes;       /* over the samples */
    double residual;     /* NaN where the method failed; summed in double from its parameters */
} outcome;

/* The caller frees with bench_free, also after an error. `source` stays the caller's. */
weft_code bench_create(texel_source *source, const weft_fit_options *options, bench *with, weft_error *error);
void bench_free(bench *with);

/* Loads a texel, and fits its neighbour for METHOD_WARM. Errors: those of the dataset. */
weft_code bench_load(bench *with, int index, int total, int channel, weft_error *error);

bool method_available(method which);
const char *method_name(method which);

/* One fit of the texel loaded last, with `options` of the bench. */
outcome method_run(bench *with, method which, int channel);

/* Start number `start` only, for the methods of general solvers. */
outcome method_run_from(bench *with, method which, int start);

#endif
