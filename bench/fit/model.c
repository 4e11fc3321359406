#include "bench/fit/problem.h"

#include <math.h>

/* One lobe at a time over plain arrays, so that the compiler vectorises exp and log. */
static void add_lobe(problem *given, const double *x, int lobe, int begin, int end)
{
    const double *own = x + 1 + 4 * lobe;
    const double amplitude = own[0], cx = own[1], cy = own[2], exponent = exp(own[3]);
    const double *dx = given->product[0], *dy = given->product[1], *dz = given->product[2], *k = given->cosine;
    double *power = given->power[lobe], *log_base = given->log_base[lobe];
    double *model = given->model;
#pragma GCC ivdep
    for (int i = begin; i < end; i++) {
        double base = cx * dx[i] + cy * dy[i] + dz[i];
        double logarithm = log(base > 1e-30 ? base : 1e-30), raised = exp(exponent * logarithm);
        log_base[i] = logarithm;
        power[i] = base > 1e-30 ? raised : 0;
        model[i] += k[i] * amplitude * power[i];
    }
}

static void evaluate(problem *given, const double *x, int begin, int end)
{
    for (int i = begin; i < end; i++)
        given->model[i] = given->cosine[i] * x[0];
    for (int lobe = 0; lobe < given->lobe_count; lobe++)
        add_lobe(given, x, lobe, begin, end);
}

static void differentiate_lobe(problem *given, const double *x, int lobe, int begin, int end)
{
    const double *own = x + 1 + 4 * lobe;
    const double amplitude = own[0], exponent = exp(own[3]);
    const double *power = given->power[lobe], *log_base = given->log_base[lobe], *k = given->cosine;
    const double *dx = given->product[0], *dy = given->product[1], *dz = given->product[2];
    const long stride = given->sample_count;
    double *by_amplitude = given->column + stride * (1 + 4 * lobe);
    double *by_cx = by_amplitude + stride, *by_cy = by_cx + stride, *by_u = by_cy + stride;
#pragma GCC ivdep
    for (int i = begin; i < end; i++) {
        double base = own[1] * dx[i] + own[2] * dy[i] + dz[i];
        double lobe_value = k[i] * power[i], slope = amplitude * exponent * lobe_value;
        double by_base = base > 1e-30 ? slope / base : 0;
        by_amplitude[i] = lobe_value;
        by_cx[i] = by_base * dx[i];
        by_cy[i] = by_base * dy[i];
        by_u[i] = slope * log_base[i];
    }
}

static void differentiate(problem *given, const double *x, int begin, int end)
{
    for (int i = begin; i < end; i++)
        given->column[i] = given->cosine[i];
    for (int lobe = 0; lobe < given->lobe_count; lobe++)
        differentiate_lobe(given, x, lobe, begin, end);
}

/* MODEL_CODE is model_vector or model_scalar, as the build compiles it. */
const model_code MODEL_CODE = {evaluate, differentiate};
