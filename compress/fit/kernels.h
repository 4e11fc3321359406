/* The inner loops of the fit, compiled once for every instruction set. */
#ifndef WEFT_COMPRESS_FIT_KERNELS_H
#define WEFT_COMPRESS_FIT_KERNELS_H

#include "base/processor.h"
#include "compress/fit/error_tally.h"
#include "compress/fit/normal.h"

/* What compress/fit/screen.c tries lobes with: arrays [sample_count], of which the samples of a part are filled, and
 * <f|f> by view. */
enum { WEFT_SCREEN_EXPONENTS = 7 /* 1, 4, 16, ... 4096 */ };
typedef struct weft_screen {
    float *error, *model, *square; /* T k (r - T f), T^2 k f, T^2 k^2 */
    float *energy;                 /* [view_stride] T^2 <f|f> */
    float negligible;              /* energy below this counts as none */
} weft_screen;

/* Of one shape, by exponent: the sums over the views of T <a|r - T f>, T^2 <a|a> and T^2 <a|f>^2 / <f|f>. */
typedef struct weft_screen_sums {
    float slope[WEFT_SCREEN_EXPONENTS], square[WEFT_SCREEN_EXPONENTS], projected[WEFT_SCREEN_EXPONENTS];
} weft_screen_sums;

/* The kernels of one set, called by WEFT_DISPATCH (base/processor.h):
 *
 * gram_accumulate: sums [WEFT_GRAM_PRODUCTS][view_stride], products of columns (see compress/fit/normal.h) summed over
 * the samples of each view in a part of its slots. table [view_stride] is T(v) in e. Views without samples keep what
 *     their sums were.
 * gram_evaluate: k (rho + sum_i A_i b_i^N_i) of the samples of a part, without T: result [sample_count].
 * gather_samples, gather_weigh: see weft_samples_gather and weft_samples_weigh_for_screen.
 * gather_compare: adds the squares of the samples, each counted once whatever its weight, and of what `model`
 *     [sample_count] times table [view_stride] leaves of them.
 * gather_brightest: the largest sample r of a channel, r / cos(theta_light), and the largest such cosine, of samples
 * that count. screen_load: from screen->model = k f, without T, to all of `screen` but `negligible`. Returns the sum of
 * T^2 <f|f>. screen_try: lobes of one shape M (compress/fit/normal.h) and all exponents. linear_digest: the linear rows
 * of a trial from its sums at `point`, and their totals. Returns the sum of <f|f> without T. linear_residual: the
 * residual at other linear parameters than those of the pass; their T into table [view_stride]. linear_normal: the same
 * residual, and normal equations of the linear parameters alone, T eliminated: h [n][n], g [n]. fit_normal: see
 * weft_normal_of_trial; without the curvature of the scale, which it returns. */
#define WEFT_DECLARE_FIT_KERNELS(set)                                                                                  \
    void weft_gram_accumulate_##set(const weft_bundle *bundle, const float *cosine, const float *value,                \
                                    const weft_gram_point *point, const float *table, weft_part part, float *sums);    \
    void weft_gather_samples_##set(const weft_bundle *bundle, weft_values values, const float *sum,                    \
                                   const float *count, int group_size, weft_samples *samples);                         \
    void weft_gather_weigh_##set(const weft_bundle *bundle, weft_samples *samples);                                    \
    void weft_gather_compare_##set(const weft_bundle *bundle, const weft_samples *samples, int channel,                \
                                   const float *model, const float *table, weft_error_sums *sums);                     \
    void weft_gather_brightest_##set(const weft_bundle *bundle, const weft_samples *samples, int channel, float *r,    \
                                     float *f, float *cosine);                                                         \
    void weft_gram_evaluate_##set(const weft_bundle *bundle, const float *cosine, const weft_gram_point *point,        \
                                  weft_part part, float *result);                                                      \
    double weft_screen_load_##set(const weft_bundle *bundle, const float *cosine, const float *value,                  \
                                  const float *table, weft_part part, weft_screen *screen);                            \
    void weft_screen_try_##set(const weft_bundle *bundle, const weft_screen *screen, const float shape[3][3],          \
                               weft_part part, weft_screen_sums *result);                                              \
    double weft_linear_digest_##set(const weft_bundle *bundle, weft_trial *trial);                                     \
    double weft_linear_residual_##set(const weft_bundle *bundle, const weft_trial *trial, bool with_table,             \
                                      const weft_linear *linear, float *table);                                        \
    double weft_linear_normal_##set(const weft_bundle *bundle, const weft_trial *trial, bool with_table,               \
                                    const weft_linear *linear, double *h, double *g);                                  \
    double weft_fit_normal_##set(const weft_bundle *bundle, const weft_trial *trial, bool with_table, bool rotate,     \
                                 weft_normal *normal)

WEFT_FOR_EACH_SET(WEFT_DECLARE_FIT_KERNELS);

#endif
