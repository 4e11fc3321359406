/* The memory of a thread that fits, and the pass over the samples that everything is made of. */
#ifndef WEFT_COMPRESS_FIT_WORKSPACE_H
#define WEFT_COMPRESS_FIT_WORKSPACE_H

#include "compress/fit/kernels.h"

enum { WEFT_TRIALS = 4 };

struct weft_fit_workspace {
    weft_trial trial[WEFT_TRIALS]; /* the point reached, the one being tried, the two best starts */
    float *table;                  /* [view_stride] T to begin with */
    double *scratch[2];            /* [view_stride] */
    float *model;                  /* [sample_count] */
    weft_screen screen;
};

/* Exchanges two trials, what they own included. */
void weft_trial_swap(weft_trial *a, weft_trial *b);

/* One pass at trial->fit with T = `table` in e (NULL: 0; without options->table: 1). Fills sums, linear parts, T,
 * residual. */
void weft_workspace_pass(const weft_bundle *bundle, const weft_samples *samples, int channel,
                         const weft_fit_options *options, const float *table, weft_trial *trial);

/* `table` [view_count] as floats, in workspace->table. */
const float *weft_workspace_keep_table(const weft_bundle *bundle, weft_fit_workspace *workspace, const double *table);

/* Starts from shapes alone: amplitudes for T = 1, then with T eliminated. */
void weft_workspace_begin_cold(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, weft_trial *trial);

/* Starts from a fit that is nearly right: its T keeps the sums free of cancellation. */
void weft_workspace_begin_warm(const weft_bundle *bundle, const weft_samples *samples, int channel,
                               const weft_fit_options *options, const float *table, weft_trial *trial);

/* Damped Gauss-Newton steps from workspace->trial[0], which holds the result. */
void weft_workspace_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                           const weft_fit_options *options, weft_fit_workspace *workspace, double damping);

/* The result of a search: rho and the amplitudes once more, now free to vanish; then `fit` and `table` [view_count]. */
void weft_workspace_finish(const weft_bundle *bundle, const weft_fit_options *options, weft_trial *trial, weft_fit *fit,
                           double *table);

/* True where there is nothing to fit, black or no samples at all; `fit` is then black and T = 1. */
bool weft_workspace_finish_empty(const weft_bundle *bundle, const weft_samples *samples, int channel, weft_fit *fit,
                                 double *table);

/* ---- Screen ---- */

/* Up to `most` lobes that promise most to trial->fit, the best first, no two of one shape; amplitudes are those of the
 * first order. Looks at the coarse lights. Returns their number. */
int weft_screen_run(const weft_bundle *bundle, const weft_samples *samples, int channel,
                    const weft_fit_options *options, weft_fit_workspace *workspace, const weft_trial *trial, int most,
                    weft_fit_lobe *lobe);

#endif
