/* Any model of Weft as a BRDF: a material, a dataset, a weave, or a cloth of microcylinders. */
#ifndef WEFT_EVALUATE_MODEL_H
#define WEFT_EVALUATE_MODEL_H

#include "base/progress.h"
#include "base/text/csv.h"
#include "reflectance/weave/weave.h"

#include <stdio.h>

typedef struct weft_model weft_model;

typedef struct weft_model_options {
    uint64_t noise_seed;             /* of a weave; 0 = without its noise */
    const weft_parameter *parameter; /* [parameter_count] for the $names of a weave or cloth */
    int parameter_count;
    bool interval;   /* with the interval of the certificate; a material that has one, evaluated as it is certified */
    bool lobes;      /* of a material that has components, too: its lobes */
    bool flat;       /* of a dataset: without its heights */
    bool as_printed; /* weights of a microcylinder cloth: of the article, not by area */
} weft_model_options;

/* Opens a .weft, .btf.h5, .wv or .mc file. The caller frees it with weft_model_close. Errors: as the reader of each. */
weft_code weft_model_open(const char *path, const weft_model_options *options, weft_model **result, weft_error *error);
void weft_model_close(weft_model *model);

/* What to evaluate. */
typedef struct weft_query {
    weft_vec3 light, view; /* unit */
    bool has_place;        /* else the mean over the whole material (of a weave: over its tile, without noise) */
    weft_real u, v;        /* in units of the material; of a weave in units of its tile */
    weft_real level;       /* mip level of a material; 0 for the others */
} weft_query;

/* BRDF in 1/sr, without the cosine; 0 below the horizon; NaN where a dataset holds no valid sample. The mean over a
 * material is that of all texels of its level (between two levels, interpolated). Not thread-safe. Errors:
 * WEFT_BAD_INPUT for a level that is negative, or not 0 in a model without levels; reading a dataset may fail. */
weft_code weft_model_brdf(weft_model *model, const weft_query *query, weft_rgb *brdf, weft_error *error);

/* Half the width of the interval about what weft_model_brdf said, 1/sr, where the options ask for it; 0 below the
 * horizon. Pure. */
weft_rgb weft_model_half_width(const weft_model *model, const weft_query *query, const weft_rgb *brdf);

/* Whether the options asked for intervals. Pure. */
bool weft_model_has_interval(const weft_model *model);

/* Evaluates the rows of a table with the columns lx, ly, lz, vx, vy, vz and maybe u and v, level; others are kept.
 * Writes the same rows with r, g, b
 * (%.9g) appended and, with intervals, their ends r_low, r_high, ..., of which the lower are at least 0. Directions are
 * normalised. Errors: WEFT_BAD_INPUT "FILE:LINE: ...", and where intervals are asked for without u and v: they are of
 * places; WEFT_SYSTEM where `output` cannot be written. */
weft_code weft_model_evaluate_table(weft_model *model, const weft_csv *table, const weft_progress *progress,
                                    FILE *output, weft_error *error);

#endif
