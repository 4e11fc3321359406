#include "base/numeric/cholesky.h"
#include "compress/weave_fit/least_squares.h"

#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Eigenvalues of J'J, columns at unit length, below which nothing is determined. */
static const double least_eigenvalue = 1e-9;

/* Share of an undetermined direction in a parameter that is not determined either. */
static const double large_share = 1e-2;

/* Keeps (I - M_c) regular where a cluster alone determines a direction. */
static const double ridge = 1e-6;

/* parameters = to_parameters y, in which J'J is the identity; n parameters, `kept` numbers in y. */
typedef struct whitening {
    int n, kept;
    double *to_parameters; /* [n][n], the first `kept` columns of which are used */
    double *inverse;       /* [n] of the length of a column of J; 0 for what is held */
    double *square;        /* [n][n] J'J of columns at unit length, then its eigenvectors, in rows */
    double *eigenvalue;    /* [n] ascending */
    bool *unknown;         /* [n] */
} whitening;

/* Sums over one cluster, whitened, and what is solved with them. */
typedef struct cluster_sums {
    double *square;   /* [cluster][kept][kept], the lower triangle */
    double *gradient; /* [cluster][kept] */
    double *white;    /* [kept] a row of J, whitened */
} cluster_sums;

/* ---- Memory ---- */

static void free_whitening(whitening *w)
{
    free(w->to_parameters);
    free(w->inverse);
    free(w->square);
    free(w->eigenvalue);
    free(w->unknown);
}

static weft_code allocate_whitening(int columns, whitening *w, weft_error *error)
{
    size_t n = (size_t)columns;
    *w = (whitening){.n = columns,
                     .to_parameters = calloc(n * n, sizeof(double)),
                     .inverse = calloc(n, sizeof(double)),
                     .square = calloc(n * n, sizeof(double)),
                     .eigenvalue = calloc(n, sizeof(double)),
                     .unknown = calloc(n, sizeof(bool))};
    if (w->to_parameters && w->inverse && w->square && w->eigenvalue && w->unknown)
        return WEFT_OK;
    free_whitening(w);
    return weft_fail_memory(error, "standard errors", 2 * n * n * sizeof(double));
}

static void free_sums(cluster_sums *sums)
{
    free(sums->square);
    free(sums->gradient);
    free(sums->white);
}

/* To be freed also where it fails. */
static weft_code allocate_sums(int cluster_count, int kept, cluster_sums *sums, weft_error *error)
{
    size_t clusters = (size_t)cluster_count, k = (size_t)kept;
    *sums = (cluster_sums){calloc(clusters * k * k + 1, sizeof(double)), calloc(clusters * k + 1, sizeof(double)),
                           calloc(k + 1, sizeof(double))};
    if (sums->square && sums->gradient && sums->white)
        return WEFT_OK;
    return weft_fail_memory(error, "standard errors", clusters * k * k * sizeof(double));
}

/* ---- Parameters in which J'J is the identity ---- */

static void find_lengths(const weft_linearised *solution, whitening *w)
{
    for (int row = 0; row < solution->rows; row++)
        for (int i = 0; i < w->n; i++) {
            double slope = solution->jacobian[(size_t)row * (size_t)w->n + (size_t)i];
            w->inverse[i] += slope * slope;
        }
    for (int i = 0; i < w->n; i++)
        w->inverse[i] = w->inverse[i] > 0 ? 1 / sqrt(w->inverse[i]) : 0;
}

static void square_unit_columns(const weft_linearised *solution, whitening *w)
{
    for (int row = 0; row < solution->rows; row++) {
        const double *slope = solution->jacobian + (size_t)row * (size_t)w->n;
        for (int i = 0; i < w->n; i++)
            for (int j = 0; j <= i && slope[i] != 0; j++)
                w->square[i * w->n + j] += slope[i] * w->inverse[i] * slope[j] * w->inverse[j];
    }
}

/* The direction of a parameter in y, or none: then what it consists of is unknown. */
static void sort_direction(whitening *w, double eigenvalue, const double *direction)
{
    bool known = eigenvalue > least_eigenvalue;
    for (int i = 0; i < w->n; i++) {
        if (known)
            w->to_parameters[i * w->n + w->kept] = w->inverse[i] * direction[i] / sqrt(eigenvalue);
        else if (direction[i] * direction[i] > large_share && w->inverse[i] > 0)
            w->unknown[i] = true;
    }
    w->kept += known;
}

static weft_code whiten(const weft_linearised *solution, whitening *w, weft_error *error)
{
    find_lengths(solution, w);
    square_unit_columns(solution, w);
    /* The lower triangle of rows is the upper one of columns; eigenvectors then stand in rows. */
    if (LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', w->n, w->square, w->n, w->eigenvalue) != 0)
        return weft_fail(error, WEFT_SYSTEM, "standard errors: the eigenvalues of the fit cannot be found");
    for (int k = 0; k < w->n; k++)
        sort_direction(w, w->eigenvalue[k], w->square + (size_t)k * (size_t)w->n);
    return WEFT_OK;
}

/* ---- Clusters ---- */

static void whiten_row(const whitening *w, const double *slope, double *white)
{
    memset(white, 0, (size_t)w->kept * sizeof *white);
    for (int i = 0; i < w->n; i++)
        for (int k = 0; k < w->kept && slope[i] != 0; k++)
            white[k] += slope[i] * w->to_parameters[i * w->n + k];
}

static void sum_clusters(const weft_linearised *solution, const whitening *w, const int *cluster, cluster_sums *sums)
{
    size_t kept = (size_t)w->kept;
    for (int row = 0; row < solution->rows; row++) {
        double *square = sums->square + (size_t)cluster[row] * kept * kept;
        double *gradient = sums->gradient + (size_t)cluster[row] * kept;
        whiten_row(w, solution->jacobian + (size_t)row * (size_t)w->n, sums->white);
        for (size_t k = 0; k < kept; k++) {
            gradient[k] += sums->white[k] * solution->residuals[row];
            for (size_t l = 0; l <= k; l++)
                square[k * kept + l] += sums->white[k] * sums->white[l];
        }
    }
}

/* Adds the squared changes of the parameters when the cluster is left out. False where they cannot be found. */
static bool add_squared_changes(const whitening *w, double *square, double *gradient, double *total)
{
    int kept = w->kept;
    for (int k = 0; k < kept; k++)
        for (int l = 0; l <= k; l++)
            square[k * kept + l] = (k == l ? 1 + ridge : 0) - square[k * kept + l];
    if (!weft_cholesky_factor(kept, kept, square))
        return false;
    weft_cholesky_solve(kept, kept, square, gradient);
    for (int i = 0; i < w->n; i++) {
        double change = 0;
        for (int k = 0; k < kept; k++)
            change += w->to_parameters[i * w->n + k] * gradient[k];
        total[i] += change * change;
    }
    return true;
}

static void find_variances(const whitening *w, cluster_sums *sums, int cluster_count, double *variance)
{
    size_t kept = (size_t)w->kept;
    bool found = cluster_count > 1;
    memset(variance, 0, (size_t)w->n * sizeof *variance);
    for (size_t c = 0; c < (size_t)cluster_count && found; c++)
        found = add_squared_changes(w, sums->square + c * kept * kept, sums->gradient + c * kept, variance);
    for (int i = 0; i < w->n; i++) {
        bool unknown = w->unknown[i] || !found || !isfinite(variance[i]);
        variance[i] = !(w->inverse[i] > 0) ? 0 : unknown ? INFINITY : variance[i] * (cluster_count - 1) / cluster_count;
    }
}

weft_code weft_jackknife_variance(const weft_linearised *solution, const int *cluster, int cluster_count,
                                  double *variance, weft_error *error)
{
    whitening w;
    cluster_sums sums = {0};
    WEFT_TRY(allocate_whitening(solution->columns, &w, error));
    weft_code code = whiten(solution, &w, error);
    if (code == WEFT_OK)
        code = allocate_sums(cluster_count, w.kept, &sums, error);
    if (code == WEFT_OK) {
        sum_clusters(solution, &w, cluster, &sums);
        find_variances(&w, &sums, cluster_count, variance);
    }
    free_sums(&sums);
    free_whitening(&w);
    return code;
}
