#include "study/tile/tile.h"
#include "cli/arguments.h"
#include "cli/command.h"

#include <stdio.h>

typedef struct tile_command {
    conversion files;
    const char *weave;
} tile_command;

enum { KEY_WEAVE = 0x2100 };

static const struct argp_option option_table[] = {
    {"output", 'o', "TILE.btf.h5", 0, "The dataset to write", 0},
    {"weave", KEY_WEAVE, "CLOTH.wv", 0,
     "The weave of the cloth: the tile is then as large as that of the weave, not the shortest repeat, and begins "
     "where "
     "that begins",
     0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    tile_command *command = state->input;
    switch (key) {
    case KEY_WEAVE:
        command->weave = argument;
        return 0;
    case ARGP_KEY_END:
        refuse_same_file(command->files.output, command->weave, state);
        return parse_conversion(key, argument, state, &command->files);
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {option_table,
                                   parse_option,
                                   "NAME.btf.h5 -o TILE.btf.h5",
                                   "Example: weft tile denim.btf.h5 --weave denim.wv -o denim-tile.btf.h5\n\n"
                                   "Finds the tile that repeats over a material, to a fraction of a texel, and writes "
                                   "a dataset of one tile: the mean of all tiles, image by image. What differs from "
                                   "tile to tile, the irregularity of the yarns and noise, goes away.",
                                   children,
                                   NULL,
                                   NULL};

static void say_report(const tile_command *command, const weft_tile_report *report)
{
    const common_options *common = &command->files.common;
    const weft_tile *tile = &report->tile;
    command_say(common, "tile      %.4g x %.4g mm, %.2f x %.2f texels, found in %d photographs (repeats: %.2f, %.2f)",
                report->width_mm, report->height_mm, tile->width, tile->height, report->picture_count, report->repeat_x,
                report->repeat_y);
    if (command->weave)
        command_say(common, "corner    %.2f texels from the left, %.2f from the top (likeness to the weave: %.2f)",
                    tile->left, tile->top, report->likeness);
    command_say(common, "averaged  %.2f tiles: %.2f x %.2f", report->tiles_x * report->tiles_y, report->tiles_x,
                report->tiles_y);
    command_say(common, "residual  %.1f %% of the variance of the texels, %.1f %% of the mean",
                100 * report->residual_share, 100 * report->residual_relative);
    if (report->empty_count > 0)
        command_say(common, "missing   %ld samples, masked in every tile", report->empty_count);
    command_say(common, "%s: %d x %d texels", command->files.output, report->texels_x, report->texels_y);
    char event[512];
    snprintf(event, sizeof event,
             "{\"event\":\"tile\",\"size_mm\":[%.6g,%.6g],\"size_texels\":[%.6g,%.6g],\"corner_texels\":[%.6g,%.6g],"
             "\"repeat\":[%.4g,%.4g],\"likeness\":%.4g,\"tiles\":[%.6g,%.6g],\"texels\":[%d,%d],"
             "\"residual_share\":%.6g,\"residual_relative\":%.6g,\"missing_samples\":%ld}",
             report->width_mm, report->height_mm, tile->width, tile->height, tile->left, tile->top, report->repeat_x,
             report->repeat_y, report->likeness, report->tiles_x, report->tiles_y, report->texels_x, report->texels_y,
             report->residual_share, report->residual_relative, report->empty_count);
    command_event(common, event);
}

static weft_code make_tile(const tile_command *command, weft_dataset *dataset, const weft_weave *weave,
                           weft_error *error)
{
    weft_progress progress = command_progress(&command->files.common);
    weft_tile_report report;
    WEFT_TRY(weft_tile_find(dataset, weave, &progress, &report, error));
    WEFT_TRY(weft_tile_write(dataset, command->files.output, &progress, &report, error));
    say_report(command, &report);
    return WEFT_OK;
}

int command_tile(int argc, char **argv)
{
    tile_command command = {.files = {.noun = "dataset", .needed = "NAME.btf.h5 and -o TILE.btf.h5"}};
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_error error = {0};
    weft_dataset *dataset = NULL;
    weft_weave weave = {0};
    weft_code code = weft_dataset_open(command.files.input, &dataset, &error);
    if (code == WEFT_OK && command.weave)
        code = weft_weave_read(command.weave, NULL, 0, &weave, NULL, &error);
    if (code == WEFT_OK)
        code = make_tile(&command, dataset, command.weave ? &weave : NULL, &error);
    weft_weave_free(&weave);
    weft_dataset_close(dataset);
    return command_exit("tile", &command.files.common, code, &error);
}
