/* The reference fit: alternation in plain double, as Daubert et al. 2001, section 5 describe it. */
#ifndef WEFT_TESTS_SUPPORT_ALTERNATION_H
#define WEFT_TESTS_SUPPORT_ALTERNATION_H

#include "compress/fit/fit.h"

/* Start values: grey, moderate highlights, Cx = 1.22 Cy for the first lobe and Cy = 1.22 Cx for the second.
 * Levenberg-Marquardt on the lobes with T fixed, then T by eq. 4, until the mean change of T is below `threshold` (the
 * paper: 0.1) or `max_rounds`. Hundreds of times slower than the joint fit. Errors: WEFT_SYSTEM for memory. */
weft_code weft_fit_alternate(const weft_bundle *bundle, const weft_samples *samples, int channel,
                             const weft_fit_options *options, double threshold, int max_rounds, const weft_frame *frame,
                             weft_fit *fit, double *table, weft_error *error);

/* Weighted sum of squared residuals of a fit, every sample evaluated in double: the judge of both. */
double weft_fit_residual(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit *fit,
                         const double *table);

#endif
