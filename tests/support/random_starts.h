/* What no clever start should miss: random texels, and fits from random lobes, each run to convergence.
 *
 * The truths are of the model itself, lobes and T, drawn without any regard to where a fit may begin. So they say
 * whether a search finds what is there, not how well the model serves real cloth. */
#ifndef WEFT_TESTS_RANDOM_STARTS_H
#define WEFT_TESTS_RANDOM_STARTS_H

#include "btf/dataset/dataset.h"
#include "compress/fit/fit.h"

#include <stdint.h>

/* Every one of `view_count` views with every one of `light_count` lights, spread over the hemisphere down to 80
 * degrees. The caller frees with weft_dataset_layout_free. */
weft_code random_truth_layout(int view_count, int light_count, weft_dataset_layout *layout, weft_error *error);

/* Samples [image_count][3], all channels alike, of one to three random lobes with a random T and relative noise. */
void random_truth_samples(const weft_dataset_layout *layout, uint64_t seed, double noise, float *samples);

/* The least residual of `start_count` fits in `frame` from random lobes, each run to convergence; summed in double.
 * best_fit is the fit that left it, table [view_count] room. */
double random_starts_best(const weft_bundle *bundle, const weft_samples *samples, int channel,
                          const weft_fit_options *options, weft_fit_workspace *workspace, const weft_frame *frame,
                          uint64_t seed, int start_count, weft_fit *best_fit, double *table);

#endif
