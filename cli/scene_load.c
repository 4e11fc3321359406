#include "cli/scene_load.h"

#include "btf/file_kind.h"
#include "cli/scene_part.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double slice_s = 0.006; /* of each frame, for uploads */

struct scene_loader {
    scene_stage stage;
    weft_loader *loader;
    char *waiting_dataset; /* until there is a player */
    bool starting;         /* what the command line named is not all there yet */
    weft_scene wanted;     /* its panes */
    weft_scene chosen;     /* the panes that were shown last for them */
};

/* ---- Life ---- */

/* From here on the settings name what is shown: nothing yet. The mesh keeps its name, as the default has one. */
static weft_code start_all(scene_loader *l, weft_error *error)
{
    static const scene_slot order[] = {SCENE_MATERIAL, SCENE_MESH, SCENE_WEAVE, SCENE_ENVIRONMENT};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        char **path = scene_stage_path(&l->stage, order[i]), *named = *path;
        if (!named)
            continue;
        WEFT_TRY(scene_part_start(&l->stage, l->loader, order[i], named, false, error));
        if (order[i] != SCENE_MESH) {
            free(named);
            *path = NULL;
        }
    }
    char **dataset = scene_stage_path(&l->stage, SCENE_DATASET);
    free(l->waiting_dataset);
    l->waiting_dataset = *dataset;
    *dataset = NULL;
    l->starting = true;
    l->wanted = l->chosen = l->stage.options->settings.scene;
    return WEFT_OK;
}

static void look_down_on_a_plane(scene_options *o)
{
    if (strcmp(o->settings.mesh, "plane") == 0 && !o->has_camera && !o->source)
        o->settings.scene.orbit =
            (weft_orbit){.azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(75), .distance = 3};
}

weft_code scene_loader_create(scene_options *options, scene_loader **result, weft_error *error)
{
    *result = NULL;
    scene_loader *l = calloc(1, sizeof *l);
    if (!l)
        return weft_fail_memory(error, "loader", sizeof *l);
    l->stage.options = options;
    look_down_on_a_plane(options);
    weft_code code = weft_loader_create(&l->loader, error);
    if (code == WEFT_OK)
        code = start_all(l, error);
    if (code == WEFT_OK)
        *result = l;
    else
        scene_loader_free(l);
    return code;
}

void scene_loader_free(scene_loader *l)
{
    if (!l)
        return;
    weft_loader_free(l->loader);
    scene_stage_free(&l->stage);
    free(l->waiting_dataset);
    free(l);
}

static weft_code start_dataset(scene_loader *l, weft_error *error)
{
    if (!l->waiting_dataset)
        return WEFT_OK;
    weft_code code = scene_part_start(&l->stage, l->loader, SCENE_DATASET, l->waiting_dataset, false, error);
    free(l->waiting_dataset);
    l->waiting_dataset = NULL;
    return code;
}

weft_code scene_loader_attach(scene_loader *l, weft_player *player, weft_error *error)
{
    l->stage.player = player;
    return start_dataset(l, error);
}

/* ---- Panes ---- */

static bool panes_are_there(const weft_scene *scene, const weft_player *player)
{
    for (int i = 0; i < weft_scene_panes(scene); i++)
        if (!weft_player_has(player, scene->pane[i]))
            return false;
    return true;
}

/* What was asked for, or stood in the picture; else all that is there for a split or a comparison of two, and the
 * compressed material or what else there is by itself. False while a comparison lacks one. */
static bool choose_panes(scene_loader *l)
{
    static const weft_mode preference[WEFT_MODE_COUNT] = {WEFT_MODE_COMPRESSED, WEFT_MODE_RAW, WEFT_MODE_ANALYTIC};
    scene_options *o = l->stage.options;
    weft_scene *scene = &o->settings.scene;
    scene->layout = l->wanted.layout;
    scene->pane_count = l->wanted.pane_count;
    memcpy(scene->pane, l->wanted.pane, sizeof scene->pane);
    bool compares = scene->layout != WEFT_LAYOUT_PANES;
    bool is_chosen = (o->has_modes && !o->split && (scene->pane_count > 1 || !compares)) || (o->source && !o->split);
    if (is_chosen && panes_are_there(scene, l->stage.player))
        return true;
    bool all = o->split || compares;
    scene->pane_count = 0;
    for (int i = 0; i < WEFT_MODE_COUNT && (all || scene->pane_count == 0); i++) {
        weft_mode mode = all ? (weft_mode)i : preference[i];
        if (weft_player_has(l->stage.player, mode))
            scene->pane[scene->pane_count++] = mode;
    }
    if (!compares || scene->pane_count >= 2)
        return true;
    scene->layout = WEFT_LAYOUT_PANES;
    return false;
}

/* While files arrive one after the other, panes are added, until the user chooses others. */
static void add_panes(scene_loader *l)
{
    const weft_scene *scene = &l->stage.options->settings.scene, *chosen = &l->chosen;
    bool is_mine = scene->layout == chosen->layout && scene->pane_count == chosen->pane_count &&
                   memcmp(scene->pane, chosen->pane, sizeof scene->pane) == 0;
    if (!is_mine)
        return;
    choose_panes(l);
    l->chosen = *scene;
}

/* What the user dropped is shown, unless several modes are. */
static void show_dropped(scene_loader *l)
{
    weft_scene *scene = &l->stage.options->settings.scene;
    if (scene->layout != WEFT_LAYOUT_PANES || scene->pane_count > 1)
        return;
    if (l->stage.slot == SCENE_DATASET)
        scene->pane[0] = WEFT_MODE_RAW;
    else if (l->stage.slot == SCENE_MATERIAL)
        scene->pane[0] = WEFT_MODE_COMPRESSED;
    else if (l->stage.slot == SCENE_WEAVE)
        scene->pane[0] = WEFT_MODE_ANALYTIC;
}

/* ---- Progress ---- */

weft_code scene_loader_poll(scene_loader *l, bool *shown, char note[WEFT_MESSAGE_SIZE], weft_error *error)
{
    l->stage.note[0] = 0;
    weft_code code = weft_loader_poll(l->loader, slice_s, shown, error);
    memcpy(note, l->stage.note, WEFT_MESSAGE_SIZE);
    if (*shown && l->starting)
        add_panes(l);
    else if (*shown && l->stage.by_user)
        show_dropped(l);
    l->starting &= weft_loader_progress(l->loader) >= 0;
    return code;
}

weft_code scene_loader_finish(scene_loader *l, weft_error *error)
{
    const common_options *common = &l->stage.options->common;
    weft_progress progress = command_progress(common);
    bool some = true;
    while (some) {
        l->stage.note[0] = 0;
        WEFT_TRY(weft_loader_wait(l->loader, &progress, &some, error));
        if (l->stage.note[0])
            command_say(common, "%s", l->stage.note);
    }
    l->starting = false;
    if (!choose_panes(l))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "a wipe or a difference needs two of a material, --raw NAME.btf.h5 and --weave CLOTH.wv");
    return WEFT_OK;
}

weft_code scene_load(scene_options *options, weft_player *player, weft_error *error)
{
    scene_loader *loader = NULL;
    WEFT_TRY(scene_loader_create(options, &loader, error));
    weft_code code = scene_loader_attach(loader, player, error);
    if (code == WEFT_OK)
        code = scene_loader_finish(loader, error);
    scene_loader_free(loader);
    return code;
}

double scene_loader_progress(scene_loader *l)
{
    return weft_loader_progress(l->loader);
}

/* ---- Files that replace others ---- */

/* What the player shows is what the settings name. */
static weft_code clear_what_is_not_named(scene_loader *l, weft_error *error)
{
    const weft_settings *s = &l->stage.options->settings;
    const char *const named[WEFT_MODE_COUNT] = {s->dataset, s->material, s->weave};
    static const scene_slot slot[WEFT_MODE_COUNT] = {SCENE_DATASET, SCENE_MATERIAL, SCENE_WEAVE};
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (named[mode])
            continue;
        weft_loader_cancel(l->loader, (int)slot[mode]);
        weft_player_clear(l->stage.player, (weft_mode)mode);
        l->stage.width_mm[slot[mode]] = 0;
    }
    if (s->environment)
        return WEFT_OK;
    weft_loader_cancel(l->loader, SCENE_ENVIRONMENT);
    return weft_player_set_environment(l->stage.player, NULL, error);
}

static weft_code open_picture(scene_loader *l, const char *path, weft_error *error)
{
    weft_settings settings = {0};
    weft_code code = weft_settings_read(path, &settings, error);
    if (code == WEFT_OK)
        code = weft_settings_check_files(&settings, path, error);
    if (code != WEFT_OK) {
        weft_settings_free(&settings);
        return code;
    }
    scene_options *o = l->stage.options;
    weft_settings_free(&o->settings);
    o->settings = settings;
    o->source = "";
    o->split = false;
    WEFT_TRY(clear_what_is_not_named(l, error));
    WEFT_TRY(start_all(l, error));
    return start_dataset(l, error);
}

static weft_code start_by_user(scene_loader *l, scene_slot slot, const char *path, weft_error *error)
{
    return scene_part_start(&l->stage, l->loader, slot, path, true, error);
}

weft_code scene_loader_open(scene_loader *l, const char *path, weft_error *error)
{
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(path, &kind, error));
    switch (kind) {
    case WEFT_FILE_MATERIAL:
        return start_by_user(l, SCENE_MATERIAL, path, error);
    case WEFT_FILE_DATASET:
        return start_by_user(l, SCENE_DATASET, path, error);
    case WEFT_FILE_WEAVE:
    case WEFT_FILE_MICROCYLINDER:
        return start_by_user(l, SCENE_WEAVE, path, error);
    case WEFT_FILE_MESH:
        return start_by_user(l, SCENE_MESH, path, error);
    case WEFT_FILE_RADIANCE:
        return start_by_user(l, SCENE_ENVIRONMENT, path, error);
    case WEFT_FILE_PICTURE:
        return open_picture(l, path, error);
    default:
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' cannot be shown: drop a .weft, .btf.h5, .wv, .mc, .obj, .exr, .hdr or a picture of weft",
                         path);
    }
}

weft_code scene_loader_open_mesh(scene_loader *l, const char *name, weft_error *error)
{
    return start_by_user(l, SCENE_MESH, name, error);
}

weft_code scene_loader_reload_slot(scene_loader *l, int slot, weft_error *error)
{
    const char *path = *scene_stage_path(&l->stage, (scene_slot)slot);
    bool is_file = path && access(path, F_OK) == 0;
    return is_file ? scene_part_start(&l->stage, l->loader, (scene_slot)slot, path, false, error) : WEFT_OK;
}

weft_code scene_loader_reload(scene_loader *l, weft_error *error)
{
    for (int slot = 0; slot < SCENE_SLOT_COUNT; slot++)
        WEFT_TRY(scene_loader_reload_slot(l, slot, error));
    return WEFT_OK;
}
