#include "compare/truth/comparison.h"

#include "geometry/drape/draped_cloth.h"
#include "player/draw/player.h"
#include "player/gl/context.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Triangles of the whole drape that are traced; about 120 bytes each. */
static const double most_triangles = 12e6;

enum { PICTURE_SAMPLES = 3, DEFAULT_BOUNCES = 3, MAX_BOUNCES = 256, COARSEST_CELLS = 4 };

/* Light of this inclination crosses the cloth from top to bottom within the reach of the cloth near by. */
static const double reach_deg = 75;

typedef struct setting {
    const char *caption;
    double light_theta_deg, light_phi_deg, azimuth_deg, elevation_deg;
} setting;

static const setting settings[WEFT_TRUTH_SCENE_COUNT] = {
    {"Light from the upper left", 40, -130, -70, 28},
    {"Light low from the right", 65, -10, -70, 28},
    {"From a low camera, light from above", 20, -60, 20, 10},
};

const char *weft_truth_model_name(weft_truth_model model)
{
    static const char *const name[WEFT_TRUTH_MODELS] = {"raw", "compressed", "truth"};
    return name[model];
}

/* Everything that is needed for the pictures. Freed with put_away. */
typedef struct truth_stage {
    weft_stitch stitch;
    weft_tile_mesh tile;
    weft_mesh drape;
    weft_draped_cloth *cloth;
    double mm_per_unit;
    double plane_mm; /* where the texels lie, above the top of the cloth */
    int side;        /* of the pictures, pixels */
    weft_headless *headless;
    weft_player *player;
} truth_stage;

static void put_away(truth_stage *stage)
{
    weft_draped_cloth_free(stage->cloth);
    weft_mesh_free(&stage->drape);
    weft_tile_mesh_free(&stage->tile);
    weft_stitch_free(&stage->stitch);
    if (stage->headless)
        weft_player_free(stage->player);
    weft_headless_free(stage->headless);
}

/* ---- What the dataset says of itself ---- */

/* Height of the texels above the top of the cloth: where they were simulated, or where `weft relief` moved them. */
static double plane_of(const json_t *provenance)
{
    const json_t *relief = json_object_get(provenance, "relief");
    double below_mm = json_number_value(json_object_get(provenance, "plane_below_top_mm"));
    return json_number_value(json_object_get(relief, "moved_mm")) - below_mm;
}

/* Where its texels lie, as many bounces as the simulation followed, and whether it was one of this stitch. */
static weft_code read_provenance(truth_stage *stage, const weft_dataset_layout *layout, weft_traced_truth *truth,
                                 weft_error *error)
{
    const weft_stitch *stitch = &stage->stitch;
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    if (!provenance)
        return weft_fail_memory(error, "provenance", strlen(layout->provenance));
    const char *name = json_string_value(json_object_get(provenance, "stitch"));
    const json_t *bounces = json_object_get(provenance, "bounces");
    json_int_t count = json_integer_value(bounces);
    stage->plane_mm = plane_of(provenance);
    truth->bounces = json_is_integer(bounces) && count >= 0 && count <= MAX_BOUNCES ? (int)count : DEFAULT_BOUNCES;
    if (!name)
        snprintf(truth->warning, sizeof truth->warning, "the dataset was not simulated from a stitch");
    else if (strcmp(name, stitch->name) != 0)
        snprintf(truth->warning, sizeof truth->warning,
                 "the dataset was simulated from '%.100s', the truth is traced from '%.100s'", name, stitch->name);
    json_decref(provenance);
    return WEFT_OK;
}

/* ---- The cloth ---- */

/* The number of triangles goes with the square of the number of cells. */
static weft_code polygonise(truth_stage *stage, const char *path, weft_traced_truth *truth, weft_error *error)
{
    const weft_stitch *stitch = &stage->stitch;
    double tiles = (double)WEFT_TRUTH_REPEAT * ceil(WEFT_TRUTH_REPEAT * stitch->width / stitch->height);
    truth->cells = truth->finest_cells = stitch->resolution;
    WEFT_TRY(weft_tile_mesh_create(stitch, 0, path, &stage->tile, error));
    double share = most_triangles / (tiles * stage->tile.triangle_count);
    if (share >= 1)
        return WEFT_OK;
    truth->cells = (int)fmax(floor(stitch->resolution * sqrt(share)), COARSEST_CELLS);
    weft_tile_mesh_free(&stage->tile);
    return weft_tile_mesh_create(stitch, truth->cells, path, &stage->tile, error);
}

static weft_code lay_cloth(truth_stage *stage, weft_error *error)
{
    weft_truth_base base;
    WEFT_TRY(weft_mesh_drape(&stage->drape, error));
    WEFT_TRY(weft_truth_base_create(&stage->drape, WEFT_TRUTH_REPEAT, stage->stitch.width, &base, error));
    stage->mm_per_unit = base.mm_per_unit;
    base.surface.plane_mm = (weft_real)stage->plane_mm;
    weft_code code = weft_draped_cloth_create(&stage->stitch, &stage->tile, &base.surface, &stage->cloth, error);
    weft_truth_base_free(&base);
    return code;
}

/* The player takes texels for square; coordinates in proportion lay the tile at its true shape. */
static weft_code set_drape(truth_stage *stage, const weft_dataset_layout *layout, weft_error *error)
{
    double shown = (double)layout->width / layout->height, is = stage->stitch.width / stage->stitch.height;
    for (int i = 0; i < stage->drape.vertex_count; i++)
        stage->drape.vertex[i].coordinate[1] *= (float)(is / shown);
    return weft_player_set_mesh(stage->player, &stage->drape, error);
}

static weft_code set_models(truth_stage *stage, const weft_traced_request *request, const weft_progress *progress,
                            weft_error *error)
{
    int skipped_levels;
    WEFT_TRY(weft_player_create(&stage->player, error));
    WEFT_TRY(set_drape(stage, weft_dataset_get_layout(request->dataset), error));
    WEFT_TRY(weft_player_set_material(stage->player, request->material, error));
    return weft_player_set_dataset(stage->player, request->dataset, progress, &skipped_levels, error);
}

static weft_code prepare(truth_stage *stage, const weft_traced_request *request, const weft_progress *progress,
                         weft_traced_truth *truth, weft_error *error)
{
    WEFT_TRY(weft_stitch_read(request->stitch, &stage->stitch, error));
    WEFT_TRY(read_provenance(stage, weft_dataset_get_layout(request->dataset), truth, error));
    WEFT_TRY(polygonise(stage, request->stitch, truth, error));
    WEFT_TRY(lay_cloth(stage, error));
    snprintf(truth->stitch, sizeof truth->stitch, "%s", stage->stitch.name);
    truth->triangles = weft_draped_cloth_triangle_count(stage->cloth);
    truth->cloth_mm = stage->mm_per_unit;
    truth->reach_mm = (double)(stage->tile.top - stage->tile.bottom) / cos(reach_deg * WEFT_PI / 180);
    truth->paths = request->paths;
    truth->has_heights[WEFT_TRUTH_RAW] = weft_dataset_has_surface(request->dataset);
    truth->has_heights[WEFT_TRUTH_COMPRESSED] = request->material->components && request->material->heights;
    return set_models(stage, request, progress, error);
}

/* ---- Pictures ---- */

static weft_scene scene_of(const setting *s)
{
    weft_scene scene = weft_scene_default();
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(s->light_theta_deg), weft_rad_of_deg(s->light_phi_deg)};
    scene.orbit.azimuth_rad = weft_rad_of_deg(s->azimuth_deg);
    scene.orbit.elevation_rad = weft_rad_of_deg(s->elevation_deg);
    scene.repeat = WEFT_TRUTH_REPEAT;
    scene.labels = false;
    return scene;
}

static weft_code draw(truth_stage *stage, const weft_scene *scene, weft_mode mode, weft_image *picture,
                      weft_error *error)
{
    weft_scene alone = *scene;
    alone.pane[0] = mode;
    return weft_player_picture(stage->player, &alone, stage->side, stage->side, PICTURE_SAMPLES, NULL, picture, error);
}

/* What the player shows behind the cloth: a picture of a triangle without area. */
static weft_code draw_background(truth_stage *stage, const weft_scene *scene, weft_image *background, weft_error *error)
{
    weft_mesh nothing;
    WEFT_TRY(weft_mesh_allocate(3, 1, &nothing, error));
    for (int i = 0; i < 3; i++) {
        nothing.vertex[i] = (weft_vertex){.position = {(float)i, 0, 0}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}};
        nothing.index[0][i] = (uint32_t)i;
    }
    weft_code code = weft_player_set_mesh(stage->player, &nothing, error);
    weft_mesh_free(&nothing);
    if (code == WEFT_OK)
        code = draw(stage, scene, WEFT_MODE_COMPRESSED, background, error);
    if (code == WEFT_OK)
        code = weft_player_set_mesh(stage->player, &stage->drape, error);
    return code;
}

static weft_code draw_models(truth_stage *stage, const weft_scene *scene, weft_truth_scene *result, weft_error *error)
{
    for (int light = 0; light < WEFT_TRUTH_LIGHTS; light++) {
        weft_scene lit = *scene;
        weft_image *picture = result->under[light].picture;
        lit.shadows = light == WEFT_TRUTH_ALL;
        WEFT_TRY(draw(stage, &lit, WEFT_MODE_RAW, &picture[WEFT_TRUTH_RAW], error));
        WEFT_TRY(draw(stage, &lit, WEFT_MODE_COMPRESSED, &picture[WEFT_TRUTH_COMPRESSED], error));
    }
    return WEFT_OK;
}

static weft_code trace(truth_stage *stage, const weft_traced_request *request, const weft_scene *scene,
                       const weft_traced_truth *truth, const weft_progress *progress, weft_truth_scene *result,
                       weft_error *error)
{
    weft_image background = {0};
    weft_traced traced;
    const weft_trace_options options = {stage->side,    stage->side,     request->paths,
                                        truth->bounces, truth->reach_mm, request->seed};
    WEFT_TRY(draw_background(stage, scene, &background, error));
    weft_code code = weft_trace(stage->cloth, &stage->drape, stage->mm_per_unit, scene, &options, &background, progress,
                                &traced, error);
    result->under[WEFT_TRUTH_ALL].picture[WEFT_TRUTH_TRACED] = traced.all;
    result->under[WEFT_TRUTH_NEAR].picture[WEFT_TRUTH_TRACED] = traced.near;
    result->noise = traced.noise;
    weft_image_free(&background);
    return code;
}

/* The error of a model that has heights, drawn without them. */
static weft_code measure_flat(truth_stage *stage, const weft_scene *scene, int light, int model,
                              const weft_surface_sample *surface, weft_truth_pictures *under, weft_error *error)
{
    weft_image picture;
    weft_scene flat = *scene;
    flat.relief = false;
    flat.shadows = light == WEFT_TRUTH_ALL;
    WEFT_TRY(draw(stage, &flat, model == WEFT_TRUTH_RAW ? WEFT_MODE_RAW : WEFT_MODE_COMPRESSED, &picture, error));
    weft_code code =
        weft_truth_error_of(&under->picture[WEFT_TRUTH_TRACED], &picture, surface, &under->flat[model], error);
    weft_image_free(&picture);
    return code;
}

static weft_code measure(truth_stage *stage, const weft_scene *scene, const weft_traced_truth *truth,
                         weft_truth_scene *result, weft_error *error)
{
    weft_surface_sample *surface;
    WEFT_TRY(weft_player_read_surface(stage->player, scene, WEFT_MODE_RAW, stage->side, stage->side, &surface, error));
    weft_code code = WEFT_OK;
    for (int i = 0; i < WEFT_TRUTH_LIGHTS * WEFT_TRUTH_TRACED && code == WEFT_OK; i++) {
        weft_truth_pictures *under = &result->under[i / WEFT_TRUTH_TRACED];
        int model = i % WEFT_TRUTH_TRACED;
        code = weft_truth_error_of(&under->picture[WEFT_TRUTH_TRACED], &under->picture[model], surface,
                                   &under->error[model], error);
        if (code == WEFT_OK && truth->has_heights[model])
            code = measure_flat(stage, scene, i / WEFT_TRUTH_TRACED, model, surface, under, error);
    }
    free(surface);
    return code;
}

static weft_code make_scene(truth_stage *stage, const weft_traced_request *request, int index,
                            const weft_progress *progress, weft_traced_truth *truth, weft_error *error)
{
    weft_truth_scene *result = &truth->scene[index];
    weft_scene scene = scene_of(&settings[index]);
    result->caption = settings[index].caption;
    WEFT_TRY(draw_models(stage, &scene, result, error));
    WEFT_TRY(trace(stage, request, &scene, truth, progress, result, error));
    return measure(stage, &scene, truth, result, error);
}

weft_code weft_traced_truth_measure(const weft_traced_request *request, const weft_progress *progress,
                                    weft_traced_truth *truth, weft_error *error)
{
    *truth = (weft_traced_truth){.width = request->side, .height = request->side};
    truth_stage stage = {.side = request->side};
    weft_error absence = {0};
    if (weft_headless_create(WEFT_GL_CORE, &stage.headless, &absence) != WEFT_OK) {
        snprintf(truth->why_not, sizeof truth->why_not, "%s", absence.message);
        return WEFT_OK;
    }
    weft_code code = prepare(&stage, request, progress, truth, error);
    for (int i = 0; i < WEFT_TRUTH_SCENE_COUNT && code == WEFT_OK; i++)
        code = make_scene(&stage, request, i, progress, truth, error);
    put_away(&stage);
    truth->drawn = code == WEFT_OK;
    if (code != WEFT_OK)
        weft_traced_truth_free(truth);
    return code;
}

void weft_traced_truth_free(weft_traced_truth *truth)
{
    for (int i = 0; i < WEFT_TRUTH_SCENE_COUNT * WEFT_TRUTH_LIGHTS; i++)
        for (int model = 0; model < WEFT_TRUTH_MODELS; model++)
            weft_image_free(&truth->scene[i / WEFT_TRUTH_LIGHTS].under[i % WEFT_TRUTH_LIGHTS].picture[model]);
    *truth = (weft_traced_truth){0};
}
