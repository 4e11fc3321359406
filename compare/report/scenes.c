#include "compare/report/compare.h"

#include "compare/pictures/frame_time.h"
#include "compare/pictures/scene_error.h"
#include "player/gl/context.h"

#include <stdio.h>
#include <stdlib.h>

enum { PICTURE_SAMPLES = 3, PLANE_REPEATS = 1 };

typedef struct setting {
    const char *mesh, *caption;
    double light_theta_deg, light_phi_deg;
    double azimuth_deg, elevation_deg; /* of the eye; of the default scene where 0 */
} setting;

static const setting settings[WEFT_SCENE_COUNT] = {
    {"drape", "Drape, light from the upper left", 40, -130, 0, 0},
    {"drape", "Drape, light low from the right", 65, -10, 0, 0},
    {"plane", "Plane seen at 60\u00b0 from its normal, light at 45\u00b0 opposite", 45, 90, -90, 30},
};

const char *weft_scenes_model_name(int model)
{
    return model == WEFT_SCENE_BARD ? "BARD" : weft_mode_name((weft_mode)model);
}

static weft_scene scene_of(const setting *s, weft_mode mode)
{
    weft_scene scene = weft_scene_default();
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(s->light_theta_deg), weft_rad_of_deg(s->light_phi_deg)};
    if (s->elevation_deg > 0) {
        scene.orbit.azimuth_rad = weft_rad_of_deg(s->azimuth_deg);
        scene.orbit.elevation_rad = weft_rad_of_deg(s->elevation_deg);
        scene.repeat = PLANE_REPEATS;
    }
    scene.pane_count = 1;
    scene.pane[0] = mode;
    scene.labels = false;
    return scene;
}

static weft_code draw(weft_player *player, const weft_scene *scene, int side, weft_image *picture, weft_error *error)
{
    return weft_player_picture(player, scene, side, side, PICTURE_SAMPLES, NULL, picture, error);
}

static weft_code set_mesh(weft_player *player, const char *name, weft_error *error)
{
    weft_mesh mesh;
    WEFT_TRY(weft_mesh_open(name, &mesh, error));
    weft_code code = weft_player_set_mesh(player, &mesh, error);
    weft_mesh_free(&mesh);
    return code;
}

static weft_code set_models(weft_player *player, const weft_scenes_request *request, const weft_progress *progress,
                            weft_scenes *scenes, weft_error *error)
{
    WEFT_TRY(weft_player_set_material(player, request->material, error));
    WEFT_TRY(weft_player_set_dataset(player, request->dataset, progress, &scenes->skipped_levels, error));
    if (request->weave)
        WEFT_TRY(weft_player_set_weave(player, request->weave, request->layout, error));
    if (request->threads)
        WEFT_TRY(weft_player_set_threads(player, request->threads, error));
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++)
        scenes->has[mode] = weft_player_has(player, (weft_mode)mode);
    return WEFT_OK;
}

static weft_code draw_scene(weft_player *player, int index, weft_scenes *scenes, weft_error *error)
{
    weft_scene_pictures *pictures = &scenes->scene[index];
    pictures->caption = settings[index].caption;
    WEFT_TRY(set_mesh(player, settings[index].mesh, error));
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (!scenes->has[mode])
            continue;
        weft_scene scene = scene_of(&settings[index], (weft_mode)mode);
        WEFT_TRY(draw(player, &scene, scenes->width, &pictures->picture[mode], error));
        if (index == 0)
            WEFT_TRY(
                weft_frame_time_measure(player, &scene, scenes->width, scenes->height, &scenes->frame_ms[mode], error));
    }
    return WEFT_OK;
}

/* The models beside the data in one scene, over the pixels that the mesh covers. */
static weft_code measure_scene(weft_player *player, int index, weft_scenes *scenes, weft_error *error)
{
    weft_scene_pictures *pictures = &scenes->scene[index];
    weft_scene scene = scene_of(&settings[index], WEFT_MODE_RAW);
    weft_surface_sample *surface;
    WEFT_TRY(weft_player_read_surface(player, &scene, WEFT_MODE_RAW, scenes->width, scenes->height, &surface, error));
    weft_code code = WEFT_OK;
    for (int model = 0; model < WEFT_SCENE_MODELS && code == WEFT_OK; model++) {
        if (scenes->has[model] && model != WEFT_MODE_RAW)
            code = weft_visible_error_of(&pictures->picture[WEFT_MODE_RAW], &pictures->picture[model], surface,
                                         &pictures->error[model], error);
    }
    free(surface);
    return code;
}

/* BARD takes the place of the data in the player. */
static weft_code draw_bard(weft_player *player, const char *path, const weft_progress *progress, weft_scenes *scenes,
                           weft_error *error)
{
    weft_dataset *bard;
    int skipped_levels;
    WEFT_TRY(weft_dataset_open(path, &bard, error));
    weft_code code = weft_player_set_dataset(player, bard, progress, &skipped_levels, error);
    weft_dataset_close(bard);
    for (int i = 0; i < WEFT_SCENE_COUNT && code == WEFT_OK; i++) {
        weft_scene scene = scene_of(&settings[i], WEFT_MODE_RAW);
        code = set_mesh(player, settings[i].mesh, error);
        if (code == WEFT_OK)
            code = draw(player, &scene, scenes->width, &scenes->scene[i].picture[WEFT_SCENE_BARD], error);
    }
    scenes->has[WEFT_SCENE_BARD] = code == WEFT_OK;
    return code;
}

static weft_code draw_all(weft_player *player, const weft_scenes_request *request, const weft_progress *progress,
                          weft_scenes *scenes, weft_error *error)
{
    scenes->width = scenes->height = request->side;
    scenes->has_heights = weft_dataset_has_surface(request->dataset);
    scenes->near_lights = weft_dataset_get_layout(request->dataset)->distance == WEFT_NEAR;
    snprintf(scenes->renderer, sizeof scenes->renderer, "%s", weft_gl_renderer());
    WEFT_TRY(set_models(player, request, progress, scenes, error));
    for (int i = 0; i < WEFT_SCENE_COUNT; i++) {
        WEFT_TRY(draw_scene(player, i, scenes, error));
        weft_progress_report(progress, "drawing scenes", i + 1, WEFT_SCENE_COUNT);
    }
    if (request->bard)
        WEFT_TRY(draw_bard(player, request->bard, progress, scenes, error));
    for (int i = 0; i < WEFT_SCENE_COUNT; i++) {
        WEFT_TRY(set_mesh(player, settings[i].mesh, error));
        WEFT_TRY(measure_scene(player, i, scenes, error));
    }
    scenes->drawn = true;
    return WEFT_OK;
}

weft_code weft_scenes_draw(const weft_scenes_request *request, const weft_progress *progress, weft_scenes *scenes,
                           weft_error *error)
{
    *scenes = (weft_scenes){0};
    weft_headless *headless;
    weft_player *player;
    weft_error absence = {0};
    if (weft_headless_create(WEFT_GL_CORE, &headless, &absence) != WEFT_OK) {
        snprintf(scenes->why_not, sizeof scenes->why_not, "%s", absence.message);
        return WEFT_OK;
    }
    weft_code code = weft_player_create(&player, error);
    if (code == WEFT_OK) {
        code = draw_all(player, request, progress, scenes, error);
        weft_player_free(player);
    }
    weft_headless_free(headless);
    if (code != WEFT_OK)
        weft_scenes_free(scenes);
    return code;
}

void weft_scenes_free(weft_scenes *scenes)
{
    for (int i = 0; i < WEFT_SCENE_COUNT; i++) {
        for (int model = 0; model < WEFT_SCENE_MODELS; model++)
            weft_image_free(&scenes->scene[i].picture[model]);
    }
    *scenes = (weft_scenes){0};
}
