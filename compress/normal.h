/* From the Gram sums of one pass to what a Gauss-Newton step needs, T(v) eliminated in every view:
 *     T = <f|r> / <f|f>,   gradient = sum_v T <df | r - T f>,   matrix = sum_v T^2 (<df|df'> - <df|f><f|df'> / <f|f>).
 * Parameters, in this order: rho; for every lobe A, the two free components of c, ln N; with `rotate` three angles of
 * the frame about its own tangent, bitangent and normal. */
#ifndef WEFT_COMPRESS_NORMAL_H
#define WEFT_COMPRESS_NORMAL_H

#include "compress/fit.h"
#include "compress/gram.h"
#include "compress/solve.h"

enum { WEFT_LINEAR_MAX = 1 + WEFT_GRAM_LOBES };

/* Largest rho or A, times the root mean square of the samples: more belongs to a lobe that no sample sees. */
#define WEFT_LARGEST_AMPLITUDE 1e5

/* rho and the amplitudes: f = sum_j x_j column_j. */
typedef struct weft_linear {
    double x[WEFT_LINEAR_MAX];
} weft_linear;

/* The part of one view's sums that belongs to the linear parameters. */
typedef struct weft_linear_view {
    double gram[WEFT_LINEAR_MAX][WEFT_LINEAR_MAX]; /* <column | column> */
    double error[WEFT_LINEAR_MAX];                 /* <column | e> */
    double square;                                 /* <e | e> */
} weft_linear_view;

/* A point of the search after its pass: the sums, and where they were taken. */
typedef struct weft_trial {
    weft_fit fit;             /* shapes and frame of the pass; rho and A are moved by weft_trial_solve_linear */
    weft_linear at;           /* rho and A of the pass */
    float *pass_table;        /* [view_count] T of the pass */
    double *table;            /* [view_count] T that belongs to `fit` */
    float *sums;              /* see weft_gram_accumulate */
    weft_linear_view *linear; /* [view_count] */
    double negligible;        /* <f|f> below this: T stays 1 */
    double residual;          /* of `fit` with `table` */
} weft_trial;

typedef struct weft_normal {
    int n;
    double h[WEFT_SOLVE_MAX * WEFT_SOLVE_MAX];
    double g[WEFT_SOLVE_MAX];
} weft_normal;

/* The matrix M_i = R^T diag(c) R of every lobe in floats, as the pass wants it. */
weft_gram_point weft_gram_point_of_fit(const weft_fit *fit);

/* Rows t, b, n of a frame: local = R direction. */
void weft_frame_rows(const weft_frame *frame, double rows[3][3]);

/* Index of the component of c held at +-1. */
int weft_lobe_fixed(const weft_fit_lobe *lobe);

/* After a pass: the linear parts of every view, then T and the residual at the parameters of the pass. */
void weft_trial_digest(const weft_bundle *bundle, bool with_table, weft_trial *trial);

/* Moves rho and the amplitudes to where the residual is smallest with T eliminated; the amplitudes stay at or above
 * `least` [lobe_count]. Needs no samples. */
void weft_trial_solve_linear(const weft_bundle *bundle, bool with_table, const double *least, weft_trial *trial);

/* The same with T given: pass_table of the trial must be 0. `low` and `high` bound rho and the amplitudes. */
void weft_trial_solve_given_table(const weft_bundle *bundle, const double *table, const double *low, const double *high,
                                  weft_trial *trial);

/* Matrix and gradient at trial->fit. */
void weft_normal_of_trial(const weft_bundle *bundle, bool with_table, bool rotate, const weft_trial *trial,
                          weft_normal *normal);

#endif
