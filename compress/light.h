/* The light table: r(l, v) = T(v) S(l) l_z (rho + lobes), one number for every light as T has one for every view. What
 * shadows a texel from some directions takes as much light from it whoever looks.
 *
 * S stands beside the cosine, so that a fit with S is a fit of samples whose cosine has been scaled by it: everything
 * in compress/fit.h and compress/pack.h takes such samples. Lights need labels (weft_bundle.light_count > 0). All
 * functions are pure and thread-safe. */
#ifndef WEFT_COMPRESS_LIGHT_H
#define WEFT_COMPRESS_LIGHT_H

#include "compress/fit.h"

/* `samples` with the cosine scaled by light [light_count], kept in `cosine` [sample_count], which the result shares. */
weft_samples weft_light_apply(const weft_bundle *bundle, const weft_samples *samples, const double *light,
                              float *cosine);

/* Improves `fit`, `table` [view_count] and `light` [light_count], start and result, until a round gains less than the
 * tolerance, and leaves what the best round did: the joint fit for given S, then S(l) = <T f | r>_l / <T f | T f>_l for
 * the rest. S of a light without samples is the mean of the others; the mean is 1. Returns the samples with S applied
 * to them, see weft_light_apply; the workspace has seen them last. */
weft_samples weft_light_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, weft_fit_workspace *workspace, float *cosine,
                               weft_fit *fit, double *table, double *light);

#endif
