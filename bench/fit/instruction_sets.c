#include "base/numeric/statistics.h"
#include "base/processor.h"
#include "bench/fit/sections.h"
#include "bench/fit/statistics.h"

#include <math.h>
#include <stdlib.h>

/* One run of the fast fit for each instruction set, texel by texel. */
typedef struct set_series {
    bench with;
    double *microseconds, *ratio, *rmse, *difference; /* ratio and difference: to the best set */
} set_series;

static weft_code create_all(const bench_plan *plan, texel_source *source, set_series *all, weft_error *error)
{
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = plan->lobe_count;
    options.tolerance = plan->tolerance;
    size_t n = (size_t)plan->texel_count;
    for (weft_instruction_set set = WEFT_BASELINE; set <= weft_processor_best(); set++) {
        double *memory = all[set].microseconds = calloc(4 * n, sizeof *memory);
        if (!memory)
            return weft_fail_memory(error, "measurements", 4 * n * sizeof *memory);
        all[set].ratio = memory + n;
        all[set].rmse = memory + 2 * n;
        all[set].difference = memory + 3 * n;
        weft_processor_limit(set);
        WEFT_TRY(bench_create(source, &options, &all[set].with, error));
    }
    return WEFT_OK;
}

static void free_all(set_series *all)
{
    for (weft_instruction_set set = WEFT_BASELINE; set <= weft_processor_best(); set++) {
        bench_free(&all[set].with);
        free(all[set].microseconds);
    }
}

/* The best set first, then the others against it. */
static void measure(const texel_source *source, int texel, set_series *all)
{
    int channel = texel % WEFT_CHANNELS;
    weft_instruction_set best = weft_processor_best();
    for (int set = (int)best; set >= WEFT_BASELINE; set--) {
        weft_processor_limit((weft_instruction_set)set);
        outcome one = method_run(&all[set].with, METHOD_FAST, channel);
        all[set].microseconds[texel] = one.microseconds;
        all[set].rmse[texel] = relative_rmse(one.residual, source->samples.energy[channel]);
        all[set].ratio[texel] = one.microseconds / all[best].microseconds[texel];
        all[set].difference[texel] = fabs(all[set].rmse[texel] - all[best].rmse[texel]);
    }
}

static void add_table(const bench_plan *plan, const texel_source *source, const set_series *all)
{
    int count = plan->texel_count;
    report_table(plan->report, "instruction sets", "The fast fit by instruction set, %d texels, %d lobes + T", count,
                 plan->lobe_count);
    for (int set = (int)weft_processor_best(); set >= WEFT_BASELINE; set--) {
        report_row(plan->report, "%s, %s", source->name, weft_instruction_set_name((weft_instruction_set)set));
        report_number(plan->report, "us median", 0, weft_quantile(all[set].microseconds, count, 0.5));
        report_number(plan->report, "times the first", 2, weft_quantile(all[set].ratio, count, 0.5));
        report_number(plan->report, "rel. RMSE", 6, mean_of(all[set].rmse, count));
        report_number(plan->report, "mean difference", 7, mean_of(all[set].difference, count));
        report_number(plan->report, "largest", 7, weft_quantile(all[set].difference, count, 1));
    }
}

weft_code section_instruction_sets(const bench_plan *plan, texel_source *source, weft_error *error)
{
    set_series all[WEFT_INSTRUCTION_SETS] = {0};
    weft_instruction_set before = weft_processor_instruction_set();
    weft_code code = create_all(plan, source, all, error);
    for (int i = 0; code == WEFT_OK && i < plan->texel_count; i++) {
        code = texel_source_load(source, i, plan->texel_count, false, error);
        if (code == WEFT_OK)
            measure(source, i, all);
    }
    if (code == WEFT_OK)
        add_table(plan, source, all);
    free_all(all);
    weft_processor_limit(before);
    return code;
}
