/* The least error that fits into a file of given size: each texel of each level has one of some candidates, nested
 * models fitted to all texels in turn. The choice minimises
 *     squared error + lambda x bytes of the model
 * texel by texel; lambda is found by bisection on the size of the file itself (Shoham and Gersho 1988, eq. 8). */
#ifndef WEFT_COMPRESS_RUN_BUDGET_H
#define WEFT_COMPRESS_RUN_BUDGET_H

#include "compress/run/dense.h"

typedef struct weft_budget_plan {
    uint64_t bytes;   /* of the file, at most */
    uint64_t reserve; /* of these, for metadata that is written later */
} weft_budget_plan;

/* Fits, chooses and measures all levels of `material`, whose shape, directions and opacity are set, and adds maps of
 * models. All candidates are held in memory, within job->budget; no checkpoint is kept. Errors: WEFT_BAD_USAGE where
 * even a diffuse term everywhere is larger; those of weft_dense_fit. */
weft_code weft_budget_fit(weft_dataset *dataset, const weft_texel_source *source, const weft_dense_job *job,
                          const weft_budget_plan *plan, weft_material *material, weft_dense_result *result,
                          weft_error *error);

#endif
