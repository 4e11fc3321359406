#include "compress/weave_fit/fit_weave.h"
#include "cli/command/arguments.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct fit_weave_command {
    weft_common_options common;
    const char *input, *output, *weave;
} fit_weave_command;

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(fit_weave_command, input)},
    {"output", 'o', "FITTED.wv", "The weave to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(fit_weave_command, output)},
    {"weave", .argument = "START.wv", .help = "Pattern, kinds and sizes of the yarns, and the start of the search",
     .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(fit_weave_command, weave)},
    {0},
};

static void say_errors(const fit_weave_command *command, const weft_fit_weave_report *report)
{
    weft_command_say(&command->common,
                     "relative error of the mean BRDF, median / 80th percentile: %.1f %% / %.1f %% before, "
                     "%.1f %% / %.1f %% after",
                     100 * report->before.median_relative, 100 * report->before.percentile80_relative,
                     100 * report->after.median_relative, 100 * report->after.percentile80_relative);
    char event[400];
    snprintf(event, sizeof event,
             "{\"event\":\"fit\",\"images\":%d,\"median_relative_before\":%.6g,\"percentile80_relative_before\":%.6g,"
             "\"median_relative\":%.6g,\"percentile80_relative\":%.6g,\"alpha\":%.9g,\"beta\":%.9g,\"seconds\":%.3g}",
             report->image_count, report->before.median_relative, report->before.percentile80_relative,
             report->after.median_relative, report->after.percentile80_relative, report->alpha, report->beta,
             report->seconds);
    weft_command_event(&command->common, event);
}

/* "30.12 +- 0.04", or that the data do not say. */
static void print_value(char *text, size_t size, double value, double deviation)
{
    if (isfinite(deviation))
        snprintf(text, size, "%.4g +- %.2g", value, deviation);
    else
        snprintf(text, size, "%.4g (undetermined)", value);
}

static void say_group(const fit_weave_command *command, const weft_fit_weave_group *group, const weft_weave *weave)
{
    char psi[64] = "0 (filament)", umax[64], kappa[64], width[64];
    weft_rgb ks = weave->yarn[group->yarn].ks;
    if (group->staple)
        print_value(psi, sizeof psi, group->psi_deg, group->psi_deviation);
    print_value(umax, sizeof umax, group->umax_deg, group->umax_deviation);
    print_value(kappa, sizeof kappa, group->kappa, group->kappa_deviation);
    if (group->width_fitted)
        print_value(width, sizeof width, group->width, group->width_deviation);
    else
        snprintf(width, sizeof width, "%.4g (as given: the data do not determine it)", group->width);
    weft_command_say(&command->common, "%s (yarn %d): psi %s, umax %s degrees, kappa %s, width %s, ks %.4g %.4g %.4g",
                     group->warp ? "warp" : "weft", group->yarn + 1, psi, umax, kappa, width, (double)ks.r,
                     (double)ks.g, (double)ks.b);
    char event[320];
    snprintf(event, sizeof event,
             "{\"event\":\"yarn\",\"type\":\"%s\",\"yarn\":%d,\"psi_deg\":%.9g,\"umax_deg\":%.9g,\"kappa\":%.9g,"
             "\"width\":%.9g,\"width_fitted\":%s}",
             group->warp ? "warp" : "weft", group->yarn + 1, group->psi_deg, group->umax_deg, group->kappa,
             group->width, group->width_fitted ? "true" : "false");
    weft_command_event(&command->common, event);
}

static void say_source(const fit_weave_command *command, const weft_fit_weave_source *source)
{
    const weft_tile *tile = &source->tile.tile;
    if (!source->tiled) {
        weft_command_say(&command->common, "mean of the whole material: %s", source->why_whole);
        return;
    }
    weft_command_say(
        &command->common,
        "mean tile of %d x %d, %.2f x %.2f texels each, corner at %.2f, %.2f (likeness to the start: %.2f)",
        source->tiles_x, source->tiles_y, tile->width, tile->height, tile->left, tile->top, source->tile.likeness);
    char event[256];
    snprintf(event, sizeof event,
             "{\"event\":\"tile\",\"size_texels\":[%.6g,%.6g],\"corner_texels\":[%.6g,%.6g],\"likeness\":%.4g,"
             "\"averaged\":[%d,%d]}",
             tile->width, tile->height, tile->left, tile->top, source->tile.likeness, source->tiles_x, source->tiles_y);
    weft_command_event(&command->common, event);
}

static void say_askew(const fit_weave_command *command, const weft_fit_weave_report *report)
{
    static const char *const turn[] = {"fitted", "vague", "at bound"};
    const weft_common_options *common = &command->common;
    const double *askew = report->askew_deg, *deviation = report->askew_deviation;
    char deviations[96] = "null", event[256];
    if (report->turn == WEFT_TURN_VAGUE)
        weft_command_say(common, "sample: assumed to lie straight; the data do not determine its rotation");
    if (report->turn == WEFT_TURN_AT_BOUND)
        weft_command_say(common, "sample: assumed to lie straight; its rotation reaches the limit of one degree, so "
                                 "something else is wrong");
    if (report->turn == WEFT_TURN_FITTED) {
        weft_command_say(
            common, "sample: rotated by %.2f +- %.2g, %.2f +- %.2g, %.2f +- %.2g degrees about weft, warp and normal",
            askew[0], deviation[0], askew[1], deviation[1], askew[2], deviation[2]);
        snprintf(deviations, sizeof deviations, "[%.6g,%.6g,%.6g]", deviation[0], deviation[1], deviation[2]);
    }
    snprintf(event, sizeof event, "{\"event\":\"askew\",\"turn\":\"%s\",\"degrees\":[%.6g,%.6g,%.6g],\"deviation\":%s}",
             turn[report->turn], askew[0], askew[1], askew[2], deviations);
    weft_command_event(common, event);
}

static void say_report(const fit_weave_command *command, const weft_weave *weave, const weft_fit_weave_report *report)
{
    char alpha[64], beta[64];
    print_value(alpha, sizeof alpha, report->alpha, report->alpha_deviation);
    print_value(beta, sizeof beta, report->beta, report->beta_deviation);
    weft_command_say(&command->common, "%s: fitted to the mean of %d images in %.1f s", command->output,
                     report->image_count, report->seconds);
    for (int group = 0; group < report->group_count; group++)
        say_group(command, &report->group[group], weave);
    weft_command_say(&command->common, "fibres: alpha %s, beta %s", alpha, beta);
    say_askew(command, report);
    say_errors(command, report);
}

static weft_code fit(const fit_weave_command *command, weft_weave *weave, weft_dataset *dataset, weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_fit_weave_source source;
    weft_fit_weave_report report;
    WEFT_TRY(weft_fit_weave_to_dataset(dataset, weave, &progress, &source, &report, error));
    WEFT_TRY(weft_fit_weave_write(command->output, weave, dataset, &report, error));
    say_source(command, &source);
    say_report(command, weave, &report);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    fit_weave_command command = {0};
    weft_arguments_parse(&weft_command_fit_weave, argc, argv, &command);
    weft_error error = {0};
    weft_dataset *dataset = NULL;
    weft_weave weave = {0};
    char warning[WEFT_MESSAGE_SIZE];
    weft_code code = weft_weave_read(command.weave, NULL, 0, &weave, warning, &error);
    if (code == WEFT_OK && warning[0])
        weft_command_say(&command.common, "%s", warning);
    if (code == WEFT_OK)
        code = weft_dataset_open(command.input, &dataset, &error);
    if (code == WEFT_OK)
        code = fit(&command, &weave, dataset, &error);
    weft_dataset_close(dataset);
    weft_weave_free(&weave);
    return weft_command_exit("fit-weave", &command.common, code, &error);
}

const weft_command weft_command_fit_weave = {
    .name = "fit-weave",
    .summary = "fit a weave to a dataset",
    .usage = "NAME.btf.h5 --weave START.wv -o FITTED.wv",
    .documentation =
        "Example: weft fit-weave denim.btf.h5 --weave twill.wv -o denim.wv\n\n"
        "Finds twist, inclination, curvature and width of the yarns, scattering of the fibres and colours, so "
        "that the weave reflects like the mean tile of the dataset. Pattern and lengths stay as in START.wv.",
    .options = option_table,
    .needs = "NAME.btf.h5, --weave START.wv and -o FITTED.wv",
    .surplus = "one dataset at a time",
    .run = run,
};
