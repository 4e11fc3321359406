#include "player/settings/scene_part.h"

#include "btf/dataset/fingerprint.h"
#include "btf/file_kind.h"
#include "player/scene/environment.h"
#include "player/scene/surroundings.h"
#include "player/settings/dataset_load.h"
#include "player/settings/first_look.h"
#include "reflectance/microcylinder/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct part {
    weft_scene_stage *stage;
    weft_scene_slot slot;
    bool by_user;
    bool is_threads; /* a weave that is microcylinder cloth */
    char *path;
    double width_mm, proportion, tiles[2];
    bool knows_measured;
    weft_measured measured; /* of a material or a dataset */
    bool is_measured;
    weft_hold_out held_out; /* of a material */
    weft_woven woven;
    char note[WEFT_MESSAGE_SIZE];
    /* One of these */
    weft_material material;
    weft_mesh mesh;
    weft_weave_texels texels;
    weft_microcylinder_description threads;
    weft_image image;
    weft_dataset_load *dataset;
} part;

void weft_scene_stage_free(weft_scene_stage *stage)
{
    free(stage->metadata);
}

char **weft_scene_stage_path(weft_scene_stage *stage, weft_scene_slot slot)
{
    weft_settings *settings = stage->settings;
    char **const path[WEFT_SLOT_COUNT] = {&settings->material, &settings->mesh, &settings->weave,
                                          &settings->environment, &settings->dataset};
    return path[slot];
}

/* ---- Reading, in the background ---- */

static weft_code read_material(part *p, weft_error *error)
{
    WEFT_TRY(weft_material_read(p->path, &p->material, error));
    p->width_mm = p->material.level[0].width * p->material.texel_pitch_mm;
    p->proportion = (double)p->material.level[0].height / p->material.level[0].width;
    WEFT_TRY(weft_measured_parse(p->material.metadata, &p->knows_measured, &p->measured, error));
    WEFT_TRY(weft_hold_out_read(p->material.metadata, &p->is_measured, &p->held_out, error));
    free(p->stage->metadata);
    p->stage->metadata = p->material.metadata;
    p->material.metadata = NULL;
    return WEFT_OK;
}

static weft_code read_weave(part *p, weft_error *error)
{
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(p->path, &kind, error));
    p->is_threads = kind == WEFT_FILE_MICROCYLINDER;
    if (p->is_threads)
        return weft_microcylinder_read(p->path, NULL, 0, &p->threads, error);
    weft_weave weave = {0};
    WEFT_TRY(weft_weave_read(p->path, NULL, 0, &weave, p->note, error));
    bool is_laid = weave.layout.tiles_u > 0 || p->tiles[0] > 0;
    p->woven.on_material = weft_weave_lay_out(&weave, p->tiles[0], p->tiles[1]);
    p->woven.alone = is_laid ? p->woven.on_material : weft_weave_square(&weave);
    p->woven.tile_width_mm = weave.tile_width * weft_weave_cell_pitch_mm(&weave);
    weft_code code = weft_weave_texels_of(&weave, &p->texels, error);
    weft_weave_free(&weave);
    return code;
}

static weft_code read_samples(part *p, weft_dataset *dataset, weft_load *load, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    char difference[WEFT_MESSAGE_SIZE] = "";
    p->measured = weft_measured_of(layout);
    p->knows_measured = true;
    p->width_mm = layout->width * layout->texel_pitch_mm;
    p->proportion = (double)layout->height / layout->width;
    if (p->stage->metadata)
        WEFT_TRY(weft_dataset_fingerprint_compare(dataset, p->stage->metadata, difference, error));
    if (difference[0])
        snprintf(p->note, sizeof p->note, "warning: %.*s", WEFT_MESSAGE_SIZE - 16, difference);
    return weft_dataset_load_read(p->dataset, dataset, load, error);
}

static weft_code read_dataset(part *p, weft_load *load, weft_error *error)
{
    weft_dataset *dataset = NULL;
    weft_code code = weft_dataset_open(p->path, &dataset, error);
    if (code == WEFT_OK)
        code = read_samples(p, dataset, load, error);
    weft_dataset_close(dataset);
    return code;
}

static weft_code read_part(void *data, weft_load *load, weft_error *error)
{
    part *p = data;
    switch (p->slot) {
    case WEFT_SLOT_MATERIAL:
        return read_material(p, error);
    case WEFT_SLOT_MESH:
        return weft_mesh_open(p->path, &p->mesh, error);
    case WEFT_SLOT_WEAVE:
        return read_weave(p, error);
    case WEFT_SLOT_ENVIRONMENT:
        return weft_surroundings_are(p->path) ? weft_surroundings_map(p->path, &p->image, error)
                                              : weft_image_read(p->path, &p->image, NULL, error);
    default:
        return read_dataset(p, load, error);
    }
}

/* ---- Showing ---- */

static weft_code show_weave(part *p, weft_error *error)
{
    if (p->is_threads)
        return weft_player_set_threads(p->stage->player, &p->threads.cloth, error);
    p->stage->woven = p->woven;
    return weft_player_set_weave_texels(p->stage->player, &p->texels, &p->woven.alone, error);
}

static weft_code show_environment(part *p, weft_error *error)
{
    weft_error cause = {0};
    int regions = weft_surroundings_are(p->path) ? WEFT_ENVIRONMENT_SMOOTH_REGIONS : WEFT_ENVIRONMENT_REGIONS;
    weft_code code = weft_player_set_environment(p->stage->player, &p->image, regions, &cause);
    if (code != WEFT_OK)
        return weft_fail(error, code, "'%s': %s", p->path, cause.message);
    if (p->by_user)
        p->stage->settings->scene.environment = true;
    return WEFT_OK;
}

static weft_code show_mesh(part *p, weft_error *error)
{
    WEFT_TRY(weft_player_set_mesh(p->stage->player, &p->mesh, error));
    weft_first_fit(p->stage->settings, &p->mesh);
    p->stage->mesh = p->mesh;
    p->stage->mesh.vertex = NULL;
    p->stage->mesh.index = NULL;
    p->stage->plane_proportion = 1;
    return WEFT_OK;
}

static weft_code show_dataset(part *p)
{
    weft_raw_plan plan;
    weft_dataset_load_show(p->dataset, &plan);
    weft_raw_format format = plan.tiles[WEFT_RAW_SAMPLES].format;
    if (format == WEFT_RAW_HALF && plan.skipped_levels == 0)
        return WEFT_OK;
    size_t used = strlen(p->note);
    int length =
        snprintf(p->note + used, sizeof p->note - used, "%s'%.200s': %.3g MB of samples as %s (%.3g MB as half floats)",
                 used > 0 ? "; " : "", p->path, 1e-6 * (double)weft_raw_plan_bytes(&plan, format),
                 weft_raw_format_name(format), 1e-6 * (double)weft_raw_plan_bytes(&plan, WEFT_RAW_HALF));
    used += (size_t)length;
    if (plan.skipped_levels > 0 && used < sizeof p->note)
        snprintf(p->note + used, sizeof p->note - used, ", at 1/%d of their size", 1 << plan.skipped_levels);
    return WEFT_OK;
}

static weft_code show_in_player(part *p, weft_error *error)
{
    switch (p->slot) {
    case WEFT_SLOT_MATERIAL:
        return weft_player_set_material(p->stage->player, &p->material, error);
    case WEFT_SLOT_MESH:
        return show_mesh(p, error);
    case WEFT_SLOT_WEAVE:
        return show_weave(p, error);
    case WEFT_SLOT_ENVIRONMENT:
        return show_environment(p, error);
    default:
        return show_dataset(p);
    }
}

/* The first measured model that says how wide it is says so for all. A weave lies on it as it was photographed, yarns
 * on yarns; alone it has its own size. */
static void lay_out(weft_scene_stage *stage)
{
    weft_settings *settings = stage->settings;
    const double *measured_mm = stage->width_mm;
    double width_mm =
        measured_mm[WEFT_SLOT_MATERIAL] > 0 ? measured_mm[WEFT_SLOT_MATERIAL] : measured_mm[WEFT_SLOT_DATASET];
    const weft_woven *woven = &stage->woven;
    bool is_woven = settings->weave && !weft_player_has_threads(stage->player);
    bool is_measured = settings->material || settings->dataset;
    if (is_woven)
        weft_player_lay_weave(stage->player, is_measured ? &woven->on_material : &woven->alone);
    if (is_woven && !is_measured)
        width_mm = woven->alone.tiles_u * woven->tile_width_mm;
    settings->scene.repeat =
        weft_settings_repeat(settings, &stage->mesh, width_mm, is_measured ? width_mm : WEFT_SETTINGS_SWATCH_MM);
}

/* The plane shows the material once, whatever its sides. */
static weft_code lay_plane(weft_scene_stage *stage, weft_error *error)
{
    const weft_settings *settings = stage->settings;
    const double *measured = stage->proportion;
    double proportion = measured[WEFT_SLOT_MATERIAL] > 0 ? measured[WEFT_SLOT_MATERIAL] : measured[WEFT_SLOT_DATASET];
    weft_mesh plane;
    bool is_shown = stage->plane_proportion > 0 && strcmp(settings->mesh, "plane") == 0;
    if (!is_shown || !(proportion > 0) || stage->plane_proportion == proportion)
        return WEFT_OK;
    WEFT_TRY(weft_mesh_plane(&plane, error));
    weft_settings_lay_plane(settings, proportion, &plane);
    weft_code code = weft_player_set_mesh(stage->player, &plane, error);
    if (code == WEFT_OK)
        weft_first_fit(stage->settings, &plane);
    weft_mesh_free(&plane);
    stage->plane_proportion = proportion;
    return code;
}

static void note_measured(const part *p)
{
    weft_settings *settings = p->stage->settings;
    if (p->slot != WEFT_SLOT_MATERIAL && p->slot != WEFT_SLOT_DATASET)
        return;
    weft_mode mode = p->slot == WEFT_SLOT_MATERIAL ? WEFT_MODE_COMPRESSED : WEFT_MODE_RAW;
    settings->knows_measured[mode] = p->knows_measured;
    settings->measured[mode] = p->measured;
}

static weft_code show_part(void *data, weft_error *error)
{
    part *p = data;
    weft_scene_stage *stage = p->stage;
    WEFT_TRY(show_in_player(p, error));
    char **path = weft_scene_stage_path(stage, p->slot);
    free(*path);
    *path = p->path;
    p->path = NULL;
    stage->width_mm[p->slot] = p->width_mm;
    stage->proportion[p->slot] = p->proportion;
    note_measured(p);
    if (p->slot == WEFT_SLOT_MATERIAL) {
        stage->is_measured = p->is_measured;
        stage->held_out = p->held_out;
    }
    stage->slot = p->slot;
    stage->by_user = p->by_user;
    memcpy(stage->note, p->note, sizeof stage->note);
    lay_out(stage);
    return lay_plane(stage, error);
}

static void release_part(void *data)
{
    part *p = data;
    weft_material_free(&p->material);
    weft_mesh_free(&p->mesh);
    weft_weave_texels_free(&p->texels);
    weft_image_free(&p->image);
    weft_dataset_load_free(p->dataset);
    free(p->path);
    free(p);
}

weft_code weft_scene_part_start(weft_scene_stage *stage, weft_loader *loader, weft_scene_slot slot, const char *path,
                                bool by_user, weft_error *error)
{
    static const weft_load_steps steps = {read_part, show_part, release_part};
    part *p = calloc(1, sizeof *p);
    if (!p)
        return weft_fail_memory(error, "load", sizeof *p);
    const double *tiles = stage->settings->tiles;
    *p = (part){.stage = stage, .slot = slot, .by_user = by_user, .path = strdup(path), .tiles = {tiles[0], tiles[1]}};
    weft_code code = p->path ? WEFT_OK : weft_fail_memory(error, "name", strlen(path));
    if (code == WEFT_OK && slot == WEFT_SLOT_DATASET)
        code = weft_dataset_load_create(stage->player, stage->settings->raw_format, &p->dataset, error);
    if (code == WEFT_OK)
        return weft_loader_start(loader, (int)slot, &steps, p, error);
    release_part(p);
    return code;
}
