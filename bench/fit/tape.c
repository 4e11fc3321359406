#include "base/numeric/statistics.h"
#include "bench/fit/sections.h"
#include "bench/fit/statistics.h"

#include <math.h>
#include <unistd.h>

enum { REPEATS = 5, STARTS = 2 };

#define TAPE_MAX_EXPONENT 65536.0 /* its lobes want several thousand */
#define TAPE_TOLERANCE 1e-4

/* Best relative RMSE of 150 starts of a general solver, by number of lobes. */
static const double best_known[PROBLEM_LOBES] = {0.7156, 0.3884, 0.3737};

/* The fast fit chooses among its starts itself; general solvers get the same starts in turn. */
static outcome run_best(bench *with, method which)
{
    if (which == METHOD_FAST)
        return method_run(with, which, 0);
    outcome best = {.residual = INFINITY};
    for (int start = 0; start < STARTS; start++) {
        outcome one = method_run_from(with, which, start);
        best.residual = fmin(best.residual, one.residual);
        best.microseconds += one.microseconds;
        best.passes += one.passes;
    }
    return best;
}

static void add_row(const bench_plan *plan, bench *with, method which, const char *name)
{
    double microseconds[REPEATS];
    outcome last = {0};
    for (int i = 0; i < REPEATS; i++) {
        last = run_best(with, which);
        microseconds[i] = last.microseconds;
    }
    double rmse = relative_rmse(last.residual, with->source->samples.energy[0]);
    int lobes = with->options.lobe_count;
    report_row(plan->report, "%d lobe%s, %s", lobes, lobes > 1 ? "s" : "", name);
    report_number(plan->report, "ms", 2, weft_quantile(microseconds, REPEATS, 0.5) / 1000);
    report_number(plan->report, "passes", 1, last.passes);
    report_number(plan->report, "rel. RMSE", 4, rmse);
    report_number(plan->report, "best known", 4, best_known[lobes - 1]);
    report_number(plan->report, "above it %", 2, 100 * (rmse / best_known[lobes - 1] - 1));
}

static weft_code measure(const bench_plan *plan, texel_source *source, weft_error *error)
{
    static const struct {
        method which;
        const char *name;
    } rows[] = {{METHOD_FAST, "fast"},
                {METHOD_CERES_ALTERNATION, "Ceres, Cholesky"},
                {METHOD_MINPACK_ALTERNATION, "MINPACK lmder"}};
    report_table(plan->report, "tape", "%s: %d samples, no T, ms of processor, general solvers from %d starts",
                 source->name, source->bundle.image_count, STARTS);
    for (int lobes = 1; lobes <= PROBLEM_LOBES; lobes++) {
        weft_fit_options options = weft_fit_default_options();
        options.lobe_count = lobes;
        options.table = false;
        options.max_exponent = TAPE_MAX_EXPONENT;
        options.tolerance = TAPE_TOLERANCE;
        options.max_passes = 200;
        bench with;
        WEFT_TRY(bench_create(source, &options, &with, error));
        if (plan->scalar_callbacks)
            with.plain.code = &model_scalar;
        problem_load(source, 0, &options, &with.plain);
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            if (method_available(rows[i].which))
                add_row(plan, &with, rows[i].which, rows[i].name);
        }
        bench_free(&with);
    }
    return WEFT_OK;
}

weft_code section_tape(const bench_plan *plan, weft_error *error)
{
    texel_source source = {0};
    if (access(plan->tape_path, R_OK)) {
        report_table(plan->report, "tape", "retro-reflective tape");
        report_note(plan->report, "Skipped: there is no '%s'.", plan->tape_path);
        return WEFT_OK;
    }
    weft_code code = texel_source_open_tape(plan->tape_path, &source, error);
    if (code == WEFT_OK)
        code = measure(plan, &source, error);
    texel_source_free(&source);
    return code;
}
