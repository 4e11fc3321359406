#include "compress/compress.h"
#include "base/atomic_file.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "study/inspect/model_report.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct compress_command {
    conversion files;
    const char *report;
    weft_compress_options options;
} compress_command;

enum {
    KEY_LOBES = 0x2000,
    KEY_TABLE,
    KEY_LIGHT_TABLE,
    KEY_WEIGHTS,
    KEY_LEVELS,
    KEY_FRAMES,
    KEY_MAX_EXPONENT,
    KEY_ERROR,
    KEY_BUDGET,
    KEY_REPORT,
    KEY_MEMORY,
    KEY_TABLES
};

static const struct argp_option option_table[] = {
    {"output", 'o', "NAME.weft", 0, "The material to write", 0},
    {"lobes", KEY_LOBES, "0..3", 0, "Lafortune lobes a texel and channel, at most (default: 2)", 0},
    {"table", KEY_TABLE, "on|off", 0, "View table T, where the samples can carry it (default: on)", 0},
    {"light-table", KEY_LIGHT_TABLE, "on|off", 0,
     "Light table S beside T, as large and several times the time; where lights repeat (default: off)", 0},
    {"tables", KEY_TABLES, "8bit|pca:K", 0,
     "Store T and S in 8 bits for each direction, or by K principal components across texels: a fraction of the size; "
     "lobes are fitted to what is stored, in a second pass (default: 8bit)",
     0},
    {"weights", KEY_WEIGHTS, "even|screen", 0,
     "What an error of a sample counts for. even: all alike, least squares. screen: less the brighter the sample, as a "
     "screen shows it; where lobes cannot follow a highlight, its surroundings keep their colour (default: even)",
     0},
    {"levels", KEY_LEVELS, "on|off", 0, "Mip levels (default: on)", 0},
    {"frames", KEY_FRAMES, "on|off|given", 0,
     "Turn the frame of each texel where that helps, from that of the surface and from the one that the dataset gives; "
     "given: as the dataset says; off: the frame of the surface everywhere, fastest (default: on)",
     0},
    {"max-exponent", KEY_MAX_EXPONENT, "N", 0, "Largest exponent of a lobe (default: 8192)", 0},
    {"error", KEY_ERROR, "PERCENT", 0,
     "Give each texel the smallest model whose relative RMSE is at most this: a diffuse term, lobes, T, S, as few bits "
     "of them as will do; the whole model "
     "where none is (default: the whole model everywhere)",
     0},
    {"budget", KEY_BUDGET, "MB", 0,
     "Choose the model of each texel so that the error is least and the file no larger; tables may have fewer bits. "
     "Fits "
     "every model first, without a checkpoint",
     0},
    {"report", KEY_REPORT, "DIR", 0,
     "With --error or --budget: a page with a map of the models that were chosen, and their shares by level", 0},
    {"memory", KEY_MEMORY, "MB", 0, "Never take more memory than this (default: a quarter of what there is)", 0},
    {0},
};

static weft_frame_choice parse_frames(const char *argument, struct argp_state *state)
{
    if (strcmp(argument, "given") == 0)
        return WEFT_FRAMES_GIVEN;
    return parse_switch("frames", argument, state) ? WEFT_FRAMES_FITTED : WEFT_FRAMES_SURFACE;
}

static weft_sample_weights parse_weights(const char *argument, struct argp_state *state)
{
    if (strcmp(argument, "even") != 0 && strcmp(argument, "screen") != 0)
        argp_error(state, "--weights is even or screen, not '%s'", argument);
    return strcmp(argument, "screen") == 0 ? WEFT_WEIGHTS_SCREEN : WEFT_WEIGHTS_EVEN;
}

static int parse_tables(char *argument, struct argp_state *state)
{
    if (strcmp(argument, "8bit") == 0)
        return 0;
    if (strncmp(argument, "pca:", 4) != 0)
        argp_error(state, "--tables is 8bit or pca:K, not '%s'", argument);
    return (int)parse_whole("tables pca:", argument + 4, 1, WEFT_BASIS_MAX_COMPONENTS, state);
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    compress_command *command = state->input;
    weft_compress_options *options = &command->options;
    switch (key) {
    case KEY_LOBES:
        options->lobe_count = (int)parse_whole("lobes", argument, 0, WEFT_MATERIAL_MAX_LOBES, state);
        return 0;
    case KEY_TABLE:
        options->table = parse_switch("table", argument, state);
        return 0;
    case KEY_LIGHT_TABLE:
        options->light_table = parse_switch("light-table", argument, state);
        return 0;
    case KEY_TABLES:
        options->table_components = parse_tables(argument, state);
        return 0;
    case KEY_WEIGHTS:
        options->weights = parse_weights(argument, state);
        return 0;
    case KEY_LEVELS:
        options->levels = parse_switch("levels", argument, state);
        return 0;
    case KEY_FRAMES:
        options->frames = parse_frames(argument, state);
        return 0;
    case KEY_MAX_EXPONENT:
        options->max_exponent = parse_number("max-exponent", argument, 1, 60000, state);
        return 0;
    case KEY_ERROR:
        options->target_error = parse_number("error", argument, 0.001, 100, state) / 100;
        return 0;
    case KEY_BUDGET:
        options->budget_bytes = (uint64_t)(1e6 * parse_number("budget", argument, 1e-3, 1e9, state));
        return 0;
    case KEY_REPORT:
        command->report = argument;
        return 0;
    case KEY_MEMORY:
        options->memory_bytes = 1000000 * parse_whole("memory", argument, 1, 1000000000, state);
        return 0;
    case ARGP_KEY_END:
        if (options->target_error > 0 && options->budget_bytes > 0)
            argp_error(state, "give --error or --budget, not both");
        if (options->table_components > 0 && (options->target_error > 0 || options->budget_bytes > 0))
            argp_error(state, "--tables pca:K is shared by all texels: leave out --error and --budget");
        if (command->report && !(options->target_error > 0 || options->budget_bytes > 0))
            argp_error(state, "--report needs --error or --budget: else all texels have the same model");
        return parse_conversion(key, argument, state, &command->files);
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {option_table,
                                   parse_option,
                                   "NAME.btf.h5 -o NAME.weft",
                                   "Example: weft compress cloth.btf.h5 -o cloth.weft --lobes 2\n\n"
                                   "Fits Lafortune lobes with a view table to every texel of every mip level of a "
                                   "dataset, and measures what the result leaves. With too few images for that, "
                                   "fits what they can carry and says so.\n\n"
                                   "Samples are read in blocks while the blocks before are fitted. What is done is "
                                   "kept in NAME.weft.partial: killed, the same command goes on where it stopped and "
                                   "ends with the same bytes. Where the memory does not suffice it says how much "
                                   "would.",
                                   children,
                                   NULL,
                                   NULL};

static void say_model(const compress_command *command, const weft_dataset_layout *layout,
                      const weft_compress_report *report)
{
    const common_options *common = &command->files.common;
    const char *table = report->model == WEFT_COMPRESS_TABLE ? " with a view table" : "";
    command_say(common, "%d x %d texels, %d images, %d lobes%s%s", layout->width, layout->height, layout->image_count,
                report->lobe_count, table, report->light_count > 0 ? " and a light table" : "");
    if (command->options.table_components > 0 && report->table_components == 0)
        command_say(common, "these images carry no tables: --tables changes nothing");
    if (command->options.weights != WEFT_WEIGHTS_EVEN && report->model == WEFT_COMPRESS_SPARSE)
        command_say(common, "with so few images --weights changes nothing");
    if (report->model == WEFT_COMPRESS_SPARSE)
        command_say(common,
                    "%d images cannot carry lobes in every texel: exponents and normals are shared with the "
                    "neighbours, only amplitudes are the texel's own",
                    layout->image_count);
    else if (report->lobe_count < command->options.lobe_count ||
             (command->options.table && report->model != WEFT_COMPRESS_TABLE))
        command_say(common, "%s: fitted %d lobes without a table",
                    layout->distance == WEFT_NEAR ? "near cameras or too few images" : "too few images",
                    report->lobe_count);
    command_say(common, "masked: %.2f %% of the samples; %ld of %ld texels without any",
                100.0 * (double)report->masked_count / (double)report->sample_count, report->empty_texel_count,
                report->texel_count);
    command_say(common, "frames turned: %.1f %% of the texels; retro-reflective starts: %.1f %%",
                100.0 * (double)report->turned_frame_count / (double)report->texel_count,
                100.0 * (double)report->second_start_count / (double)report->texel_count);
}

static void say_target(const compress_command *command, const weft_compress_report *report)
{
    if (command->options.target_error > 0)
        command_say(&command->files.common, "relative RMSE above %g %% with the whole model: %ld of %ld texels",
                    100 * command->options.target_error, report->missed_texel_count, report->texel_count);
}

static void say_errors(const common_options *common, const weft_material *material)
{
    command_say(common, "level       texels   median rel.  80 %% rel.  RMSE       rel. RMSE  PSNR dB");
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        const weft_error_summary *error = &level->error;
        command_say(common, "%5d  %5d x %-5d  %10.4f  %9.4f  %9.3e  %9.4f  %7.2f", k, level->width, level->height,
                    error->median_relative, error->percentile80_relative, error->rmse, error->relative_rmse,
                    error->psnr_db);
        char event[320];
        snprintf(event, sizeof event,
                 "{\"event\":\"level\",\"level\":%d,\"width\":%d,\"height\":%d,\"median_relative\":%.6g,"
                 "\"percentile80_relative\":%.6g,\"rmse\":%.6g,\"relative_rmse\":%.6g,\"psnr_db\":%.6g}",
                 k, level->width, level->height, error->median_relative, error->percentile80_relative, error->rmse,
                 error->relative_rmse, isfinite(error->psnr_db) ? error->psnr_db : 0);
        command_event(common, event);
    }
}

static void say_sizes(const compress_command *command, const weft_dataset_layout *layout,
                      const weft_compress_report *report)
{
    double samples = 6.0 * layout->width * layout->height * layout->image_count;
    double material = (double)weft_file_bytes(command->files.output);
    command_say(&command->files.common,
                "%s: %.2f MB, 1:%.0f of the samples as half floats (%.1f MB; the file has %.1f MB)",
                command->files.output, material * 1e-6, material > 0 ? samples / material : 0, samples * 1e-6,
                (double)weft_file_bytes(command->files.input) * 1e-6);
    if (report->read_seconds > 0)
        command_say(&command->files.common, "read %.1f MB in %ld blocks at %.0f MB/s; the fit waited for it %.1f s",
                    report->read_bytes * 1e-6, report->block_count - report->resumed_block_count,
                    report->read_bytes * 1e-6 / report->read_seconds, report->starved_seconds);
    command_say(&command->files.common, "fitted in %.1f s", report->seconds);
}

static void say_note(void *context, const char *text)
{
    command_say(context, "%s", text);
}

/* Tells before hours of work that the output cannot be written. */
static weft_code check_output(const char *path, weft_error *error)
{
    weft_atomic_file file;
    weft_code code = weft_atomic_file_begin(path, &file, error);
    weft_atomic_file_abandon(&file);
    return code;
}

static weft_code compress_dataset(const compress_command *command, const char *partial_path, weft_error *error)
{
    weft_progress progress = command_progress(&command->files.common);
    weft_compress_options options = command->options;
    options.checkpoint_path = partial_path;
    options.log = (weft_log){say_note, (void *)&command->files.common};
    weft_dataset *dataset = NULL;
    weft_material material = {0};
    weft_compress_report report;
    weft_code code = weft_dataset_open(command->files.input, &dataset, error);
    if (code == WEFT_OK)
        code = weft_compress(dataset, &options, &progress, &material, &report, error);
    if (code == WEFT_OK)
        code = weft_material_write(command->files.output, &material, error);
    if (code == WEFT_OK && command->report)
        code = weft_model_report_write(command->report, &material, error);
    if (code == WEFT_OK) {
        const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
        unlink(partial_path);
        say_model(command, layout, &report);
        say_target(command, &report);
        say_errors(&command->files.common, &material);
        say_sizes(command, layout, &report);
    }
    weft_material_free(&material);
    weft_dataset_close(dataset);
    return code;
}

int command_compress(int argc, char **argv)
{
    compress_command command = {.files = {.noun = "dataset", .needed = "NAME.btf.h5 and -o NAME.weft"},
                                .options = weft_compress_default_options()};
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_error error = {0};
    char partial_path[PATH_MAX];
    weft_code code = check_output(command.files.output, &error);
    if (code == WEFT_OK) {
        snprintf(partial_path, sizeof partial_path, "%s.partial", command.files.output);
        code = compress_dataset(&command, partial_path, &error);
    }
    return command_exit("compress", &command.files.common, code, &error);
}
