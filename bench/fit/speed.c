#include "base/numeric/statistics.h"
#include "base/processor.h"
#include "bench/fit/sections.h"
#include "bench/fit/statistics.h"

#include <math.h>
#include <stdlib.h>

/* All runs of one method, texel by texel. */
typedef struct series {
    double *microseconds, *ratio, *passes, *rmse, *excess; /* excess: our residual over theirs */
} series;

static weft_code create_series(int count, series all[METHOD_COUNT], double **memory, weft_error *error)
{
    size_t n = (size_t)count;
    *memory = calloc(5 * n * METHOD_COUNT, sizeof **memory);
    if (!*memory)
        return weft_fail_memory(error, "measurements", 5 * n * METHOD_COUNT * sizeof **memory);
    for (size_t i = 0; i < METHOD_COUNT; i++) {
        double *own = *memory + 5 * n * i;
        all[i] = (series){own, own + n, own + 2 * n, own + 3 * n, own + 4 * n};
    }
    return WEFT_OK;
}

static void measure(bench *with, int texel, series all[METHOD_COUNT])
{
    int channel = texel % WEFT_CHANNELS;
    outcome fast = {0};
    for (method which = 0; which < METHOD_COUNT; which++) {
        if (!method_available(which))
            continue;
        /* In a material a fit follows others of the same texel: the second run finds the caches as they leave them. */
        method_run(with, which, channel);
        outcome one = method_run(with, which, channel);
        if (which == METHOD_FAST)
            fast = one;
        all[which].microseconds[texel] = one.microseconds;
        all[which].ratio[texel] = one.microseconds / fast.microseconds;
        all[which].passes[texel] = one.passes;
        all[which].rmse[texel] = relative_rmse(one.residual, with->source->samples.energy[channel]);
        all[which].excess[texel] = isnan(one.residual) ? 0 : fast.residual / one.residual;
    }
}

static void add_row(report *to, const series *of, method which, int count, double tolerance)
{
    report_row(to, "%s", method_name(which));
    report_number(to, "us q1", 0, weft_quantile(of->microseconds, count, 0.25));
    report_number(to, "us median", 0, weft_quantile(of->microseconds, count, 0.5));
    report_number(to, "us q3", 0, weft_quantile(of->microseconds, count, 0.75));
    report_number(to, "passes", 1, mean_of(of->passes, count));
    report_number(to, "rel. RMSE", 4, mean_of(of->rmse, count));
    report_number(to, "ratio", 1, weft_quantile(of->ratio, count, 0.5));
    report_number(to, "ours <= %", 1, 100 * share_at_most(of->excess, count, 1 + tolerance));
}

weft_code section_speed(const bench_plan *plan, texel_source *source, weft_error *error)
{
    series all[METHOD_COUNT];
    double *memory = NULL;
    bench with;
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = plan->lobe_count;
    options.tolerance = plan->tolerance;
    weft_code code = bench_create(source, &options, &with, error);
    if (plan->scalar_callbacks)
        with.plain.code = &model_scalar;
    if (code == WEFT_OK)
        code = create_series(plan->texel_count, all, &memory, error);
    for (int i = 0; code == WEFT_OK && i < plan->texel_count; i++) {
        code = bench_load(&with, i, plan->texel_count, i % WEFT_CHANNELS, error);
        if (code == WEFT_OK)
            measure(&with, i, all);
    }
    if (code == WEFT_OK) {
        report_table(plan->report, "speed",
                     "%s: %d texels, %d lobes + T, %d samples, microseconds of processor a channel, %s", source->name,
                     plan->texel_count, plan->lobe_count, source->bundle.image_count,
                     weft_instruction_set_name(weft_processor_instruction_set()));
        for (method which = 0; which < METHOD_COUNT; which++) {
            if (method_available(which))
                add_row(plan->report, &all[which], which, plan->texel_count, plan->tolerance);
        }
    }
    free(memory);
    bench_free(&with);
    return code;
}
