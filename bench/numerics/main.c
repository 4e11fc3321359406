/* Worst-case errors of every model by search, against binary128 (docs/notes/numerics.md).
 * Usage: bench_numerics [EVALUATIONS [--check]]    evaluations in each search of a cheap model (3000); --check
 * prints no page and measures only what has a bound. The exit code is 1 where a bound is broken or a value is NaN,
 * infinite or negative, and 3 without memory. */
#include "bench/numerics/report.h"

#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    static numerics_results results;
    long evaluations = argc > 1 ? strtol(argv[1], NULL, 10) : 3000;
    bool check = argc > 2 && strcmp(argv[2], "--check") == 0;
    if (!numerics_float.begin() || !numerics_double.begin() || !numerics_quad.begin())
        return 3;
    numerics_measure_all(evaluations, check, &results);
    if (!check)
        numerics_print(&results, evaluations);
    return numerics_hold_to_claims(&results) ? 0 : 1;
}
