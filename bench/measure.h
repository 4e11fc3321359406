/* What the benches of the player share. */
#ifndef WEFT_BENCH_MEASURE_H
#define WEFT_BENCH_MEASURE_H

#include "base/picture/image.h"
#include "base/status.h"

#include <time.h>

/* Prints "PROGRAM: message" and ends the program, unless `code` is WEFT_OK. */
void bench_stop_on(const char *program, weft_code code, const weft_error *error);

/* Milliseconds of a clock (CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID). */
double bench_now_ms(clockid_t clock);

/* The relative RMSE (base/numeric/error_summary.h) over the channels where the reference, of the same size, differs
 * from the background. */
double bench_relative_rmse(const weft_image *image, const weft_image *reference, const weft_image *background);

#endif
