/* The ground that cloth stands on, and the shadow that it takes. */
#include "base/numeric/statistics.h"
#include "player/draw/canvas.h"
#include "player/draw/lighting.h"
#include "player/draw/pace.h"
#include "player/draw/player_parts.h"
#include "player/scene/surroundings.h"
#include "studio.h"
#include "tests/support/suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void cloth_stands_on_a_ground_that_takes_its_shadow(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_surface_sample *at;
    float *share = malloc(PIXELS * sizeof *share);
    for (int i = 0; i < (suite_argument ? 3 : 1); i++) {
        studio_show(s->player, "drape");
        weft_scene scene = studio_scene(s->player, weft_surroundings_names[i], WEFT_ENVIRONMENT_SMOOTH_REGIONS);
        weft_image image = studio_picture(s->player, &scene);
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        scene.shadows = false;
        weft_image without = studio_picture(s->player, &scene);
        scene.exposure = 3;
        weft_image brighter = studio_picture(s->player, &scene);
        size_t count = 0;
        for (int k = 0; k < PIXELS; k++) {
            if (at[k].covered > 0)
                continue;
            share[count++] = image.pixels[3 * k + 1] / without.pixels[3 * k + 1];
            assert_float_equal(brighter.pixels[3 * k + 1], without.pixels[3 * k + 1], 1e-4);
        }
        float deepest = weft_quantile_of_floats(share, count, 0.002f),
              usual = weft_quantile_of_floats(share, count, 0.8f);
        print_message("%s: %.3f of the light in the deepest shadow on the ground, %.3f far from it\n",
                      weft_surroundings_names[i], (double)deepest, (double)usual);
        assert_true(deepest < 0.8 && deepest > 0.02 && usual > 0.98 && usual <= 1.0001f);
        free(at);
        weft_image_free(&image);
        weft_image_free(&without);
        weft_image_free(&brighter);
    }
    free(share);
}

/* As likely as they bring light to level ground: bright and high ones more often. */
static void the_light_of_the_ground_comes_as_often_as_it_is_bright_there(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_image map = studio_map("studio");
    weft_environment *environment = calloc(1, sizeof *environment);
    weft_scene scene = studio_scene(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    expect_ok(weft_environment_of_image(&map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, environment, &error), &error);
    double wanted[3] = {0}, found[3] = {0}, all = 0;
    for (int i = 0; i < WEFT_ENVIRONMENT_STRATA * environment->region_count; i++) {
        const weft_distant_light *light =
            &environment->stratum[i / environment->region_count][i % environment->region_count];
        double weight = fmax((double)light->direction.z, 0) *
                        (double)(light->irradiance[0] + light->irradiance[1] + light->irradiance[2]);
        wanted[0] += weight * (double)light->direction.x;
        wanted[1] += weight * (double)light->direction.y;
        wanted[2] += weight * (double)light->direction.z;
        all += weight;
    }
    for (int i = 0; i < WEFT_GROUND_DIRECTIONS; i++) {
        weft_vec3 light = weft_lighting_ground_place(&scene, environment, i);
        assert_true(light.z > 0);
        found[0] += (double)light.x / WEFT_GROUND_DIRECTIONS;
        found[1] += (double)light.y / WEFT_GROUND_DIRECTIONS;
        found[2] += (double)light.z / WEFT_GROUND_DIRECTIONS;
    }
    for (int c = 0; c < 3; c++)
        assert_float_equal(found[c], wanted[c] / all, 0.02);
    weft_image_free(&map);
    free(environment);
}

typedef struct ball {
    weft_vec3 centre;
    double radius;
} ball;

static ball ball_of_mesh(void)
{
    weft_error error = {0};
    weft_mesh mesh;
    float centre[3], radius;
    expect_ok(weft_mesh_open("sphere", &mesh, &error), &error);
    weft_mesh_bounds(&mesh, centre, &radius);
    weft_mesh_free(&mesh);
    return (ball){weft_vec3_of((weft_real)centre[0], (weft_real)centre[1], (weft_real)centre[2]), (double)radius};
}

/* The place of the ground that a pixel shows. */
static weft_vec3 place_on_ground(const weft_scene *scene, const ball *b, int pixel)
{
    weft_orbit_axes ray = weft_orbit_rays(&scene->orbit, WIDTH, HEIGHT, 0, 0);
    double x = pixel % WIDTH + 0.5, y = HEIGHT - (pixel / WIDTH + 0.5);
    weft_vec3 along = weft_subtract(weft_add(weft_scale(ray.right, (weft_real)x), weft_scale(ray.up, (weft_real)y)),
                                    ray.backward),
              eye = weft_orbit_eye(&scene->orbit, b->centre, b->radius);
    weft_real ground = b->centre.z - (weft_real)b->radius;
    return weft_add(eye, weft_scale(along, (ground - eye.z) / along.z));
}

/* The share of the key light that a ball on level ground leaves a place there. */
static double seen_beside_ball(const weft_scene *scene, const ball *b, weft_vec3 place)
{
    enum { DIRECTIONS = 200 };
    weft_vec3 toward = weft_subtract(b->centre, place);
    int hidden = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        weft_vec3 light = weft_lighting_key_place(scene, i);
        double along = (double)weft_dot(toward, light);
        hidden += along > 0 && (double)weft_dot(toward, toward) - along * along < b->radius * b->radius;
    }
    return 1 - (double)hidden / DIRECTIONS;
}

/* Where a ball casts its shadow is plain geometry: from a small and from a large light. */
static void the_shadow_of_a_ball_lies_where_geometry_has_it(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    ball b = ball_of_mesh();
    studio_show(s->player, "sphere");
    for (int i = 0; i < 2; i++) {
        weft_surface_sample *at;
        weft_scene scene = weft_scene_default();
        scene.orbit.distance = 8;
        scene.light[0].direction = (weft_angles){weft_rad_of_deg(25 + 25 * i), weft_rad_of_deg(-60 + 130 * i)};
        scene.key_size_rad = i % 2 ? weft_rad_of_deg(9) : 0;
        scene.ground = true;
        weft_image without = studio_picture(s->player, &scene);
        scene.shadows = true;
        weft_image image = studio_picture(s->player, &scene);
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        double off = 0;
        long count = 0, shaded = 0;
        for (int k = 0; k < PIXELS; k++) {
            weft_vec3 place = place_on_ground(&scene, &b, k), away = weft_subtract(place, b.centre);
            if (at[k].covered > 0 || weft_dot(away, away) > (weft_real)(6 * b.radius * b.radius))
                continue;
            double expected = seen_beside_ball(&scene, &b, place);
            off += fabs((double)(image.pixels[3 * k] / without.pixels[3 * k]) - expected);
            shaded += expected < 0.5;
            count++;
        }
        printf("light %d: %ld of %ld places are shaded, shares are off by %.4f\n", i, shaded, count,
               off / (double)count);
        assert_true(shaded > 300);
        assert_true(off < 0.004 * (double)count);
        free(at);
        weft_image_free(&image);
        weft_image_free(&without);
    }
}

/* Levels of 255 that two pictures of the drape differ by on its ground, in the mean of squares. */
static double difference_on_ground(weft_player *player, const weft_scene *scene, const weft_image *a,
                                   const weft_image *b)
{
    weft_error error = {0};
    weft_surface_sample *at;
    double sum = 0;
    long count = 0;
    expect_ok(weft_player_read_surface(player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int k = 1; k < PIXELS - 1; k++) {
        if (at[k - 1].covered > 0 || at[k].covered > 0 || at[k + 1].covered > 0)
            continue;
        sum += pow(255 * (double)(a->pixels[3 * k] - b->pixels[3 * k]), 2);
        count++;
    }
    free(at);
    return sqrt(sum / (double)count);
}

/* One frame, after so many that moved, very small, in which the camera turned. */
static weft_image frame_at_rest(weft_player *player, const weft_scene *scene, int moving)
{
    weft_error error = {0};
    weft_canvas canvas;
    weft_image image;
    weft_scene moved = *scene;
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    for (int i = 0; i < moving; i++) {
        moved.orbit.azimuth_rad += 0.01;
        weft_canvas_begin_small_frame(&canvas, 0.05);
        expect_ok(weft_player_draw(player, &moved, canvas.drawn_width, canvas.drawn_height,
                                   (weft_sampling){.frame = -1}, &error),
                  &error);
    }
    weft_canvas_clear(&canvas);
    weft_canvas_begin_frame(&canvas);
    expect_ok(weft_player_draw(player, scene, WIDTH, HEIGHT, (weft_sampling){.frame = 0}, &error), &error);
    weft_canvas_end_frame(&canvas);
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    return image;
}

/* Its light is that of many frames, in the first one at rest. */
static void the_ground_is_whole_when_a_camera_comes_to_rest(void **state)
{
    stage *s = *state;
    studio_show(s->player, "drape");
    weft_scene scene = studio_scene(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    weft_image early = frame_at_rest(s->player, &scene, 0), late = frame_at_rest(s->player, &scene, 60),
               whole = studio_picture(s->player, &scene);
    double early_off = difference_on_ground(s->player, &scene, &early, &whole),
           late_off = difference_on_ground(s->player, &scene, &late, &whole);
    printf("the ground is off by %.3f levels of 255 at once, by %.3f after the camera has moved\n", early_off,
           late_off);
    assert_true(late_off < 0.5 && early_off > 1.5 * late_off);
    weft_image_free(&early);
    weft_image_free(&late);
    weft_image_free(&whole);
}

/* A board that leans: few triangles cast its shadow. */
static void show_board(weft_player *player)
{
    weft_error error = {0};
    weft_mesh mesh;
    studio_show(player, "plane");
    expect_ok(weft_mesh_open("plane", &mesh, &error), &error);
    for (int i = 0; i < mesh.vertex_count; i++)
        mesh.vertex[i].position[2] += mesh.vertex[i].position[0];
    expect_ok(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
}

static void expect_new_ground(weft_player *player, const weft_scene *scene)
{
    weft_image after = studio_picture(player, scene);
    show_board(player);
    weft_image fresh = studio_picture(player, scene);
    assert_memory_equal(after.pixels, fresh.pixels, 3 * sizeof(float) * PIXELS);
    weft_image_free(&after);
    weft_image_free(&fresh);
}

/* Whatever was drawn before. */
static void another_light_casts_another_shadow_on_the_ground(void **state)
{
    stage *s = *state;
    show_board(s->player);
    weft_scene scene = studio_scene(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS), first = scene;
    weft_image before = studio_picture(s->player, &scene);
    scene.light[0].direction.theta_rad += 0.2;
    scene.light[0].direction.phi_rad += 0.5;
    expect_new_ground(s->player, &scene);
    scene.key_size_rad *= 0.3;
    expect_new_ground(s->player, &scene);
    scene.environment_turn_rad += 1;
    expect_new_ground(s->player, &scene);
    scene = studio_scene(s->player, "overcast", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    expect_new_ground(s->player, &scene);
    studio_scene(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    weft_image again = studio_picture(s->player, &first);
    assert_memory_equal(before.pixels, again.pixels, 3 * sizeof(float) * PIXELS);
    weft_image_free(&before);
    weft_image_free(&again);
}

int test_ground(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cloth_stands_on_a_ground_that_takes_its_shadow),
        cmocka_unit_test(the_light_of_the_ground_comes_as_often_as_it_is_bright_there),
        cmocka_unit_test(the_shadow_of_a_ball_lies_where_geometry_has_it),
        cmocka_unit_test(the_ground_is_whole_when_a_camera_comes_to_rest),
        cmocka_unit_test(another_light_casts_another_shadow_on_the_ground),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}
