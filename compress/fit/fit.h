/* Fitting Lafortune lobes with a view table to the samples of one channel of one texel (Daubert et al. 2001, section
 * 5): r(l, v) = T(v) l_z (rho + sum_i A_i max(0, l' . diag(c_i) . v')^N_i),    C_i = A_i^(1/N_i) c_i least squares over
 * the samples of positive weight. All functions are pure and thread-safe. */
#ifndef WEFT_COMPRESS_FIT_FIT_H
#define WEFT_COMPRESS_FIT_FIT_H

#include "btf/material/material.h"
#include "compress/fit/bundle.h"

#include <stdbool.h>

/* c has its largest component at +1 or -1, so that no power overflows whatever the exponent. */
typedef struct weft_fit_lobe {
    double c[3];
    double log_exponent; /* ln N */
    double amplitude;    /* A >= 0, in the scaled units of weft_samples */
} weft_fit_lobe;

typedef struct weft_fit {
    double diffuse; /* rho >= 0 */
    int lobe_count;
    weft_fit_lobe lobe[WEFT_MATERIAL_MAX_LOBES];
    weft_frame frame; /* of the texel */
    bool has_turned;  /* the frame is not the one that the search began in */
    double residual;  /* weighted sum of squares; compare with weft_samples.energy */
    int passes;       /* over the samples, coarse ones counted as a quarter (rounded up) */
} weft_fit;

typedef struct weft_fit_options {
    int lobe_count;       /* 0..3 */
    bool table;           /* fit T; else T = 1 */
    bool fit_frame;       /* let the joint fit turn the frame */
    bool coarse;          /* look at the coarse lights of each view only */
    double max_exponent;  /* N <= this; cloth stays below 512, retro-reflective tape wants thousands */
    double max_amplitude; /* rho and each A <= this, in the scaled units of weft_samples */
    double tolerance;     /* stop when the next step promises to lower the residual by less than half this fraction */
    int max_passes;
    double wanted; /* stop when the next step promises too little to leave less than this; 0: do not */
} weft_fit_options;

/* 2 lobes, table, N <= 8192, tolerance 1e-3, 40 passes. */
weft_fit_options weft_fit_default_options(void);

/* What a thread needs to fit; one per thread, reused for any number of texels. */
typedef struct weft_fit_workspace weft_fit_workspace;
weft_code weft_fit_workspace_create(const weft_bundle *bundle, weft_fit_workspace **result, weft_error *error);
void weft_fit_workspace_free(weft_fit_workspace *workspace);

/* The largest number of lobes <= wanted that the valid samples of a texel can carry: at least four samples for every
 * free parameter, the entries of T among them. */
int weft_fit_affordable_lobes(const weft_bundle *bundle, const weft_samples *samples, int wanted, bool table);

/* ---- Joint fit ----
 *
 * T is eliminated (variable projection, Golub and Pereyra 1973); the rest is found by Gauss-Newton with damping. */

/* Improves `fit` and `table` [view_count], both a start and the result, until they converge. The start may come from
 * another texel or channel: rho, the amplitudes and T are solved for at once. All results are finite. */
void weft_fit_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                     const weft_fit_options *options, weft_fit_workspace *workspace, weft_fit *fit, double *table);

/* From nothing, in the frame that is given, lobe by lobe: each number of lobes begins from the fit with one fewer. Its
 * starts are found with few passes over few lights, and the best two are refined. With options->fit_frame the frame is
 * turned, where that takes at least 2 % off the residual. */
void weft_fit_cold(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit_options *options,
                   weft_fit_workspace *workspace, const weft_frame *frame, weft_fit *fit, double *table);

/* The model at every sample, without T: [sample_count], valid until the workspace is used again. */
const float *weft_fit_evaluate(const weft_bundle *bundle, const weft_samples *samples, weft_fit_workspace *workspace,
                               const weft_fit *fit);

#endif
