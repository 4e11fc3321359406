#include "compress/fit/workspace.h"

#include <math.h>
#include <string.h>

#define LEAST_TILT_COSINE 0.35 /* normals beyond 70 degrees are not believed */

/* Brings the largest component of c back to +-1. The amplitude stays: A times (largest)^N is exact but explodes for
 * high N, and the next pass solves for A anyway. */
static void normalise_lobe(weft_fit_lobe *lobe)
{
    double largest = fabs(lobe->c[weft_lobe_fixed(lobe)]);
    if (!(largest > 0)) {
        *lobe = (weft_fit_lobe){.c = {0, 0, 1}, .log_exponent = lobe->log_exponent, .amplitude = lobe->amplitude};
        return;
    }
    for (int k = 0; k < 3; k++)
        lobe->c[k] /= largest;
}

/* Turns the coordinates of a frame by the small rotation w: new l' = l' + w x l' to first order. */
static void rotate_frame(const double w[3], weft_frame *frame)
{
    double angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    if (!(angle > 0))
        return;
    double rows[3][3], turned[3][3];
    weft_frame_rows(frame, rows);
    const double axis[3] = {w[0] / angle, w[1] / angle, w[2] / angle};
    const double skew[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int column = 0; column < 3; column++) {
            double sum = cos(angle) * rows[i][column];
            for (int k = 0; k < 3; k++)
                sum += (sin(angle) * skew[i][k] + (1 - cos(angle)) * axis[i] * axis[k]) * rows[k][column];
            turned[i][column] = sum;
        }
    }
    frame->normal = weft_unit(weft_vec3_of(turned[2][0], turned[2][1], turned[2][2]));
    weft_vec3 tangent = weft_vec3_of(turned[0][0], turned[0][1], turned[0][2]);
    tangent = weft_subtract(tangent, weft_scale(frame->normal, weft_dot(tangent, frame->normal)));
    frame->tangent = weft_unit(tangent);
    frame->bitangent = weft_cross(frame->normal, frame->tangent);
}

static void step_bounds(const weft_fit *fit, const weft_fit_options *options, int n, double *low, double *high)
{
    low[0] = -fit->diffuse;
    high[0] = INFINITY;
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        int at = 1 + 4 * i, next = 1;
        low[at] = -0.9 * lobe->amplitude;
        high[at] = fmax(0, options->max_amplitude - lobe->amplitude);
        for (int k = 0; k < 3; k++) {
            if (k == weft_lobe_fixed(lobe))
                continue;
            low[at + next] = fmax(-0.5, -1.5 - lobe->c[k]);
            high[at + next] = fmin(0.5, 1.5 - lobe->c[k]);
            next++;
        }
        low[at + 3] = fmin(0, fmax(-1.2, -lobe->log_exponent));
        high[at + 3] = fmax(0, fmin(1.2, log(options->max_exponent) - lobe->log_exponent));
    }
    for (int p = 1 + 4 * fit->lobe_count; p < n; p++) {
        low[p] = -0.3;
        high[p] = 0.3;
    }
}

static void apply_step(const double *d, int n, weft_fit *fit)
{
    fit->diffuse = fmax(0, fit->diffuse + d[0]);
    for (int i = 0; i < fit->lobe_count; i++) {
        weft_fit_lobe *lobe = &fit->lobe[i];
        const double *own = d + 1 + 4 * i;
        int fixed = weft_lobe_fixed(lobe), next = 1;
        lobe->amplitude = fmax(0, lobe->amplitude + own[0]);
        for (int k = 0; k < 3; k++)
            lobe->c[k] += k == fixed ? 0 : own[next++];
        lobe->log_exponent = fmax(0, lobe->log_exponent + own[3]);
        normalise_lobe(lobe);
    }
    if (n > 1 + 4 * fit->lobe_count)
        rotate_frame(d + 1 + 4 * fit->lobe_count, &fit->frame);
}

/* By how much the quadratic model says that a step lowers the residual. */
static double predicted_gain(const weft_normal *normal, const double *d)
{
    double gain = 0;
    for (int p = 0; p < normal->n; p++) {
        gain += 2 * normal->g[p] * d[p];
        for (int q = 0; q < normal->n; q++)
            gain -= d[p] * normal->h[p * normal->n + q] * d[q];
    }
    return gain;
}

/* The damped step from `normal` and what it promises; false where there is none. */
static bool make_step(const weft_normal *normal, double damping, const weft_fit_options *options, weft_fit *fit,
                      double *gain)
{
    int n = normal->n;
    double h[WEFT_NORMAL_MAX * WEFT_NORMAL_MAX], low[WEFT_NORMAL_MAX], high[WEFT_NORMAL_MAX], d[WEFT_NORMAL_MAX] = {0};
    double trace = 0;
    memcpy(h, normal->h, sizeof h);
    for (int p = 0; p < n; p++)
        trace += h[p * n + p];
    for (int p = 0; p < n; p++)
        h[p * n + p] += damping * h[p * n + p] + 1e-10 * trace + 1e-300;
    step_bounds(fit, options, n, low, high);
    if (!weft_quadratic_program_solve(n, h, normal->g, low, high, d))
        return false;
    apply_step(d, n, fit);
    *gain = predicted_gain(normal, d);
    return fit->frame.normal.z >= LEAST_TILT_COSINE;
}

/* Factor of the damping after a step that kept `share` of what it promised: Nielsen 1999. One that kept little is not
 * followed by a bolder one, which would cost a pass for nothing. */
static double ease(double share)
{
    return fmin(2, fmax(0.1, 1 - pow(2 * share - 1, 3)));
}

/* All further steps rarely gain more than so many times what the next one promises. */
#define FURTHER 4

/* Whether the next step promises so little that the search will not get where it is wanted. */
static bool is_hopeless(const weft_fit_options *options, double left, double gain)
{
    return options->wanted > 0 && left - FURTHER * gain >= options->wanted;
}

/* Whether the next step promises next to nothing. What the last one brought says less: a damped step is short, and the
 * one after it may reach far. */
static bool has_converged(const weft_fit_options *options, double left, double gain)
{
    return gain < 0.5 * options->tolerance * left;
}

void weft_workspace_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                           const weft_fit_options *options, weft_fit_workspace *workspace, double damping)
{
    weft_trial *now = &workspace->trial[0], *next = &workspace->trial[1];
    double enough = 1e-10 * samples->energy[channel];
    while (now->residual > enough) {
        weft_normal normal;
        weft_normal_of_trial(bundle, options->table, options->fit_frame, now, &normal);
        bool accepted = false;
        while (!accepted) {
            double gain = 0;
            if (now->fit.passes >= options->max_passes || !(damping < 1e5))
                return;
            next->fit = now->fit;
            if (make_step(&normal, damping, options, &next->fit, &gain)) {
                if (has_converged(options, now->residual, gain) || is_hopeless(options, now->residual, gain))
                    return;
                weft_workspace_begin_warm(bundle, samples, channel, options, now->table, next);
                accepted = next->residual < now->residual;
            }
            now->fit.passes = next->fit.passes;
            damping = fmax(1e-6, damping * (accepted ? ease((now->residual - next->residual) / gain) : 30));
        }
        weft_trial_swap(now, next);
    }
}

void weft_fit_refine(const weft_bundle *bundle, const weft_samples *samples, int channel,
                     const weft_fit_options *options, weft_fit_workspace *workspace, weft_fit *fit, double *table)
{
    if (weft_workspace_finish_empty(bundle, samples, channel, fit, table))
        return;
    weft_trial *now = &workspace->trial[0];
    now->fit = *fit;
    now->fit.passes = 0;
    weft_workspace_begin_warm(bundle, samples, channel, options, weft_workspace_keep_table(bundle, workspace, table),
                              now);
    weft_workspace_refine(bundle, samples, channel, options, workspace, 0.01);
    weft_workspace_finish(bundle, options, now, fit, table);
}
