/* The reference fit: Daubert et al. 2001, section 5, sample by sample in double. Slow on purpose: nothing in it is
 * clever. */
#include "tests/support/alternation.h"

#include "compress/fit/normal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One sample in the frame of the texel. */
typedef struct observation {
    double light[3], view[3], cosine, value;
    int bundle;
} observation;

typedef struct problem {
    observation *observations;
    int count, view_count;
    int parameter_count; /* rho; A, two free c, ln N of every lobe */
} problem;

static void local_of(const weft_frame *frame, weft_vec3 direction, double local[3])
{
    local[0] = weft_dot(frame->tangent, direction);
    local[1] = weft_dot(frame->bitangent, direction);
    local[2] = weft_dot(frame->normal, direction);
}

static weft_code gather(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_frame *frame,
                        problem *result, weft_error *error)
{
    size_t capacity = (size_t)bundle->sample_count + 1;
    *result = (problem){.observations = calloc(capacity, sizeof(observation)), .view_count = bundle->view_count};
    if (!result->observations)
        return weft_fail_memory(error, "observations", capacity * sizeof(observation));
    for (int i = 0; i < bundle->sample_count; i++) {
        if (!(samples->cosine[i] > 0))
            continue;
        observation *one = &result->observations[result->count++];
        *one = (observation){.cosine = (double)samples->cosine[i],
                             .value = (double)samples->value[channel][i],
                             .bundle = bundle->view_of[i]};
        local_of(frame, bundle->view[one->bundle], one->view);
        local_of(frame,
                 weft_vec3_of((double)bundle->light[0][i], (double)bundle->light[1][i], (double)bundle->light[2][i]),
                 one->light);
    }
    return WEFT_OK;
}

/* b^N; the base of a lobe, 0 or less where it does not shine. */
static double base_of(const weft_fit_lobe *lobe, const observation *at)
{
    double base = 0;
    for (int k = 0; k < 3; k++)
        base += lobe->c[k] * at->light[k] * at->view[k];
    return base;
}

static double model_without_table(const weft_fit *fit, const observation *at)
{
    double sum = fit->diffuse;
    for (int i = 0; i < fit->lobe_count; i++) {
        double base = base_of(&fit->lobe[i], at);
        sum += base > 0 ? fit->lobe[i].amplitude * pow(base, exp(fit->lobe[i].log_exponent)) : 0;
    }
    return at->cosine * sum;
}

/* Derivatives of the model without T by every parameter. */
static void derivatives(const weft_fit *fit, const observation *at, double *by)
{
    by[0] = at->cosine;
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        double *own = by + 1 + 4 * i, base = base_of(lobe, at), exponent = exp(lobe->log_exponent);
        memset(own, 0, 4 * sizeof *own);
        if (!(base > 0))
            continue;
        double power = at->cosine * pow(base, exponent);
        int next = 1;
        own[0] = power;
        for (int k = 0; k < 3; k++) {
            if (k != weft_lobe_fixed(lobe))
                own[next++] = lobe->amplitude * exponent * power / base * at->light[k] * at->view[k];
        }
        own[3] = lobe->amplitude * power * log(base) * exponent;
    }
}

static double residual_of(const problem *given, const weft_fit *fit, const double *table)
{
    double sum = 0;
    for (int i = 0; i < given->count; i++) {
        const observation *at = &given->observations[i];
        double difference = at->value - table[at->bundle] * model_without_table(fit, at);
        sum += difference * difference;
    }
    return sum;
}

static void normal_equations(const problem *given, const weft_fit *fit, const double *table, weft_normal *normal)
{
    int n = given->parameter_count;
    memset(normal, 0, sizeof *normal);
    normal->n = n;
    for (int i = 0; i < given->count; i++) {
        const observation *at = &given->observations[i];
        double by[WEFT_NORMAL_MAX], t = table[at->bundle];
        derivatives(fit, at, by);
        double difference = at->value - t * model_without_table(fit, at);
        for (int p = 0; p < n; p++) {
            normal->g[p] += t * by[p] * difference;
            for (int q = 0; q < n; q++)
                normal->h[p * n + q] += t * t * by[p] * by[q];
        }
    }
}

static void step_from(const weft_fit *start, const double *d, weft_fit *fit)
{
    *fit = *start;
    fit->diffuse += d[0];
    for (int i = 0; i < fit->lobe_count; i++) {
        weft_fit_lobe *lobe = &fit->lobe[i];
        const double *own = d + 1 + 4 * i;
        int fixed = weft_lobe_fixed(lobe), next = 1;
        lobe->amplitude += own[0];
        for (int k = 0; k < 3; k++)
            lobe->c[k] += k == fixed ? 0 : own[next++];
        lobe->log_exponent += own[3];
        double largest = fabs(lobe->c[weft_lobe_fixed(lobe)]);
        lobe->amplitude *= pow(largest, exp(lobe->log_exponent));
        for (int k = 0; k < 3; k++)
            lobe->c[k] /= largest;
    }
}

/* Levenberg-Marquardt on the lobes with T fixed. */
static void fit_lobes(const problem *given, const weft_fit_options *options, const double *table, weft_fit *fit)
{
    double damping = 0.1, residual = residual_of(given, fit, table);
    for (int round = 0; round < 100 && damping < 1e6 && residual > 0; round++) {
        weft_normal normal;
        normal_equations(given, fit, table, &normal);
        double low[WEFT_NORMAL_MAX], high[WEFT_NORMAL_MAX], d[WEFT_NORMAL_MAX] = {0};
        int n = normal.n;
        for (int p = 0; p < n; p++) {
            normal.h[p * n + p] *= 1 + damping;
            normal.h[p * n + p] += 1e-12;
            low[p] = -0.5;
            high[p] = 0.5;
        }
        low[0] = -fit->diffuse;
        high[0] = INFINITY;
        for (int i = 0; i < fit->lobe_count; i++) {
            low[1 + 4 * i] = -0.9 * fit->lobe[i].amplitude;
            high[1 + 4 * i] = INFINITY;
            low[4 + 4 * i] = fmax(-1.2, -fit->lobe[i].log_exponent);
            high[4 + 4 * i] = fmin(1.2, log(options->max_exponent) - fit->lobe[i].log_exponent);
        }
        weft_fit trial = *fit;
        double next = INFINITY;
        if (weft_quadratic_program_solve(n, normal.h, normal.g, low, high, d)) {
            step_from(fit, d, &trial);
            next = residual_of(given, &trial, table);
        }
        fit->passes += 2;
        if (!(next < residual)) {
            damping *= 10;
            continue;
        }
        bool converged = residual - next < options->tolerance * residual;
        *fit = trial;
        residual = next;
        damping *= 0.1;
        if (converged)
            break;
    }
}

/* Eq. 4 for every view; returns the mean change of T. */
static double update_table(const problem *given, const weft_fit *fit, double *table, double *fr, double *ff)
{
    memset(fr, 0, (size_t)given->view_count * sizeof *fr);
    memset(ff, 0, (size_t)given->view_count * sizeof *ff);
    double energy = 0, change = 0;
    for (int i = 0; i < given->count; i++) {
        const observation *at = &given->observations[i];
        double f = model_without_table(fit, at);
        fr[at->bundle] += f * at->value;
        ff[at->bundle] += f * f;
        energy += f * f;
    }
    for (int view = 0; view < given->view_count; view++) {
        double t = ff[view] > 1e-9 * energy / given->view_count ? fmax(0, fr[view] / ff[view]) : 1;
        change += fabs(t - table[view]);
        table[view] = t;
    }
    return change / given->view_count;
}

/* An average grey with moderate highlights, slightly anisotropic. */
static void place_paper_start(const problem *given, const weft_samples *samples, int channel, int lobe_count,
                              weft_fit *fit)
{
    double cosine = 0;
    for (int i = 0; i < given->count; i++)
        cosine += given->observations[i].cosine * given->observations[i].cosine;
    double grey = cosine > 0 ? sqrt(samples->energy[channel] / cosine) : 0;
    fit->diffuse = 0.7 * grey;
    fit->lobe_count = lobe_count;
    for (int i = 0; i < lobe_count; i++) {
        double cx = i == 1 ? -0.8 / 1.22 : -0.8, cy = i == 0 ? -0.8 / 1.22 : -0.8;
        fit->lobe[i] =
            (weft_fit_lobe){.c = {cx, cy, 1}, .log_exponent = log(8 / (1 + 2.0 * i)), .amplitude = 0.3 * grey};
    }
}

weft_code weft_fit_alternate(const weft_bundle *bundle, const weft_samples *samples, int channel,
                             const weft_fit_options *options, double threshold, int max_rounds, const weft_frame *frame,
                             weft_fit *fit, double *table, weft_error *error)
{
    problem given;
    WEFT_TRY(gather(bundle, samples, channel, frame, &given, error));
    double *sums = calloc(2 * (size_t)bundle->view_count, sizeof *sums);
    if (!sums) {
        free(given.observations);
        return weft_fail_memory(error, "sums of a view table", 2 * (size_t)bundle->view_count * sizeof *sums);
    }
    *fit = (weft_fit){.frame = *frame};
    place_paper_start(&given, samples, channel, options->lobe_count, fit);
    given.parameter_count = 1 + 4 * fit->lobe_count;
    for (int view = 0; view < bundle->view_count; view++)
        table[view] = 1;
    for (int round = 0; round < max_rounds; round++) {
        fit_lobes(&given, options, table, fit);
        if (!options->table || update_table(&given, fit, table, sums, sums + bundle->view_count) < threshold)
            break;
    }
    fit->residual = residual_of(&given, fit, table);
    free(sums);
    free(given.observations);
    return WEFT_OK;
}

double weft_fit_residual(const weft_bundle *bundle, const weft_samples *samples, int channel, const weft_fit *fit,
                         const double *table)
{
    double sum = 0;
    for (int i = 0; i < bundle->sample_count; i++) {
        observation at = {.bundle = bundle->view_of[i], .cosine = (double)samples->cosine[i]};
        weft_vec3 light =
            weft_vec3_of((double)bundle->light[0][i], (double)bundle->light[1][i], (double)bundle->light[2][i]);
        local_of(&fit->frame, bundle->view[at.bundle], at.view);
        local_of(&fit->frame, light, at.light);
        double difference = (double)samples->value[channel][i] - table[at.bundle] * model_without_table(fit, &at);
        sum += difference * difference;
    }
    return sum;
}
