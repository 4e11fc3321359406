#include "player/settings/scene_loader.h"

#include "btf/file_kind.h"
#include "player/settings/first_look.h"
#include "player/settings/scene_part.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double slice_s = 0.006; /* of each frame, for uploads */

struct weft_scene_loader {
    weft_scene_stage stage;
    weft_loader *loader;
    char *waiting_dataset; /* until there is a player */
    bool starting;         /* what the command line named is not all there yet */
    weft_scene wanted;     /* its panes */
    weft_scene chosen;     /* the panes that were shown last for them */
};

/* ---- Life ---- */

/* From here on the settings name what is shown: nothing yet. The mesh keeps its name, as the default has one. */
static weft_code start_all(weft_scene_loader *l, weft_error *error)
{
    static const weft_scene_slot order[] = {WEFT_SLOT_MATERIAL, WEFT_SLOT_MESH, WEFT_SLOT_WEAVE, WEFT_SLOT_ENVIRONMENT};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        char **path = weft_scene_stage_path(&l->stage, order[i]), *named = *path;
        if (!named)
            continue;
        WEFT_TRY(weft_scene_part_start(&l->stage, l->loader, order[i], named, false, error));
        if (order[i] != WEFT_SLOT_MESH) {
            free(named);
            *path = NULL;
        }
    }
    char **dataset = weft_scene_stage_path(&l->stage, WEFT_SLOT_DATASET);
    free(l->waiting_dataset);
    l->waiting_dataset = *dataset;
    *dataset = NULL;
    l->starting = true;
    l->wanted = l->chosen = l->stage.settings->scene;
    return WEFT_OK;
}

weft_code weft_scene_loader_create(weft_settings *settings, weft_scene_loader **result, weft_error *error)
{
    *result = NULL;
    weft_scene_loader *l = calloc(1, sizeof *l);
    if (!l)
        return weft_fail_memory(error, "loader", sizeof *l);
    l->stage.settings = settings;
    weft_code code = weft_first_look(settings, error);
    if (code == WEFT_OK)
        code = weft_loader_create(&l->loader, error);
    if (code == WEFT_OK)
        code = start_all(l, error);
    if (code == WEFT_OK)
        *result = l;
    else
        weft_scene_loader_free(l);
    return code;
}

void weft_scene_loader_free(weft_scene_loader *l)
{
    if (!l)
        return;
    weft_loader_free(l->loader);
    weft_scene_stage_free(&l->stage);
    free(l->waiting_dataset);
    free(l);
}

static weft_code start_dataset(weft_scene_loader *l, weft_error *error)
{
    if (!l->waiting_dataset)
        return WEFT_OK;
    weft_code code = weft_scene_part_start(&l->stage, l->loader, WEFT_SLOT_DATASET, l->waiting_dataset, false, error);
    free(l->waiting_dataset);
    l->waiting_dataset = NULL;
    return code;
}

weft_code weft_scene_loader_attach(weft_scene_loader *l, weft_player *player, weft_error *error)
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
static bool choose_panes(weft_scene_loader *l)
{
    static const weft_mode preference[WEFT_MODE_COUNT] = {WEFT_MODE_COMPRESSED, WEFT_MODE_RAW, WEFT_MODE_ANALYTIC};
    weft_settings *s = l->stage.settings;
    weft_scene *scene = &s->scene;
    scene->layout = l->wanted.layout;
    scene->pane_count = l->wanted.pane_count;
    memcpy(scene->pane, l->wanted.pane, sizeof scene->pane);
    bool compares = scene->layout != WEFT_LAYOUT_PANES;
    bool is_chosen =
        (weft_settings_has(s, "mode") && !s->split && (scene->pane_count > 1 || !compares)) || (s->source && !s->split);
    if (is_chosen && panes_are_there(scene, l->stage.player))
        return true;
    bool all = s->split || compares;
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
static void add_panes(weft_scene_loader *l)
{
    const weft_scene *scene = &l->stage.settings->scene, *chosen = &l->chosen;
    bool is_mine = scene->layout == chosen->layout && scene->pane_count == chosen->pane_count &&
                   memcmp(scene->pane, chosen->pane, sizeof scene->pane) == 0;
    if (!is_mine)
        return;
    choose_panes(l);
    l->chosen = *scene;
}

/* What the user dropped is shown, unless several modes are. */
static void show_dropped(weft_scene_loader *l)
{
    weft_scene *scene = &l->stage.settings->scene;
    if (scene->layout != WEFT_LAYOUT_PANES || scene->pane_count > 1)
        return;
    if (l->stage.slot == WEFT_SLOT_DATASET)
        scene->pane[0] = WEFT_MODE_RAW;
    else if (l->stage.slot == WEFT_SLOT_MATERIAL)
        scene->pane[0] = WEFT_MODE_COMPRESSED;
    else if (l->stage.slot == WEFT_SLOT_WEAVE)
        scene->pane[0] = WEFT_MODE_ANALYTIC;
}

/* ---- Progress ---- */

weft_code weft_scene_loader_poll(weft_scene_loader *l, bool *shown, char note[WEFT_MESSAGE_SIZE], weft_error *error)
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

weft_code weft_scene_loader_finish(weft_scene_loader *l, const weft_progress *progress, const weft_log *log,
                                   weft_error *error)
{
    bool some = true;
    while (some) {
        l->stage.note[0] = 0;
        WEFT_TRY(weft_loader_wait(l->loader, progress, &some, error));
        if (l->stage.note[0])
            weft_log_line(log, l->stage.note);
    }
    l->starting = false;
    if (!choose_panes(l))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "a wipe or a difference needs two of a material, --raw NAME.btf.h5 and --weave CLOTH.wv");
    return WEFT_OK;
}

static weft_code require_lobes(const weft_settings *settings, const weft_player *player, weft_error *error)
{
    if (settings->scene.components > 0 || weft_player_drawn_components(player, &settings->scene) == 0)
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE, "'%s' has no lobes: --components 0 cannot draw it", settings->material);
}

weft_code weft_scene_load(weft_settings *settings, weft_player *player, const weft_progress *progress,
                          const weft_log *log, weft_error *error)
{
    weft_scene_loader *loader = NULL;
    WEFT_TRY(weft_scene_loader_create(settings, &loader, error));
    weft_code code = weft_scene_loader_attach(loader, player, error);
    if (code == WEFT_OK)
        code = weft_scene_loader_finish(loader, progress, log, error);
    if (code == WEFT_OK)
        code = require_lobes(settings, player, error);
    weft_scene_loader_free(loader);
    return code;
}

double weft_scene_loader_progress(weft_scene_loader *l)
{
    return weft_loader_progress(l->loader);
}

const weft_hold_out *weft_scene_loader_held_out(const weft_scene_loader *l)
{
    bool is_there = l->stage.player && weft_player_has(l->stage.player, WEFT_MODE_COMPRESSED);
    return is_there && l->stage.is_measured ? &l->stage.held_out : NULL;
}

/* ---- Files that replace others ---- */

/* What the player shows is what the settings name. */
static weft_code clear_what_is_not_named(weft_scene_loader *l, weft_error *error)
{
    const weft_settings *s = l->stage.settings;
    const char *const named[WEFT_MODE_COUNT] = {s->dataset, s->material, s->weave};
    static const weft_scene_slot slot[WEFT_MODE_COUNT] = {WEFT_SLOT_DATASET, WEFT_SLOT_MATERIAL, WEFT_SLOT_WEAVE};
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (named[mode])
            continue;
        weft_loader_cancel(l->loader, (int)slot[mode]);
        weft_player_clear(l->stage.player, (weft_mode)mode);
        l->stage.width_mm[slot[mode]] = 0;
    }
    if (s->environment)
        return WEFT_OK;
    weft_loader_cancel(l->loader, WEFT_SLOT_ENVIRONMENT);
    return weft_player_set_environment(l->stage.player, NULL, 0, error);
}

static weft_code open_picture(weft_scene_loader *l, const char *path, weft_error *error)
{
    weft_settings settings = {0};
    weft_code code = weft_settings_read(path, &settings, error);
    if (code == WEFT_OK)
        code = weft_settings_check_files(&settings, path, error);
    if (code != WEFT_OK) {
        weft_settings_free(&settings);
        return code;
    }
    weft_settings_free(l->stage.settings);
    *l->stage.settings = settings;
    l->stage.settings->source = "";
    WEFT_TRY(clear_what_is_not_named(l, error));
    WEFT_TRY(start_all(l, error));
    return start_dataset(l, error);
}

static weft_code start_by_user(weft_scene_loader *l, weft_scene_slot slot, const char *path, weft_error *error)
{
    return weft_scene_part_start(&l->stage, l->loader, slot, path, true, error);
}

weft_code weft_scene_loader_open(weft_scene_loader *l, const char *path, weft_error *error)
{
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(path, &kind, error));
    switch (kind) {
    case WEFT_FILE_MATERIAL:
        return start_by_user(l, WEFT_SLOT_MATERIAL, path, error);
    case WEFT_FILE_DATASET:
        return start_by_user(l, WEFT_SLOT_DATASET, path, error);
    case WEFT_FILE_WEAVE:
    case WEFT_FILE_MICROCYLINDER:
        return start_by_user(l, WEFT_SLOT_WEAVE, path, error);
    case WEFT_FILE_MESH:
        return start_by_user(l, WEFT_SLOT_MESH, path, error);
    case WEFT_FILE_RADIANCE:
        return start_by_user(l, WEFT_SLOT_ENVIRONMENT, path, error);
    case WEFT_FILE_PICTURE:
        return open_picture(l, path, error);
    default:
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' cannot be shown: drop a .weft, .btf.h5, .wv, .mc, .obj, .exr, .hdr or a picture of weft",
                         path);
    }
}

weft_code weft_scene_loader_open_mesh(weft_scene_loader *l, const char *name, weft_error *error)
{
    return start_by_user(l, WEFT_SLOT_MESH, name, error);
}

weft_code weft_scene_loader_open_surroundings(weft_scene_loader *l, const char *name, weft_error *error)
{
    return start_by_user(l, WEFT_SLOT_ENVIRONMENT, name, error);
}

weft_code weft_scene_loader_reload_slot(weft_scene_loader *l, int slot, weft_error *error)
{
    const char *path = *weft_scene_stage_path(&l->stage, (weft_scene_slot)slot);
    bool is_file = path && access(path, F_OK) == 0;
    return is_file ? weft_scene_part_start(&l->stage, l->loader, (weft_scene_slot)slot, path, false, error) : WEFT_OK;
}

weft_code weft_scene_loader_reload(weft_scene_loader *l, weft_error *error)
{
    for (int slot = 0; slot < WEFT_SLOT_COUNT; slot++)
        WEFT_TRY(weft_scene_loader_reload_slot(l, slot, error));
    return WEFT_OK;
}
