/* What is made of a fitted material without another fit. */
#ifndef WEFT_COMPARE_TRADEOFF_VARIANT_H
#define WEFT_COMPARE_TRADEOFF_VARIANT_H

#include "btf/material/material.h"
#include "compare/tradeoff/priced_model.h"

/* A material as the model wants it: a copy of `fitted` with rounded tables, with components that are rounded by
 * `rounding_step`, which the report of the fit has, with the first of its components alone, without its finest level or
 * without heights. It goes through a file at `path`, which is gone afterwards. The caller frees *result. Errors: those
 * of writing and reading. */
weft_code weft_variant_make(const weft_material *fitted, const weft_priced_model *model, double rounding_step,
                            const char *path, weft_material *result, weft_error *error);

#endif
