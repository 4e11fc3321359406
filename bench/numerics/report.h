/* Measures all models and prints the sections of docs/notes/numerics.md. */
#ifndef WEFT_BENCH_NUMERICS_REPORT_H
#define WEFT_BENCH_NUMERICS_REPORT_H

#include "base/status.h"
#include "bench/numerics/search.h"

enum { NUMERICS_COLUMNS = 5 }; /* double, float, vectors of floats, stored, GLSL */

/* All that was measured of one model in one precision. */
typedef struct numerics_column {
    numerics_worst vectors; /* over the rows of the reference vectors */
    numerics_found found[NUMERICS_OBJECTIVES];
} numerics_column;

typedef struct numerics_results {
    numerics_column of[NUMERICS_MODELS][NUMERICS_COLUMNS];
    const char *renderer; /* NULL: no shader was measured, for this reason: */
    char no_shader[WEFT_MESSAGE_SIZE];
} numerics_results;

/* The set of a column; NULL for GLSL. */
const numerics_set *numerics_set_of_column(int column);

/* `evaluations` of a cheap model in each search; on demand only of what has a bound. Errors: none; a missing context is
 * noted in the results. */
void numerics_measure_all(long evaluations, bool bounded_only, numerics_results *results);

/* Says on standard error what goes beyond its bound or is no number; true where nothing does. */
bool numerics_hold_to_claims(const numerics_results *results);

/* Every section, after a line <!-- numerics NAME --> each, on standard output. */
void numerics_print(const numerics_results *results, long evaluations);

#endif
