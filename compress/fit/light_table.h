/* The light table: r(l, v) = T(v) S(l) l_z (rho + lobes), one number for every light as T has one for every view. What
 * shadows a texel from some directions takes as much light from it whoever looks.
 *
 * S stands beside the cosine, so that a fit with S is a fit of samples whose cosine has been scaled by it: everything
 * in compress/fit/fit.h and compress/texel/pack.h takes such samples. Lights need labels (weft_bundle.light_count > 0).
 * All functions are pure and thread-safe. */
#ifndef WEFT_COMPRESS_FIT_LIGHT_TABLE_H
#define WEFT_COMPRESS_FIT_LIGHT_TABLE_H

#include "compress/fit/fit.h"
#include "compress/fit/kernels.h"

/* What a thread needs for S beside what it needs to fit. */
typedef struct weft_light_workspace {
    float *cosine; /* [sample_count] with S */
    weft_separable separable;
    float *table;          /* [view_stride] T and */
    float *light, *energy; /* [light_count] S of the round; what the model with T has for each light */
    double *before, *step; /* [light_count] S of the round before, and where that led it */
    double *table_best;    /* [view_count] of the best round */
    double *light_best;    /* [light_count] alike */
    weft_fit best;         /* alike */
    double least;          /* what that leaves at moderate contrast */
} weft_light_workspace;

/* Errors: WEFT_SYSTEM. The caller frees, also after a failure. */
weft_code weft_light_workspace_create(const weft_bundle *bundle, weft_light_workspace *result, weft_error *error);
void weft_light_workspace_free(weft_light_workspace *workspace);

/* `samples` with the cosine scaled by light [light_count], kept in `cosine` [sample_count], which the result shares. */
weft_samples weft_light_apply(const weft_bundle *bundle, const weft_samples *samples, const double *light,
                              float *cosine);

/* Improves `fit`, `table` [view_count] and `light` [light_count], start and result, until a round gains less than the
 * tolerance or `most_rounds` are done, and leaves what the best round did: a few passes of the joint fit for given S,
 * then T(v) = <S f | r>_v / <S f | S f>_v and S(l) = <T f | r>_l / <T f | T f>_l in turn for given lobes. S of a light
 * without samples is the mean of the others; the mean is 1. Returns the samples with S applied to them, see
 * weft_light_apply; they share the cosine of `own`. */
weft_samples weft_light_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, int most_rounds, weft_fit_workspace *workspace,
                               weft_light_workspace *own, weft_fit *fit, double *table, double *light);

#endif
