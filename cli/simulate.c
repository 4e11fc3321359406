#include "base/csv.h"
#include "btf/direction/direction.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "geometry/acquisition/acquisition.h"

#include <stdlib.h>
#include <string.h>

enum { KEY_DIRECTIONS = 0x2000, KEY_BOUNCES, KEY_NOISE, KEY_SEED, KEY_OBJ, KEY_OBJ_TILES, KEY_RESOLUTION };
enum { MAX_DIRECTIONS = 1024, MAX_TEXELS_ACROSS = 4096, MAX_BOUNCES = 256, MAX_TILES_ACROSS = 64 };

typedef struct simulate_command {
    conversion files;
    const char *obj, *directions;
    int tiles_x, tiles_y, resolution;
    weft_acquisition_options options;
} simulate_command;

static const struct argp_option option_table[] = {
    {"output", 'o', "NAME.btf.h5", 0, "The dataset to write", 0},
    {"size", 's', "WxH", 0, "Texels of the tile (default: 32x32)", 0},
    {"directions", KEY_DIRECTIONS, "WHICH", 0,
     "Directions of views and lights: 64 (default) spread evenly within 80 degrees of the normal, ubo81, or a CSV with "
     "the columns "
     "theta_deg and phi_deg",
     0},
    {"bounces", KEY_BOUNCES, "N", 0, "Follow light over so many bounces between yarns (default: 3)", 0},
    {"noise", KEY_NOISE, "PERCENT", 0,
     "Stop when the standard error of each view is this part of its samples, RMS (default: 1)", 0},
    {"seed", KEY_SEED, "N", 0, "Start of the random numbers (default: 1)", 0},
    {"resolution", KEY_RESOLUTION, "N", 0, "Cells of the mesh across the tile (default: what the stitch says)", 0},
    {"obj", KEY_OBJ, "FILE.obj", 0, "Write the surface of the yarns too; without -o, only that", 0},
    {"obj-tiles", KEY_OBJ_TILES, "WxH", 0, "Tiles in the OBJ file (default: 1x1)", 0},
    {0},
};

static void check_complete(const simulate_command *command, struct argp_state *state)
{
    if (!command->files.input || (!command->files.output && !command->obj))
        argp_error(state, "needs a stitch, and -o NAME.btf.h5 or --obj FILE.obj");
    refuse_same_file(command->obj, command->files.input, state);
    refuse_same_file(command->obj, command->directions, state);
    refuse_same_file(command->files.output, command->directions, state);
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    simulate_command *command = state->input;
    weft_acquisition_options *options = &command->options;
    switch (key) {
    case 's':
        parse_size("size", argument, MAX_TEXELS_ACROSS, &options->width, &options->height, state);
        return 0;
    case KEY_DIRECTIONS:
        command->directions = argument;
        return 0;
    case KEY_BOUNCES:
        options->bounces = (int)parse_whole("bounces", argument, 0, MAX_BOUNCES, state);
        return 0;
    case KEY_NOISE:
        options->noise = parse_number("noise", argument, 0.01, 1000, state) / 100;
        return 0;
    case KEY_SEED:
        options->seed = parse_whole("seed", argument, 0, INT64_MAX, state);
        return 0;
    case KEY_RESOLUTION:
        command->resolution = (int)parse_whole("resolution", argument, 4, 1024, state);
        return 0;
    case KEY_OBJ:
        command->obj = argument;
        return 0;
    case KEY_OBJ_TILES:
        parse_size("obj-tiles", argument, MAX_TILES_ACROSS, &command->tiles_x, &command->tiles_y, state);
        return 0;
    case ARGP_KEY_END:
        check_complete(command, state);
        return parse_conversion(key, argument, state, &command->files);
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "STITCH -o NAME.btf.h5",
    "Example: weft simulate plain_knit.stitch -o knit.btf.h5\n\n"
    "Makes a dataset of cloth from its geometry: yarns in space, what they hide, shade and send to each "
    "other, and the holes between them. Every direction is a view and a light. A sample is reflectance "
    "times cosine of the whole texel; the opacity says which part of it is cloth.",
    children,
    NULL,
    NULL};

static weft_code read_direction(const weft_csv *csv, int row, int theta, int phi, weft_vec3 *direction,
                                weft_error *error)
{
    double theta_deg, phi_deg;
    WEFT_TRY(weft_csv_number(csv, row, theta, &theta_deg, error));
    WEFT_TRY(weft_csv_number(csv, row, phi, &phi_deg, error));
    if (!(theta_deg >= 0 && theta_deg < 89.9))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: theta_deg = %g is outside [0, 89.9)", csv->path, csv->line[row],
                         theta_deg);
    *direction =
        weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(remainder(phi_deg, 360))});
    return WEFT_OK;
}

static weft_code read_rows(const weft_csv *csv, weft_vec3 *direction, int *count, weft_error *error)
{
    int theta = weft_csv_column(csv, "theta_deg"), phi = weft_csv_column(csv, "phi_deg");
    if (theta < 0 || phi < 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: needs the columns theta_deg and phi_deg", csv->path);
    if (csv->row_count < 1 || csv->row_count > MAX_DIRECTIONS)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: %d directions, 1 to %d can be simulated", csv->path,
                         csv->row_count, MAX_DIRECTIONS);
    for (int row = 0; row < csv->row_count; row++)
        WEFT_TRY(read_direction(csv, row, theta, phi, &direction[row], error));
    *count = csv->row_count;
    return WEFT_OK;
}

/* The directions that --directions names, at most MAX_DIRECTIONS. */
static weft_code choose_directions(const char *which, weft_vec3 *direction, int *count, weft_error *error)
{
    if (!which || strcmp(which, "64") == 0) {
        *count = WEFT_ACQUISITION_DIRECTIONS;
        for (int i = 0; i < *count; i++)
            direction[i] = weft_acquisition_direction(i);
        return WEFT_OK;
    }
    if (strcmp(which, "ubo81") == 0) {
        *count = WEFT_UBO81_COUNT;
        for (int i = 0; i < *count; i++)
            direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
        return WEFT_OK;
    }
    weft_csv csv;
    WEFT_TRY(weft_csv_read(which, true, &csv, error));
    weft_code code = read_rows(&csv, direction, count, error);
    weft_csv_free(&csv);
    return code;
}

static weft_code acquire(const simulate_command *command, const weft_stitch *stitch, const weft_tile_mesh *mesh,
                         weft_error *error)
{
    const common_options *common = &command->files.common;
    const weft_acquisition_options *options = &command->options;
    weft_vec3 direction[MAX_DIRECTIONS];
    weft_acquisition_report report;
    weft_progress progress = command_progress(common);
    int count;
    WEFT_TRY(choose_directions(command->directions, direction, &count, error));
    WEFT_TRY(weft_acquire(stitch, mesh, direction, count, options, command->files.output, &progress, &report, error));
    command_say(common, "%s: %d x %d texels of %.3g x %.3g mm, %d views x %d lights", command->files.output,
                options->width, options->height, stitch->width / options->width, stitch->height / options->height,
                count, count);
    command_say(common,
                "noise of the worst view: %.2f %%, with %.0f paths per texel and view; %.1f %% of the tile covered",
                100 * report.noise, report.paths_per_texel, 100 * report.covered);
    return WEFT_OK;
}

static weft_code simulate(const simulate_command *command, weft_error *error)
{
    weft_stitch stitch;
    weft_tile_mesh mesh = {0};
    WEFT_TRY(weft_stitch_read(command->files.input, &stitch, error));
    weft_code code = weft_tile_mesh_create(&stitch, command->resolution, command->files.input, &mesh, error);
    if (code == WEFT_OK)
        command_say(&command->files.common, "%s: %d triangles", command->files.input, mesh.triangle_count);
    if (code == WEFT_OK && command->obj)
        code = weft_tile_mesh_write_obj(command->obj, &mesh, command->tiles_x, command->tiles_y, error);
    if (code == WEFT_OK && command->files.output)
        code = acquire(command, &stitch, &mesh, error);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
    return code;
}

int command_simulate(int argc, char **argv)
{
    simulate_command command = {.files = {.noun = "stitch"},
                                .tiles_x = 1,
                                .tiles_y = 1,
                                .options = {.width = 32, .height = 32, .bounces = 3, .noise = 0.01, .seed = 1}};
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_error error = {0};
    weft_code code = simulate(&command, &error);
    return command_exit("simulate", &command.files.common, code, &error);
}
