/* The answers of every stage to queries drawn at random. */
#ifndef WEFT_COMPARE_ERROR_BUDGET_MEASURE_H
#define WEFT_COMPARE_ERROR_BUDGET_MEASURE_H

#include "base/progress.h"
#include "capture/virtual/sample.h"
#include "compare/error_budget/stack.h"

/* What is asked. */
typedef struct weft_source_stages {
    const weft_virtual_sample *sample;
    const char *registered; /* NAME.btf.h5, a far dataset of the opening of the sample */
    const char *fitted;     /* NAME.weft, before it was rounded */
    const char *stored;     /* the same as it is kept */
} weft_source_stages;

typedef struct weft_source_queries {
    int count;
    int paths; /* of light for each value of the cloth */
    uint64_t seed;
} weft_source_queries;

/* Where queries lie. */
typedef struct weft_source_span {
    double theta_rad; /* lights and views are at most so far from the normal: as the outermost that were photographed */
    int asked, unseen; /* queries, and how many of them no registered sample answers, which are left out */
} weft_source_span;

/* Draws queries: a texel of the dataset, asked at its centre, and independently a light and a view, evenly in solid
 * angle within the span. The exact samples that s is made of are those of the cloth in the directions of the dataset,
 * which raw BTF would take (evaluate/raw_btf.h). The same for any number of threads. answer [queries->count]
 * receives span->asked - span->unseen answers. Errors: WEFT_BAD_INPUT where a file cannot be read or the dataset is
 * near; those of reading; WEFT_SYSTEM. */
weft_code weft_source_answers(const weft_source_stages *stages, const weft_source_queries *queries,
                              const weft_progress *progress, weft_source_answer *answer, weft_source_span *span,
                              weft_error *error);

#endif
