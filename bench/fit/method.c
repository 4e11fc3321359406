#include "bench/fit/method.h"

#include "bench/fit/statistics.h"
#include "tests/support/alternation.h"

#ifdef WEFT_HAVE_CERES
#include "bench/fit/ceres_bridge.h"
#endif
#ifdef WEFT_HAVE_MINPACK
#include "bench/fit/minpack.h"
#endif

#include <math.h>
#include <stdlib.h>
#include <string.h>

weft_code bench_create(texel_source *source, const weft_fit_options *options, bench *with, weft_error *error)
{
    size_t views = (size_t)source->bundle.view_count;
    *with = (bench){.source = source, .options = *options};
    WEFT_TRY(problem_create(source, &with->plain, error));
    WEFT_TRY(weft_fit_workspace_create(&source->bundle, &with->workspace, error));
    with->table = calloc(2 * views, sizeof *with->table);
    if (!with->table)
        return weft_fail_memory(error, "view tables", 2 * views * sizeof *with->table);
    with->neighbour_table = with->table + views;
    return WEFT_OK;
}

void bench_free(bench *with)
{
    weft_fit_workspace_free(with->workspace);
    problem_free(&with->plain);
    free(with->table);
    *with = (bench){0};
}

static weft_frame upright(void)
{
    return weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
}

weft_code bench_load(bench *with, int index, int total, int channel, weft_error *error)
{
    const weft_frame frame = upright();
    texel_source *source = with->source;
    WEFT_TRY(texel_source_load(source, index, total, true, error));
    weft_fit_cold(&source->bundle, &source->samples, channel, &with->options, with->workspace, &frame, &with->neighbour,
                  with->neighbour_table);
    WEFT_TRY(texel_source_load(source, index, total, false, error));
    problem_load(source, channel, &with->options, &with->plain);
    return WEFT_OK;
}

bool method_available(method which)
{
#ifndef WEFT_HAVE_CERES
    if (which == METHOD_CERES_JOINT || which == METHOD_CERES_ALTERNATION)
        return false;
#endif
#ifndef WEFT_HAVE_MINPACK
    if (which == METHOD_MINPACK_JOINT || which == METHOD_MINPACK_ALTERNATION)
        return false;
#endif
    return which < METHOD_COUNT;
}

const char *method_name(method which)
{
    static const char *const name[METHOD_COUNT] = {
        [METHOD_FAST] = "fast: joint, from nothing",
        [METHOD_WARM] = "fast: joint, from the neighbour",
        [METHOD_REFERENCE] = "reference: alternation, double",
        [METHOD_CERES_JOINT] = "Ceres, joint, DENSE_SCHUR",
        [METHOD_CERES_ALTERNATION] = "Ceres, alternation, Cholesky",
        [METHOD_MINPACK_JOINT] = "MINPACK lmder, joint, T eliminated",
        [METHOD_MINPACK_ALTERNATION] = "MINPACK lmder, alternation",
    };
    return name[which];
}

/* Seconds are taken around the fit alone; the judge comes after. */
static outcome run_ours(bench *with, method which, int channel)
{
    const weft_bundle *bundle = &with->source->bundle;
    const weft_samples *samples = &with->source->samples;
    const weft_frame frame = upright();
    weft_error error = {0};
    weft_code code = WEFT_OK;
    weft_fit fit = {.passes = 0};
    double began = thread_microseconds();
    if (which == METHOD_FAST) {
        weft_fit_cold(bundle, samples, channel, &with->options, with->workspace, &frame, &fit, with->table);
    } else if (which == METHOD_WARM) {
        fit = with->neighbour;
        memcpy(with->table, with->neighbour_table, (size_t)bundle->view_count * sizeof *with->table);
        weft_fit_refine(bundle, samples, channel, &with->options, with->workspace, &fit, with->table);
    } else {
        code = weft_fit_alternate(bundle, samples, channel, &with->options, ALTERNATION_THRESHOLD, ALTERNATION_ROUNDS,
                                  &frame, &fit, with->table, &error);
    }
    outcome result = {.microseconds = thread_microseconds() - began, .passes = fit.passes, .residual = NAN};
    if (code == WEFT_OK)
        result.residual = weft_fit_residual(bundle, samples, channel, &fit, with->table);
    return result;
}

static int solve(problem *given, method which, solution *found)
{
#ifdef WEFT_HAVE_CERES
    if (which == METHOD_CERES_JOINT)
        return ceres_joint(given, found);
    if (which == METHOD_CERES_ALTERNATION)
        return ceres_alternate(given, ALTERNATION_THRESHOLD, ALTERNATION_ROUNDS, found);
#endif
#ifdef WEFT_HAVE_MINPACK
    if (which == METHOD_MINPACK_JOINT)
        return minpack_joint(given, found);
    if (which == METHOD_MINPACK_ALTERNATION)
        return minpack_alternate(given, ALTERNATION_THRESHOLD, ALTERNATION_ROUNDS, found);
#endif
    (void)given;
    (void)which;
    (void)found;
    return -1;
}

outcome method_run_from(bench *with, method which, int start)
{
    solution found = {.table = with->table};
    with->plain.passes = 0;
    double began = thread_microseconds();
    problem_start(&with->plain, start, &found);
    int failed = solve(&with->plain, which, &found);
    outcome result = {.microseconds = thread_microseconds() - began, .passes = with->plain.passes, .residual = NAN};
    if (!failed)
        result.residual = problem_residual(&with->plain, &found);
    return result;
}

outcome method_run(bench *with, method which, int channel)
{
    return which <= METHOD_REFERENCE ? run_ours(with, which, channel) : method_run_from(with, which, 0);
}
