/* The alternation of Daubert et al. 2001 as one would write it with MINPACK's Levenberg-Marquardt: a yardstick. */
#ifndef WEFT_BENCH_FIT_MINPACK_H
#define WEFT_BENCH_FIT_MINPACK_H

#include "compress/fit.h"

/* Fits rho and lobes (Cx, Cy, Cz, N) by lmder, T by eq. 4, in turns until the mean change of T is below `threshold`.
 * Nothing is bounded: a negative rho and N below 1, which a material cannot store, sometimes leave a few percent less.
 * Returns the residual, negative where MINPACK failed. */
double minpack_alternate(const weft_bundle *bundle, const weft_samples *samples, int channel, int lobe_count,
                         double threshold);

#endif
