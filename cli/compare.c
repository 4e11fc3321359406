#include "compare/report/compare.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "compress/bard/predict.h"

#include <stdio.h>

typedef struct compare_command {
    weft_common_options common;
    weft_compare_options options;
} compare_command;

enum { MAX_PATHS = 65536, SMALLEST_PICTURE = 32, LARGEST_PICTURE = 4096 };

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(compare_command, options.dataset)},
    {.argument = "NAME.weft",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(compare_command, options.material)},
    {"output", 'o', "REPORT/", "The folder for the page and its pictures", .is_required = true,
     .kind = WEFT_OPTION_FOLDER, .offset = offsetof(compare_command, options.folder)},
    {"weave", .argument = "CLOTH.wv|CLOTH.mc", .help = "Compare this weave or microcylinder cloth, too",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(compare_command, options.weave)},
    {"fit", .help = "Fit that weave to the dataset first (see fit-weave); writes REPORT/fitted.wv",
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(compare_command, options.fit)},
    {"tiles", .argument = "X,Y",
     .help = "Tiles of a .wv across the material (default: those that --fit finds, else those in its file, else those "
             "of the virtual rig)",
     .kind = WEFT_OPTION_PAIR, .offset = offsetof(compare_command, options.tiles_u), .high = 1e6},
    {"bard", .argument = "NAME.bard.h5", .help = "Compare this prediction of `weft bard`, too",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(compare_command, options.bard)},
    {"truth", .argument = "FILE.stitch", .help = "Trace the geometry that the dataset was simulated from, too",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(compare_command, options.truth)},
    {"paths", .argument = "N", .help = "With --truth: light paths for each pixel (default: 64)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(compare_command, options.truth_paths), .low = 4, .high = MAX_PATHS},
    {"size", .argument = "N", .help = "Pixels along each side of the pictures of scenes (default: 400)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(compare_command, options.picture_side), .low = SMALLEST_PICTURE,
     .high = LARGEST_PICTURE},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    const weft_compare_options *o = &((compare_command *)values)->options;
    if (o->fit && !o->weave)
        return weft_fail(error, WEFT_BAD_USAGE, "--fit needs --weave, the start of the fit");
    if (o->tiles_u > 0 && !o->weave)
        return weft_fail(error, WEFT_BAD_USAGE, "--tiles needs --weave CLOTH.wv");
    if (o->truth_paths > 0 && !o->truth)
        return weft_fail(error, WEFT_BAD_USAGE, "--paths needs --truth FILE.stitch");
    return WEFT_OK;
}

static void say_error(const weft_common_options *common, const char *model, const char *what,
                      const weft_error_summary *e)
{
    weft_command_say(common, "%s, %s: relative RMSE %.2f %%, median relative error %.2f %%, 80th percentile %.2f %%",
                     model, what, 100 * e->relative_rmse, 100 * e->median_relative, 100 * e->percentile80_relative);
    char event[256];
    snprintf(event, sizeof event,
             "{\"event\":\"measurement\",\"model\":\"%s\",\"of\":\"%s\",\"values\":%ld,\"relative_rmse\":%.6g,"
             "\"median_relative\":%.6g,\"percentile80_relative\":%.6g}",
             model, what, e->count, e->relative_rmse, e->median_relative, e->percentile80_relative);
    weft_command_event(common, event);
}

static void say_truth_error(const weft_common_options *common, const weft_truth_scene *scene, int light, int model,
                            bool flat)
{
    static const char *const name[WEFT_TRUTH_LIGHTS] = {"all", "near"};
    const weft_truth_pictures *under = &scene->under[light];
    const weft_truth_error *e = flat ? &under->flat[model] : &under->error[model];
    char what[64];
    snprintf(what, sizeof what, "%s%s", weft_truth_model_name((weft_truth_model)model), flat ? " without heights" : "");
    weft_command_say(common, "%s, %s light, %s against truth: relative RMSE %.2f %%, PSNR %.2f dB, of blocks %.2f %%",
                     scene->caption, name[light], what, 100 * e->error.relative_rmse, e->error.psnr_db,
                     100 * e->block_relative_rmse);
    char event[384], psnr[WEFT_NUMBER_SIZE];
    snprintf(event, sizeof event,
             "{\"event\":\"truth\",\"scene\":\"%s\",\"light\":\"%s\",\"model\":\"%s\",\"relative_rmse\":%.6g,"
             "\"psnr_db\":%s,\"block_relative_rmse\":%.6g}",
             scene->caption, name[light], what, e->error.relative_rmse, weft_command_number(e->error.psnr_db, psnr),
             e->block_relative_rmse);
    weft_command_event(common, event);
}

static void say_truth(const weft_common_options *common, const weft_traced_truth *truth)
{
    if (truth->why_not[0])
        weft_command_say(common, "no truth: %s", truth->why_not);
    if (truth->warning[0])
        weft_command_say(common, "warning: %s", truth->warning);
    for (int i = 0; truth->drawn && i < WEFT_TRUTH_SCENE_COUNT; i++)
        for (int light = 0; light < WEFT_TRUTH_LIGHTS; light++)
            for (int model = 0; model < WEFT_TRUTH_TRACED; model++)
                for (int flat = 0; flat <= truth->has_heights[model]; flat++)
                    say_truth_error(common, &truth->scene[i], light, model, flat);
}

static void say_weave(const weft_common_options *common, const weft_comparison *comparison)
{
    if (!comparison->weave_origin[0])
        return;
    weft_command_say(common, "analytic: the %s '%s', %s",
                     comparison->weave_is_threads ? "microcylinder cloth" : "weave", comparison->weave_name,
                     comparison->weave_origin);
    const weft_error_summary *before = &comparison->fit.before, *after = &comparison->fit.after;
    if (comparison->fit.image_count > 0)
        weft_command_say(common,
                         "analytic, mean BRDF that the fit saw: median relative error %.2f %% before the fit, %.2f %% "
                         "after, 80th percentile %.2f %% and %.2f %%",
                         100 * before->median_relative, 100 * after->median_relative,
                         100 * before->percentile80_relative, 100 * after->percentile80_relative);
}

/* The error to judge the material by, before any other. */
static weft_code say_held_out(const weft_common_options *common, const weft_comparison *comparison, weft_error *error)
{
    char line[WEFT_HOLD_OUT_LINE];
    if (!comparison->has_held_out) {
        weft_command_say(common, "compressed, on directions that were not fitted: not measured by `weft compress`");
        return WEFT_OK;
    }
    weft_hold_out_headline(&comparison->held_out, line);
    weft_command_say(common, "compressed, %s", line);
    return weft_command_report(common, "held_out", weft_hold_out_to_json(&comparison->held_out), error);
}

/* The first scene, whose frames are timed: how a model looks beside the photographs, and what it costs. */
static void say_scene(const weft_common_options *common, const weft_scenes *scenes)
{
    const weft_scene_pictures *scene = &scenes->scene[0];
    double raw_ms = scenes->frame_ms[WEFT_MODE_RAW];
    for (int model = 0; model < WEFT_SCENE_MODELS; model++) {
        const weft_error_summary *e = &scene->error[model];
        double frame_ms = model == WEFT_SCENE_BARD ? raw_ms : scenes->frame_ms[model];
        if (!scenes->drawn || !scenes->has[model] || model == WEFT_MODE_RAW || e->count == 0)
            continue;
        weft_command_say(common, "%s, %s beside raw: PSNR %.2f dB, relative RMSE %.2f %%; %.1f ms a frame, raw %.1f ms",
                         scene->caption, weft_scenes_model_name(model), e->psnr_db, 100 * e->relative_rmse, frame_ms,
                         raw_ms);
        char event[384], psnr[WEFT_NUMBER_SIZE];
        snprintf(event, sizeof event,
                 "{\"event\":\"scene\",\"scene\":\"%s\",\"model\":\"%s\",\"relative_rmse\":%.6g,"
                 "\"psnr_db\":%s,\"frame_ms\":%.6g,\"raw_frame_ms\":%.6g}",
                 scene->caption, weft_scenes_model_name(model), e->relative_rmse, weft_command_number(e->psnr_db, psnr),
                 frame_ms, raw_ms);
        weft_command_event(common, event);
    }
}

/* How many samples of this dataset lie in their interval; of those that were fitted more do. */
static void say_coverage(const weft_common_options *common, const weft_comparison *comparison)
{
    const weft_coverage *coverage = &comparison->model[0].texture.coverage;
    if (coverage->all.count == 0)
        return;
    weft_command_say(
        common,
        "certificate: %.2f %% of the samples lie in their interval of %g %%; mean width %.1f %% of the mean "
        "sample, %.1f %% if all were alike",
        100 * coverage->all.covered, 100 * comparison->held_out.certificate.probability, 100 * coverage->all.width,
        100 * coverage->even_width);
    char line[WEFT_HOLD_OUT_LINE], event[256];
    weft_certificate_describe_levels(&comparison->held_out.certificate, line);
    if (line[0])
        weft_command_say(common, "  %s", line);
    snprintf(event, sizeof event,
             "{\"event\":\"coverage\",\"values\":%ld,\"covered\":%.6g,\"width\":%.6g,\"even_width\":%.6g,"
             "\"dark\":%.6g,\"bright\":%.6g,\"measured_levels\":%d}",
             coverage->all.count, coverage->all.covered, coverage->all.width, coverage->even_width,
             coverage->dark.covered, coverage->bright.covered, comparison->held_out.certificate.measured_levels);
    weft_command_event(common, event);
}

static void say_numbers(const compare_command *command, const weft_comparison *comparison)
{
    const weft_common_options *common = &command->common;
    if (comparison->warning[0])
        weft_command_say(common, "warning: %s", comparison->warning);
    say_weave(common, comparison);
    for (int i = 0; i < comparison->model_count; i++) {
        say_error(common, comparison->model[i].name, i == 0 ? "fitted samples" : "samples",
                  &comparison->model[i].texture.all);
        say_error(common, comparison->model[i].name, "mean BRDF", &comparison->model[i].mean);
    }
    say_coverage(common, comparison);
    weft_command_say(common, "size: %.0f bytes, 1:%.1f of the half floats", comparison->material_bytes,
                     comparison->half_float_bytes / comparison->material_bytes);
    /* Interpolated, a handful of photographs is no picture to be compared with. */
    if (!comparison->has_few_images)
        say_scene(common, &comparison->scenes);
    if (!comparison->scenes.drawn)
        weft_command_say(common, "no pictures of scenes: %s", comparison->scenes.why_not);
    say_truth(common, &comparison->truth);
    weft_command_say_page(common, "page", command->options.folder);
}

static int run(int argc, char **argv)
{
    compare_command command = {0};
    weft_arguments_parse(&weft_command_compare, argc, argv, &command);
    if (command.options.truth_paths == 0)
        command.options.truth_paths = WEFT_TRUTH_DEFAULT_PATHS;
    weft_progress progress = weft_command_progress(&command.common);
    weft_comparison comparison;
    weft_error error = {0};
    weft_code code = command.options.bard ? weft_bard_check(command.options.bard, &error) : WEFT_OK;
    if (code == WEFT_OK)
        code = weft_compare(&command.options, &progress, &comparison, &error);
    if (code == WEFT_OK) {
        code = say_held_out(&command.common, &comparison, &error);
        say_numbers(&command, &comparison);
        weft_comparison_free(&comparison);
    }
    return weft_command_exit("compare", &command.common, code, &error);
}

const weft_command weft_command_compare = {
    .name = "compare",
    .summary = "put dataset, material and analytic cloth side by side",
    .usage = "NAME.btf.h5 NAME.weft -o REPORT/",
    .documentation =
        "Example: weft compare silk.btf.h5 silk.weft --weave silk.wv --fit -o report/\n\n"
        "Writes one HTML page: dataset, material, analytic cloth and BARD side by side, their errors against "
        "the dataset, of every sample and of the mean BRDF, slices of the mean BRDF, sizes and times.",
    .options = option_table,
    .needs = "a dataset, a material and -o REPORT/",
    .surplus = "a dataset and a material",
    .check = check,
    .run = run,
};
