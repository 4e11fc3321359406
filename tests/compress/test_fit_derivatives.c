/* The gradient and the matrix of a Gauss-Newton step against finite differences of the model in double precision, by
 * every parameter (rho; A, the free components of c and ln N of each lobe; the rotations of the frame), with T
 * eliminated and without T, for every instruction set that this processor has. */
#include "base/processor.h"
#include "compress/fit/workspace.h"
#include "texel_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = WEFT_NORMAL_MAX };

/* ---- The model, from its definition in compress/fit/fit.h ---- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double model_at(const weft_fit *fit, const double light[3], const double view[3])
{
    const weft_vec3 axis[3] = {fit->frame.tangent, fit->frame.bitangent, fit->frame.normal};
    double value = fit->diffuse;
    for (int i = 0; i < fit->lobe_count; i++) {
        double base = 0;
        for (int k = 0; k < 3; k++) {
            const double own[3] = {axis[k].x, axis[k].y, axis[k].z};
            base += fit->lobe[i].c[k] * dot(own, light) * dot(own, view);
        }
        value += base > 0 ? fit->lobe[i].amplitude * pow(base, exp(fit->lobe[i].log_exponent)) : 0;
    }
    return value;
}

/* The two components of c that are not the largest. */
static int free_component(const weft_fit_lobe *lobe, int which)
{
    int largest = 0;
    for (int k = 1; k < 3; k++)
        largest = fabs(lobe->c[k]) > fabs(lobe->c[largest]) ? k : largest;
    return which == 0 ? (largest == 0) : 3 - largest - (largest == 0);
}

/* The coordinates of every direction in the frame turn by `angle` about axis number `about` of the frame. */
static void turn_frame(weft_frame *frame, int about, double angle)
{
    weft_vec3 *axis[3] = {&frame->tangent, &frame->bitangent, &frame->normal};
    weft_vec3 *a = axis[(about + 1) % 3], *b = axis[(about + 2) % 3], old = *a;
    *a = weft_subtract(weft_scale(old, cos(angle)), weft_scale(*b, sin(angle)));
    *b = weft_add(weft_scale(old, sin(angle)), weft_scale(*b, cos(angle)));
}

/* The fit with parameter `p` larger by `step`, in the order of compress/fit/normal.h. */
static weft_fit moved(weft_fit fit, int p, double step)
{
    int lobes = 4 * fit.lobe_count;
    if (p == 0) {
        fit.diffuse += step;
    } else if (p > lobes) {
        turn_frame(&fit.frame, p - 1 - lobes, step);
    } else {
        weft_fit_lobe *lobe = &fit.lobe[(p - 1) / 4];
        switch ((p - 1) % 4) {
        case 0:
            lobe->amplitude += step;
            break;
        case 3:
            lobe->log_exponent += step;
            break;
        default:
            lobe->c[free_component(lobe, (p - 1) % 4 - 1)] += step;
        }
    }
    return fit;
}

/* ---- What a step needs, from its definition in compress/fit/normal.h ---- */

/* k f and its derivatives for every sample. */
typedef struct samples_of_model {
    double *f, *df[MOST];
} samples_of_model;

/* Products of a view. */
typedef struct view_sums {
    double ff, fr, rr, df_f[MOST], df_r[MOST], df_df[MOST][MOST];
} view_sums;

typedef struct expectation {
    double h[MOST][MOST], g[MOST];
    double strength[MOST]; /* sum of T^2 <df|df>: what bounds the others by Cauchy and Schwarz */
    double residual;
    double scale; /* sum of <T f|T f> where T follows f */
} expectation;

static void model_all(const texel_fixture *x, const weft_fit *fit, double *result)
{
    const weft_bundle *b = &x->bundle;
    for (int i = 0; i < b->sample_count; i++) {
        const double light[3] = {(double)b->light[0][i], (double)b->light[1][i], (double)b->light[2][i]};
        weft_vec3 v = b->view[b->view_of[i]];
        const double view[3] = {v.x, v.y, v.z};
        result[i] = b->image[i] < 0 ? 0 : (double)x->samples.cosine[i] * model_at(fit, light, view);
    }
}

static void differentiate(const texel_fixture *x, const weft_fit *fit, int n, samples_of_model *to)
{
    const double step = 1e-5;
    size_t count = (size_t)x->bundle.sample_count;
    double *above = malloc(count * sizeof *above);
    to->f = malloc(count * sizeof *to->f);
    model_all(x, fit, to->f);
    for (int p = 0; p < n; p++) {
        weft_fit high = moved(*fit, p, step), low = moved(*fit, p, -step);
        to->df[p] = malloc(count * sizeof *to->df[p]);
        model_all(x, &high, above);
        model_all(x, &low, to->df[p]);
        for (size_t i = 0; i < count; i++)
            to->df[p][i] = (above[i] - to->df[p][i]) / (2 * step);
    }
    free(above);
}

static void add_samples(const texel_fixture *x, const samples_of_model *at, int n, view_sums *sums)
{
    for (int i = 0; i < x->bundle.sample_count; i++) {
        if (x->bundle.image[i] < 0)
            continue;
        view_sums *s = &sums[x->bundle.view_of[i]];
        double f = at->f[i], r = (double)x->samples.value[WEFT_GREY][i];
        s->ff += f * f, s->fr += f * r, s->rr += r * r;
        for (int p = 0; p < n; p++) {
            s->df_f[p] += at->df[p][i] * f;
            s->df_r[p] += at->df[p][i] * r;
            for (int q = 0; q < n; q++)
                s->df_df[p][q] += at->df[p][i] * at->df[q][i];
        }
    }
}

static expectation expect(const texel_fixture *x, const weft_fit *fit, int n, bool with_table)
{
    expectation e = {.residual = 0};
    samples_of_model at;
    view_sums *sums = calloc((size_t)x->bundle.view_count, sizeof *sums);
    differentiate(x, fit, n, &at);
    add_samples(x, &at, n, sums);
    for (int v = 0; v < x->bundle.view_count; v++) {
        const view_sums *s = &sums[v];
        double t = with_table ? s->fr / s->ff : 1, eliminated = with_table ? 1 / s->ff : 0;
        e.scale += with_table ? t * t * s->ff : 0;
        e.residual += s->rr - 2 * t * s->fr + t * t * s->ff;
        for (int p = 0; p < n; p++) {
            e.g[p] += t * (s->df_r[p] - t * s->df_f[p]);
            e.strength[p] += t * t * s->df_df[p][p];
            for (int q = 0; q < n; q++)
                e.h[p][q] += t * t * (s->df_df[p][q] - eliminated * s->df_f[p] * s->df_f[q]);
        }
    }
    for (int p = 0; p < n; p++)
        free(at.df[p]);
    free(at.f);
    free(sums);
    return e;
}

/* Half of how fast the residual falls along a parameter, T eliminated anew on either side. */
static double half_fall(const texel_fixture *x, const weft_fit *fit, int p, bool with_table)
{
    const double step = 1e-4;
    weft_fit high = moved(*fit, p, step), low = moved(*fit, p, -step);
    return (expect(x, &low, 0, with_table).residual - expect(x, &high, 0, with_table).residual) / (4 * step);
}

/* ---- What the kernels say ---- */

static weft_normal normal_of(texel_fixture *x, const weft_fit *fit, int n, bool with_table, weft_instruction_set set)
{
    weft_fit_options options = weft_fit_default_options();
    weft_trial *trial = &x->workspace->trial[0];
    weft_normal normal = {.n = n};
    options.table = with_table;
    weft_processor_limit(set);
    trial->fit = *fit;
    weft_workspace_pass(&x->bundle, &x->samples, WEFT_GREY, &options, NULL, trial);
    WEFT_DISPATCH(weft_fit_normal)(&x->bundle, trial, with_table, n > 1 + 4 * fit->lobe_count, &normal);
    return normal;
}

static void expect_near(const char *what, int p, int q, double value, double expected, double scale)
{
    if (!(fabs(value - expected) <= 5e-4 * scale))
        fail_msg("%s of parameters %d, %d is %g, should be %g (of the order of %g)", what, p, q, value, expected,
                 scale);
}

static void compare(const expectation *e, const weft_normal *normal)
{
    int n = normal->n;
    for (int p = 0; p < n; p++) {
        expect_near("gradient", p, p, normal->g[p], e->g[p], sqrt(e->strength[p] * e->residual));
        for (int q = 0; q < n; q++)
            expect_near("matrix", p, q, normal->h[p * n + q], e->h[p][q], sqrt(e->strength[p] * e->strength[q]));
    }
}

/* A point of no particular merit, away from where any derivative vanishes. */
static weft_fit some_fit(int lobes, uint64_t seed)
{
    weft_fit fit = {.diffuse = 0.3, .lobe_count = lobes};
    for (int i = 0; i < lobes; i++) {
        weft_fit_lobe *lobe = &fit.lobe[i];
        int largest = (int)((seed + (uint64_t)i) % 3);
        for (int k = 0; k < 3; k++)
            lobe->c[k] = k == largest ? 1 : 1.4 * synthetic_uniform(&seed) - 0.7;
        lobe->log_exponent = log(2 + 10 * synthetic_uniform(&seed));
        lobe->amplitude = 0.4 + synthetic_uniform(&seed);
    }
    weft_vec3 tilted = weft_vec3_of(0.6 * synthetic_uniform(&seed) - 0.3, 0.6 * synthetic_uniform(&seed) - 0.3, 1);
    fit.frame = weft_frame_of_normal(weft_unit(tilted), 3 * synthetic_uniform(&seed));
    return fit;
}

static void every_derivative_is_that_of_the_model(void **state)
{
    texel_fixture *x = *state;
    for (uint64_t seed = 0; seed < 24; seed++) {
        int lobes = (int)(seed % 4), n = 1 + 4 * lobes + (lobes > 0 && seed % 8 > 3 ? 3 : 0);
        bool with_table = seed % 12 < 8;
        weft_fit fit = some_fit(lobes, 1000 + seed);
        texel_fixture_fill(x, (synthetic_kind)(seed % SYNTHETIC_KINDS), 64 * seed, 0.1);
        expectation e = expect(x, &fit, n, with_table);
        for (int p = 0; p < n; p++)
            expect_near("fall", p, p, half_fall(x, &fit, p, with_table), e.g[p], sqrt(e.strength[p] * e.residual));
        for (weft_instruction_set set = WEFT_BASELINE; set <= weft_processor_best(); set++) {
            weft_normal normal = normal_of(x, &fit, n, with_table, set);
            compare(&e, &normal);
        }
    }
}

/* The inner problem, in rho and the amplitudes alone, at other values than those of the pass. Their common scale, which
 * T leaves free, gets the curvature that it would have with T fixed. */
static expectation expect_linear(const texel_fixture *x, const weft_fit *fit, bool with_table)
{
    int n = 1 + fit->lobe_count;
    const weft_linear linear = weft_linear_of_fit(fit);
    expectation all = expect(x, fit, 1 + 4 * fit->lobe_count, with_table), e = {.residual = all.residual};
    double length = 0;
    for (int p = 0; p < n; p++)
        length += linear.x[p] * linear.x[p];
    for (int p = 0; p < n; p++) {
        int from = p ? 4 * p - 3 : 0;
        e.g[p] = all.g[from];
        e.strength[p] = all.strength[from];
        for (int q = 0; q < n; q++)
            e.h[p][q] = all.h[from][q ? 4 * q - 3 : 0] + all.scale * linear.x[p] * linear.x[q] / (length * length);
    }
    return e;
}

static void linear_derivatives_follow_from_the_same_sums(void **state)
{
    texel_fixture *x = *state;
    for (uint64_t seed = 0; seed < 16; seed++) {
        int lobes = (int)(seed % 4), n = 1 + lobes;
        bool with_table = seed % 8 < 5;
        weft_fit fit = some_fit(lobes, 2000 + seed), other = fit;
        texel_fixture_fill(x, SYNTHETIC_YARN, 64 * seed, 0.1);
        other.diffuse *= 1.3;
        for (int i = 0; i < lobes; i++)
            other.lobe[i].amplitude *= 0.7 + 0.2 * i;
        expectation e = expect_linear(x, &other, with_table);
        for (weft_instruction_set set = WEFT_BASELINE; set <= weft_processor_best(); set++) {
            weft_normal normal = normal_of(x, &fit, 1 + 4 * lobes, with_table, set);
            const weft_linear linear = weft_linear_of_fit(&other);
            const weft_trial *trial = &x->workspace->trial[0];
            normal.n = n;
            double residual =
                WEFT_DISPATCH(weft_linear_normal)(&x->bundle, trial, with_table, &linear, normal.h, normal.g);
            compare(&e, &normal);
            expect_near("residual", 0, 0, residual, e.residual, x->samples.energy[WEFT_GREY]);
        }
    }
}

int test_fit_derivatives(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_derivative_is_that_of_the_model),
        cmocka_unit_test(linear_derivatives_follow_from_the_same_sums),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
