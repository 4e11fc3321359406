/* The parts of the bench, each of which adds its tables to the report. */
#ifndef WEFT_BENCH_FIT_SECTIONS_H
#define WEFT_BENCH_FIT_SECTIONS_H

#include "bench/fit/method.h"
#include "bench/fit/report.h"

/* What the command line asks for. */
typedef struct bench_plan {
    int texel_count, lobe_count;
    double tolerance;
    bool scalar_callbacks; /* general solvers call the scalar exp and log of the C library */
    const char *tape_path;
    report *report;
} bench_plan;

/* All methods, one after the other on each texel: time, passes, error. */
weft_code section_speed(const bench_plan *plan, texel_source *source, weft_error *error);

/* What a fit from nothing leaves, against the alternation run to convergence and the best of five random starts. */
weft_code section_quality(const bench_plan *plan, texel_source *source, weft_error *error);

/* What more freedom gains: the frame fitted. */
weft_code section_extensions(const bench_plan *plan, texel_source *source, weft_error *error);

/* The fast fit with every instruction set that the processor has. */
weft_code section_instruction_sets(const bench_plan *plan, texel_source *source, weft_error *error);

/* Measured retro-reflective tape: 1, 2, 3 lobes without T against known optima. Skipped where there is no file. */
weft_code section_tape(const bench_plan *plan, weft_error *error);

/* One pass over the samples against the arithmetic that it cannot do without. */
weft_code section_pass(const bench_plan *plan, weft_error *error);

#endif
