#include "bench/fit/sections.h"
#include "bench/fit/statistics.h"
#include "tests/support/alternation.h"

typedef struct variant {
    const char *name;
    bool fit_frame;
} variant;

static const variant variants[] = {{"nominal frame", false}, {"frame fitted", true}};

enum { VARIANTS = sizeof variants / sizeof *variants };

typedef struct totals {
    double rmse[VARIANTS], microseconds[VARIANTS];
    int lower[VARIANTS]; /* texels with a lower residual than the first variant */
} totals;

static void measure(bench *with, int channel, totals *sums)
{
    const texel_source *source = with->source;
    const weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    double first = 0;
    for (int i = 0; i < VARIANTS; i++) {
        weft_fit_options options = with->options;
        options.fit_frame = variants[i].fit_frame;
        weft_fit fit;
        double began = thread_microseconds();
        weft_fit_cold(&source->bundle, &source->samples, channel, &options, with->workspace, &frame, &fit, with->table);
        sums->microseconds[i] += thread_microseconds() - began;
        double residual = weft_fit_residual(&source->bundle, &source->samples, channel, &fit, with->table);
        first = i ? first : residual;
        sums->rmse[i] += relative_rmse(residual, source->samples.energy[channel]);
        sums->lower[i] += residual < first;
    }
}

weft_code section_extensions(const bench_plan *plan, texel_source *source, weft_error *error)
{
    bench with;
    totals sums = {0};
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = plan->lobe_count;
    options.tolerance = plan->tolerance;
    int count = plan->texel_count;
    weft_code code = bench_create(source, &options, &with, error);
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        code = texel_source_load(source, i, count, false, error);
        if (code == WEFT_OK)
            measure(&with, i % WEFT_CHANNELS, &sums);
    }
    bench_free(&with);
    if (code != WEFT_OK)
        return code;
    report_table(plan->report, "extensions", "What more freedom gains, %d texels, %d lobes + T", count,
                 plan->lobe_count);
    for (int i = 0; i < VARIANTS; i++) {
        report_row(plan->report, "%s, %s", source->name, variants[i].name);
        report_number(plan->report, "us mean", 0, sums.microseconds[i] / count);
        report_number(plan->report, "rel. RMSE", 4, sums.rmse[i] / count);
        report_number(plan->report, "lower by %", 1, 100 * (1 - sums.rmse[i] / sums.rmse[0]));
        report_number(plan->report, "% of texels lower", 1, 100.0 * sums.lower[i] / count);
    }
    return WEFT_OK;
}
