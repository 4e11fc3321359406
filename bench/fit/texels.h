/* Where the texels of the bench come from: an invented family, a dataset, or the measured retro-reflective tape. */
#ifndef WEFT_BENCH_FIT_TEXELS_H
#define WEFT_BENCH_FIT_TEXELS_H

#include "bench/fit/problem.h"
#include "compress/fit/fit.h"
#include "tests/support/synthetic_texel.h"

typedef struct texel_source {
    const char *name;
    weft_dataset *dataset; /* NULL where texels are invented */
    synthetic_kind kind;
    bool is_random;             /* random truths instead of a family */
    int first_seed;             /* of these */
    double noise;               /* relative, of invented texels */
    weft_dataset_layout layout; /* that of the dataset, or the source's own */
    weft_bundle bundle;
    weft_samples samples; /* of the texel loaded last */
    int x, y;             /* that texel */
    float *sum, *count;   /* [image_count][3], [image_count] */
    weft_half *half;      /* [image_count][3] */
    uint8_t *mask;        /* [image_count] */
} texel_source;

/* The caller frees each with texel_source_free, also after an error. Errors: WEFT_BAD_INPUT, WEFT_SYSTEM. */
weft_code texel_source_invent(synthetic_kind kind, texel_source *source, weft_error *error);
weft_code texel_source_truths(int view_count, int light_count, int first_seed, texel_source *source, weft_error *error);
weft_code texel_source_open(const char *path, texel_source *source, weft_error *error);
void texel_source_free(texel_source *source);

/* One view for every angle of the light in the file, one "light" for every view: the roles are swapped because the
 * samples of the tape hold the cosine of the view, and a lobe does not change when light and view do. Loads its only
 * texel. */
weft_code texel_source_open_tape(const char *path, texel_source *source, weft_error *error);

/* Loads texel number `index` of `total` that are spread over the source, or its neighbour. */
weft_code texel_source_load(texel_source *source, int index, int total, bool neighbour, weft_error *error);

/* The samples of a texel on plain arrays; freed with problem_free. Errors: WEFT_SYSTEM. */
weft_code problem_create(const texel_source *source, problem *given, weft_error *error);
void problem_load(const texel_source *source, int channel, const weft_fit_options *options, problem *given);
void problem_free(problem *given);

#endif
