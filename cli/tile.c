#include "study/tile/tile.h"
#include "cli/arguments.h"

#include <stdio.h>

typedef struct tile_command {
    weft_common_options common;
    const char *input, *output, *weave;
} tile_command;

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(tile_command, input)},
    {"output", 'o', "TILE.btf.h5", "The dataset to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(tile_command, output)},
    {"weave", .argument = "CLOTH.wv",
     .help = "The weave of the cloth: the tile is then as large as that of the weave, not the shortest repeat, and "
             "begins where that begins",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(tile_command, weave)},
    {0},
};

static void say_report(const tile_command *command, const weft_tile_report *report)
{
    const weft_common_options *common = &command->common;
    const weft_tile *tile = &report->tile;
    weft_command_say(common,
                     "tile      %.4g x %.4g mm, %.2f x %.2f texels, found in %d photographs (repeats: %.2f, %.2f)",
                     report->width_mm, report->height_mm, tile->width, tile->height, report->picture_count,
                     report->repeat_x, report->repeat_y);
    if (command->weave)
        weft_command_say(common, "corner    %.2f texels from the left, %.2f from the top (likeness to the weave: %.2f)",
                         tile->left, tile->top, report->likeness);
    weft_command_say(common, "averaged  %.2f tiles: %.2f x %.2f", report->tiles_x * report->tiles_y, report->tiles_x,
                     report->tiles_y);
    weft_command_say(common, "residual  %.1f %% of the variance of the texels, %.1f %% of the mean",
                     100 * report->residual_share, 100 * report->residual_relative);
    if (report->empty_count > 0)
        weft_command_say(common, "missing   %ld samples, masked in every tile", report->empty_count);
    weft_command_say(common, "%s: %d x %d texels", command->output, report->texels_x, report->texels_y);
    char event[512];
    snprintf(event, sizeof event,
             "{\"event\":\"tile\",\"size_mm\":[%.6g,%.6g],\"size_texels\":[%.6g,%.6g],\"corner_texels\":[%.6g,%.6g],"
             "\"repeat\":[%.4g,%.4g],\"likeness\":%.4g,\"tiles\":[%.6g,%.6g],\"texels\":[%d,%d],"
             "\"residual_share\":%.6g,\"residual_relative\":%.6g,\"missing_samples\":%ld}",
             report->width_mm, report->height_mm, tile->width, tile->height, tile->left, tile->top, report->repeat_x,
             report->repeat_y, report->likeness, report->tiles_x, report->tiles_y, report->texels_x, report->texels_y,
             report->residual_share, report->residual_relative, report->empty_count);
    weft_command_event(common, event);
}

static weft_code make_tile(const tile_command *command, weft_dataset *dataset, const weft_weave *weave,
                           weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_tile_report report;
    WEFT_TRY(weft_tile_find(dataset, weave, &progress, &report, error));
    WEFT_TRY(weft_tile_write(dataset, command->output, &progress, &report, error));
    say_report(command, &report);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    tile_command command = {0};
    weft_arguments_parse(&weft_command_tile, argc, argv, &command);
    weft_error error = {0};
    weft_dataset *dataset = NULL;
    weft_weave weave = {0};
    weft_code code = weft_dataset_open(command.input, &dataset, &error);
    if (code == WEFT_OK && command.weave)
        code = weft_weave_read(command.weave, NULL, 0, &weave, NULL, &error);
    if (code == WEFT_OK)
        code = make_tile(&command, dataset, command.weave ? &weave : NULL, &error);
    weft_weave_free(&weave);
    weft_dataset_close(dataset);
    return weft_command_exit("tile", &command.common, code, &error);
}

const weft_command weft_command_tile = {
    .name = "tile",
    .summary = "average the repeats of a dataset into one tile",
    .usage = "NAME.btf.h5 -o TILE.btf.h5",
    .documentation = "Example: weft tile denim.btf.h5 --weave denim.wv -o denim-tile.btf.h5\n\n"
                     "Finds the tile that repeats over a material, to a fraction of a texel, and writes "
                     "a dataset of one tile: the mean of all tiles, image by image. What differs from "
                     "tile to tile, the irregularity of the yarns and noise, goes away.",
    .options = option_table,
    .needs = "NAME.btf.h5 and -o TILE.btf.h5",
    .surplus = "one dataset at a time",
    .run = run,
};
