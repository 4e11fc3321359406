#include "cli/scene_options.h"

#include "btf/dataset_fingerprint.h"
#include "capture/virtual_cloth.h"

#include <stdlib.h>
#include <string.h>

typedef struct loading {
    const scene_options *options;
    const weft_settings *settings;
    weft_player *player;
    double width_mm; /* of the material, or what stands for it; 0 until it is known */
} loading;

/* The first that says how wide it is says so for all. */
static void note_width(loading *l, double width_mm)
{
    if (l->width_mm == 0)
        l->width_mm = width_mm;
}

/* *metadata is given to the caller. */
static weft_code load_material(loading *l, char **metadata, weft_error *error)
{
    weft_material material = {0};
    weft_code code = weft_material_read(l->settings->material, &material, error);
    if (code == WEFT_OK) {
        note_width(l, material.level[0].width * material.texel_pitch_mm);
        code = weft_player_set_material(l->player, &material, error);
    }
    *metadata = material.metadata;
    material.metadata = NULL;
    weft_material_free(&material);
    return code;
}

static weft_code warn_of_another_origin(const loading *l, weft_dataset *dataset, const char *metadata,
                                        weft_error *error)
{
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_dataset_fingerprint_compare(dataset, metadata, warning, error));
    if (warning[0])
        command_say(&l->options->common, "warning: %s", warning);
    return WEFT_OK;
}

static weft_code upload_dataset(loading *l, weft_dataset *dataset, weft_error *error)
{
    int skipped_levels = 0;
    weft_progress progress = command_progress(&l->options->common);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    note_width(l, layout->width * (double)layout->texel_pitch_mm);
    WEFT_TRY(weft_player_set_dataset(l->player, dataset, &progress, &skipped_levels, error));
    if (skipped_levels > 0)
        command_say(&l->options->common,
                    "'%s' does not fit into graphics memory: its samples are shown at 1/%d of their size",
                    l->settings->dataset, 1 << skipped_levels);
    return WEFT_OK;
}

/* `metadata` of the material beside it, or NULL. */
static weft_code load_dataset(loading *l, const char *metadata, weft_error *error)
{
    weft_dataset *dataset = NULL;
    weft_code code = weft_dataset_open(l->settings->dataset, &dataset, error);
    if (code == WEFT_OK && metadata)
        code = warn_of_another_origin(l, dataset, metadata, error);
    if (code == WEFT_OK)
        code = upload_dataset(l, dataset, error);
    weft_dataset_close(dataset);
    return code;
}

static weft_code load_weave(loading *l, weft_error *error)
{
    weft_rig_settings rig = weft_rig_settings_default();
    weft_virtual_cloth cloth = {0};
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_virtual_cloth_read(l->settings->weave, &rig, 0, &cloth, warning, error));
    if (warning[0])
        command_say(&l->options->common, "%s", warning);
    const double *tiles = l->settings->tiles;
    note_width(l, cloth.opening_mm);
    weft_code code = weft_player_set_weave(l->player, &cloth.weave, tiles[0] > 0 ? tiles[0] : cloth.tiles_x,
                                           tiles[1] > 0 ? tiles[1] : cloth.tiles_y, error);
    weft_virtual_cloth_free(&cloth);
    return code;
}

static weft_code load_models(loading *l, weft_error *error)
{
    char *metadata = NULL;
    weft_code code = l->settings->material ? load_material(l, &metadata, error) : WEFT_OK;
    if (code == WEFT_OK && l->settings->dataset)
        code = load_dataset(l, metadata, error);
    free(metadata);
    WEFT_TRY(code);
    return l->settings->weave ? load_weave(l, error) : WEFT_OK;
}

static weft_code load_environment(const loading *l, weft_error *error)
{
    weft_image image = {0};
    weft_error cause = {0};
    if (!l->settings->environment)
        return WEFT_OK;
    WEFT_TRY(weft_image_read(l->settings->environment, &image, NULL, error));
    weft_code code = weft_player_set_environment(l->player, &image, &cause);
    weft_image_free(&image);
    if (code != WEFT_OK)
        return weft_fail(error, code, "'%s': %s", l->settings->environment, cause.message);
    return WEFT_OK;
}

weft_code scene_load_mesh(scene_options *o, weft_player *player, weft_error *error)
{
    weft_mesh mesh = {0};
    weft_settings *s = &o->settings;
    weft_code code = weft_mesh_open(s->mesh, &mesh, error);
    if (code == WEFT_OK)
        code = weft_player_set_mesh(player, &mesh, error);
    if (code == WEFT_OK)
        s->scene.repeat = weft_settings_repeat(s, &mesh, o->material_width_mm);
    weft_mesh_free(&mesh);
    return code;
}

static bool panes_are_there(const weft_scene *scene, const weft_player *player)
{
    for (int i = 0; i < weft_scene_panes(scene); i++)
        if (!weft_player_has(player, scene->pane[i]))
            return false;
    return true;
}

/* What was asked for, or stood in the picture; else all that is there for a split or a comparison of two, and the
 * compressed material or what else there is by itself. */
static weft_code choose_panes(scene_options *o, const weft_player *player, weft_error *error)
{
    static const weft_mode preference[WEFT_MODE_COUNT] = {WEFT_MODE_COMPRESSED, WEFT_MODE_RAW, WEFT_MODE_ANALYTIC};
    weft_scene *scene = &o->settings.scene;
    bool compares = scene->layout != WEFT_LAYOUT_PANES;
    bool is_chosen = (o->has_modes && !o->split && (scene->pane_count > 1 || !compares)) || (o->source && !o->split);
    if (is_chosen && panes_are_there(scene, player))
        return WEFT_OK;
    bool all = o->split || compares;
    scene->pane_count = 0;
    for (int i = 0; i < WEFT_MODE_COUNT && (all || scene->pane_count == 0); i++) {
        weft_mode mode = all ? (weft_mode)i : preference[i];
        if (weft_player_has(player, mode))
            scene->pane[scene->pane_count++] = mode;
    }
    if (compares && scene->pane_count < 2)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "a wipe or a difference needs two of a material, --raw NAME.btf.h5 and --weave CLOTH.wv");
    return WEFT_OK;
}

weft_code scene_load(scene_options *o, weft_player *player, weft_error *error)
{
    loading l = {o, &o->settings, player, 0};
    WEFT_TRY(load_models(&l, error));
    o->material_width_mm = l.width_mm;
    WEFT_TRY(load_environment(&l, error));
    WEFT_TRY(scene_load_mesh(o, player, error));
    if (strcmp(o->settings.mesh, "plane") == 0 && !o->has_camera && !o->source)
        o->settings.scene.orbit =
            (weft_orbit){.azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(75), .distance = 3};
    return choose_panes(o, player, error);
}
