#include "compare/tradeoff/tradeoff.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"

typedef struct tradeoff_command {
    weft_common_options common;
    const char *input, *folder, *weave;
} tradeoff_command;

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(tradeoff_command, input)},
    {"output", 'o', "REPORT/", "The folder for the page and its pictures", .is_required = true,
     .kind = WEFT_OPTION_FOLDER, .offset = offsetof(tradeoff_command, folder)},
    {"weave", 0, "CLOTH.wv|CLOTH.mc", "Add a weave, fitted to the dataset, or microcylinder cloth (.mc) as it is",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(tradeoff_command, weave)},
    {0},
};

static void say_row(const weft_common_options *common, const weft_tradeoff_row *row)
{
    const weft_error_summary *held = &row->measured.held[WEFT_SAMPLES_ALL],
                             *fitted = &row->measured.fitted[WEFT_SAMPLES_ALL];
    char frame[32] = "", beside[32] = "", width[32] = "", presets[64];
    weft_tradeoff_print_presets(row, presets, sizeof presets);
    if (row->price.frame_ms > 0)
        snprintf(frame, sizeof frame, "%.1f", row->price.frame_ms);
    if (fitted->count > 0)
        snprintf(beside, sizeof beside, "%.2f %%", 100 * fitted->relative_rmse);
    if (row->measured.interval_width > 0)
        snprintf(width, sizeof width, "%.1f %%", 100 * row->measured.interval_width);
    weft_command_say(common, "%-36s %12.0f %8.1f %9s %10.2f %% %8s %9s  %s", row->model.name, row->price.bytes,
                     row->price.fit_s, frame, 100 * held->relative_rmse, beside, width, presets);
}

static weft_code say_results(const tradeoff_command *command, const weft_tradeoff *result, weft_error *error)
{
    const weft_common_options *common = &command->common;
    char held[160];
    weft_tradeoff_print_held(result, held, sizeof held);
    char times[32] = "", lobes[48] = "";
    if (result->split_count > 1 && result->measured_texels != result->neighbours)
        snprintf(times, sizeof times, " %d times", result->split_count);
    if (result->lobe_texels != result->measured_texels)
        snprintf(lobes, sizeof lobes, ", lobes on %ld", result->lobe_texels);
    weft_command_say(common, "relative RMSE with %s held out%s, on %ld of %ld texels%s:", held, times,
                     result->measured_texels, result->texels, lobes);
    weft_command_say(common, "%-36s %12s %8s %9s %12s %8s %9s", "model", "bytes", "fit, s", "ms a frame", "not fitted",
                     "fitted", "95 % wide");
    for (int i = 0; i < result->row_count; i++) {
        say_row(common, &result->row[i]);
        WEFT_TRY(weft_command_report(common, "model", weft_tradeoff_row_to_json(&result->row[i]), error));
    }
    if (result->why_not_drawn[0])
        weft_command_say(common, "no times of frames: %s", result->why_not_drawn);
    weft_command_say_page(common, "page", command->folder);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    tradeoff_command command = {0};
    weft_arguments_parse(&weft_command_tradeoff, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    weft_tradeoff result;
    weft_error error = {0};
    weft_code code = weft_tradeoff_study(command.input, command.weave, command.folder, &progress, &result, &error);
    if (code == WEFT_OK) {
        code = say_results(&command, &result, &error);
        weft_tradeoff_free(&result);
    }
    return weft_command_exit("tradeoff", &command.common, code, &error);
}

const weft_command weft_command_tradeoff = {
    .name = "tradeoff",
    .summary = "list bytes, time and error of every model of a dataset",
    .usage = "NAME.btf.h5 -o REPORT/",
    .documentation =
        "Example: weft tradeoff silk.btf.h5 -o silk-prices\n\n"
        "Fits every model that the dataset supports: lobes, components, fewer photographs and texels, BARD "
        "from one light, models of RTI of one view, products of matrices of a grid, and a weave with --weave. Writes "
        "one HTML page with bytes, time of the fit and of a frame, and the error on held-out and on fitted "
        "photographs; plots; the models that no other one beats; and the same as comma-separated values. Takes "
        "minutes.",
    .options = option_table,
    .needs = "a dataset and -o REPORT/",
    .surplus = "one dataset at a time",
    .run = run,
};
