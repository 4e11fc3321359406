#include "edit/prune/prune.h"
#include "base/atomic_file.h"
#include "btf/material/metadata.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "player/gl/context.h"
#include "player/settings/exposure.h"
#include "player/settings/scene_loader.h"

typedef struct prune_command {
    weft_common_options common;
    weft_settings settings;
    const char *output, *path_file;
    weft_prune_error allowed;
    uint64_t seed;
    weft_path path;
} prune_command;

static const weft_option option_table[] = {
    {"output", 'o', "SMALL.weft", "The material to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(prune_command, output)},
    {"path", .argument = "PATH.csv",
     .help = "Move camera and light through the key frames of this table, as for weft render; default: a still scene",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(prune_command, path_file)},
    {"error", .argument = "N",
     .help = "Allowed difference of pictures: RMSE of N/255 in screen values (default: 0.5); 0: remove only data that "
             "no pixel can reach",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(prune_command, allowed.rmse), .low = 0, .high = 255},
    {"flip", .argument = "X", .help = "Let them differ by X in the mean of FLIP", .usual = "0.05",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(prune_command, allowed.flip), .low = 0, .high = 1},
    {"seed", .argument = "N", .help = "Seed of the random moments that are measured", .usual = "1",
     .kind = WEFT_OPTION_SEED, .offset = offsetof(prune_command, seed)},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    const prune_command *command = values;
    return command->settings.material ? WEFT_OK : weft_fail(error, WEFT_BAD_USAGE, "needs a material: NAME.weft");
}

/* ---- What it says ---- */

static double percent(weft_prune_count count)
{
    return count.of > 0 ? 100.0 * (double)count.kept / (double)count.of : 0;
}

static void say_reach(const weft_common_options *common, const weft_prune_report *r)
{
    weft_command_say(
        common, "visible   %ld spans of the path; mip levels %.1f to %.1f; %.0f %% of the views, %.0f %% of the lights",
        r->span_count, r->level_low, r->level_high, percent(r->view_cells), percent(r->light_cells));
    weft_command_say(common, "levels    the finest %d and the coarsest %d are gone; %.1f %% of the texels are seen",
                     r->finer_levels, r->coarser_levels, percent(r->texels));
    if (r->views.of > 0)
        weft_command_say(common, "table     %ld of %ld views; %ld lobes of texels are removed", r->views.kept,
                         r->views.of, r->lobes_gone);
    if (r->components.of > 0)
        weft_command_say(common, "components    %ld of %ld; %ld of %ld images; values rounded to %.2g of reflectance",
                         r->components.kept, r->components.of, r->images.kept, r->images.of, r->value_step);
}

static void say_errors(const weft_common_options *common, const weft_prune_report *r)
{
    weft_command_say(common, "predicted RMSE %.3f/255, FLIP %.4f (%d frames used for pruning)", r->predicted.rmse,
                     r->predicted.flip, r->decided_count);
    char of[64] = "the same moment, because nothing moves";
    if (r->decided_count > 1)
        snprintf(of, sizeof of, "%d other moments, whole pictures", r->measured_count);
    weft_command_say(common, "measured  RMSE %.3f/255, FLIP %.4f (%s)", r->measured.rmse, r->measured.flip, of);
    if (!weft_prune_holds(r))
        weft_command_say(common, "that is more than allowed: keep the whole material for this scene");
}

static weft_code say(const prune_command *command, const weft_prune_report *report, weft_error *error)
{
    const weft_common_options *common = &command->common;
    double before = (double)weft_file_bytes(command->settings.material);
    double after = (double)weft_file_bytes(command->output);
    say_reach(common, report);
    say_errors(common, report);
    weft_command_say(common, "%s: %.3f MB of %.3f MB, %.1f times smaller", command->output, after * 1e-6, before * 1e-6,
                     before / after);
    return weft_command_report(common, "pruned", weft_prune_to_json(report), error);
}

/* ---- The work ---- */

static weft_code prune_material(prune_command *command, weft_player *player, weft_material *material,
                                weft_prune_report *report, weft_error *error)
{
    const weft_settings *settings = &command->settings;
    const weft_progress progress = weft_command_progress(&command->common);
    weft_mesh mesh;
    WEFT_TRY(weft_mesh_open(settings->mesh, &mesh, error));
    weft_settings_lay_plane(settings, (double)material->level[0].height / material->level[0].width, &mesh);
    const weft_prune_scene scene = {.mesh = &mesh,
                                    .path = command->path_file ? &command->path : NULL,
                                    .scene = settings->scene,
                                    .width = settings->width,
                                    .height = settings->height,
                                    .samples = settings->samples};
    weft_code code = weft_prune(player, &scene, command->allowed, command->seed, &progress, material, report, error);
    weft_mesh_free(&mesh);
    if (code == WEFT_OK)
        code = weft_material_put_metadata(material, "pruned", weft_prune_to_json(report), error);
    return code == WEFT_OK ? weft_material_write(command->output, material, error) : code;
}

static weft_code prune(prune_command *command, weft_player *player, weft_error *error)
{
    const weft_common_options *common = &command->common;
    const weft_progress progress = weft_command_progress(common);
    const weft_log log = weft_command_log(common);
    weft_settings *settings = &command->settings;
    weft_material material;
    weft_prune_report report;
    bool exposed;
    if (command->path_file)
        WEFT_TRY(weft_path_read(command->path_file, &command->path, error));
    WEFT_TRY(weft_scene_load(settings, player, &progress, &log, error));
    WEFT_TRY(weft_expose(settings, player, &settings->scene, &exposed, error));
    WEFT_TRY(weft_material_read(settings->material, &material, error));
    weft_code code = prune_material(command, player, &material, &report, error);
    weft_material_free(&material);
    return code == WEFT_OK ? say(command, &report, error) : code;
}

static weft_code run_headless(prune_command *command, weft_error *error)
{
    weft_headless *headless = NULL;
    weft_player *player = NULL;
    WEFT_TRY(weft_headless_create(WEFT_GL_CORE, &headless, error));
    weft_code code = weft_player_create(&player, error);
    if (code == WEFT_OK)
        code = prune(command, player, error);
    weft_player_free(player);
    weft_headless_free(headless);
    return code;
}

static int run(int argc, char **argv)
{
    prune_command command = {.allowed.rmse = 0.5};
    weft_arguments_parse(&weft_command_prune, argc, argv, &command);
    weft_error error = {0};
    weft_code code = run_headless(&command, &error);
    weft_path_free(&command.path);
    weft_settings_free(&command.settings);
    return weft_command_exit("prune", &command.common, code, &error);
}

const weft_command weft_command_prune = {
    .name = "prune",
    .summary = "remove data of a material that one scene never shows",
    .usage = "NAME.weft -o SMALL.weft",
    .documentation =
        "Example: weft prune silk.weft --settings shot.png --path turn.csv -o silk-shot.weft\n\n"
        "Removes the mip levels, texels, views and lobes of a material that the pictures of one scene "
        "can never reach, and data that changes them by less than the allowed error. Mesh, camera, lights and "
        "size of the picture are given as for weft render.",
    .options = option_table,
    .settings_offset = offsetof(prune_command, settings),
    .needs = "-o SMALL.weft",
    .check = check,
    .run = run,
};
