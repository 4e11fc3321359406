#include "compress/fit/normal.h"

#include "compress/fit/kernels.h"

#include <math.h>
#include <string.h>

#define LINEAR_TOLERANCE 1e-4 /* part of the residual that a further step of rho and the amplitudes must promise */
#define MOST_CONTRAST 8       /* of T against its mean */

enum { LINEAR_ROUNDS = 4 };

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

weft_linear weft_linear_of_fit(const weft_fit *fit)
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

void weft_trial_digest(const weft_bundle *bundle, weft_trial *trial)
{
    trial->negligible = 1e-9 * WEFT_DISPATCH(weft_linear_digest)(bundle, trial) / bundle->view_count;
}

/* The residual and its normal equations at some linear parameters. */
typedef struct linear_state {
    weft_linear linear;
    double residual, h[WEFT_LINEAR_MAX * WEFT_LINEAR_MAX], g[WEFT_LINEAR_MAX];
} linear_state;

/* Gauss-Newton, the amplitudes no lower than `least` and none higher than `most`; false where it promises no
 * more than `least_gain`. */
static bool linear_step(const linear_state *now, int n, const double *least, double most, double least_gain,
                        weft_linear *next)
{
    double h[WEFT_LINEAR_MAX * WEFT_LINEAR_MAX], low[WEFT_LINEAR_MAX], high[WEFT_LINEAR_MAX];
    double d[WEFT_LINEAR_MAX] = {0}, trace = 0;
    memcpy(h, now->h, sizeof h);
    for (int j = 0; j < n; j++) {
        low[j] = fmin(0, (j ? least[j - 1] : 0) - now->linear.x[j]);
        high[j] = fmax(0, most - now->linear.x[j]);
        trace += h[j * n + j];
    }
    for (int j = 0; j < n; j++)
        h[j * n + j] += 1e-7 * h[j * n + j] + 1e-12 * trace + 1e-300;
    if (!weft_quadratic_program_solve(n, h, now->g, low, high, d))
        return false;
    double gain = 0;
    for (int j = 0; j < n; j++) {
        next->x[j] = now->linear.x[j] + d[j];
        gain += d[j] * now->g[j];
    }
    return gain > least_gain;
}

void weft_trial_solve_linear(const weft_bundle *bundle, bool with_table, const double *least, weft_trial *trial)
{
    linear_state now = {.linear = weft_linear_of_fit(&trial->fit)}, next;
    now.residual = WEFT_DISPATCH(weft_linear_normal)(bundle, trial, with_table, &now.linear, now.h, now.g);
    for (int round = 0; round < LINEAR_ROUNDS; round++) {
        double least_gain = round == 0 ? 0 : LINEAR_TOLERANCE * now.residual;
        if (!linear_step(&now, trial->fit.lobe_count + 1, least, trial->most, least_gain, &next.linear))
            break;
        next.residual = WEFT_DISPATCH(weft_linear_normal)(bundle, trial, with_table, &next.linear, next.h, next.g);
        if (!(next.residual < now.residual))
            break;
        now = next;
    }
    linear_to_fit(&now.linear, &trial->fit);
    trial->residual = WEFT_DISPATCH(weft_linear_residual)(bundle, trial, with_table, &now.linear, trial->table);
}

void weft_trial_model_energy(const weft_bundle *bundle, const weft_trial *trial, const weft_fit *fit, double *energy)
{
    const weft_linear linear = weft_linear_of_fit(fit);
    for (int view = 0; view < bundle->view_count; view++) {
        energy[view] = 0;
        for (int j = 0; j <= fit->lobe_count; j++) {
            for (int k = 0; k <= fit->lobe_count; k++)
                energy[view] += linear.x[j] * linear.x[k] *
                                (double)trial->linear[weft_linear_gram(j, k) * bundle->view_stride + view];
        }
    }
}

double weft_trial_moderate_residual(const weft_bundle *bundle, const weft_trial *trial)
{
    double energy[WEFT_MATERIAL_MAX_VIEWS], sum = 0, weight = 0, residual = trial->residual;
    if (!(residual > 0))
        return residual;
    weft_trial_model_energy(bundle, trial, &trial->fit, energy);
    for (int view = 0; view < bundle->view_count; view++) {
        double t = (double)trial->table[view], explained = energy[view] * t * t;
        sum += explained > 0 ? explained * log(t) : 0;
        weight += explained;
    }
    double mean = weight > 0 ? exp(sum / weight) : 1;
    for (int view = 0; view < bundle->view_count; view++) {
        double t = (double)trial->table[view], moderate = fmin(fmax(t, mean / MOST_CONTRAST), mean * MOST_CONTRAST);
        residual += energy[view] * (moderate - t) * (moderate - t);
    }
    return residual;
}

void weft_trial_table(const weft_bundle *bundle, const weft_trial *trial, const weft_fit *fit, double *table)
{
    const weft_linear linear = weft_linear_of_fit(fit);
    WEFT_DISPATCH(weft_linear_residual)(bundle, trial, true, &linear, trial->table);
    weft_trial_take_table(bundle, trial, table);
}

void weft_trial_take_table(const weft_bundle *bundle, const weft_trial *trial, double *table)
{
    double sum = 0;
    int seen = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        if (trial->linear[view] > 0) {
            sum += (double)trial->table[view];
            seen++;
        }
    }
    for (int view = 0; view < bundle->view_count; view++)
        table[view] = trial->linear[view] > 0 ? (double)trial->table[view] : seen ? sum / seen : 1;
}

/* <column j | r>: r = e + T f at the parameters of the pass. */
static double column_sample(const weft_trial *trial, int j, int stride, int view)
{
    double sum = 0;
    for (int k = 0; k <= trial->fit.lobe_count; k++)
        sum += trial->at.x[k] * (double)trial->linear[weft_linear_gram(j, k) * stride + view];
    return sum * (double)trial->pass_table[view] + (double)trial->linear[(WEFT_LINEAR_ERROR + j) * stride + view];
}

void weft_trial_solve_given_table(const weft_bundle *bundle, const weft_trial *trial, const double *table,
                                  const double *low, const double *high, weft_fit *fit)
{
    int n = fit->lobe_count + 1, stride = bundle->view_stride;
    double h[WEFT_LINEAR_MAX * WEFT_LINEAR_MAX] = {0}, g[WEFT_LINEAR_MAX] = {0}, trace = 0;
    for (int view = 0; view < bundle->view_count; view++) {
        for (int j = 0; j < n; j++) {
            g[j] += table[view] * column_sample(trial, j, stride, view);
            for (int k = 0; k < n; k++)
                h[j * n + k] +=
                    table[view] * table[view] * (double)trial->linear[weft_linear_gram(j, k) * stride + view];
        }
    }
    for (int j = 0; j < n; j++)
        trace += h[j * n + j];
    for (int j = 0; j < n; j++)
        h[j * n + j] += 1e-9 * h[j * n + j] + 1e-14 * trace + 1e-300;
    weft_linear solution = weft_linear_of_fit(fit);
    if (weft_quadratic_program_solve(n, h, g, low, high, solution.x))
        linear_to_fit(&solution, fit);
}

/* T leaves the overall scale of rho and A free: give that direction the curvature it would have with T fixed. */
static void fix_scale(const weft_fit *fit, double scale, weft_normal *normal)
{
    double x[WEFT_NORMAL_MAX] = {fit->diffuse}, length = fit->diffuse * fit->diffuse;
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
    *normal = (weft_normal){.n = 1 + 4 * trial->fit.lobe_count + (rotate && trial->fit.lobe_count ? 3 : 0)};
    double scale = WEFT_DISPATCH(weft_fit_normal)(bundle, trial, with_table, rotate, normal);
    fix_scale(&trial->fit, scale, normal);
}
