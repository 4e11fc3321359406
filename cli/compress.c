#include "compress/compress.h"
#include "base/atomic_file.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "cli/command/arguments.h"
#include "cli/compress_report.h"
#include "compare/tradeoff/component_count.h"
#include "compress/hold_out/hold_out.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Of held-out splits: as many as the dataset asks for. */
enum { ENOUGH_SPLITS = -1 };

/* Components that leave more have missed what the material is; lobes are suggested that leave at most this share. */
static const double components_fail = 0.5, clearly_less = 0.75;

typedef struct compress_command {
    weft_common_options common;
    const char *input, *output;
    int components, lobes; /* 0: not asked for */
    double wished_error;   /* relative RMSE on directions that are not fitted; 0: any */
    uint64_t budget_bytes; /* of the file; 0: any */
    weft_preset preset;
    double least_fps; /* 0: any */
    weft_sample_weights weights;
    int hold_out; /* splits, or ENOUGH_SPLITS; 0: off */
    uint64_t memory_bytes;
} compress_command;

/* ---- Options ---- */

static weft_code read_components(const weft_option *option, const char *text, void *values, weft_error *error)
{
    unsigned long long count;
    WEFT_TRY(weft_option_whole(option->name, text, WEFT_COMPONENTS_GROUP, WEFT_COMPONENTS_MAX, &count, error));
    if (count % WEFT_COMPONENTS_GROUP != 0)
        return weft_fail(error, WEFT_BAD_USAGE, "--components is a multiple of %d, not %llu", WEFT_COMPONENTS_GROUP,
                         count);
    ((compress_command *)values)->components = (int)count;
    return WEFT_OK;
}

static weft_code read_budget(const weft_option *option, const char *text, void *values, weft_error *error)
{
    double megabytes;
    WEFT_TRY(weft_option_number(option->name, text, 1e-3, 1e9, &megabytes, error));
    ((compress_command *)values)->budget_bytes = (uint64_t)(1e6 * megabytes);
    return WEFT_OK;
}

static weft_code read_memory(const weft_option *option, const char *text, void *values, weft_error *error)
{
    unsigned long long megabytes;
    WEFT_TRY(weft_option_whole(option->name, text, 1, 1000000000, &megabytes, error));
    ((compress_command *)values)->memory_bytes = 1000000 * megabytes;
    return WEFT_OK;
}

static weft_code read_hold_out(const weft_option *option, const char *text, void *values, weft_error *error)
{
    unsigned long long splits = 0;
    if (strcmp(text, "off") != 0)
        WEFT_TRY(weft_option_whole(option->name, text, 1, WEFT_SPLIT_MOST, &splits, error));
    ((compress_command *)values)->hold_out = (int)splits;
    return WEFT_OK;
}

static const char *const preset_words[] = {"off", "small", "balanced", "best", NULL}; /* in the order of weft_preset */
static const char *const weight_words[] = {"even", "screen", NULL}; /* in the order of weft_sample_weights */

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(compress_command, input)},
    {"output", 'o', "NAME.weft", "The material to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(compress_command, output)},
    {"components", .former_name = "layers", .argument = "K",
     .help = "K components, 4 to 64, a multiple of 4: K bytes a texel, and tables that all texels share (default: 8 "
             "for fewer than 20 images, 16 for fewer than 100, else 32; one lobe for fewer than 20 near images)",
     .read = read_components},
    {"lobes", .argument = "1..3",
     .help = "Fit N Lafortune lobes a texel and channel instead of components, with a view table where there are "
             "enough images",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(compress_command, lobes), .low = 1, .high = WEFT_MATERIAL_MAX_LOBES},
    {"weights", .argument = "even|screen",
     .help = "What an error counts for. screen: less in bright samples, as on a screen (default of components). even: "
             "the same in all samples, as linear light (default of lobes)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(compress_command, weights), .words = weight_words},
    {"error", .argument = "PERCENT",
     .help = "Use the fewest components whose relative RMSE on held-out directions is at most this",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(compress_command, wished_error), .low = 0.001, .high = 100,
     .divisor = 100},
    {"budget", .argument = "MB", .help = "Use the most components whose file is no larger than this",
     .read = read_budget},
    {"preset", .argument = "small|balanced|best",
     .help = "Choose components or lobes. Fits models to some texels with some views and lights held out, and predicts "
             "file size and held-out error. small: few bytes; best: the least error; balanced: between them, where "
             "more bytes gain little (see tradeoff)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(compress_command, preset), .words = preset_words},
    {"fps", .argument = "N",
     .help = "Choose like --preset (default: best), but only models that this machine draws at N frames a second or "
             "more: 730 x 400 pixels, every texel, level and direction evaluated",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(compress_command, least_fps), .low = 0.01, .high = 10000},
    {"hold-out", .argument = "off|N",
     .help = "Measure the held-out error N times: fit some texels without about a tenth of the views and lights, and "
             "predict those (default: 1, or more for few images). The material itself is fitted to all images",
     .read = read_hold_out},
    {"memory", .argument = "MB", .help = "Use at most this much memory (default: a quarter of the machine's)",
     .read = read_memory},
    /* Of 0.1: */
    {"table", .gone = "T is fitted wherever there are enough images"},
    {"light-table", .gone = "components follow the light better: leave out the option, or use --components"},
    {"tables", .gone = "T has 8 bits; for smaller files use --components or --budget"},
    {"levels", .gone = "materials have mip levels"},
    {"heights", .gone = "heights are used where held-out photographs show a gain"},
    {"rounding", .gone = "components are always quantised below their error"},
    {"frames", .gone = "frames are always fitted, from the frames of the dataset where it gives some"},
    {"max-exponent", .gone = "exponents reach 8192"},
    {"report", .gone = "all texels have the same model; weft compare writes a page about it"},
    {0},
};

/* ---- The model ---- */

static bool has_preset(const compress_command *command)
{
    return command->preset != WEFT_PRESET_NONE || command->least_fps > 0;
}

static weft_code check(void *values, weft_error *error)
{
    const compress_command *command = values;
    int choices = (command->components > 0) + (command->lobes > 0) + (command->wished_error > 0) +
                  (command->budget_bytes > 0) + has_preset(command);
    if (choices > 1)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--components, --lobes, --error, --budget and --preset (with --fps) each choose the model: "
                         "give one of them");
    if (command->wished_error > 0 && command->hold_out == 0)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--error is measured on images that are held out: leave out "
                         "--hold-out off");
    return WEFT_OK;
}

static weft_compress_options options_of(const compress_command *command, const weft_dataset *dataset)
{
    weft_compress_options options = weft_compress_default_options();
    options.weights = command->weights;
    options.memory_bytes = command->memory_bytes;
    if (command->lobes > 0) {
        options.component_count = 0;
        options.lobe_count = command->lobes;
    } else if (command->components > 0) {
        options.component_count = command->components;
    }
    return weft_compress_settle(&options, dataset);
}

/* What a run hands from step to step. */
typedef struct run_state {
    const compress_command *command;
    weft_progress progress;
    char scratch_path[PATH_MAX], partial_path[PATH_MAX];
    weft_dataset *dataset;
    weft_compress_options options;
    weft_hold_out held_out;
    weft_prediction prediction; /* of a preset or a budget; else of no bytes */
    weft_material material;
    weft_compress_report report;
} run_state;

/* Without a preset, fast frames are to be as good as they can be. What draws them keeps memory that the fit may need.
 */
static weft_code choose_by_preset(run_state *state, weft_error *error)
{
    const compress_command *command = state->command;
    const weft_preset_wish wish = {.preset = command->preset == WEFT_PRESET_NONE ? WEFT_PRESET_BEST : command->preset,
                                   .least_fps = command->least_fps,
                                   .times_frames = !command->common.quiet && command->memory_bytes == 0,
                                   .measured_splits = command->hold_out};
    WEFT_TRY(weft_preset_predict(state->dataset, &wish, state->scratch_path, &state->progress, &state->options,
                                 &state->prediction, error));
    return weft_report_prediction(&command->common, &state->prediction, error);
}

static weft_code count_splits(const run_state *state, int *count, weft_error *error)
{
    *count = state->command->hold_out;
    if (*count != ENOUGH_SPLITS)
        return WEFT_OK;
    return weft_hold_out_enough_splits(weft_dataset_get_layout(state->dataset), count, error);
}

/* What is measured for the choice is the error of the material, too. */
static weft_code choose_by_error(run_state *state, weft_error *error)
{
    weft_component_count chosen;
    int splits;
    WEFT_TRY(count_splits(state, &splits, error));
    WEFT_TRY(weft_components_for_error(state->dataset, &state->options, state->command->wished_error, splits,
                                       state->scratch_path, &state->progress, &chosen, error));
    state->options.component_count = chosen.count;
    state->held_out = chosen.held_out;
    return weft_report_components_for_error(&state->command->common, state->command->wished_error, &chosen, error);
}

static weft_code choose_by_budget(run_state *state, weft_error *error)
{
    const compress_command *command = state->command;
    weft_component_count chosen;
    WEFT_TRY(weft_components_for_size(state->dataset, &state->options, command->budget_bytes, state->scratch_path,
                                      &state->progress, &chosen, error));
    if (!chosen.is_met)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--budget %.3g is too small for '%s': the smallest file, of %d components, has about %.4g MB",
                         1e-6 * (double)command->budget_bytes, command->input, chosen.count, 1e-6 * chosen.bytes);
    state->options.component_count = chosen.count;
    state->prediction.bytes = chosen.bytes;
    return weft_report_components_for_budget(&command->common, command->budget_bytes, &chosen, error);
}

static weft_code choose(run_state *state, weft_error *error)
{
    if (has_preset(state->command))
        return choose_by_preset(state, error);
    if (state->command->wished_error > 0)
        return choose_by_error(state, error);
    return state->command->budget_bytes > 0 ? choose_by_budget(state, error) : WEFT_OK;
}

/* ---- The work ---- */

static weft_code measure_model(run_state *state, const weft_compress_options *options, weft_hold_out *result,
                               weft_error *error)
{
    int splits;
    WEFT_TRY(count_splits(state, &splits, error));
    return weft_hold_out_measure(state->dataset, options, splits, state->scratch_path, &state->progress, result, error);
}

/* Where it cannot be measured, for want of memory say, or because the texels that were chosen are holes, the user is
 * told, and there are no splits: what concerns the whole, too, its fit will say. */
static weft_code measure_held_out(run_state *state, weft_error *error)
{
    weft_error own = {0};
    if (state->command->hold_out == 0)
        return WEFT_OK;
    weft_code code = measure_model(state, &state->options, &state->held_out, &own);
    if (weft_class_of(code) == WEFT_BAD_USAGE || weft_class_of(code) == WEFT_BAD_INPUT) {
        weft_command_say(&state->command->common, "error on directions that were not fitted: not measured: %s",
                         own.message);
        state->held_out = (weft_hold_out){0};
        return WEFT_OK;
    }
    if (code != WEFT_OK)
        *error = own;
    return code;
}

/* Components of which more than half is wrong where they were not fitted, as of a cloth that shines back in a beam
 * narrower than the photographs are apart: then one lobe is measured, too, and the user is told where it leaves clearly
 * less. Where that fails nothing is said. */
static void suggest_lobes(run_state *state)
{
    weft_compress_options one_lobe = state->options;
    weft_hold_out of_lobe = {0};
    weft_error ignored = {0};
    double components_error = state->held_out.material.all.relative_rmse;
    one_lobe.component_count = 0;
    one_lobe.lobe_count = 1;
    if (state->held_out.split_count == 0 || !(components_error > components_fail) ||
        measure_model(state, &one_lobe, &of_lobe, &ignored) != WEFT_OK)
        return;
    double lobe_error = of_lobe.material.all.relative_rmse;
    if (lobe_error < clearly_less * components_error)
        weft_command_say(&state->command->common,
                         "components err by %.1f %% %s, one lobe by %.1f %%: try --lobes 1, 2 or 3, or --preset best",
                         100 * components_error, weft_hold_out_about(&state->held_out), 100 * lobe_error);
}

static weft_code measure(run_state *state, weft_error *error)
{
    const compress_command *command = state->command;
    bool by_default = command->components == 0 && command->lobes == 0 && !has_preset(command);
    if (state->held_out.split_count == 0)
        WEFT_TRY(measure_held_out(state, error));
    if (state->held_out.heights.asked)
        state->options.heights = state->held_out.heights.used;
    if (by_default && state->options.component_count > 0)
        suggest_lobes(state);
    return WEFT_OK;
}

static weft_code fit(run_state *state, weft_error *error)
{
    WEFT_TRY(weft_compress(state->dataset, &state->options, &state->progress, &state->material, &state->report, error));
    if (state->held_out.split_count > 0)
        WEFT_TRY(weft_hold_out_store(&state->held_out, &state->material, error));
    if (state->prediction.model[0])
        WEFT_TRY(weft_material_put_metadata(&state->material, "predicted", weft_prediction_to_json(&state->prediction),
                                            error));
    return WEFT_OK;
}

/* Whether the file is within the budget, which a prediction from some texels may miss by a little. */
static weft_code is_within_budget(const run_state *state, bool *is_within, weft_error *error)
{
    uint64_t size = 0;
    *is_within = true;
    if (state->command->budget_bytes == 0)
        return WEFT_OK;
    WEFT_TRY(weft_material_size(&state->material, &size, error));
    *is_within = size <= state->command->budget_bytes;
    if (!*is_within && state->options.component_count == WEFT_COMPONENTS_GROUP)
        return weft_fail(error, WEFT_BAD_USAGE, "--budget is too small: the smallest file has %.4g MB",
                         1e-6 * (double)size);
    if (!*is_within)
        weft_command_say(&state->command->common, "%d components would take %.3f MB: %d are fitted instead",
                         state->options.component_count, 1e-6 * (double)size,
                         state->options.component_count - WEFT_COMPONENTS_GROUP);
    return WEFT_OK;
}

static weft_code measure_and_fit(run_state *state, weft_error *error)
{
    for (bool is_done = false; !is_done;) {
        WEFT_TRY(measure(state, error));
        WEFT_TRY(fit(state, error));
        WEFT_TRY(is_within_budget(state, &is_done, error));
        if (is_done)
            break;
        state->options.component_count -= WEFT_COMPONENTS_GROUP;
        state->held_out = (weft_hold_out){0};
        weft_material_free(&state->material);
    }
    return WEFT_OK;
}

static weft_code compress_dataset(run_state *state, weft_error *error)
{
    const compress_command *command = state->command;
    WEFT_TRY(weft_dataset_open(command->input, &state->dataset, error));
    state->options = options_of(command, state->dataset);
    WEFT_TRY(choose(state, error));
    state->options.checkpoint_path = state->partial_path;
    state->options.log = weft_command_log(&command->common);
    WEFT_TRY(measure_and_fit(state, error));
    WEFT_TRY(weft_material_write(command->output, &state->material, error));
    unlink(state->partial_path);
    weft_sweep_left_over(command->output);
    return weft_report_compressed(&(weft_compressed){.common = &command->common,
                                                     .input = command->input,
                                                     .output = command->output,
                                                     .options = &state->options,
                                                     .dataset = state->dataset,
                                                     .material = &state->material,
                                                     .report = &state->report,
                                                     .held_out = &state->held_out,
                                                     .prediction = &state->prediction},
                                  error);
}

/* Tells before hours of work that the output cannot be written. */
static weft_code check_output(const char *path, weft_error *error)
{
    weft_atomic_file file;
    weft_code code = weft_atomic_file_begin(path, &file, error);
    weft_atomic_file_abandon(&file);
    return code;
}

static int run(int argc, char **argv)
{
    compress_command command = {.hold_out = ENOUGH_SPLITS, .weights = WEFT_WEIGHTS_BY_MODEL};
    weft_error error = {0};
    weft_arguments_parse(&weft_command_compress, argc, argv, &command);
    run_state state = {.command = &command, .progress = weft_command_progress(&command.common)};
    snprintf(state.scratch_path, sizeof state.scratch_path, "%s.held-out.btf.h5", command.output);
    snprintf(state.partial_path, sizeof state.partial_path, "%s.partial", command.output);
    weft_code code = check_output(command.output, &error);
    if (code == WEFT_OK)
        code = compress_dataset(&state, &error);
    weft_material_free(&state.material);
    weft_dataset_close(state.dataset);
    return weft_command_exit("compress", &command.common, code, &error);
}

const weft_command weft_command_compress = {
    .name = "compress",
    .summary = "fit a small model of reflectance to a dataset",
    .usage = "NAME.btf.h5 -o NAME.weft",
    .documentation = "Example: weft compress cloth.btf.h5 -o cloth.weft\n\n"
                     "Fits a small model to every texel and mip level of a dataset: components, whose tables all "
                     "texels share, or with --lobes 2 Lafortune lobes with a view table, which can be edited and "
                     "reach beyond the directions that were photographed. It measures the error on the samples that "
                     "were fitted and on directions that were not.\n\n"
                     "Samples are read in blocks while the blocks before are fitted. Finished blocks are kept in "
                     "NAME.weft.partial: if the command is killed, the same command goes on from there and writes the "
                     "same bytes. If the memory does not suffice, a message says how much would.",
    .options = option_table,
    .needs = "NAME.btf.h5 and -o NAME.weft",
    .surplus = "one dataset at a time",
    .check = check,
    .run = run,
};
