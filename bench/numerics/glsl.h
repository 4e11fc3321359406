/* The models as the shaders compute them: the same lists of numbers, a picture of them at a time. */
#ifndef WEFT_BENCH_NUMERICS_GLSL_H
#define WEFT_BENCH_NUMERICS_GLSL_H

#include "base/status.h"
#include "bench/numerics/search.h"

/* Makes a context without a display. Errors: WEFT_SYSTEM where there is none, with why. */
weft_code numerics_glsl_open(weft_error *error);
void numerics_glsl_close(void);

/* Name of the driver. */
const char *numerics_glsl_renderer(void);

/* Whether the model has a twin that is measured. */
bool numerics_glsl_has(numerics_id id);

/* Searches as numerics_search does for relative errors, by generations of `evaluations` / 6 points. Errors:
 * WEFT_SYSTEM. */
weft_code numerics_glsl_search(numerics_id id, long evaluations, numerics_found *found, weft_error *error);

#endif
