#include "fit_minpack.h"

#include <cminpack.h>
#include <math.h>
#include <stdlib.h>

typedef struct problem {
    int lobe_count, count, view_count;
    double (*direction)[3]; /* [count] l v, component by component */
    double *cosine, *value, *table;
    int *view;
} problem;

/* max(0, a)^N of every lobe; the model without T. */
static double model(const problem *given, const double *x, int i, double power[3])
{
    double sum = x[0];
    for (int k = 0; k < given->lobe_count; k++) {
        const double *lobe = x + 1 + 4 * k, *d = given->direction[i];
        double a = lobe[0] * d[0] + lobe[1] * d[1] + lobe[2] * d[2];
        power[k] = a > 0 ? pow(a, lobe[3]) : 0;
        sum += power[k];
    }
    return given->cosine[i] * sum;
}

static void jacobian_row(const problem *given, const double *x, int i, double *jacobian, int stride)
{
    double power[3], factor = -given->table[given->view[i]] * given->cosine[i];
    model(given, x, i, power);
    jacobian[i] = factor;
    for (int k = 0; k < given->lobe_count; k++) {
        const double *lobe = x + 1 + 4 * k, *d = given->direction[i];
        double a = lobe[0] * d[0] + lobe[1] * d[1] + lobe[2] * d[2];
        for (int c = 0; c < 3; c++)
            jacobian[i + stride * (1 + 4 * k + c)] = a > 0 ? factor * lobe[3] * power[k] / a * d[c] : 0;
        jacobian[i + stride * (4 + 4 * k)] = a > 0 ? factor * power[k] * log(a) : 0;
    }
}

static int evaluate(void *context, int m, int n, const double *x, double *residual, double *jacobian, int stride,
                    int what)
{
    const problem *given = context;
    (void)n;
    for (int i = 0; i < m; i++) {
        double power[3];
        if (what == 1)
            residual[i] = given->value[i] - given->table[given->view[i]] * model(given, x, i, power);
        else
            jacobian_row(given, x, i, jacobian, stride);
    }
    return 0;
}

static double update_table(const problem *given, const double *x, double *fr, double *ff)
{
    double change = 0, power[3];
    for (int view = 0; view < given->view_count; view++)
        fr[view] = ff[view] = 0;
    for (int i = 0; i < given->count; i++) {
        double f = model(given, x, i, power);
        fr[given->view[i]] += f * given->value[i];
        ff[given->view[i]] += f * f;
    }
    for (int view = 0; view < given->view_count; view++) {
        double t = ff[view] > 0 ? fr[view] / ff[view] : 1;
        change += fabs(t - given->table[view]) / given->view_count;
        given->table[view] = t;
    }
    return change;
}

static void gather(const weft_bundle *bundle, const weft_samples *samples, int channel, problem *given)
{
    for (int view = 0; view < bundle->view_count; view++) {
        given->table[view] = 1;
        for (int lane = bundle->first_lane[view]; lane < bundle->first_lane[view + 1]; lane++) {
            if (!(samples->cosine[lane] > 0))
                continue;
            int i = given->count++;
            given->direction[i][0] = (double)bundle->light[0][lane] * bundle->view[view].x;
            given->direction[i][1] = (double)bundle->light[1][lane] * bundle->view[view].y;
            given->direction[i][2] = (double)bundle->light[2][lane] * bundle->view[view].z;
            given->cosine[i] = (double)samples->cosine[lane];
            given->value[i] = (double)samples->value[channel][lane];
            given->view[i] = view;
        }
    }
}

double minpack_alternate(const weft_bundle *bundle, const weft_samples *samples, int channel, int lobe_count,
                         double threshold)
{
    size_t lanes = (size_t)bundle->lane_count, views = (size_t)bundle->view_count;
    int n = 1 + 4 * lobe_count, pivot[13], work_size = 5 * n + bundle->lane_count;
    problem given = {.lobe_count = lobe_count, .view_count = bundle->view_count};
    given.direction = calloc(lanes, sizeof *given.direction);
    given.view = calloc(lanes, sizeof *given.view);
    double *memory = calloc(lanes * (size_t)(4 + n) + 3 * views + 5 * (size_t)n, sizeof *memory), residual = -1;
    if (given.direction && given.view && memory) {
        given.cosine = memory;
        given.value = memory + lanes;
        double *error = memory + 2 * lanes, *work = memory + 3 * lanes, *jacobian = work + lanes + 5 * n;
        given.table = jacobian + lanes * (size_t)n;
        gather(bundle, samples, channel, &given);
        double x[13] = {0.5, -0.8, -0.8 / 1.22, 1, 8, -0.8 / 1.22, -0.8, 1, 3, 0.1, 0.1, 0.9, 2};
        for (int round = 0; round < 20; round++) {
            lmder1(evaluate, &given, given.count, n, x, error, jacobian, given.count, 1e-3, pivot, work, work_size);
            if (update_table(&given, x, given.table + views, given.table + 2 * views) < threshold)
                break;
        }
        evaluate(&given, given.count, n, x, error, NULL, 0, 1);
        residual = 0;
        for (int i = 0; i < given.count; i++)
            residual += error[i] * error[i];
    }
    free(given.direction);
    free(given.view);
    free(memory);
    return isfinite(residual) ? residual : -1;
}
