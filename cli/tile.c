#include "edit/tile/tile.h"
#include "btf/file_kind.h"
#include "cli/command/arguments.h"
#include "edit/blend/blend.h"

#include <stdio.h>
#include <string.h>

typedef struct tile_command {
    weft_common_options common;
    const char *input, *output, *weave;
    bool blend;
} tile_command;

static const weft_option option_table[] = {
    {.argument = "NAME.btf.h5|NAME.weft",
     .is_required = true,
     .kind = WEFT_OPTION_INPUT,
     .offset = offsetof(tile_command, input)},
    {"output", 'o', "TILE.btf.h5|TILE.weft", "The dataset or material to write", .is_required = true,
     .kind = WEFT_OPTION_OUTPUT, .offset = offsetof(tile_command, output)},
    {"weave", .argument = "CLOTH.wv",
     .help = "The weave of the cloth, which gives size and corner of the tile (default: the shortest repeat)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(tile_command, weave)},
    {"blend",
     .help = "Make a material tile that does not repeat: overlap its ends and cut them where they differ least",
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(tile_command, blend)},
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

static weft_code average(const tile_command *command, weft_error *error)
{
    weft_dataset *dataset = NULL;
    weft_weave weave = {0};
    weft_code code = weft_dataset_open(command->input, &dataset, error);
    if (code == WEFT_OK && command->weave)
        code = weft_weave_read(command->weave, NULL, 0, &weave, NULL, error);
    if (code == WEFT_OK)
        code = make_tile(command, dataset, command->weave ? &weave : NULL, error);
    weft_weave_free(&weave);
    weft_dataset_close(dataset);
    return code;
}

/* ---- A material whose ends are blended ---- */

static void say_seam(const weft_common_options *common, const char *what, const weft_seam *seam)
{
    weft_command_say(common,
                     "%-9s %.1f %% of %ld pairs of texels across the seam differ more than 99 %% of neighbours in the "
                     "material do; %.2f times as much as these in the mean",
                     what, 100 * seam->above_99th, seam->pair_count, seam->mean_difference);
}

static void say_blend(const tile_command *command, const weft_blend_report *report)
{
    const weft_common_options *common = &command->common;
    weft_command_say(common, "overlap   %d columns, %d rows", report->overlap_x, report->overlap_y);
    say_seam(common, "before", &report->before);
    say_seam(common, "after", &report->after);
    weft_command_say(common, "%s: %d x %d texels", command->output, report->width, report->height);
    char event[384];
    snprintf(event, sizeof event,
             "{\"event\":\"blend\",\"texels\":[%d,%d],\"overlap_texels\":[%d,%d],"
             "\"before\":{\"above_99th\":%.6g,\"strongest\":%.6g,\"mean_difference\":%.6g},"
             "\"after\":{\"above_99th\":%.6g,\"strongest\":%.6g,\"mean_difference\":%.6g}}",
             report->width, report->height, report->overlap_x, report->overlap_y, report->before.above_99th,
             report->before.strongest, report->before.mean_difference, report->after.above_99th,
             report->after.strongest, report->after.mean_difference);
    weft_command_event(common, event);
}

static weft_code blend(const tile_command *command, weft_error *error)
{
    weft_material material, tile = {0};
    weft_blend_report report;
    WEFT_TRY(weft_material_read(command->input, &material, error));
    weft_code code = weft_blend(&material, &tile, &report, error);
    weft_material_free(&material);
    if (code == WEFT_OK)
        code = weft_material_write(command->output, &tile, error);
    weft_material_free(&tile);
    if (code == WEFT_OK)
        say_blend(command, &report);
    return code;
}

static weft_code run_on(const tile_command *command, weft_error *error)
{
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(command->input, &kind, error));
    if (command->blend && command->weave)
        return weft_fail(error, WEFT_BAD_USAGE, "--weave finds tiles of a cloth that repeats; --blend needs none");
    if (command->blend && kind != WEFT_FILE_MATERIAL)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' is not a material (.weft): compress the dataset first, then use --blend",
                         command->input);
    if (!command->blend && kind == WEFT_FILE_MATERIAL)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' is a material, not a dataset (.btf.h5): to make a material tile, use --blend",
                         command->input);
    const char *dot = strrchr(command->output, '.');
    if (dot && strcmp(dot, command->blend ? ".h5" : ".weft") == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' names a %s, but weft tile turns a %s into a %s", command->output,
                         command->blend ? "dataset" : "material", command->blend ? "material" : "dataset",
                         command->blend ? "material" : "dataset");
    return command->blend ? blend(command, error) : average(command, error);
}

static int run(int argc, char **argv)
{
    tile_command command = {0};
    weft_arguments_parse(&weft_command_tile, argc, argv, &command);
    weft_error error = {0};
    weft_code code = run_on(&command, &error);
    return weft_command_exit("tile", &command.common, code, &error);
}

const weft_command weft_command_tile = {
    .name = "tile",
    .summary = "average the repeats of a dataset into one tile, or make a material tile",
    .usage = "NAME.btf.h5 -o TILE.btf.h5\nNAME.weft --blend -o TILE.weft",
    .documentation =
        "Example: weft tile denim.btf.h5 --weave denim.wv -o denim-tile.btf.h5\n\n"
        "For a dataset: finds the tile that repeats over it, to a fraction of a texel, and writes a dataset "
        "of one tile: the mean of all tiles, image by image. Irregularity of the yarns and noise are averaged "
        "out.\n\n"
        "For a material, with --blend: makes it tile without a visible seam, whatever it shows. Its ends are "
        "overlapped and cut where they differ least, and the remaining difference is spread over the tile.",
    .options = option_table,
    .needs = "NAME.btf.h5 and -o TILE.btf.h5, or NAME.weft, --blend and -o TILE.weft",
    .surplus = "one dataset or material at a time",
    .run = run,
};
