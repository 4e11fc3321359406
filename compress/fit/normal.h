/* From the Gram sums of one pass to what a Gauss-Newton step needs, T(v) eliminated in every view:
 *     T = <f|r> / <f|f>,   gradient = sum_v T <df | r - T f>,   matrix = sum_v T^2 (<df|df'> - <df|f><f|df'> / <f|f>).
 * Parameters, in this order: rho; for every lobe A, the two free components of c, ln N; with `rotate` three angles of
 * the frame about its own tangent, bitangent and normal. */
#ifndef WEFT_COMPRESS_FIT_NORMAL_H
#define WEFT_COMPRESS_FIT_NORMAL_H

#include "base/numeric/quadratic_program.h"
#include "compress/fit/bundle.h"
#include "compress/fit/fit.h"

/* ---- The pass ---- */

/* The one pass over the samples of a texel that a joint fit makes for every trial: per view, the products of the
 * columns from which residual, gradient, Gauss-Newton matrix and T all follow without another look at the samples.
 *
 * With b_i = l . M_i v, M_i = R^T diag(Cx, Cy, Cz)_i R, k = sqrt(w) S(l) l_z, h_i = k b_i^(N_i - 1), the columns of a
 * view are
 *     k | h_i l_x, h_i l_y, h_i l_z, q_i = h_i b_i log2 b_i for every lobe | e = r - T(v) k (rho + sum_i A_i b_i^N_i)
 * The lobe itself, k b_i^N_i, is M_i v times its first three columns, and so are its derivatives by any parameter of
 * M_i. */

enum {
    WEFT_GRAM_LOBES = 3,
    WEFT_GRAM_COLUMNS = 2 + 4 * WEFT_GRAM_LOBES,
    WEFT_GRAM_PRODUCTS = WEFT_GRAM_COLUMNS * (WEFT_GRAM_COLUMNS + 1) / 2
};

/* Where the model is evaluated. */
typedef struct weft_gram_point {
    int lobe_count;
    float diffuse;
    float amplitude[WEFT_GRAM_LOBES];
    float exponent[WEFT_GRAM_LOBES];
    float shape[WEFT_GRAM_LOBES][3][3]; /* M_i, symmetric, |l . M v| <= 1 for unit l, v */
} weft_gram_point;

/* Number of columns, e the last. */
static inline int weft_gram_columns(int lobe_count)
{
    return 2 + 4 * lobe_count;
}

/* Place of the product of columns a <= b among all. */
static inline int weft_gram_product(int a, int b, int columns)
{
    return a * columns - a * (a - 1) / 2 + b - a;
}

enum {
    WEFT_LINEAR_MAX = 1 + WEFT_GRAM_LOBES,
    WEFT_NORMAL_MAX = 1 + 4 * WEFT_GRAM_LOBES + 3 /* parameters of a step */
};
_Static_assert((int)WEFT_NORMAL_MAX <= (int)WEFT_QUADRATIC_PROGRAM_MAX, "a step is a quadratic program");

/* Largest rho or A, times the root mean square of the samples: more belongs to a lobe that no sample sees. */
#define WEFT_LARGEST_AMPLITUDE 1e5

/* rho and the amplitudes: f = sum_j x_j column_j. */
typedef struct weft_linear {
    double x[WEFT_LINEAR_MAX];
} weft_linear;

/* What a view's sums say about the linear parameters, a row [view_stride] for each number. */
enum {
    WEFT_LINEAR_GRAM = 0,                                                               /* <column | column>, packed */
    WEFT_LINEAR_ERROR = WEFT_LINEAR_GRAM + WEFT_LINEAR_MAX * (WEFT_LINEAR_MAX + 1) / 2, /* <column | e> */
    WEFT_LINEAR_SQUARE = WEFT_LINEAR_ERROR + WEFT_LINEAR_MAX,                           /* <e | e> */
    WEFT_LINEAR_ROWS
};

/* Row of <column j | column k>. */
static inline int weft_linear_gram(int j, int k)
{
    int low = j < k ? j : k, high = j < k ? k : j;
    return WEFT_LINEAR_GRAM + low * WEFT_LINEAR_MAX - low * (low - 1) / 2 + high - low;
}

/* A point of the search after its pass: the sums, and where they were taken. Arrays by view are [view_stride]. */
typedef struct weft_trial {
    double most;                      /* that rho and each A may be */
    weft_fit fit;                     /* shapes and frame of the pass; rho and A are moved by weft_trial_solve_linear */
    weft_linear at;                   /* rho and A of the pass */
    weft_gram_point point;            /* the same, and the shapes */
    float *pass_table;                /* T of the pass */
    float *table;                     /* T that belongs to `fit` */
    float *sums;                      /* [WEFT_GRAM_PRODUCTS][view_stride], see compress/fit/kernels.h */
    float *linear;                    /* [WEFT_LINEAR_ROWS][view_stride] */
    double strength[WEFT_LINEAR_MAX]; /* sum over the views of <column | column> */
    double energy;                    /* of <e | e> */
    double negligible;                /* <f|f> below this: T stays 1 */
    double residual;                  /* of `fit` with `table` */
} weft_trial;

typedef struct weft_normal {
    int n;
    double h[WEFT_NORMAL_MAX * WEFT_NORMAL_MAX];
    double g[WEFT_NORMAL_MAX];
} weft_normal;

/* The matrix M_i = R^T diag(c) R of every lobe in floats, as the pass wants it. */
weft_gram_point weft_gram_point_of_fit(const weft_fit *fit);

/* rho and the amplitudes of a fit. */
weft_linear weft_linear_of_fit(const weft_fit *fit);

/* Rows t, b, n of a frame: local = R direction. */
void weft_frame_rows(const weft_frame *frame, double rows[3][3]);

/* Index of the component of c held at +-1. */
int weft_lobe_fixed(const weft_fit_lobe *lobe);

/* After a pass: the linear rows. */
void weft_trial_digest(const weft_bundle *bundle, weft_trial *trial);

/* Moves rho and the amplitudes to where the residual is smallest with T eliminated; the amplitudes stay at or above
 * `least` [lobe_count]. Needs no samples. */
void weft_trial_solve_linear(const weft_bundle *bundle, bool with_table, const double *least, weft_trial *trial);

/* From the sums of a trial's last pass, for other linear parameters than it ended with: <f|f> of every view, without T;
 * T by eq. 4; rho and the amplitudes between `low` and `high` that are best for a given T [view_count]. The shapes and
 * the frame of `fit` are those of the pass. */
void weft_trial_model_energy(const weft_bundle *bundle, const weft_trial *trial, const weft_fit *fit, double *energy);
void weft_trial_table(const weft_bundle *bundle, const weft_trial *trial, const weft_fit *fit, double *table);
void weft_trial_solve_given_table(const weft_bundle *bundle, const weft_trial *trial, const double *table,
                                  const double *low, const double *high, weft_fit *fit);

/* What trial->fit leaves if T keeps within a moderate contrast to its mean, both weighted by what they explain. A model
 * may leave least where it almost vanishes in some views and T makes up for it a millionfold; between such a view and
 * the next one, where T is interpolated, it would glare. */
double weft_trial_moderate_residual(const weft_bundle *bundle, const weft_trial *trial);

/* trial->table as doubles [view_count], with the mean of the others in views where nothing was learnt. */
void weft_trial_take_table(const weft_bundle *bundle, const weft_trial *trial, double *table);

/* Matrix and gradient at trial->fit. */
void weft_normal_of_trial(const weft_bundle *bundle, bool with_table, bool rotate, const weft_trial *trial,
                          weft_normal *normal);

#endif
