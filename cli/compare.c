#include "study/compare/compare.h"
#include "cli/arguments.h"
#include "cli/command.h"

#include <math.h>
#include <stdio.h>

typedef struct compare_command {
    common_options common;
    weft_compare_options options;
} compare_command;

enum { KEY_TILES = 0x2000, KEY_WEAVE, KEY_BARD, KEY_TRUTH, KEY_PATHS, KEY_FIT };
enum { MAX_PATHS = 65536 };

static const struct argp_option option_table[] = {
    {"output", 'o', "REPORT/", 0, "The folder for the page and its pictures", 0},
    {"weave", KEY_WEAVE, "CLOTH.wv|CLOTH.mc", 0, "Compare this weave or microcylinder cloth, too", 0},
    {"fit", KEY_FIT, NULL, 0, "Fit that weave to the dataset first (see fit-weave); writes REPORT/fitted.wv", 0},
    {"tiles", KEY_TILES, "X,Y", 0,
     "Tiles of a .wv across the material (default: as --fit finds, its file says, or the virtual rig lays it)", 0},
    {"bard", KEY_BARD, "NAME.bard.h5", 0, "Compare what `weft bard` predicted, too", 0},
    {"truth", KEY_TRUTH, "FILE.stitch", 0, "Trace the geometry that the dataset was simulated from, too", 0},
    {"paths", KEY_PATHS, "N", 0, "With --truth: paths of light for each pixel (default: 64)", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    compare_command *command = state->input;
    weft_compare_options *options = &command->options;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &command->common;
        return 0;
    case 'o':
        options->folder = argument;
        return 0;
    case KEY_WEAVE:
        options->weave = argument;
        return 0;
    case KEY_FIT:
        options->fit = true;
        return 0;
    case KEY_BARD:
        options->bard = argument;
        return 0;
    case KEY_TRUTH:
        options->truth = argument;
        return 0;
    case KEY_PATHS:
        options->truth_paths = (int)parse_whole("paths", argument, 4, MAX_PATHS, state);
        return 0;
    case KEY_TILES:
        parse_tiles("tiles", argument, &options->tiles_u, &options->tiles_v, state);
        return 0;
    case ARGP_KEY_ARG:
        if (state->arg_num > 1)
            argp_error(state, "a dataset and a material: '%s' is one too many", argument);
        *(state->arg_num == 0 ? &options->dataset : &options->material) = argument;
        return 0;
    case ARGP_KEY_END:
        if (!options->material || !options->folder)
            argp_error(state, "needs a dataset, a material and -o REPORT/");
        if (options->fit && !options->weave)
            argp_error(state, "--fit needs --weave, where the fit starts");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "NAME.btf.h5 NAME.weft -o REPORT/",
    "Example: weft compare silk.btf.h5 silk.weft --weave silk.wv --fit -o report/\n\n"
    "Writes one HTML page: dataset, material, analytic cloth and BARD side by side, the errors of each against the "
    "dataset, sample by sample and of the mean BRDF, slices of the mean BRDF, sizes and times. "
    "A dataset of fewer than 30 images is also fitted with each image left out, to see how well the others predict it.",
    children,
    NULL,
    NULL};

static void say_error(const common_options *common, const char *model, const char *what, const weft_error_summary *e)
{
    command_say(common, "%s, %s: relative RMSE %.4f, median relative error %.2f %%, 80th percentile %.2f %%", model,
                what, e->relative_rmse, 100 * e->median_relative, 100 * e->percentile80_relative);
    char event[256];
    snprintf(event, sizeof event,
             "{\"event\":\"error\",\"model\":\"%s\",\"of\":\"%s\",\"values\":%ld,\"relative_rmse\":%.6g,"
             "\"median_relative\":%.6g,\"percentile80_relative\":%.6g}",
             model, what, e->count, e->relative_rmse, e->median_relative, e->percentile80_relative);
    command_event(common, event);
}

static void say_truth_error(const common_options *common, const weft_truth_scene *scene, int light, int model)
{
    static const char *const name[WEFT_TRUTH_LIGHTS] = {"all", "near"};
    const weft_truth_error *e = &scene->under[light].error[model];
    const char *what = weft_truth_model_name((weft_truth_model)model);
    command_say(common, "%s, %s light, %s against truth: relative RMSE %.4f, PSNR %.2f dB, of blocks %.4f",
                scene->caption, name[light], what, e->error.relative_rmse, e->error.psnr_db, e->block_relative_rmse);
    char event[384];
    snprintf(event, sizeof event,
             "{\"event\":\"truth\",\"scene\":\"%s\",\"light\":\"%s\",\"model\":\"%s\",\"relative_rmse\":%.6g,"
             "\"psnr_db\":%.6g,\"block_relative_rmse\":%.6g}",
             scene->caption, name[light], what, e->error.relative_rmse,
             isfinite(e->error.psnr_db) ? e->error.psnr_db : 0, e->block_relative_rmse);
    command_event(common, event);
}

static void say_truth(const common_options *common, const weft_traced_truth *truth)
{
    if (truth->why_not[0])
        command_say(common, "no truth: %s", truth->why_not);
    if (truth->warning[0])
        command_say(common, "warning: %s", truth->warning);
    for (int i = 0; truth->drawn && i < WEFT_TRUTH_SCENE_COUNT; i++)
        for (int light = 0; light < WEFT_TRUTH_LIGHTS; light++)
            for (int model = 0; model < WEFT_TRUTH_TRACED; model++)
                say_truth_error(common, &truth->scene[i], light, model);
}

static void say_weave(const common_options *common, const weft_comparison *comparison)
{
    if (!comparison->weave_origin[0])
        return;
    command_say(common, "analytic: the %s '%s', %s", comparison->weave_is_threads ? "microcylinder cloth" : "weave",
                comparison->weave_name, comparison->weave_origin);
    if (comparison->fit.image_count > 0)
        command_say(common,
                    "analytic before the fit, mean BRDF: median relative error %.2f %%, 80th percentile %.2f %%",
                    100 * comparison->fit.before.median_relative, 100 * comparison->fit.before.percentile80_relative);
}

static void say_numbers(const compare_command *command, const weft_comparison *comparison)
{
    const common_options *common = &command->common;
    if (comparison->warning[0])
        command_say(common, "warning: %s", comparison->warning);
    say_weave(common, comparison);
    for (int i = 0; i < comparison->model_count; i++) {
        say_error(common, comparison->model[i].name, "samples", &comparison->model[i].texture.all);
        say_error(common, comparison->model[i].name, "mean BRDF", &comparison->model[i].mean);
    }
    command_say(common, "size: %.0f bytes, 1:%.1f of the half floats", comparison->material_bytes,
                comparison->half_float_bytes / comparison->material_bytes);
    if (comparison->left_out.count > 0)
        command_say(common, "leave one out: relative RMSE %.4f, median relative error %.4f (means of %d photographs)",
                    comparison->left_out.mean_relative_rmse, comparison->left_out.mean_median_relative,
                    comparison->left_out.count);
    if (!comparison->scenes.drawn)
        command_say(common, "no pictures of scenes: %s", comparison->scenes.why_not);
    say_truth(common, &comparison->truth);
    command_say(common, "page: %s/index.html", command->options.folder);
}

int command_compare(int argc, char **argv)
{
    compare_command command = {.options.truth_paths = WEFT_TRUTH_DEFAULT_PATHS};
    command_parse(&parser, argc, argv, &command, &command.common);
    weft_progress progress = command_progress(&command.common);
    weft_comparison comparison;
    weft_error error = {0};
    weft_code code = weft_compare(&command.options, &progress, &comparison, &error);
    if (code == WEFT_OK) {
        say_numbers(&command, &comparison);
        weft_comparison_free(&comparison);
    }
    return command_exit("compare", &command.common, code, &error);
}
