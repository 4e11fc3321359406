#include "base/atomic_file.h"
#include "base/integers.h"
#include "base/text/csv.h"
#include "btf/direction/direction.h"
#include "cli/command/arguments.h"
#include "cli/command/heights.h"
#include "geometry/acquisition/acquisition.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Where texels lie. */
typedef enum plane { PLANE_AUTO, PLANE_TOP, PLANE_MEAN } plane;
static const char *const plane_words[] = {"auto", "top", "mean", NULL};

/* Enough to see the plane at which the views agree: half as many texels each way, but no fewer than so many. */
#define ROUGH_NOISE 0.1
enum { FEWEST_ROUGH = 16 };

enum { MAX_DIRECTIONS = 1024, MAX_TEXELS_ACROSS = 4096, MAX_BOUNCES = 256, MAX_TILES_ACROSS = 64 };

typedef struct simulate_command {
    weft_common_options common;
    const char *input, *output, *obj, *directions;
    int tiles_x, tiles_y, resolution;
    bool heights;
    plane plane;
    weft_acquisition_options options;
} simulate_command;

static const weft_option option_table[] = {
    {.argument = "STITCH", .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(simulate_command, input)},
    {"output", 'o', "NAME.btf.h5", "The dataset to write", .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(simulate_command, output)},
    {"size", 's', "WxH", "Texels of the tile", .usual = "32x32", .kind = WEFT_OPTION_SIZE,
     .offset = offsetof(simulate_command, options.width), .high = MAX_TEXELS_ACROSS},
    {"directions", .argument = "WHICH",
     .help = "Directions of views and lights: 64 (default) spread evenly within 80 degrees of the normal, ubo81, or a "
             "CSV with the columns theta_deg and phi_deg",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(simulate_command, directions)},
    {"bounces", .argument = "N", .help = "Number of bounces of light between yarns", .usual = "3",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(simulate_command, options.bounces), .low = 0, .high = MAX_BOUNCES},
    {"noise", .argument = "PERCENT",
     .help = "Stop when the standard error of each view is this percentage of its samples, RMS", .usual = "1",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(simulate_command, options.noise), .low = 0.01, .high = 1000,
     .divisor = 100},
    {"seed", .argument = "N", .help = "Seed of the random numbers", .usual = "1", .kind = WEFT_OPTION_SEED,
     .offset = offsetof(simulate_command, options.seed)},
    {"resolution", .argument = "N", .help = "Cells of the mesh across the tile (default: as the stitch says)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(simulate_command, resolution), .low = 4, .high = 1024},
    {"plane", .argument = "WHICH",
     .help =
         "Plane of the texels: where the views of a rough simulation agree best (auto, default), the top face of the "
         "cloth (top), or the mean height seen from above (mean)",
     .kind = WEFT_OPTION_CHOICE, .offset = offsetof(simulate_command, plane), .words = plane_words},
    WEFT_HEIGHTS_OPTION(simulate_command, heights),
    {"obj", .argument = "FILE.obj", .help = "Write the surface of the yarns too; without -o, only that",
     .kind = WEFT_OPTION_OUTPUT, .offset = offsetof(simulate_command, obj)},
    {"obj-tiles", .argument = "WxH", .help = "Tiles in the OBJ file", .usual = "1x1", .kind = WEFT_OPTION_SIZE,
     .offset = offsetof(simulate_command, tiles_x), .high = MAX_TILES_ACROSS},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    const simulate_command *command = values;
    if (!command->output && !command->obj)
        return weft_fail(error, WEFT_BAD_USAGE, "needs %s", weft_command_simulate.needs);
    return WEFT_OK;
}

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

/* What is simulated. */
typedef struct request {
    const weft_stitch *stitch;
    const weft_tile_mesh *mesh;
    weft_vec3 direction[MAX_DIRECTIONS];
    int count;
    weft_acquisition_options options;
} request;

/* The best plane of a dataset; the top where its views tell none. */
static weft_code find_best(const weft_common_options *common, const char *path, double depth_mm, double *plane_mm,
                           weft_error *error)
{
    weft_relief_report report;
    weft_code code = weft_heights_estimate(common, path, &report, error);
    if (code == WEFT_BAD_INPUT) {
        weft_command_say(common, "plane: the top of the cloth, for too few views lie among others to tell the best");
        return WEFT_OK;
    }
    if (code != WEFT_OK)
        return code;
    *plane_mm = report.verdict == WEFT_RELIEF_NOTHING ? 0 : fmax(fmin(report.plane_mm, 0), -depth_mm);
    weft_relief_report_free(&report);
    return WEFT_OK;
}

/* A hidden file beside the output. */
static weft_code rough_path(const char *output, char path[PATH_MAX], weft_error *error)
{
    const char *slash = strrchr(output, '/'), *name = slash ? slash + 1 : output;
    int length = snprintf(path, PATH_MAX, "%.*s.%s.rough", (int)(name - output), output, name);
    return length < PATH_MAX ? WEFT_OK : weft_fail(error, WEFT_BAD_USAGE, "'%s' is too long a name", output);
}

/* The same from a rough simulation, whose file goes when it has been looked at. */
static weft_code find_best_roughly(const simulate_command *command, const request *wanted, double *plane_mm,
                                   weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_acquisition_options rough = wanted->options;
    weft_acquisition_report report;
    char path[PATH_MAX];
    WEFT_TRY(rough_path(command->output, path, error));
    rough.noise = fmax(rough.noise, ROUGH_NOISE);
    rough.width = weft_larger(rough.width / 2, weft_smaller(rough.width, FEWEST_ROUGH));
    rough.height = weft_larger(rough.height / 2, weft_smaller(rough.height, FEWEST_ROUGH));
    weft_sweep_left_over(path);
    weft_code code = weft_acquire(wanted->stitch, wanted->mesh, wanted->direction, wanted->count, &rough, path,
                                  &progress, &report, error);
    if (code == WEFT_OK)
        code = find_best(&command->common, path, (double)(wanted->mesh->top - wanted->mesh->bottom), plane_mm, error);
    unlink(path);
    return code;
}

static weft_code choose_plane(const simulate_command *command, request *wanted, weft_error *error)
{
    double *plane_mm = &wanted->options.plane_mm;
    if (command->plane == PLANE_MEAN)
        WEFT_TRY(weft_acquisition_mean_height(wanted->stitch, wanted->mesh, plane_mm, error));
    if (command->plane == PLANE_AUTO)
        WEFT_TRY(find_best_roughly(command, wanted, plane_mm, error));
    if (*plane_mm < 0)
        weft_command_say(&command->common, "texels lie %.3f mm below the top of the cloth", fabs(*plane_mm));
    return WEFT_OK;
}

static weft_code acquire(const simulate_command *command, const weft_stitch *stitch, const weft_tile_mesh *mesh,
                         weft_error *error)
{
    const weft_common_options *common = &command->common;
    const weft_acquisition_options *options = &command->options;
    request wanted = {.stitch = stitch, .mesh = mesh, .options = *options};
    weft_acquisition_report report;
    weft_progress progress = weft_command_progress(common);
    WEFT_TRY(choose_directions(command->directions, wanted.direction, &wanted.count, error));
    weft_sweep_left_over(command->output);
    WEFT_TRY(choose_plane(command, &wanted, error));
    int count = wanted.count;
    WEFT_TRY(weft_acquire(stitch, mesh, wanted.direction, count, &wanted.options, command->output, &progress, &report,
                          error));
    weft_command_say(common, "%s: %d x %d texels of %.3g x %.3g mm, %d views x %d lights", command->output,
                     options->width, options->height, stitch->width / options->width, stitch->height / options->height,
                     count, count);
    weft_command_say(
        common, "noise of the worst view: %.2f %%, with %.0f paths per texel and view; %.1f %% of the tile covered",
        100 * report.noise, report.paths_per_texel, 100 * report.covered);
    if (command->heights)
        weft_heights_look(common, command->output);
    return WEFT_OK;
}

static weft_code simulate(const simulate_command *command, weft_error *error)
{
    weft_stitch stitch;
    weft_tile_mesh mesh = {0};
    WEFT_TRY(weft_stitch_read(command->input, &stitch, error));
    weft_code code = weft_tile_mesh_create(&stitch, command->resolution, command->input, &mesh, error);
    if (code == WEFT_OK)
        weft_command_say(&command->common, "%s: %d triangles", command->input, mesh.triangle_count);
    if (code == WEFT_OK && command->obj)
        code = weft_tile_mesh_write_obj(command->obj, &mesh, command->tiles_x, command->tiles_y, error);
    if (code == WEFT_OK && command->output)
        code = acquire(command, &stitch, &mesh, error);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
    return code;
}

static int run(int argc, char **argv)
{
    simulate_command command = {.heights = true};
    weft_arguments_parse(&weft_command_simulate, argc, argv, &command);
    weft_error error = {0};
    weft_code code = simulate(&command, &error);
    return weft_command_exit("simulate", &command.common, code, &error);
}

const weft_command weft_command_simulate = {
    .name = "simulate",
    .summary = "make a dataset of cloth from the geometry of its yarns",
    .usage = "STITCH -o NAME.btf.h5",
    .documentation =
        "Example: weft simulate plain_knit.stitch -o knit.btf.h5\n\n"
        "Computes a dataset of cloth from yarns in space, which hide and shade each other and pass light on, "
        "with holes between them. Every direction is a view and a light. A sample is reflectance times cosine "
        "of the whole texel; the opacity is the share of the texel that is cloth.",
    .options = option_table,
    .needs = "a stitch, and -o NAME.btf.h5 or --obj FILE.obj",
    .surplus = "one stitch at a time",
    .check = check,
    .run = run,
};
