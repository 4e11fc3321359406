#include "compress/normal.h"

#include <math.h>
#include <string.h>

#define LN2 0.69314718055994530942

void weft_frame_rows(const weft_frame *frame, double rows[3][3])
{
    const weft_vec3 axis[3] = {frame->tangent, frame->bitangent, frame->normal};
    for (int i = 0; i < 3; i++) {
        rows[i][0] = axis[i].x;
        rows[i][1] = axis[i].y;
        rows[i][2] = axis[i].z;
    }
}

int weft_lobe_fixed(const weft_fit_lobe *lobe)
{
    int fixed = 2;
    for (int k = 0; k < 2; k++) {
        if (fabs(lobe->c[k]) > fabs(lobe->c[fixed]))
            fixed = k;
    }
    return fixed;
}

weft_gram_point weft_gram_point_of_fit(const weft_fit *fit)
{
    weft_gram_point point = {.lobe_count = fit->lobe_count, .diffuse = (float)fit->diffuse};
    double rows[3][3];
    weft_frame_rows(&fit->frame, rows);
    for (int i = 0; i < fit->lobe_count; i++) {
        point.amplitude[i] = (float)fit->lobe[i].amplitude;
        point.exponent[i] = (float)exp(fit->lobe[i].log_exponent);
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) {
                double sum = 0;
                for (int k = 0; k < 3; k++)
                    sum += rows[k][a] * fit->lobe[i].c[k] * rows[k][b];
                point.shape[i][a][b] = (float)sum;
            }
        }
    }
    return point;
}

static weft_linear linear_of_fit(const weft_fit *fit)
{
    weft_linear linear = {.x = {fit->diffuse}};
    for (int i = 0; i < fit->lobe_count; i++)
        linear.x[1 + i] = fit->lobe[i].amplitude;
    return linear;
}

static void linear_to_fit(const weft_linear *linear, weft_fit *fit)
{
    fit->diffuse = linear->x[0];
    for (int i = 0; i < fit->lobe_count; i++)
        fit->lobe[i].amplitude = linear->x[1 + i];
}

/* ---- Linear parameters ---- */

typedef double direction[3];

/* p_i = diag(c_i) v' in the frame of the texel, and m_i = R^T p_i. */
static void shapes_of_view(const weft_fit *fit, double rows[3][3], weft_vec3 view, direction *local_view, direction *p,
                           direction *m)
{
    for (int k = 0; k < 3; k++)
        (*local_view)[k] = rows[k][0] * view.x + rows[k][1] * view.y + rows[k][2] * view.z;
    for (int i = 0; i < fit->lobe_count; i++) {
        for (int k = 0; k < 3; k++)
            p[i][k] = fit->lobe[i].c[k] * (*local_view)[k];
        for (int k = 0; k < 3; k++)
            m[i][k] = rows[0][k] * p[i][0] + rows[1][k] * p[i][1] + rows[2][k] * p[i][2];
    }
}

static double gram_at(const float *sums, int i, int j)
{
    return (double)sums[i * WEFT_GRAM_STRIDE + j];
}

/* Linear column j is the combination `weight` [width] of the columns from `first`. */
typedef struct combination {
    int first, width;
    double weight[3];
} combination;

static combination linear_column(int j, const direction *m)
{
    if (j == 0)
        return (combination){0, 1, {1}};
    return (combination){1 + 4 * (j - 1), 3, {m[j - 1][0], m[j - 1][1], m[j - 1][2]}};
}

static double product(const float *sums, const combination *a, const combination *b)
{
    double sum = 0;
    for (int i = 0; i < a->width; i++) {
        for (int j = 0; j < b->width; j++)
            sum += a->weight[i] * b->weight[j] * gram_at(sums, a->first + i, b->first + j);
    }
    return sum;
}

static void digest_view(int lobe_count, const float *sums, const direction *m, weft_linear_view *linear)
{
    int e = 1 + 4 * lobe_count;
    const combination error = {e, 1, {1}};
    combination column[WEFT_LINEAR_MAX];
    for (int j = 0; j <= lobe_count; j++)
        column[j] = linear_column(j, m);
    for (int j = 0; j <= lobe_count; j++) {
        linear->error[j] = product(sums, &column[j], &error);
        for (int k = 0; k <= j; k++)
            linear->gram[j][k] = linear->gram[k][j] = product(sums, &column[j], &column[k]);
    }
    linear->square = gram_at(sums, e, e);
}

static double quadratic(const weft_linear_view *view, int count, const double *a, const double *b)
{
    double sum = 0;
    for (int j = 0; j < count; j++) {
        for (int k = 0; k < count; k++)
            sum += a[j] * view->gram[j][k] * b[k];
    }
    return sum;
}

/* What is known about one view at linear parameters x. r - T f = e + sum_j delta_j column_j. */
typedef struct view_state {
    double t, ff, residual;
    double delta[WEFT_LINEAR_MAX];
    bool eliminated; /* T follows f; else it is fixed */
} view_state;

static view_state state_of_view(const weft_trial *trial, int view, bool with_table, const double *x)
{
    const weft_linear_view *linear = &trial->linear[view];
    int count = trial->fit.lobe_count + 1;
    double pass_t = (double)trial->pass_table[view];
    view_state state = {.t = 1, .ff = quadratic(linear, count, x, x)};
    if (with_table && state.ff > trial->negligible) {
        double fr = pass_t * quadratic(linear, count, x, trial->at.x);
        for (int j = 0; j < count; j++)
            fr += x[j] * linear->error[j];
        state.t = fr > 0 ? fr / state.ff : 0;
        state.eliminated = true;
    }
    state.residual = linear->square;
    for (int j = 0; j < count; j++) {
        state.delta[j] = pass_t * trial->at.x[j] - state.t * x[j];
        state.residual += 2 * state.delta[j] * linear->error[j];
    }
    state.residual += quadratic(linear, count, state.delta, state.delta);
    state.residual = state.residual > 0 ? state.residual : 0;
    return state;
}

static double residual_at(const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                          const weft_linear *linear, double *table)
{
    double sum = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        view_state state = state_of_view(trial, view, with_table, linear->x);
        if (table)
            table[view] = state.t;
        sum += state.residual;
    }
    return sum;
}

void weft_trial_digest(const weft_bundle *bundle, bool with_table, weft_trial *trial)
{
    double rows[3][3], energy = 0;
    weft_frame_rows(&trial->fit.frame, rows);
    trial->at = linear_of_fit(&trial->fit);
    for (int view = 0; view < bundle->view_count; view++) {
        direction local_view, p[WEFT_GRAM_LOBES], m[WEFT_GRAM_LOBES];
        const float *sums = trial->sums + (size_t)view * WEFT_GRAM_STRIDE * WEFT_GRAM_STRIDE;
        shapes_of_view(&trial->fit, rows, bundle->view[view], &local_view, p, m);
        digest_view(trial->fit.lobe_count, sums, (const direction *)m, &trial->linear[view]);
        energy += quadratic(&trial->linear[view], trial->fit.lobe_count + 1, trial->at.x, trial->at.x);
    }
    trial->negligible = 1e-9 * energy / bundle->view_count;
    trial->residual = residual_at(bundle, trial, with_table, &trial->at, trial->table);
}

/* Normal equations of the linear parameters alone, T eliminated as in weft_normal_of_trial. */
static void linear_normal(const weft_bundle *bundle, const weft_trial *trial, bool with_table, const double *x,
                          double *h, double *g)
{
    int n = trial->fit.lobe_count + 1;
    memset(h, 0, (size_t)(n * n) * sizeof *h);
    memset(g, 0, (size_t)n * sizeof *g);
    double scale = 0, length = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        const weft_linear_view *linear = &trial->linear[view];
        view_state state = state_of_view(trial, view, with_table, x);
        double s[WEFT_LINEAR_MAX] = {0};
        for (int j = 0; j < n; j++) {
            double error = linear->error[j];
            for (int k = 0; k < n; k++) {
                s[j] += linear->gram[j][k] * x[k];
                error += linear->gram[j][k] * state.delta[k];
            }
            g[j] += state.t * error;
        }
        for (int j = 0; j < n; j++) {
            for (int k = 0; k < n; k++) {
                double projected = state.eliminated ? s[j] * s[k] / state.ff : 0;
                h[j * n + k] += state.t * state.t * (linear->gram[j][k] - projected);
            }
        }
        scale += state.eliminated ? state.t * state.t * state.ff : 0;
    }
    for (int j = 0; j < n; j++)
        length += x[j] * x[j];
    for (int j = 0; length > 0 && j < n; j++) {
        for (int k = 0; k < n; k++)
            h[j * n + k] += scale * x[j] * x[k] / (length * length);
    }
}

static bool linear_step(const weft_bundle *bundle, bool with_table, const double *least, weft_trial *trial)
{
    int n = trial->fit.lobe_count + 1;
    double h[WEFT_LINEAR_MAX * WEFT_LINEAR_MAX], g[WEFT_LINEAR_MAX], low[WEFT_LINEAR_MAX], high[WEFT_LINEAR_MAX];
    double d[WEFT_LINEAR_MAX] = {0}, trace = 0;
    weft_linear now = linear_of_fit(&trial->fit), next = now;
    linear_normal(bundle, trial, with_table, now.x, h, g);
    for (int j = 0; j < n; j++) {
        low[j] = (j ? least[j - 1] : 0) - now.x[j];
        low[j] = low[j] < 0 ? low[j] : 0;
        high[j] = fmax(0, WEFT_LARGEST_AMPLITUDE - now.x[j]);
        trace += h[j * n + j];
    }
    for (int j = 0; j < n; j++)
        h[j * n + j] += 1e-7 * h[j * n + j] + 1e-12 * trace + 1e-300;
    if (!weft_solve_box(n, h, g, low, high, d))
        return false;
    for (int j = 0; j < n; j++)
        next.x[j] += d[j];
    double residual = residual_at(bundle, trial, with_table, &next, NULL);
    if (!(residual < trial->residual))
        return false;
    bool worthwhile = residual < (1 - 1e-4) * trial->residual;
    trial->residual = residual;
    linear_to_fit(&next, &trial->fit);
    return worthwhile;
}

void weft_trial_solve_linear(const weft_bundle *bundle, bool with_table, const double *least, weft_trial *trial)
{
    for (int round = 0; round < 4; round++) {
        if (!linear_step(bundle, with_table, least, trial))
            break;
    }
    weft_linear linear = linear_of_fit(&trial->fit);
    trial->residual = residual_at(bundle, trial, with_table, &linear, trial->table);
}

void weft_trial_solve_given_table(const weft_bundle *bundle, const double *table, const double *low, const double *high,
                                  weft_trial *trial)
{
    int n = trial->fit.lobe_count + 1;
    double h[WEFT_LINEAR_MAX * WEFT_LINEAR_MAX] = {0}, g[WEFT_LINEAR_MAX] = {0}, trace = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        const weft_linear_view *linear = &trial->linear[view];
        for (int j = 0; j < n; j++) {
            g[j] += table[view] * linear->error[j];
            for (int k = 0; k < n; k++)
                h[j * n + k] += table[view] * table[view] * linear->gram[j][k];
        }
    }
    for (int j = 0; j < n; j++)
        trace += h[j * n + j];
    for (int j = 0; j < n; j++)
        h[j * n + j] += 1e-9 * h[j * n + j] + 1e-14 * trace + 1e-300;
    weft_linear solution = linear_of_fit(&trial->fit);
    if (weft_solve_box(n, h, g, low, high, solution.x))
        linear_to_fit(&solution, &trial->fit);
}

/* ---- All parameters ---- */

/* The derivative of f by one parameter: `weight` over the columns [first, end). */
typedef struct derivative {
    int first, end;
    double weight[WEFT_GRAM_COLUMNS];
} derivative;

static void cross(const double *a, const double *b, double *result)
{
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
}

static void lobe_derivatives(const weft_fit_lobe *lobe, int i, double rows[3][3], const direction local_view,
                             const direction m, derivative *by)
{
    int block = 1 + 4 * i, next = 1;
    double exponent = exp(lobe->log_exponent), factor = lobe->amplitude * exponent;
    by[0] = (derivative){.first = block, .end = block + 3};
    memcpy(by[0].weight + block, m, sizeof(direction));
    for (int k = 0; k < 3; k++) {
        if (k == weft_lobe_fixed(lobe))
            continue;
        by[next] = (derivative){.first = block, .end = block + 3};
        for (int axis = 0; axis < 3; axis++)
            by[next].weight[block + axis] = factor * local_view[k] * rows[k][axis];
        next++;
    }
    by[3] = (derivative){.first = block + 3, .end = block + 4};
    by[3].weight[block + 3] = factor * LN2;
}

/* A small rotation w turns l' into l' + w x l' and v' likewise: db = l' . (p x w + c o (w x v')). */
static void frame_derivatives(const weft_fit *fit, double rows[3][3], const direction local_view, const direction *p,
                              derivative *by)
{
    for (int k = 0; k < 3; k++) {
        by[k] = (derivative){.first = 1, .end = 1 + 4 * fit->lobe_count};
        const double w[3] = {k == 0, k == 1, k == 2};
        for (int i = 0; i < fit->lobe_count; i++) {
            const weft_fit_lobe *lobe = &fit->lobe[i];
            double factor = lobe->amplitude * exp(lobe->log_exponent), turned[3], moved[3];
            cross(p[i], w, turned);
            cross(w, local_view, moved);
            for (int axis = 0; axis < 3; axis++) {
                for (int row = 0; row < 3; row++)
                    by[k].weight[1 + 4 * i + axis] +=
                        factor * rows[row][axis] * (turned[row] + lobe->c[row] * moved[row]);
            }
        }
    }
}

static void add_view(int n, const derivative *by, const float *sums, const double *f, const double *error_weight,
                     const view_state *state, int columns, weft_normal *normal)
{
    double product_of[WEFT_SOLVE_MAX][WEFT_GRAM_COLUMNS], s[WEFT_SOLVE_MAX];
    for (int p = 0; p < n; p++) {
        double error = 0, along = 0;
        for (int c = 0; c < columns; c++) {
            double sum = 0;
            for (int k = by[p].first; k < by[p].end; k++)
                sum += by[p].weight[k] * gram_at(sums, k, c);
            product_of[p][c] = sum;
            error += sum * error_weight[c];
            along += c < columns - 1 ? sum * f[c] : 0;
        }
        s[p] = along;
        normal->g[p] += state->t * error;
    }
    double t2 = state->t * state->t;
    for (int p = 0; p < n; p++) {
        for (int q = 0; q <= p; q++) {
            double sum = state->eliminated ? -s[p] * s[q] / state->ff : 0;
            for (int k = by[q].first; k < by[q].end; k++)
                sum += product_of[p][k] * by[q].weight[k];
            normal->h[p * n + q] += t2 * sum;
        }
    }
}

/* f and r - T f as combinations of the columns. */
static void expand_columns(const weft_fit *fit, const direction *m, const view_state *state, double *f, double *error)
{
    f[0] = fit->diffuse;
    error[0] = state->delta[0];
    for (int i = 0; i < fit->lobe_count; i++) {
        for (int k = 0; k < 3; k++) {
            f[1 + 4 * i + k] = fit->lobe[i].amplitude * m[i][k];
            error[1 + 4 * i + k] = state->delta[1 + i] * m[i][k];
        }
        f[4 + 4 * i] = error[4 + 4 * i] = 0;
    }
    error[1 + 4 * fit->lobe_count] = 1;
}

/* T leaves the overall scale of rho and A free: give that direction the curvature it would have with T fixed. */
static void fix_scale(const weft_fit *fit, double scale, weft_normal *normal)
{
    double x[WEFT_SOLVE_MAX] = {fit->diffuse}, length = fit->diffuse * fit->diffuse;
    for (int i = 0; i < fit->lobe_count; i++) {
        x[1 + 4 * i] = fit->lobe[i].amplitude;
        length += x[1 + 4 * i] * x[1 + 4 * i];
    }
    for (int p = 0; length > 0 && p < normal->n; p++) {
        for (int q = 0; q < normal->n; q++)
            normal->h[p * normal->n + q] += scale * x[p] * x[q] / (length * length);
    }
}

void weft_normal_of_trial(const weft_bundle *bundle, bool with_table, bool rotate, const weft_trial *trial,
                          weft_normal *normal)
{
    const weft_fit *fit = &trial->fit;
    int n = 1 + 4 * fit->lobe_count + (rotate && fit->lobe_count ? 3 : 0), columns = weft_gram_columns(fit->lobe_count);
    double rows[3][3], scale = 0;
    weft_linear linear = linear_of_fit(fit);
    weft_frame_rows(&fit->frame, rows);
    memset(normal, 0, sizeof *normal);
    normal->n = n;
    for (int view = 0; view < bundle->view_count; view++) {
        direction local_view, p[WEFT_GRAM_LOBES], m[WEFT_GRAM_LOBES];
        derivative by[WEFT_SOLVE_MAX] = {{.first = 0, .end = 1, .weight = {1}}};
        double f[WEFT_GRAM_COLUMNS] = {0}, error[WEFT_GRAM_COLUMNS] = {0};
        view_state state = state_of_view(trial, view, with_table, linear.x);
        shapes_of_view(fit, rows, bundle->view[view], &local_view, p, m);
        for (int i = 0; i < fit->lobe_count; i++)
            lobe_derivatives(&fit->lobe[i], i, rows, local_view, m[i], by + 1 + 4 * i);
        if (n > 1 + 4 * fit->lobe_count)
            frame_derivatives(fit, rows, local_view, (const direction *)p, by + 1 + 4 * fit->lobe_count);
        expand_columns(fit, (const direction *)m, &state, f, error);
        add_view(n, by, trial->sums + (size_t)view * WEFT_GRAM_STRIDE * WEFT_GRAM_STRIDE, f, error, &state, columns,
                 normal);
        scale += state.eliminated ? state.t * state.t * state.ff : 0;
    }
    for (int p = 0; p < n; p++) {
        for (int q = 0; q < p; q++)
            normal->h[q * n + p] = normal->h[p * n + q];
    }
    fix_scale(fit, scale, normal);
}
