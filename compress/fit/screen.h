/* Which lobe would help a fit most: all lobes of a grid of shapes and exponents, tried at once to first order.
 *
 * For a lobe a(l, v) = k b^N that is added to a model f with amplitude x >= 0, T(v) eliminated in every view, the
 * residual falls to first order by g^2 / h with
 *     g = sum_v T <a | r - T f>,    h = sum_v T^2 (<a|a> - <a|f>^2 / <f|f>), without T: sum_v <a|a>.
 * Exponents are the powers of four: each is the square of the square of the one before, and the square between them is
 * what <a|a> takes. So a lobe costs five operations a sample, no power and no table, in any frame and for any
 * directions.
 *
 * A fit grows lobe by lobe, each found so and then moved with all others (Boyd, Schiebinger and Recht 2017: alternating
 * descent conditional gradient). */
#ifndef WEFT_COMPRESS_FIT_SCREEN_H
#define WEFT_COMPRESS_FIT_SCREEN_H

#include "compress/fit/workspace.h"

/* Up to `most` lobes that promise most to trial->fit, the best first, no two of one shape; amplitudes are those of the
 * first order. Looks at the coarse lights. Returns their number. */
int weft_screen_run(const weft_bundle *bundle, const weft_samples *samples, int channel,
                    const weft_fit_options *options, weft_fit_workspace *workspace, const weft_trial *trial, int most,
                    weft_fit_lobe *lobe);

#endif
