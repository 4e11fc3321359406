/* Speed and quality of the fit, against general solvers on the same texels (docs/notes/benchmarks.md). */
#include "base/processor.h"
#include "bench/fit/sections.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SPEED, QUALITY, EXTENSIONS, INSTRUCTION_SETS, TAPE, PASS, SECTIONS };

static const char *const section_name[SECTIONS] = {"speed", "quality", "extensions", "instruction-sets",
                                                   "tape",  "pass"};

typedef struct arguments {
    bench_plan plan;
    const char *dataset;
    int only; /* a section, or -1 for all */
    report_form form;
} arguments;

enum { OPTION_JSON = 256, OPTION_MARKDOWN, OPTION_ONLY, OPTION_TAPE, OPTION_TOLERANCE, OPTION_SCALAR };

static const struct argp_option option[] = {
    {"texels", 'n', "N", 0, "Texels of each family (default 100)", 0},
    {"lobes", 'l', "K", 0, "Lobes, 1 to 3 (default 2)", 0},
    {"tolerance", OPTION_TOLERANCE, "X", 0, "Relative decrease that ends a fit, for all methods (default 0.001)", 0},
    {"only", OPTION_ONLY, "SECTION", 0, "speed, quality, extensions, instruction-sets, tape or pass (default all)", 0},
    {"tape", OPTION_TAPE, "FILE", 0, "Measurements of the retro-reflective tape", 0},
    {"scalar", OPTION_SCALAR, NULL, 0, "Let general solvers call the scalar exp and log of libm, not those on vectors",
     0},
    {"json", OPTION_JSON, NULL, 0, "Print all tables as JSON", 0},
    {"markdown", OPTION_MARKDOWN, NULL, 0, "Print all tables as Markdown", 0},
    {0},
};

static int section_of_name(const char *name, struct argp_state *state)
{
    for (int i = 0; i < SECTIONS; i++) {
        if (!strcmp(section_name[i], name))
            return i;
    }
    argp_error(state, "there is no section '%s'", name);
    return -1;
}

static long whole_number(const char *text, long low, long high, const char *what, struct argp_state *state)
{
    char *end;
    long value = strtol(text, &end, 10);
    if (end == text || *end || value < low || value > high)
        argp_error(state, "'%s': the %s must be %ld to %ld", text, what, low, high);
    return value;
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    arguments *to = state->input;
    char *end;
    switch (key) {
    case 'n':
        to->plan.texel_count = (int)whole_number(text, 1, 100000, "number of texels", state);
        return 0;
    case 'l':
        to->plan.lobe_count = (int)whole_number(text, 1, 3, "number of lobes", state);
        return 0;
    case OPTION_TOLERANCE:
        to->plan.tolerance = strtod(text, &end);
        if (end == text || *end || !(to->plan.tolerance > 0) || to->plan.tolerance >= 1)
            argp_error(state, "'%s': the tolerance must lie between 0 and 1", text);
        return 0;
    case OPTION_ONLY:
        to->only = section_of_name(text, state);
        return 0;
    case OPTION_TAPE:
        to->plan.tape_path = text;
        return 0;
    case OPTION_SCALAR:
        to->plan.scalar_callbacks = true;
        return 0;
    case OPTION_JSON:
        to->form = REPORT_JSON;
        return 0;
    case OPTION_MARKDOWN:
        to->form = REPORT_MARKDOWN;
        return 0;
    case ARGP_KEY_ARG:
        if (to->dataset)
            argp_error(state, "one dataset at most");
        to->dataset = text;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = option,
    .parser = parse_option,
    .args_doc = "[NAME.btf.h5]",
    .doc = "Fits texels of a dataset, or of three invented families, with Weft and with general solvers.\v"
           "Times are processor times of one thread. What the columns mean is written in docs/notes/benchmarks.md.",
};

/* One section after the other over all sources, so that a table may hold them all. */
static weft_code run_sources(const arguments *given, texel_source *sources, int count, weft_error *error)
{
    static weft_code (*const section[])(const bench_plan *, texel_source *, weft_error *) = {
        [SPEED] = section_speed,
        [QUALITY] = section_quality,
        [EXTENSIONS] = section_extensions,
        [INSTRUCTION_SETS] = section_instruction_sets,
    };
    for (int i = SPEED; i < TAPE; i++) {
        for (int k = 0; k < count && (given->only < 0 || given->only == i); k++)
            WEFT_TRY(section[i](&given->plan, &sources[k], error));
    }
    return WEFT_OK;
}

/* Four samples for every unknown, or there is nothing to compare: any method fits them exactly. */
static weft_code check_samples(const arguments *given, const texel_source *source, weft_error *error)
{
    int samples = source->layout.image_count, unknowns = 1 + 4 * given->plan.lobe_count + source->layout.view_count;
    if (samples < 4 * unknowns)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': %d images are too few for %d lobes and T of %d views: %d wanted",
                         given->dataset, samples, given->plan.lobe_count, source->layout.view_count, 4 * unknowns);
    return WEFT_OK;
}

static weft_code run_dataset(const arguments *given, weft_error *error)
{
    texel_source source;
    weft_code code = texel_source_open(given->dataset, &source, error);
    if (code == WEFT_OK)
        code = check_samples(given, &source, error);
    if (code == WEFT_OK)
        code = run_sources(given, &source, 1, error);
    texel_source_free(&source);
    return code;
}

static weft_code run_families(const arguments *given, weft_error *error)
{
    texel_source sources[SYNTHETIC_KINDS] = {0};
    weft_code code = WEFT_OK;
    for (synthetic_kind kind = 0; code == WEFT_OK && kind < SYNTHETIC_KINDS; kind++)
        code = texel_source_invent(kind, &sources[kind], error);
    if (code == WEFT_OK)
        code = run_sources(given, sources, SYNTHETIC_KINDS, error);
    for (synthetic_kind kind = 0; kind < SYNTHETIC_KINDS; kind++)
        texel_source_free(&sources[kind]);
    return code;
}

/* Tape and pass have nothing to do with a dataset. */
static weft_code run(const arguments *given, weft_error *error)
{
    WEFT_TRY(given->dataset ? run_dataset(given, error) : run_families(given, error));
    bool all = given->only < 0 && !given->dataset;
    if (all || given->only == TAPE)
        WEFT_TRY(section_tape(&given->plan, error));
    if (all || given->only == PASS)
        WEFT_TRY(section_pass(&given->plan, error));
    return WEFT_OK;
}

int main(int argc, char **argv)
{
    arguments given = {.plan = {.texel_count = 100,
                                .lobe_count = 2,
                                .tolerance = 1e-3,
                                .tape_path = WEFT_SHARED "/real/retro-tape/retro-3M-yellow.dat"},
                       .only = -1};
    argp_parse(&parser, argc, argv, 0, NULL, &given);
    given.plan.report = report_create(given.form);
    weft_error error = {0};
    weft_code code = given.plan.report ? WEFT_OK : weft_fail_memory(&error, "the report", sizeof(void *));
    unsigned state = weft_denormals_off();
    if (code == WEFT_OK)
        code = weft_processor_check(&error);
    if (code == WEFT_OK)
        code = run(&given, &error);
    weft_denormals_restore(state);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_fit: %s\n", error.message);
    bool printed = !given.plan.report || report_finish(given.plan.report);
    return code == WEFT_OK && printed ? EXIT_SUCCESS : EXIT_FAILURE;
}
