#include "compress/compress.h"
#include "base/atomic_file.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "cli/command/arguments.h"
#include "cli/compress_held_out.h"
#include "cli/compress_words.h"
#include "compress/hold_out/hold_out.h"
#include "inspect/inspect.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct compress_command {
    weft_common_options common;
    const char *input, *output, *report;
    weft_compress_options options;
    int hold_out;                 /* splits; 0: off */
    int lobes, table, components; /* NOT_GIVEN, or as in the options */
    weft_preset preset;
    double least_fps; /* 0: any */
} compress_command;

enum { NOT_GIVEN = -1 };

static weft_code read_budget(const weft_option *option, const char *text, void *values, weft_error *error)
{
    double megabytes;
    WEFT_TRY(weft_option_number(option->name, text, 1e-3, 1e9, &megabytes, error));
    ((compress_command *)values)->options.budget_bytes = (uint64_t)(1e6 * megabytes);
    return WEFT_OK;
}

static weft_code read_memory(const weft_option *option, const char *text, void *values, weft_error *error)
{
    unsigned long long megabytes;
    WEFT_TRY(weft_option_whole(option->name, text, 1, 1000000000, &megabytes, error));
    ((compress_command *)values)->options.memory_bytes = 1000000 * megabytes;
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

/* In the order of weft_frame_choice and of weft_sample_weights. */
static const char *const frame_words[] = {"off", "given", "on", NULL};
static const char *const switch_words[] = {"off", "on", NULL};
static const char *const preset_words[] = {"off", "small", "balanced", "best", NULL}; /* in the order of weft_preset */
static const char *const weight_words[] = {"even", "screen", NULL};

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(compress_command, input)},
    {"output", 'o', "NAME.weft", "The material to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(compress_command, output)},
    {"lobes", .argument = "0..3",
     .help = "Lafortune lobes a texel and channel, at most, instead of components (default: 2 where there are no "
             "components)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(compress_command, lobes), .low = 0, .high = WEFT_MATERIAL_MAX_LOBES},
    {"table", .argument = "on|off",
     .help = "View table T beside the lobes, where the samples can carry it (default: on, without components)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(compress_command, table), .words = switch_words},
    {"components", .argument = "K",
     .help =
         "K components, 4 to 64, a multiple of 4: K bytes a texel and tables that all texels share; 0: none. "
         "Without --lobes and --table there is a diffuse term beside them, for players without components (default: 8 "
         "for "
         "fewer than 20 images, 16 for fewer than 100, else 32; 0 for fewer than 20 near images, and where an option "
         "asks for lobes or tables)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(compress_command, components), .low = 0,
     .high = WEFT_COMPONENTS_MAX},
    {"light-table", .argument = "on|off",
     .help = "Light table S beside T, as large and several times the time; where lights repeat (default: off)",
     .kind = WEFT_OPTION_SWITCH, .offset = offsetof(compress_command, options.light_table)},
    {"weights", .argument = "even|screen",
     .help = "What an error of a sample counts for. even: all alike, least squares. screen: less the brighter the "
             "sample, as a screen shows it; where lobes cannot follow a highlight, its surroundings keep their colour "
             "(default: even)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(compress_command, options.weights), .words = weight_words},
    {"levels", .argument = "on|off", .help = "Mip levels (default: on)", .kind = WEFT_OPTION_SWITCH,
     .offset = offsetof(compress_command, options.levels)},
    {"heights", .argument = "on|off",
     .help =
         "With components: see them through the heights that `weft relief` found, where held-out photographs say that "
         "this helps (default: on)",
     .kind = WEFT_OPTION_SWITCH, .offset = offsetof(compress_command, options.heights)},
    {"rounding", .argument = "on|off",
     .help = "With components: round their numbers where what they leave of the photographs hides it. Files of small "
             "cloths are a third as large; Weft of before 27 November 2026 does not read it (default: off)",
     .kind = WEFT_OPTION_SWITCH, .offset = offsetof(compress_command, options.rounded)},
    {"frames", .argument = "on|off|given",
     .help = "Turn the frame of each texel where that helps, from that of the surface and from the one that the "
             "dataset gives; given: as the dataset says; off: the frame of the surface everywhere, fastest (default: "
             "on)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(compress_command, options.frames), .words = frame_words},
    {"max-exponent", .argument = "N", .help = "Largest exponent of a lobe (default: 8192)", .kind = WEFT_OPTION_NUMBER,
     .offset = offsetof(compress_command, options.max_exponent), .low = 1, .high = 60000},
    {"error", .argument = "PERCENT",
     .help = "Give each texel the smallest model whose relative RMSE is at most this: a diffuse term, lobes, T, S, as "
             "few bits of them as will do; the whole model where none is (default: the whole model everywhere). Says "
             "before "
             "the work, as --preset does, how large the file will be and how well it will predict what is not fitted",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(compress_command, options.target_error), .low = 0.001, .high = 100,
     .divisor = 100},
    {"budget", .argument = "MB",
     .help = "Choose the model of each texel so that the error is least and the file no larger; tables may have fewer "
             "bits. Fits every model first, without a checkpoint. Predicts as --error does",
     .read = read_budget},
    {"preset", .argument = "small|balanced|best",
     .help =
         "Choose lobes, tables or components: tries models on some texels, without some of the views and of the "
         "lights, "
         "and says before the work how large the file will be and how well it will predict these; afterwards how "
         "large it is, and how well it does. small: few bytes; best: the least error; balanced: between them, where "
         "more bytes gain little (see tradeoff)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(compress_command, preset), .words = preset_words},
    {"fps", .argument = "N",
     .help = "Choose as --preset does (default: best), of the models of which this machine draws at least so many "
             "frames a second: 730 x 400 pixels, every texel, level and direction evaluated",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(compress_command, least_fps), .low = 0.01, .high = 10000},
    {"hold-out", .argument = "off|N",
     .help =
         "Fit some texels N times without about a tenth of the views and of the lights, others each time, and say "
         "how well the material predicts these (default: 1, or more where few are held out); the material itself is "
         "fitted to all images",
     .read = read_hold_out},
    {"report", .argument = "DIR",
     .help = "With --error or --budget: a page with a map of the models that were chosen, and their shares by level",
     .kind = WEFT_OPTION_FOLDER, .offset = offsetof(compress_command, report)},
    {"memory", .argument = "MB", .help = "Never take more memory than this (default: a quarter of what there is)",
     .read = read_memory},
    {0},
};

/* Without a preset, fast frames are to be as good as they can be. What draws them keeps memory that the fit may need.
 */
static weft_preset_wish wish_of(const compress_command *command)
{
    bool alone = command->preset == WEFT_PRESET_NONE && command->least_fps > 0;
    return (weft_preset_wish){.preset = alone ? WEFT_PRESET_BEST : command->preset,
                              .least_fps = command->least_fps,
                              .times_frames = !command->common.quiet && command->options.memory_bytes == 0,
                              .measured_splits = command->hold_out};
}

/* Whether each texel gets a model of its own. */
static bool chooses_by_texel(const weft_compress_options *options)
{
    return options->target_error > 0 || options->budget_bytes > 0;
}

/* A preset chooses what these options say. */
static weft_code check_preset(const compress_command *command, weft_error *error)
{
    const weft_compress_options usual = weft_compress_default_options(), *o = &command->options;
    bool chosen = command->lobes != NOT_GIVEN || command->table != NOT_GIVEN || command->components != NOT_GIVEN ||
                  o->light_table || o->rounded || o->frames != usual.frames || chooses_by_texel(o);
    if (wish_of(command).preset == WEFT_PRESET_NONE || !chosen)
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE,
                     "--preset and --fps choose the model: leave out --lobes, --table, --light-table, --components, "
                     "--rounding, --frames, --error and --budget");
}

/* Where components are chosen by the number of photographs, weft_compress says it. */
static weft_code check_rounding(const compress_command *command, weft_error *error)
{
    const weft_compress_options *o = &command->options;
    bool of_lobes = command->lobes != NOT_GIVEN || command->table != NOT_GIVEN || o->light_table || chooses_by_texel(o);
    if (!o->rounded || command->components > 0 || (command->components == NOT_GIVEN && !of_lobes))
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE, "--rounding is for components: ask for some with --components");
}

static weft_code check(void *values, weft_error *error)
{
    const compress_command *command = values;
    const weft_compress_options *o = &command->options;
    WEFT_TRY(check_preset(command, error));
    WEFT_TRY(check_rounding(command, error));
    if (command->components > 0 && command->components % WEFT_COMPONENTS_GROUP != 0)
        return weft_fail(error, WEFT_BAD_USAGE, "--components is a multiple of %d, not %d", WEFT_COMPONENTS_GROUP,
                         command->components);
    bool chooses = chooses_by_texel(o);
    if (command->components > 0 && chooses)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--error and --budget choose lobes and tables for each texel: leave out --components");
    if (o->target_error > 0 && o->budget_bytes > 0)
        return weft_fail(error, WEFT_BAD_USAGE, "give --error or --budget, not both");
    if (command->report && !chooses)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--report needs --error or --budget: else all texels have the same model");
    return WEFT_OK;
}

/* Tells before hours of work that the output cannot be written. */
static weft_code check_output(const char *path, weft_error *error)
{
    weft_atomic_file file;
    weft_code code = weft_atomic_file_begin(path, &file, error);
    weft_atomic_file_abandon(&file);
    return code;
}

/* Beside components lobes are for those who cannot play components, unless they were asked for; opacity lies in the
 * table. */
static weft_compress_options resolve(const compress_command *command, const weft_dataset *dataset)
{
    weft_compress_options options = command->options;
    bool lobes_given = command->lobes != NOT_GIVEN || command->table != NOT_GIVEN;
    bool alone = command->components == NOT_GIVEN || command->components == 0;
    options.component_count = command->components != NOT_GIVEN ? command->components
                              : lobes_given                    ? 0
                                                               : WEFT_COMPONENTS_AUTOMATIC;
    options.lobe_count = command->lobes != NOT_GIVEN ? command->lobes : alone ? options.lobe_count : 0;
    options.table = command->table != NOT_GIVEN ? command->table : alone || weft_dataset_has_opacity(dataset);
    return weft_compress_settle(&options, dataset);
}

/* Lobes that nobody has asked for, in place of components that nobody has asked for. */
static void ask_lobes(const compress_command *command, const weft_held_out_job *job, weft_dataset *dataset,
                      const weft_compress_options *options, const weft_hold_out *held_out)
{
    compress_command other = *command;
    bool by_default = command->components == NOT_GIVEN && options->component_count > 0 &&
                      wish_of(command).preset == WEFT_PRESET_NONE && !chooses_by_texel(options);
    other.lobes = 1;
    const weft_compress_options lobes = resolve(&other, dataset);
    if (by_default)
        weft_ask_lobes(job, dataset, &lobes, held_out);
}

/* What is predicted is told before the work. Of what was asked for, nothing need be: where no image can be held out, or
 * the fit fails, the user hears it, and the work says the rest. */
static weft_code predict(const compress_command *command, weft_dataset *dataset, weft_compress_options *options,
                         const weft_progress *progress, weft_prediction *prediction, weft_error *error)
{
    char scratch_path[PATH_MAX];
    weft_error own = {0};
    const weft_preset_wish wish = wish_of(command);
    bool must = wish.preset != WEFT_PRESET_NONE;
    *prediction = (weft_prediction){0};
    if (!must && !chooses_by_texel(options))
        return WEFT_OK;
    if (!must && options->memory_bytes > 0) {
        weft_command_say(&command->common, "size and error: not predicted: it might take more than --memory allows");
        return WEFT_OK;
    }
    snprintf(scratch_path, sizeof scratch_path, "%s.held-out.btf.h5", command->output);
    weft_code code =
        weft_preset_predict(dataset, &wish, scratch_path, progress, options, prediction, must ? error : &own);
    if (code == WEFT_OK)
        return weft_say_prediction(&command->common, prediction, error);
    *prediction = (weft_prediction){0};
    if (!must && (code == WEFT_BAD_USAGE || code == WEFT_BAD_INPUT)) {
        weft_command_say(&command->common, "size and error: not predicted: %s", own.message);
        return WEFT_OK;
    }
    if (!must)
        *error = own;
    return code;
}

/* The budget leaves room for what is predicted. */
static weft_code reserve(const weft_prediction *prediction, weft_compress_options *options, weft_error *error)
{
    uint64_t bytes = 0;
    if (prediction->bytes > 0)
        WEFT_TRY(weft_prediction_stored_bytes(prediction, &bytes, error));
    options->added_bytes += bytes;
    return WEFT_OK;
}

static weft_code compress_dataset(const compress_command *command, const char *partial_path, weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_compress_options options = command->options;
    weft_dataset *dataset = NULL;
    weft_material material = {0};
    weft_compress_report report;
    weft_hold_out held_out;
    weft_prediction prediction = {0};
    weft_code code = weft_dataset_open(command->input, &dataset, error);
    if (code == WEFT_OK) {
        options = resolve(command, dataset);
        code = predict(command, dataset, &options, &progress, &prediction, error);
    }
    const weft_held_out_job job = {&command->common, command->output, command->hold_out, &progress};
    if (code == WEFT_OK)
        code = weft_measure_held_out(&job, dataset, &options, &held_out, error);
    if (code == WEFT_OK)
        ask_lobes(command, &job, dataset, &options, &held_out);
    if (code == WEFT_OK)
        code = reserve(&prediction, &options, error);
    if (code == WEFT_OK) {
        options.checkpoint_path = partial_path;
        options.log = weft_command_log(&command->common);
        code = weft_compress(dataset, &options, &progress, &material, &report, error);
    }
    if (code == WEFT_OK && held_out.split_count > 0)
        code = weft_hold_out_store(&held_out, &material, error);
    if (code == WEFT_OK && prediction.bytes > 0)
        code = weft_material_put_metadata(&material, "predicted", weft_prediction_to_json(&prediction), error);
    if (code == WEFT_OK)
        code = weft_material_write(command->output, &material, error);
    if (code == WEFT_OK && command->report)
        code = weft_model_report_write(command->report, &material, error);
    if (code == WEFT_OK) {
        unlink(partial_path);
        weft_sweep_left_over(command->output);
        code = weft_say_compressed(&(weft_compressed){.common = &command->common,
                                                      .input = command->input,
                                                      .output = command->output,
                                                      .options = &options,
                                                      .dataset = dataset,
                                                      .material = &material,
                                                      .report = &report,
                                                      .held_out = &held_out,
                                                      .prediction = &prediction},
                                   error);
    }
    weft_material_free(&material);
    weft_dataset_close(dataset);
    return code;
}

static int run(int argc, char **argv)
{
    compress_command command = {.options = weft_compress_default_options(),
                                .hold_out = NOT_GIVEN,
                                .lobes = NOT_GIVEN,
                                .table = NOT_GIVEN,
                                .components = NOT_GIVEN};
    weft_arguments_parse(&weft_command_compress, argc, argv, &command);
    weft_error error = {0};
    char partial_path[PATH_MAX];
    weft_code code = check_output(command.output, &error);
    if (code == WEFT_OK) {
        snprintf(partial_path, sizeof partial_path, "%s.partial", command.output);
        code = compress_dataset(&command, partial_path, &error);
    }
    return weft_command_exit("compress", &command.common, code, &error);
}

const weft_command weft_command_compress = {
    .name = "compress",
    .summary = "fit a small model of reflectance to a dataset",
    .usage = "NAME.btf.h5 -o NAME.weft",
    .documentation = "Example: weft compress cloth.btf.h5 -o cloth.weft\n\n"
                     "Fits a small model to every texel of every mip level of a dataset: components, whose tables "
                     "all texels share, or with --lobes 2 Lafortune lobes with a view table, which need no table "
                     "of their neighbours, can be edited and reach beyond what was photographed. It measures what the "
                     "result leaves: of the samples that it was fitted to, and of directions that it was not. With too "
                     "few images for that, fits what they can carry and says so.\n\n"
                     "Samples are read in blocks while the blocks before are fitted. What is done is "
                     "kept in NAME.weft.partial: killed, the same command goes on where it stopped and "
                     "ends with the same bytes. Where the memory does not suffice it says how much "
                     "would.",
    .options = option_table,
    .needs = "NAME.btf.h5 and -o NAME.weft",
    .surplus = "one dataset at a time",
    .check = check,
    .run = run,
};
