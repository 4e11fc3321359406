/* Do the starts of the fit find what 60 random starts find, each run to convergence? Random truths, invented cloth, the
 * measured tape, and any datasets that are named (docs/notes/benchmarks.md). */
#include "base/processor.h"
#include "bench/fit/report.h"
#include "bench/fit/statistics.h"
#include "bench/fit/texels.h"
#include "tests/support/alternation.h"
#include "tests/support/random_starts.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { MOST_LOBES = 3, TRUTH_VIEWS = 40, TRUTH_LIGHTS = 60, MOST_DATASETS = 64 };

#define ABOVE 1.02 /* times the least RMSE */

typedef struct arguments {
    int texel_count, start_count, truth_count, first_seed;
    const char *dataset[MOST_DATASETS];
    int dataset_count;
    bool per_texel;
    report_form form;
    report *report;
} arguments;

/* A fit from nothing, and room for it. */
typedef struct contest {
    double noise; /* relative */
    const weft_bundle *bundle;
    const weft_samples *samples;
    weft_fit_workspace *workspace;
    double *table;
} contest;

/* What the texels of a set said. */
typedef struct tally {
    int count, above;
    int above_run_on; /* when the fit, too, is run to convergence: what is above then is in another minimum */
    int missed;       /* above, and above what noise leaves: more lobes than the truth has follow the noise */
    double microseconds, worst;
    double passes;
} tally;

static void print_fit(const char *name, int texel, const char *which, const weft_fit *fit, double square)
{
    printf("%s, texel %d, %s: %.4f, rho %.3f", name, texel, which, sqrt(square), fit->diffuse);
    for (int i = 0; i < fit->lobe_count; i++)
        printf(" | %.2f %.2f %.2f, N %.1f, A %.3f", fit->lobe[i].c[0], fit->lobe[i].c[1], fit->lobe[i].c[2],
               exp(fit->lobe[i].log_exponent), fit->lobe[i].amplitude);
    printf("\n");
}

/* What a fit leaves when it is run to convergence as the random ones are. */
static double run_on(const contest *with, int channel, const weft_fit_options *options, const weft_fit *from)
{
    weft_fit_options converged = *options;
    weft_fit fit = *from;
    converged.tolerance = 1e-6;
    converged.max_passes = 400;
    for (int view = 0; view < with->bundle->view_count; view++)
        with->table[view] = 1;
    weft_fit_refine(with->bundle, with->samples, channel, &converged, with->workspace, &fit, with->table);
    return weft_fit_residual(with->bundle, with->samples, channel, &fit, with->table);
}

static void judge(const arguments *given, const contest *with, int channel, int lobes, bool table, uint64_t seed,
                  const char *name, tally *own)
{
    const weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = lobes;
    options.table = table;
    weft_fit fit, best;
    double began = thread_microseconds();
    weft_fit_cold(with->bundle, with->samples, channel, &options, with->workspace, &frame, &fit, with->table);
    own->microseconds += thread_microseconds() - began;
    own->passes += fit.passes;
    double left = weft_fit_residual(with->bundle, with->samples, channel, &fit, with->table);
    double least = random_starts_best(with->bundle, with->samples, channel, &options, with->workspace, &frame, seed,
                                      given->start_count, &best, with->table);
    double ratio = left > 0 ? sqrt(left / least) : 1;
    own->count++;
    own->above += ratio > ABOVE;
    own->above_run_on += run_on(with, channel, &options, &fit) > ABOVE * ABOVE * least;
    own->missed += left > ABOVE * ABOVE * fmax(least, with->noise * with->noise * with->samples->energy[channel]);
    own->worst = fmax(own->worst, ratio);
    if (given->per_texel && ratio > ABOVE) {
        print_fit(name, (int)seed, "the fit", &fit, left / with->samples->energy[channel]);
        print_fit(name, (int)seed, "random", &best, least / with->samples->energy[channel]);
    }
}

static void add_row(const arguments *given, const char *name, int lobes, const tally *own)
{
    report_table(given->report, "starts", "What a fit from nothing leaves, against the best of %d random starts",
                 given->start_count);
    report_row(given->report, "%s, %d lobe%s", name, lobes, lobes > 1 ? "s" : "");
    report_number(given->report, "fits", 0, own->count);
    report_number(given->report, "above by 2 %, %", 2, 100.0 * own->above / (own->count ? own->count : 1));
    report_number(given->report, "run on, %", 2, 100.0 * own->above_run_on / (own->count ? own->count : 1));
    report_number(given->report, "and above the noise, %", 2, 100.0 * own->missed / (own->count ? own->count : 1));
    report_number(given->report, "worst ratio", 3, own->worst);
    report_number(given->report, "us a fit", 0, own->microseconds / (own->count ? own->count : 1));
    report_number(given->report, "passes", 1, own->passes / (own->count ? own->count : 1));
}

/* Fits with T where the samples of the texel carry it; models that they do not carry are left out. */
static void judge_texel(const arguments *given, const contest *with, int channel, uint64_t seed, const char *name,
                        tally *own)
{
    for (int lobes = 1; lobes <= MOST_LOBES; lobes++) {
        bool table = with->bundle->view_count > 1 &&
                     weft_fit_affordable_lobes(with->bundle, with->samples, lobes, true) == lobes;
        if (with->samples->energy[channel] > 0 &&
            weft_fit_affordable_lobes(with->bundle, with->samples, lobes, table) == lobes)
            judge(given, with, channel, lobes, table, seed, name, &own[lobes - 1]);
    }
}

static weft_code run_source(const arguments *given, texel_source *source, int count, const char *name, tally *sum,
                            weft_error *error)
{
    tally own[MOST_LOBES] = {0};
    contest with = {.noise = source->noise, .bundle = &source->bundle, .samples = &source->samples};
    WEFT_TRY(weft_fit_workspace_create(&source->bundle, &with.workspace, error));
    with.table = calloc((size_t)source->layout.view_count, sizeof *with.table);
    weft_code code =
        with.table ? WEFT_OK : weft_fail_memory(error, "T of a texel", (size_t)source->layout.view_count * 8);
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        if (source->dataset || source->half)
            code = texel_source_load(source, i, count, false, error);
        if (code == WEFT_OK)
            judge_texel(given, &with, WEFT_GREY, (uint64_t)i, name, own);
    }
    for (int i = 0; code == WEFT_OK && i < MOST_LOBES; i++) {
        if (own[i].count > 0)
            add_row(given, name, i + 1, &own[i]);
        sum[i].count += own[i].count;
        sum[i].above += own[i].above;
        sum[i].above_run_on += own[i].above_run_on;
        sum[i].missed += own[i].missed;
        sum[i].worst = fmax(sum[i].worst, own[i].worst);
        sum[i].microseconds += own[i].microseconds;
        sum[i].passes += own[i].passes;
    }
    weft_fit_workspace_free(with.workspace);
    free(with.table);
    return code;
}

static weft_code run_datasets(const arguments *given, tally *sum, weft_error *error)
{
    for (int i = 0; i < given->dataset_count; i++) {
        texel_source source;
        weft_code code = texel_source_open(given->dataset[i], &source, error);
        int texels = code == WEFT_OK ? source.layout.width * source.layout.height : 0;
        int count = texels < given->texel_count ? texels : given->texel_count;
        if (code == WEFT_OK)
            code = run_source(given, &source, count, source.name, sum, error);
        texel_source_free(&source);
        WEFT_TRY(code);
    }
    return WEFT_OK;
}

static weft_code run_families(const arguments *given, tally *sum, weft_error *error)
{
    for (synthetic_kind kind = SYNTHETIC_WARD; kind < SYNTHETIC_KINDS; kind++) {
        texel_source source = {0};
        weft_code code = texel_source_invent(kind, &source, error);
        if (code == WEFT_OK)
            code = run_source(given, &source, given->texel_count, source.name, sum, error);
        texel_source_free(&source);
        WEFT_TRY(code);
    }
    return WEFT_OK;
}

static weft_code run_tape(const arguments *given, tally *sum, weft_error *error)
{
    const char *path = WEFT_SHARED "/real/retro-tape/retro-3M-yellow.dat";
    texel_source source;
    if (access(path, R_OK))
        return WEFT_OK;
    weft_code code = texel_source_open_tape(path, &source, error);
    if (code == WEFT_OK)
        code = run_source(given, &source, 1, source.name, sum, error);
    texel_source_free(&source);
    return code;
}

static weft_code run_truths(const arguments *given, tally *sum, weft_error *error)
{
    texel_source source;
    WEFT_TRY(texel_source_truths(TRUTH_VIEWS, TRUTH_LIGHTS, given->first_seed, &source, error));
    weft_code code = run_source(given, &source, given->truth_count, source.name, sum, error);
    texel_source_free(&source);
    return code;
}

static weft_code run(const arguments *given, weft_error *error)
{
    tally sum[MOST_LOBES] = {0};
    if (given->truth_count > 0)
        WEFT_TRY(run_truths(given, sum, error));
    if (given->texel_count > 0) {
        WEFT_TRY(run_families(given, sum, error));
        WEFT_TRY(run_tape(given, sum, error));
    }
    WEFT_TRY(run_datasets(given, sum, error));
    for (int i = 0; i < MOST_LOBES; i++)
        add_row(given, "all", i + 1, &sum[i]);
    return WEFT_OK;
}

enum { OPTION_JSON = 256, OPTION_MARKDOWN, OPTION_EACH, OPTION_FIRST };

static const struct argp_option option[] = {
    {"texels", 'n', "N", 0, "Texels of each invented family and dataset (default 50)", 0},
    {"truths", 't', "N", 0, "Random truths (default 500)", 0},
    {"starts", 's', "N", 0, "Random starts of each (default 60)", 0},
    {"first", OPTION_FIRST, "N", 0, "Seed of the first random truth (default 0)", 0},
    {"each", OPTION_EACH, NULL, 0, "Print each fit that is above", 0},
    {"json", OPTION_JSON, NULL, 0, "Print the table as JSON", 0},
    {"markdown", OPTION_MARKDOWN, NULL, 0, "Print the table as Markdown", 0},
    {0},
};

static int whole_number(const char *text, struct argp_state *state)
{
    char *end;
    long value = strtol(text, &end, 10);
    if (end == text || *end || value < 0 || value > 100000)
        argp_error(state, "'%s': a number from 0 to 100000 is wanted", text);
    return (int)value;
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    arguments *to = state->input;
    switch (key) {
    case 'n':
        to->texel_count = whole_number(text, state);
        return 0;
    case 't':
        to->truth_count = whole_number(text, state);
        return 0;
    case 's':
        to->start_count = whole_number(text, state);
        return 0;
    case OPTION_FIRST:
        to->first_seed = whole_number(text, state);
        return 0;
    case OPTION_EACH:
        to->per_texel = true;
        return 0;
    case OPTION_JSON:
        to->form = REPORT_JSON;
        return 0;
    case OPTION_MARKDOWN:
        to->form = REPORT_MARKDOWN;
        return 0;
    case ARGP_KEY_ARG:
        if (to->dataset_count == MOST_DATASETS)
            argp_error(state, "at most %d datasets", MOST_DATASETS);
        to->dataset[to->dataset_count++] = text;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = option,
    .parser = parse_option,
    .args_doc = "[NAME.btf.h5...]",
    .doc = "Compares the fit from nothing with the best of random starts, each run to convergence: random truths, "
           "invented cloth, measured tape, and the datasets that are named.",
};

int main(int argc, char **argv)
{
    arguments given = {.texel_count = 50, .start_count = 60, .truth_count = 500};
    argp_parse(&parser, argc, argv, 0, NULL, &given);
    given.report = report_create(given.form);
    weft_error error = {0};
    weft_code code = given.report ? WEFT_OK : weft_fail_memory(&error, "the report", sizeof(void *));
    unsigned state = weft_denormals_off();
    if (code == WEFT_OK)
        code = weft_processor_check(&error);
    if (code == WEFT_OK)
        code = run(&given, &error);
    weft_denormals_restore(state);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_starts: %s\n", error.message);
    bool printed = !given.report || report_finish(given.report);
    return code == WEFT_OK && printed ? EXIT_SUCCESS : EXIT_FAILURE;
}
