#include "capture/synthetic/plan.h"
#include "capture/synthetic/scene.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

/* A scene without things on the sheet or a window, and a small lamp. */
typedef struct stage {
    weft_synthetic_request request;
    weft_synthetic_shot shot;
    weft_synthetic_sheet sheet;
    weft_virtual_sample content;
    weft_synthetic_scene scene;
} stage;

static void set_up(stage *s, bool with_things)
{
    *s = (stage){.request = weft_synthetic_request_default()};
    s->request.photograph_count = 1;
    s->request.width = 1800;
    s->request.window = 0;
    s->request.lamp_radius_mm = 2;
    s->request.no_balls = s->request.no_pin = !with_things;
    weft_synthetic_plan(&s->request, &s->shot);
    s->sheet = weft_synthetic_sheet_of(s->request.opening_mm, true, 1);
    s->content = (weft_virtual_sample){.opening_mm = s->request.opening_mm, .is_checker = true};
    s->scene = weft_synthetic_scene_of(&s->request, &s->shot, &s->sheet, &s->content);
}

/* What the eye sees of the plane straight from above a point, the mean over the lamp. */
static double seen_at(const stage *s, double x, double y)
{
    double sum = 0;
    for (int i = 0; i < 64; i++) {
        weft_synthetic_chance chance = {{(i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8}, 1, (uint32_t)i};
        sum += weft_synthetic_scene_look(&s->scene, weft_vec3_of(x, y, 5), weft_vec3_of(0, 0, -1), &chance,
                                         WEFT_SYNTHETIC_ALL_SOLIDS, WEFT_SYNTHETIC_ALL_SOLIDS)
                   .r /
               64;
    }
    return sum;
}

/* Bare paper under the lamp at distances d straight above and at slants: 0.85 I cos / (pi d^2). */
static void light_falls_with_square_and_cosine(void **state)
{
    (void)state;
    stage s;
    set_up(&s, false);
    for (int i = 0; i < 24; i++) {
        double theta = i % 6 * 0.22, d = 250 * pow(2, i / 6), x = -45, y = 58;
        s.scene.lamp.at = weft_vec3_of(x + d * sin(theta), y, d * cos(theta));
        double metres = d / 1000, expected = 0.85 * 2500 * cos(theta) / (WEFT_PI * metres * metres);
        assert_float_equal(seen_at(&s, x, y) / expected, 1, 0.01);
    }
}

/* The flash shines as its face shows itself: half as bright at 60 degrees from its axis. */
static void a_disc_shines_ahead(void **state)
{
    (void)state;
    stage s;
    set_up(&s, false);
    s.scene.lamp.is_disc = true;
    s.scene.lamp.at = weft_vec3_of(-45, 58, 500);
    s.scene.lamp.axis = weft_vec3_of(0, 0, -1);
    double ahead = seen_at(&s, -45, 58);
    s.scene.lamp.axis = weft_vec3_of(sin(WEFT_PI / 3), 0, -0.5);
    assert_float_equal(seen_at(&s, -45, 58) / ahead, 0.5, 0.005);
    s.scene.lamp.axis = weft_vec3_of(0, 0, 1);
    assert_true(seen_at(&s, -45, 58) < 1e-9 * ahead);
}

/* The middle of the pin's head casts its shadow where the line from the lamp through it meets the sheet. */
static void the_pin_throws_its_shadow(void **state)
{
    (void)state;
    stage s;
    double foot[2];
    set_up(&s, true);
    s.scene.lamp.at = weft_vec3_of(300, 150, 600);
    weft_target_pin(&s.sheet.target, foot);
    double height = 28.5, part = height / (600 - height);
    double x = foot[0] + (foot[0] - 300) * part, y = foot[1] + (foot[1] - 150) * part;
    double bright = seen_at(&s, x - 4, y - 4);
    assert_true(seen_at(&s, x, y) < 0.05 * bright);
    assert_true(seen_at(&s, x + 0.9, y - 0.9) < 0.05 * bright);
    assert_true(seen_at(&s, x - 2.5, y + 2.5) > 0.9 * bright);
    assert_true(seen_at(&s, x + 2.5, y - 2.5) > 0.9 * bright);
    /* Of the stick between. */
    assert_true(seen_at(&s, 0.5 * (x + foot[0]), 0.5 * (y + foot[1])) < 0.3 * bright);
}

/* The distance of two lines against a search over both, for fingers of all lengths and directions. */
static void distances_of_lines_are_least(void **state)
{
    (void)state;
    enum { STEPS = 400 };
    for (int i = 0; i < 60; i++) {
        weft_vec3 p = {20 * sin(i), 20 * cos(3 * i), 10}, q = {30 * cos(i), 25 * sin(2 * i), 90};
        weft_synthetic_solid s = {.a = {15 * sin(5 * i), 12, 30 + 20 * cos(i)}, .b = {-20 * cos(i), 8 * sin(i), 50}};
        double least = INFINITY;
        for (int k = 0; k <= STEPS * STEPS; k++) {
            double u = (double)(k % STEPS) / (STEPS - 1), v = (double)(k / STEPS) / STEPS;
            weft_vec3 on_ray = weft_add(p, weft_scale(weft_subtract(q, p), u));
            weft_vec3 on_solid = weft_add(s.a, weft_scale(weft_subtract(s.b, s.a), v));
            least = fmin(least, weft_length(weft_subtract(on_ray, on_solid)));
        }
        assert_float_equal(weft_synthetic_solid_distance(&s, p, q), least, 0.15);
    }
}

/* A larger lamp has softer shadows: beside the edge of a ball's shadow, a part of the light. */
static void shadows_are_soft(void **state)
{
    (void)state;
    stage s;
    double ball[2];
    set_up(&s, true);
    s.scene.lamp.at = weft_vec3_of(0, 0, 900);
    s.scene.lamp.radius_mm = 30;
    weft_target_ball(&s.sheet.target, 0, ball);
    double length = hypot(ball[0], ball[1]), x = ball[0] / length, y = ball[1] / length;
    int partial = 0;
    for (int i = 0; i < 60; i++) {
        double at = length + 0.25 * i,
               lit = seen_at(&s, x * at, y * at) /
                     (weft_synthetic_scene_illuminance(&s.scene, weft_vec3_of(x * at, y * at, 0)).r);
        partial += lit > 0.03 && lit < 0.24;
    }
    assert_true(partial >= 2);
}

/* Pixels that are traced are as bright as those that are not: the paper with and without something that may stand
 * before it, to the corners of the frame. */
static void both_ways_to_a_pixel_agree(void **state)
{
    (void)state;
    stage s;
    set_up(&s, false);
    s.shot.lens.width = 300;
    s.shot.lens.height = 200;
    s.shot.lens.axis_x = 149.5;
    s.shot.lens.axis_y = 99.5;
    for (int row = 0; row < WEFT_SYNTHETIC_CELLS_Y; row++)
        for (int column = 0; column < WEFT_SYNTHETIC_CELLS_X; column++)
            s.sheet.cell[row][column] = 0.85F;
    s.sheet.margin_mm = 2000;
    s.scene.lamp.at = weft_vec3_of(700, 500, 250);
    float *quick = calloc(300 * 200 * 3, sizeof *quick), *traced = calloc(300 * 200 * 3, sizeof *traced);
    assert_true(quick && traced);
    weft_synthetic_render(&s.shot.lens, &s.shot.pose, &s.scene, 1, quick);
    /* A ball just over the eye and over the lamp hides nothing, but comes near all that the eye sees. */
    weft_vec3 eye = weft_pose_camera_position(&s.shot.pose);
    s.scene.solid[0] =
        (weft_synthetic_solid){.a = {eye.x, eye.y, eye.z + 60}, .b = {eye.x, eye.y, eye.z + 60}, .radius_mm = 59};
    s.scene.solid_count = 1;
    weft_synthetic_render(&s.shot.lens, &s.shot.pose, &s.scene, 1, traced);
    int differ = 0, tried = 0;
    for (size_t i = 0; i < 300 * 200; i++) {
        differ += fabsf(traced[3 * i] - quick[3 * i]) > 0.04F * quick[3 * i];
        tried += traced[3 * i] != quick[3 * i];
    }
    assert_true(tried > 1000);
    assert_true(differ < 0.02 * 300 * 200);
    free(quick);
    free(traced);
}

/* ---- The mirror ---- */

static double path_by_ball(weft_vec3 middle, double theta, double phi, weft_vec3 a, weft_vec3 b)
{
    weft_vec3 normal = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    weft_vec3 at = weft_add(middle, weft_scale(normal, 10));
    return weft_length(weft_subtract(at, a)) + weft_length(weft_subtract(at, b));
}

/* Light takes the shortest way off a ball (Fermat): a search that halves its steps. */
static weft_vec3 shortest_way(weft_vec3 middle, weft_vec3 a, weft_vec3 b)
{
    double theta = 0.3, phi = 0.3;
    for (double step = 0.5; step > 1e-10;) {
        double best = path_by_ball(middle, theta, phi, a, b), old_theta = theta, old_phi = phi;
        for (int i = 0; i < 4; i++) {
            double t = old_theta + (i == 0   ? step
                                    : i == 1 ? -step
                                             : 0),
                   p = old_phi + (i == 2   ? step
                                  : i == 3 ? -step
                                           : 0);
            if (path_by_ball(middle, t, p, a, b) < best) {
                best = path_by_ball(middle, t, p, a, b);
                theta = t;
                phi = p;
            }
        }
        if (theta == old_theta && phi == old_phi)
            step /= 2;
    }
    return weft_add(middle, weft_scale(weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)), 10));
}

static weft_vec3 into_camera(const weft_pose *pose, weft_vec3 p)
{
    const double(*r)[3] = pose->rotation;
    weft_vec3 t = pose->translation;
    return weft_vec3_of(r[0][0] * p.x + r[0][1] * p.y + r[0][2] * p.z + t.x,
                        r[1][0] * p.x + r[1][1] * p.y + r[1][2] * p.z + t.y,
                        r[2][0] * p.x + r[2][1] * p.y + r[2][2] * p.z + t.z);
}

/* The middle of the light within some pixels of a place. */
static void middle_of_light(const stage *s, const float *radiance, const double near[2], double found[2])
{
    double sum = 0;
    found[0] = found[1] = 0;
    for (int y = (int)near[1] - 12; y <= (int)near[1] + 12; y++) {
        for (int x = (int)near[0] - 12; x <= (int)near[0] + 12; x++) {
            double light = (double)radiance[3 * ((size_t)y * (size_t)s->shot.lens.width + (size_t)x)];
            if (light < 5000)
                continue;
            sum += light;
            found[0] += light * x;
            found[1] += light * y;
        }
    }
    assert_true(sum > 0);
    found[0] /= sum;
    found[1] /= sum;
}

static void a_ball_mirrors_the_lamp(void **state)
{
    (void)state;
    stage s;
    set_up(&s, true);
    s.scene.lamp.radius_mm = 10;
    weft_vec3 eye = weft_pose_camera_position(&s.shot.pose);
    float *radiance = calloc((size_t)s.shot.lens.width * (size_t)s.shot.lens.height * 3, sizeof *radiance);
    assert_non_null(radiance);
    weft_synthetic_render(&s.shot.lens, &s.shot.pose, &s.scene, 5, radiance);
    for (int i = 0; i < WEFT_TARGET_BALL_COUNT; i++) {
        double place[2], expected[2], found[2];
        weft_target_ball(&s.sheet.target, i, place);
        weft_vec3 at = shortest_way(weft_vec3_of(place[0], place[1], 10), eye, s.scene.lamp.at);
        assert_true(weft_synthetic_lens_project(&s.shot.lens, into_camera(&s.shot.pose, at), expected));
        middle_of_light(&s, radiance, expected, found);
        assert_float_equal(found[0], expected[0], 0.3);
        assert_float_equal(found[1], expected[1], 0.3);
    }
    free(radiance);
}

/* A ball shows the window where its mirrored ray leaves the room through it. */
static void a_ball_mirrors_the_window(void **state)
{
    (void)state;
    stage s;
    set_up(&s, true);
    s.scene.window.luminance = 77;
    double place[2];
    weft_target_ball(&s.sheet.target, 0, place);
    weft_vec3 middle = {place[0], place[1], 10}, eye = {0, 0, 500};
    weft_vec3 beside_bars = weft_add(s.scene.window.middle, weft_scale(s.scene.window.across, 200));
    weft_vec3 at = shortest_way(middle, eye, beside_bars);
    weft_vec3 along = weft_unit(weft_subtract(at, eye));
    double seen = weft_synthetic_scene_look(&s.scene, eye, along, &(weft_synthetic_chance){{0.5, 0.5}, 1, 0},
                                            WEFT_SYNTHETIC_ALL_SOLIDS, WEFT_SYNTHETIC_ALL_SOLIDS)
                      .g;
    assert_float_equal(seen, 0.66 * 77, 1e-3);
}

int test_synthetic_scene(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_falls_with_square_and_cosine),
        cmocka_unit_test(a_disc_shines_ahead),
        cmocka_unit_test(the_pin_throws_its_shadow),
        cmocka_unit_test(distances_of_lines_are_least),
        cmocka_unit_test(shadows_are_soft),
        cmocka_unit_test(both_ways_to_a_pixel_agree),
        cmocka_unit_test(a_ball_mirrors_the_lamp),
        cmocka_unit_test(a_ball_mirrors_the_window),
    };
    return cmocka_run_group_tests_name("synthetic scene", tests, NULL, NULL);
}
