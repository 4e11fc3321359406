/* What a scene reaches of a material, against what a player really asks for; and materials without the rest. The bounds
 * are tried with pixels of random moments, whose places, levels and directions come from the shaders: they know nothing
 * of the bounds. Skipped without OpenGL. */
#include "base/atomic_file.h"
#include "btf/direction/direction.h"
#include "btf/direction/square_map.h"
#include "btf/material/component_rounding.h"
#include "edit/prune/steps.h"
#include "edit/prune/visibility.h"
#include "player/draw/player.h"
#include "player/gl/context.h"
#include "player/scene/false_colour.h"
#include "tests/compare/fixture.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 120, HEIGHT = 90, PIXELS = WIDTH * HEIGHT, TEXELS_X = 48, TEXELS_Y = 40, MOMENTS = 8 };

static weft_headless *headless;
static weft_player *player;

static double chance(void)
{
    return rand() / (RAND_MAX + 1.0);
}

/* ---- A material ---- */

static weft_half half(double value)
{
    return weft_half_of_float((float)value);
}

/* One lobe everywhere, a table of 81 views that tells directions and texels apart. */
static weft_material make_material(void)
{
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_create(TEXELS_X, TEXELS_Y, 1, WEFT_UBO81_COUNT, 0, 1, &material, &error), &error);
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        material.view[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    for (int k = 0; k < material.level_count; k++) {
        weft_material_level *level = &material.level[k];
        size_t texels = (size_t)level->width * (size_t)level->height;
        for (size_t i = 0; i < texels; i++) {
            for (size_t c = 0; c < 3; c++) {
                level->diffuse[4 * i + c] = half(0.1 + 0.1 * (double)c + 0.01 * (double)(i % 7));
                weft_half *lobe = level->lobe + 4 * (c * texels + i);
                lobe[0] = lobe[1] = half(-0.8);
                lobe[2] = half(0.8);
                lobe[3] = half(20);
            }
        }
        for (size_t i = 0; i < 4 * WEFT_UBO81_COUNT * texels; i++)
            level->table[i] = i % 4 == 3 ? 255 : (uint8_t)(120 + (i / 4 * 37 + i % 4) % 130);
    }
    return material;
}

/* ---- Scenes ---- */

typedef struct stage {
    weft_mesh mesh;
    weft_path path;
    weft_prune_scene scene;
    weft_material material;
    weft_visibility visibility;
} stage;

static void open_stage(const char *mesh, const char *path, double repeat, stage *s)
{
    weft_error error = {0};
    expect_ok(weft_mesh_open(mesh, &s->mesh, &error), &error);
    expect_ok(weft_write_file("path.csv", path, strlen(path), &error), &error);
    expect_ok(weft_path_read("path.csv", &s->path, &error), &error);
    s->material = make_material();
    s->scene = (weft_prune_scene){&s->mesh, &s->path, weft_scene_default(), WIDTH, HEIGHT, 1};
    s->scene.scene.repeat = repeat;
    expect_ok(weft_visibility_find(&s->scene, &s->material, NULL, &s->visibility, &error), &error);
    expect_ok(weft_player_set_mesh(player, &s->mesh, &error), &error);
    expect_ok(weft_player_set_material(player, &s->material, &error), &error);
}

static void close_stage(stage *s)
{
    weft_visibility_free(&s->visibility);
    weft_material_free(&s->material);
    weft_path_free(&s->path);
    weft_mesh_free(&s->mesh);
}

static const char turning[] = "time_s,azimuth_deg,elevation_deg,distance,light_theta_deg,light_phi_deg\n"
                              "0,-70,35,3.4,30,-110\n1,-60,28,3.2,35,-100\n1.5,-50,30,3.0,40,-95\n";
static const char close_by[] = "time_s,azimuth_deg,elevation_deg,distance,pan_right,light_theta_deg,light_phi_deg\n"
                               "0,-90,70,1.2,0.3,20,10\n1,-80,75,1.1,0.32,25,20\n";
static const char still[] = "time_s,azimuth_deg,elevation_deg,distance\n0,-70,28,4\n";

/* ---- What pixels ask for ---- */

static bool is_set(const uint8_t *map, int side, const float direction[3])
{
    weft_place place = weft_place_of_direction(weft_vec3_of(direction[0], direction[1], direction[2]));
    int column = (int)fmin(place.x * side, side - 1), row = (int)fmin(place.y * side, side - 1);
    return map[row * side + column] != 0;
}

/* All four texels around a place. */
static bool has_texels(const weft_visibility *visibility, int k, double u, double v)
{
    int width = visibility->width[k], height = visibility->height[k];
    int x = (int)floor((u - floor(u)) * width - 0.5), y = (int)floor((-v - floor(-v)) * height - 0.5);
    bool all = true;
    for (int i = 0; i < 4; i++)
        all = all && visibility->texel[k][(y + i / 2 + height) % height * width + (x + i % 2 + width) % width];
    return all;
}

static int pair_of(const float d[3])
{
    weft_place place = weft_place_of_direction(weft_vec3_of(d[0], d[1], d[2]));
    int side = WEFT_VISIBILITY_PAIR_SIDE;
    return (int)fmin(place.y * side, side - 1) * side + (int)fmin(place.x * side, side - 1);
}

/* A pixel that takes less than this of a level may find it gone: levels are rounded in single precision. */
static const double trifle = 1e-3;

static void expect_held(const weft_visibility *visibility, const weft_surface_sample *at)
{
    double level = fmin(fmax((double)at->level, 0), visibility->level_count - 1);
    assert_true((level > floor(level) && ceil(level) - level < trifle) ||
                has_texels(visibility, (int)level, (double)at->u, (double)at->v));
    assert_true(level - floor(level) < trifle ||
                has_texels(visibility, (int)ceil(level), (double)at->u, (double)at->v));
    assert_true(is_set(visibility->view, WEFT_VISIBILITY_SIDE, at->view));
    if (at->light[2] <= 0)
        return;
    assert_true(is_set(visibility->light, WEFT_VISIBILITY_SIDE, at->light));
    assert_true(visibility->pair[(size_t)pair_of(at->view) * WEFT_VISIBILITY_PAIR_CELLS + (size_t)pair_of(at->light)]);
    for (int i = 0; i < 9; i++) {
        double product = (double)(at->light[i / 3] * at->view[i % 3]);
        assert_true(product >= visibility->product[i / 3][i % 3][0] && product <= visibility->product[i / 3][i % 3][1]);
    }
}

/* Returns how many pixels were held against the bounds. */
static long expect_all_held(const stage *s)
{
    long covered = 0;
    double length_s = s->path.time_s[s->path.key_count - 1] - s->path.time_s[0];
    for (int i = 0; i < MOMENTS; i++) {
        weft_error error = {0};
        weft_surface_sample *at;
        weft_scene scene = s->scene.scene;
        weft_path_apply(&s->path, s->path.time_s[0] + length_s * chance(), &scene);
        expect_ok(weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
        for (int pixel = 0; pixel < PIXELS; pixel++)
            if (at[pixel].covered > 0) {
                expect_held(&s->visibility, &at[pixel]);
                covered++;
            }
        free(at);
    }
    return covered;
}

static double share_of(const uint8_t *map, size_t count)
{
    size_t set = 0;
    for (size_t i = 0; i < count; i++)
        set += map[i];
    return (double)set / (double)count;
}

/* The largest value that a lobe takes for the pairs of a moment is below its bound. */
static void expect_lobes_held(const stage *s)
{
    const double lobe[2][4] = {{-0.8, -0.7, 0.9, 30}, {0.9, 0.8, 0.4, 12}};
    const int16_t code[3] = {6000, -4000, 9000};
    weft_frame frame = weft_frame_decode(code);
    weft_error error = {0};
    weft_surface_sample *at;
    weft_scene scene = s->scene.scene;
    weft_path_apply(&s->path, 0.7, &scene);
    expect_ok(weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int i = 0; i < 2; i++) {
        double bound = weft_lobe_bound(&s->visibility, &frame, lobe[i]), most = 0;
        for (int p = 0; p < PIXELS; p++) {
            weft_vec3 l = weft_vec3_of(at[p].light[0], at[p].light[1], at[p].light[2]);
            weft_vec3 v = weft_vec3_of(at[p].view[0], at[p].view[1], at[p].view[2]);
            double a = lobe[i][0] * weft_dot(l, frame.tangent) * weft_dot(v, frame.tangent) +
                       lobe[i][1] * weft_dot(l, frame.bitangent) * weft_dot(v, frame.bitangent) +
                       lobe[i][2] * weft_dot(l, frame.normal) * weft_dot(v, frame.normal);
            if (at[p].covered > 0 && l.z > 0 && a > 0)
                most = fmax(most, pow(a, lobe[i][3]));
        }
        assert_true(most > 0 && most <= bound);
    }
    free(at);
}

/* Camera and light move round folds: everything is near the bounds somewhere. */
static void no_pixel_of_a_moving_drape_leaves_the_bounds(void **state)
{
    (void)state;
    stage s;
    open_stage("drape", turning, 3, &s);
    assert_true(expect_all_held(&s) > MOMENTS * PIXELS / 10);
    assert_true(s.visibility.span_count > 4);
    assert_true(share_of(s.visibility.pair, (size_t)WEFT_VISIBILITY_PAIR_CELLS * WEFT_VISIBILITY_PAIR_CELLS) < 0.75);
    expect_lobes_held(&s);
    close_stage(&s);
}

/* A part of one material, seen from a few directions: most of it is not needed, and what is needed is known well. */
static void a_close_camera_reaches_little(void **state)
{
    (void)state;
    stage s;
    open_stage("plane", close_by, 1, &s);
    assert_true(expect_all_held(&s) > MOMENTS * PIXELS / 2);
    assert_int_equal(s.visibility.texel_count[s.visibility.level_count - 1], 0);
    assert_true((double)s.visibility.texel_count[0] < 0.75 * TEXELS_X * TEXELS_Y);
    assert_true(share_of(s.visibility.view, sizeof s.visibility.view) < 0.2);
    assert_true(share_of(s.visibility.light, sizeof s.visibility.light) < 0.05);
    close_stage(&s);
}

/* Both sides of the ball's poles, and small pictures' coarser triangles. */
static void a_still_ball_stays_within_its_bounds(void **state)
{
    (void)state;
    stage s;
    open_stage("sphere", still, 30, &s);
    assert_true(expect_all_held(&s) > PIXELS / 10);
    assert_int_equal(s.visibility.span_count, 1);
    assert_int_equal(s.visibility.texel_count[0], 0);
    close_stage(&s);
}

static void a_path_that_sees_nothing_is_refused(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_mesh mesh;
    weft_visibility visibility;
    weft_material material = make_material();
    expect_ok(weft_mesh_open("plane", &mesh, &error), &error);
    weft_prune_scene scene = {&mesh, NULL, weft_scene_default(), WIDTH, HEIGHT, 1};
    scene.scene.orbit.pan_right = 50;
    assert_int_equal(weft_visibility_find(&scene, &material, NULL, &visibility, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "nothing of the mesh"));
    for (int i = 0; i < mesh.vertex_count; i++)
        mesh.vertex[i].coordinate[0] = mesh.vertex[i].coordinate[1] = 0.5f;
    scene.scene.orbit.pan_right = 0;
    assert_int_equal(weft_visibility_find(&scene, &material, NULL, &visibility, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "texture coordinates"));
    weft_mesh_free(&mesh);
    weft_material_free(&material);
}

/* ---- Without the rest ---- */

/* Pictures of random moments are those of the whole material: what is gone no pixel has asked for. */
static void pictures_stay_as_they_were(void **state)
{
    (void)state;
    weft_error error = {0};
    stage s;
    weft_image before[3], after;
    double time_s[3];
    int finer, coarser;
    long lobes;
    open_stage("plane", close_by, 1, &s);
    for (int i = 0; i < 3; i++) {
        weft_scene scene = s.scene.scene;
        weft_path_apply(&s.path, time_s[i] = chance(), &scene);
        expect_ok(weft_player_picture(player, &scene, WIDTH, HEIGHT, 1, NULL, &before[i], &error), &error);
    }
    expect_ok(weft_prune_texels(&s.visibility, &s.material, &finer, &coarser, &error), &error);
    expect_ok(weft_prune_tables(&s.visibility, &s.material, &error), &error);
    weft_prune_lobes(&s.visibility, 1e-4, &s.material, &lobes);
    assert_true(coarser > 0);
    assert_true(s.material.view_count < 40);
    expect_ok(weft_player_set_material(player, &s.material, &error), &error);
    for (int i = 0; i < 3; i++) {
        weft_scene scene = s.scene.scene;
        weft_path_apply(&s.path, time_s[i], &scene);
        expect_ok(weft_player_picture(player, &scene, WIDTH, HEIGHT, 1, NULL, &after, &error), &error);
        for (int p = 0; p < 3 * PIXELS; p++)
            assert_float_equal(after.pixels[p], before[i].pixels[p], 1e-3);
        weft_image_free(&after);
        weft_image_free(&before[i]);
    }
    close_stage(&s);
}

/* Every other texel is a copy of one that is kept; the kept ones are as they were. */
static void texels_that_are_not_seen_become_copies(void **state)
{
    (void)state;
    weft_error error = {0};
    stage s;
    int finer, coarser;
    open_stage("plane", close_by, 1, &s);
    weft_material whole = make_material();
    expect_ok(weft_prune_texels(&s.visibility, &s.material, &finer, &coarser, &error), &error);
    const weft_material_level *level = &s.material.level[0];
    for (int i = 0; i < TEXELS_X * TEXELS_Y; i++) {
        bool copied = false;
        for (int j = 0; j < TEXELS_X * TEXELS_Y && !copied; j++)
            copied = s.visibility.texel[0][j] && memcmp(level->table + 4 * i, whole.level[0].table + 4 * j, 4) == 0;
        assert_true(copied);
        if (s.visibility.texel[0][i])
            assert_memory_equal(level->table + 4 * i, whole.level[0].table + 4 * i, 4);
    }
    weft_material_free(&whole);
    close_stage(&s);
}

enum { SIDE = 16, SHARED = 4, SHOTS = 300 };

static weft_components *make_components(void)
{
    const weft_components shape = {.kind = WEFT_COMPONENTS_OF_LIGHT,
                                   .component_count = SHARED,
                                   .view_count = 1,
                                   .image_count = SHOTS,
                                   .light_side = 8,
                                   .view_side = 4,
                                   .light_smoothness = 1,
                                   .view_smoothness = 1,
                                   .least_cosine = 0.1f};
    weft_components *components;
    assert_int_equal(weft_components_create(&shape, SIDE, SIDE, 1, &components, NULL), WEFT_OK);
    components->first[1] = SHOTS;
    for (int k = 0; k < SHARED; k++)
        components->scale[k] = 0.01f / (float)(k + 1);
    for (int i = 0; i < 3 * SHOTS * SHARED; i++)
        components->value[i] = weft_half_of_float(0.3f * sinf(3.7f * (float)i) * (float)(i % 5));
    for (int i = 0; i < SHARED * SIDE * SIDE; i++)
        components->level[0].coefficient[i] = (int8_t)lround(127 * sin(1.9 * i));
    return components;
}

static double value_of(const weft_components *components, int texel, int i)
{
    double sum = 0;
    for (int k = 0; k < SHARED; k++)
        sum += (double)components->scale[k] * components->level[0].coefficient[SHARED * texel + k] *
               (double)weft_float_of_half(components->value[3 * (SHARED * (i / 3) + k) + i % 3]);
    return sum;
}

static int count_codes(const weft_components *components, int layer)
{
    bool is_there[256] = {false};
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        uint8_t code = (uint8_t)components->level[0].coefficient[SHARED * i + layer];
        count += !is_there[code];
        is_there[code] = true;
    }
    return count;
}

/* Values and coefficients of each layer are rounded to steps that change what they add by `step`, RMS: each of these
 * 2 x 4 errors spreads evenly over its step. */
static void rounding_changes_reflectance_by_its_step(void **state)
{
    (void)state;
    const double step = 0.05, expected = step * sqrt(2 * SHARED / 12.0);
    weft_components *whole = make_components(), *components = make_components();
    double squares = 0;
    weft_components_round_values(step, components);
    weft_components_round_coefficients(step, false, components);
    for (int texel = 0; texel < SIDE * SIDE; texel++)
        for (int i = 0; i < 3 * SHOTS; i++) {
            double difference = value_of(components, texel, i) - value_of(whole, texel, i);
            squares += difference * difference;
        }
    double is = sqrt(squares / (SIDE * SIDE * 3 * SHOTS));
    assert_in_range((long)(100 * is / expected), 80, 115);
    for (int layer = 0; layer < SHARED; layer++)
        assert_in_range(count_codes(components, layer), 3, 127);
    assert_true(weft_components_have_differences(components));
    weft_components_free(whole);
    weft_components_free(components);
}

/* The finest levels go, and with them the size of a texel grows; the material stays as wide. */
static void far_cameras_take_finer_levels_away(void **state)
{
    (void)state;
    weft_error error = {0};
    stage s;
    int finer, coarser;
    open_stage("sphere", still, 30, &s);
    double width_mm = s.material.texel_pitch_mm * s.material.level[0].width;
    expect_ok(weft_prune_texels(&s.visibility, &s.material, &finer, &coarser, &error), &error);
    assert_true(finer >= 1);
    assert_int_equal(s.material.level[0].width, TEXELS_X >> finer);
    assert_float_equal(s.material.texel_pitch_mm * s.material.level[0].width, width_mm, 1e-9);
    expect_ok(weft_prune_note_seen(&s.visibility, finer, coarser, &s.material, &error), &error);
    assert_int_equal(s.material.visibility->finer_levels, finer);
    assert_false(weft_material_visibility_place(s.material.visibility, -0.5, 0.3, 0.3));
    assert_true(weft_material_visibility_place(s.material.visibility, 0.5, 0.3, 0.3));
    close_stage(&s);
}

/* Beside the path the shader tints what the maps, asked in C, say is missing. */
static void the_tint_is_what_the_maps_say(void **state)
{
    (void)state;
    weft_error error = {0};
    stage s;
    int finer, coarser;
    double last_view, last_light;
    weft_surface_sample *at;
    weft_image plain, tinted;
    long count[3] = {0};
    open_stage("plane", close_by, 1, &s);
    expect_ok(weft_prune_texels(&s.visibility, &s.material, &finer, &coarser, &error), &error);
    expect_ok(weft_prune_note_seen(&s.visibility, finer, coarser, &s.material, &error), &error);
    expect_ok(weft_player_set_material(player, &s.material, &error), &error);
    weft_player_last_ring(player, WEFT_MODE_COMPRESSED, &last_view, &last_light);
    weft_scene scene = s.scene.scene;
    scene.orbit = (weft_orbit){weft_rad_of_deg(-85), weft_rad_of_deg(60), 1.3, 0, 0};
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(22), weft_rad_of_deg(15)};
    expect_ok(weft_player_picture(player, &scene, WIDTH, HEIGHT, 1, NULL, &plain, &error), &error);
    scene.show_extrapolation = true;
    expect_ok(weft_player_picture(player, &scene, WIDTH, HEIGHT, 1, NULL, &tinted, &error), &error);
    expect_ok(weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int p = 0; p < PIXELS; p++) {
        weft_vec3 v = weft_vec3_of(at[p].view[0], at[p].view[1], at[p].view[2]);
        weft_vec3 l = weft_vec3_of(at[p].light[0], at[p].light[1], at[p].light[2]);
        float shown[3];
        if (at[p].covered == 0)
            continue;
        const weft_missing missing = {
            .view = v.z < cos(last_view) - 1e-3 ||
                    !weft_material_visibility_direction(s.material.visibility, WEFT_MATERIAL_VISIBILITY_VIEWS, v),
            .light = l.z > 0 &&
                     (l.z < cos(last_light) - 1e-3 ||
                      !weft_material_visibility_direction(s.material.visibility, WEFT_MATERIAL_VISIBILITY_LIGHTS, l)),
            .place = !weft_material_visibility_place(s.material.visibility, (double)at[p].level, (double)at[p].u,
                                                     (double)at[p].v)};
        weft_extrapolation_shown(plain.pixels + 3 * p, missing, shown);
        bool same = true;
        for (int c = 0; c < 3; c++)
            same = same && fabsf(shown[c] - tinted.pixels[3 * p + c]) < 1e-4f;
        count[0]++;
        count[1] += missing.view || missing.place;
        count[2] += !same; /* at the border of a cell, by rounding */
    }
    assert_true(count[1] > 100 && count[1] < count[0]);
    assert_true(count[2] < count[0] / 200);
    free(at);
    weft_image_free(&plain);
    weft_image_free(&tinted);
    close_stage(&s);
}

int test_prune(void)
{
    weft_error error = {0};
    if (weft_headless_create(WEFT_GL_CORE, &headless, &error) != WEFT_OK) {
        printf("no OpenGL: skipped\n");
        return 77;
    }
    expect_ok(weft_player_create(&player, &error), &error);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_pixel_of_a_moving_drape_leaves_the_bounds),
        cmocka_unit_test(a_close_camera_reaches_little),
        cmocka_unit_test(a_still_ball_stays_within_its_bounds),
        cmocka_unit_test(a_path_that_sees_nothing_is_refused),
        cmocka_unit_test(pictures_stay_as_they_were),
        cmocka_unit_test(texels_that_are_not_seen_become_copies),
        cmocka_unit_test(far_cameras_take_finer_levels_away),
        cmocka_unit_test(rounding_changes_reflectance_by_its_step),
        cmocka_unit_test(the_tint_is_what_the_maps_say),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    weft_player_free(player);
    weft_headless_free(headless);
    return failed;
}
