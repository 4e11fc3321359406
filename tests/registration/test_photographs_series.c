/* Photographs of one view and one lamp that differ in exposure. The camera's curve is that of film on a screen, in
 * whole numbers of 8 bits; the room under test bends sRGB by a polynomial. */
#include "registration/lamp/lamp.h"
#include "registration/lamp/read.h"
#include "registration/photographs/steps.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

#include "base/picture/colour.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENES = 8, TWICE = 4, PHOTOGRAPHS = SCENES + TWICE, COLUMNS = 17, PLACES = COLUMNS * COLUMNS };

static const double pitch_mm = 9, paper = 0.85, ink = 0.05, beam_power = 1.5;

static const double lamp_mm[SCENES][3] = {{300, 200, 400}, {-250, 350, 450}, {-420, -60, 330}, {100, -400, 380},
                                          {60, 90, 500},   {350, -260, 300}, {-90, 520, 420},  {-300, -330, 520}};

typedef struct scene {
    weft_target target;
    double place[PLACES][2];
    bool is_ink[PLACES];
    weft_paper_places places;
    weft_paper_sample sample[PHOTOGRAPHS][PLACES];
    weft_lamp_evidence evidence[PHOTOGRAPHS];
    weft_vec3 lamp[PHOTOGRAPHS];
} scene;

/* What the file holds of light, 0..1. */
static double film(double light)
{
    return pow((1 - exp(-2.5 * light)) / (1 - exp(-2.5)), 1 / 2.0);
}

/* The mean of what a square of 25 pixels holds, decoded as sRGB; the sensor's noise blurs the rounding to 8 bits. */
static float decoded(double light, int salt)
{
    double sum = 0;
    for (int i = 0; i < 25; i++) {
        double noise = sin(1.7 * i + 12.9 * salt) + sin(4.1 * i + 7.3 * salt);
        sum += (double)weft_linear_of_srgb((float)(round(255 * film(light) + 0.5 * noise) / 255));
    }
    return (float)(sum / 25);
}

/* `exposure` as the camera writes it; its shutter is off by `error`. */
static void photograph(scene *s, int i, weft_vec3 lamp, weft_pose pose, double exposure, double error)
{
    weft_lamp_evidence *e = &s->evidence[i];
    *e = (weft_lamp_evidence){.pose = pose, .exposure = exposure, .paper = {PLACES, s->sample[i]}};
    weft_vec3 eye = weft_pose_camera_position(&pose);
    /* A torch in the hand is held towards some place near the middle. */
    weft_vec3 axis = weft_unit(weft_subtract(lamp, weft_vec3_of(20 * (i % 3) - 20, 15 * (i % 2), 0)));
    s->lamp[i] = lamp;
    for (int k = 0; k < PLACES; k++) {
        weft_vec3 at = weft_vec3_of(s->place[k][0], s->place[k][1], 0), to = weft_subtract(lamp, at);
        weft_vec3 ray = weft_unit(weft_subtract(at, eye)), ahead = weft_unit(weft_scale(eye, -1));
        double off_axis = weft_dot(ray, ahead), far = weft_length(to), beam = weft_dot(weft_unit(to), axis);
        double value = (s->is_ink[k] ? ink : paper) * lamp.z / (far * far * far) * exposure * (1 + error) *
                       pow(off_axis, 4) * pow(beam, beam_power);
        s->sample[i][k] = (weft_paper_sample){.place = k, .radius_squared = (float)(1 / (off_axis * off_axis) - 1)};
        for (int c = 0; c < 3; c++)
            s->sample[i][k].light[c] = decoded(value, 3 * (i * PLACES + k) + c);
    }
}

/* The brightest paper comes to 0.6 of the range. */
static double exposure_of(weft_vec3 lamp)
{
    double far = weft_length(lamp);
    return 0.5 * far * far * far / lamp.z / paper;
}

static scene *draw_places(void)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->target = weft_target_printed(40);
    for (int k = 0; k < PLACES; k++) {
        s->place[k][0] = pitch_mm * (k % COLUMNS - COLUMNS / 2);
        s->place[k][1] = pitch_mm * (k / COLUMNS - COLUMNS / 2);
        s->is_ink[k] = k % 4 == 3;
    }
    s->places = (weft_paper_places){PLACES, s->place, s->is_ink, 1};
    return s;
}

static weft_vec3 lamp_of(int i)
{
    return weft_vec3_of(lamp_mm[i][0], lamp_mm[i][1], lamp_mm[i][2]);
}

/* Of the first TWICE scenes a second one, two stops darker; the hands have moved a little. */
static scene *photograph_all(void)
{
    scene *s = draw_places();
    for (int i = 0; i < SCENES; i++) {
        weft_angles view = {weft_rad_of_deg(5 + 6 * i), 2.4 * i};
        weft_pose pose = weft_pose_of_view(view, 400 + 20 * (i % 3));
        double exposure = exposure_of(lamp_of(i));
        photograph(s, i, lamp_of(i), pose, exposure, 0.004 * (i % 3 - 1));
        if (i >= TWICE)
            continue;
        pose.translation.x += 0.5;
        photograph(s, SCENES + i, weft_add(lamp_of(i), weft_vec3_of(1, -1, 1)), pose, exposure / 4, 0.005 * (i % 2));
    }
    return s;
}

static weft_lamp_problem problem_of(const scene *s, int count)
{
    return (weft_lamp_problem){.target = &s->target,
                               .places = &s->places,
                               .count = count,
                               .evidence = s->evidence,
                               .corner_radius_squared = 0.16,
                               .tone_unknown = true};
}

/* Light of an encoded value under the curve found, but for a factor. */
static double light_of(const weft_lamp_solution *found, double encoded)
{
    weft_tone_curve curve = weft_tone_srgb();
    weft_tone_bend(&curve, found->tone);
    return (double)weft_tone_decode(&curve, (float)encoded);
}

/* Where a highlight on the first ball lies that throws the ray of the camera back at just above the sheet. */
static weft_vec3 low_highlight(const weft_lamp_problem *problem, weft_vec3 eye)
{
    double foot[2], radius = problem->ball_diameter_mm / 2;
    weft_target_ball(problem->target, 0, foot);
    double azimuth = atan2(foot[1], foot[0]);
    for (double slope = 0.1; slope < 1.5; slope += 0.001) {
        weft_vec3 normal = weft_vec3_of(sin(slope) * cos(azimuth), sin(slope) * sin(azimuth), cos(slope));
        weft_vec3 point = weft_add(weft_vec3_of(foot[0], foot[1], radius), weft_scale(normal, radius));
        weft_vec3 ray = weft_unit(weft_subtract(point, eye));
        if (ray.z - 2 * weft_dot(ray, normal) * normal.z < 0.06)
            return ray;
    }
    fail_msg("the ball throws no ray that low");
    return eye;
}

/* The ray towards the highlight of a lamp on a ball: its normal halves the angle between lamp and camera. */
static weft_highlight highlight_of(const weft_target *target, int ball, double diameter_mm, weft_vec3 lamp,
                                   weft_vec3 eye)
{
    double foot[2];
    weft_target_ball(target, ball, foot);
    weft_vec3 centre = weft_vec3_of(foot[0], foot[1], diameter_mm / 2), at = centre;
    for (int i = 0; i < 50; i++) {
        weft_vec3 to_lamp = weft_unit(weft_subtract(lamp, at)), to_eye = weft_unit(weft_subtract(eye, at));
        at = weft_add(centre, weft_scale(weft_unit(weft_add(to_lamp, to_eye)), diameter_mm / 2));
    }
    return (weft_highlight){.found = true, .ray = weft_unit(weft_subtract(at, eye)), .deviation_rad = 0.01};
}

/* A sheet that is printed smaller than it should be makes balls and pin larger than they should be. */
static void the_size_of_balls_and_pin_tells_the_scale_of_the_print(void **state)
{
    (void)state;
    for (int smaller = 0; smaller < 2; smaller++) {
        scene *s = photograph_all();
        weft_lamp_place place[PHOTOGRAPHS];
        weft_lamp_solution found = {.place = place};
        weft_lamp_problem problem = problem_of(s, PHOTOGRAPHS);
        weft_error error = {0};
        double scale = smaller ? 1 / 0.94 : 1, foot[2];
        problem.ball_diameter_mm = 20;
        problem.pin_height_mm = 30;
        weft_target_pin(problem.target, foot);
        for (int i = 0; i < PHOTOGRAPHS; i++) {
            weft_lamp_evidence *seen = &s->evidence[i];
            weft_vec3 eye = weft_pose_camera_position(&seen->pose);
            weft_vec3 head = weft_vec3_of(foot[0], foot[1], scale * (30 - weft_pin_head_radius_mm));
            weft_vec3 down = weft_subtract(head, s->lamp[i]);
            for (int ball = 0; ball < WEFT_TARGET_BALL_COUNT; ball++)
                seen->highlight[ball] = highlight_of(problem.target, ball, 20 * scale, s->lamp[i], eye);
            seen->pin = (weft_pin_shadow){.found = true, .along_mm = 0.3, .across_mm = 0.2};
            seen->pin.place[0] = head.x - down.x / down.z * head.z;
            seen->pin.place[1] = head.y - down.y / down.z * head.z;
        }
        weft_lamp_guess(&problem, &found);
        assert_int_equal(weft_lamp_solve(&problem, &found, &error), WEFT_OK);
        print_message("balls and pin: %.3f +- %.3f of their size, %.3f in truth; misfits %.1f, %.1f\n", found.size,
                      found.size_error, scale, found.ball_misfit, found.pin_misfit);
        assert_near(found.size, scale, 0.015);
        assert_true(found.size_error > 0 && found.size_error < 0.012);
        free(s);
    }
}

/* A hand on the sheet shines in a ball: the highlight says that the lamp is lower than the pin, whose shadow is there.
 */
static void a_highlight_too_low_for_the_pin_stops_nothing(void **state)
{
    (void)state;
    scene *s = photograph_all();
    weft_lamp_place place[PHOTOGRAPHS];
    weft_lamp_solution found = {.place = place};
    weft_lamp_problem problem = problem_of(s, PHOTOGRAPHS);
    weft_error error = {0};
    problem.tone_unknown = true;
    problem.ball_diameter_mm = 20;
    problem.pin_height_mm = 80;
    weft_lamp_evidence *seen = &s->evidence[0];
    double foot[2];
    weft_target_pin(problem.target, foot);
    weft_vec3 lamp = lamp_of(0), head = weft_vec3_of(foot[0], foot[1], problem.pin_height_mm - weft_pin_head_radius_mm);
    weft_vec3 down = weft_subtract(head, lamp);
    seen->pin = (weft_pin_shadow){.found = true, .along_mm = 1, .across_mm = 0.5};
    seen->pin.place[0] = head.x - down.x / down.z * head.z;
    seen->pin.place[1] = head.y - down.y / down.z * head.z;
    seen->highlight[0] = (weft_highlight){.found = true, .deviation_rad = 0.01};
    seen->highlight[0].ray = low_highlight(&problem, weft_pose_camera_position(&seen->pose));
    weft_lamp_guess(&problem, &found);
    assert_int_equal(place[0].source, WEFT_LAMP_PIN);
    assert_int_equal(weft_lamp_solve(&problem, &found, &error), WEFT_OK);
    double off = acos(weft_dot(weft_unit(place[0].position_mm), weft_unit(lamp)));
    print_message("the lamp is off by %.2f degrees\n", weft_deg_of_rad(off));
    assert_true(off < weft_rad_of_deg(3));
    free(s);
}

static void exposures_tell_the_curve_and_so_the_lamps(void **state)
{
    (void)state;
    scene *s = photograph_all();
    weft_lamp_place place[PHOTOGRAPHS];
    weft_exposure_pair pair[PHOTOGRAPHS];
    weft_lamp_solution found = {.place = place};
    weft_lamp_problem problem = problem_of(s, PHOTOGRAPHS);
    weft_error error = {0};
    assert_int_equal(weft_exposure_pairs_find(&problem, pair, &problem.pair_count, &error), WEFT_OK);
    assert_int_equal(problem.pair_count, TWICE);
    for (int i = 0; i < TWICE; i++) {
        assert_int_equal(pair[i].bright, i);
        assert_int_equal(pair[i].dark, SCENES + i);
        assert_near(pair[i].log_ratio, log(4), 1e-9);
    }
    problem.pair = pair;
    weft_lamp_guess(&problem, &found);
    /* The pairs alone, and then with all else. */
    for (int all = 0; all < 2; all++) {
        assert_int_equal(all ? weft_lamp_solve(&problem, &found, &error)
                             : weft_tone_of_pairs(&problem, found.tone, &error),
                         WEFT_OK);
        for (int i = 0; i < 5; i++) {
            double times = (double[]){2, 5, 10, 20, 40}[i];
            double ratio = light_of(&found, film(0.45)) / light_of(&found, film(0.45 / times)) / times;
            printf("1/%.0f of the light: %.3f\n", times, ratio);
            assert_near(ratio, 1, all ? 0.02 : 0.1);
        }
    }
    assert_true(found.dark_error > 0.002 && found.dark_error < 0.04);
    for (int i = 0; i < PHOTOGRAPHS; i++) {
        double off = weft_deg_of_rad(acos(weft_dot(weft_unit(place[i].position_mm), weft_unit(s->lamp[i]))));
        printf("lamp %d: %.2f degrees off (%.2f)\n", i, off, place[i].uncertainty_deg);
        assert_true(off < 2 && off < 3 * place[i].uncertainty_deg);
    }
    free(s);
}

/* Paper alone, with grain of 1.5 %: a curve that is nearly flat makes the grain small, but not the paper right. */
static void grain_does_not_flatten_the_curve(void **state)
{
    (void)state;
    scene *s = photograph_all();
    weft_lamp_place place[SCENES];
    weft_lamp_solution found = {.place = place};
    weft_lamp_problem problem = problem_of(s, SCENES);
    weft_error error = {0};
    for (int i = 0; i < SCENES; i++) {
        for (int k = 0; k < PLACES; k++) {
            double grain = 0.015 * (sin(2.9 * k + 1.3 * i) + sin(7.7 * k + 5.1 * i));
            for (int c = 0; c < 3; c++)
                s->sample[i][k].light[c] *= (float)(1 + grain);
        }
    }
    weft_lamp_guess(&problem, &found);
    assert_int_equal(weft_lamp_solve(&problem, &found, &error), WEFT_OK);
    printf("ink %.4f of paper\n", found.ink);
    assert_near(found.ink / (ink / paper), 1, 0.25);
    for (int i = 0; i < SCENES; i++) {
        double off = weft_deg_of_rad(acos(weft_dot(weft_unit(place[i].position_mm), weft_unit(s->lamp[i]))));
        printf("lamp %d: %.2f degrees off (%.2f)\n", i, off, place[i].uncertainty_deg);
        assert_true(off < 6 && off < 2.5 * place[i].uncertainty_deg);
    }
    free(s);
}

/* A camera on a stand that exposes by itself: lamps that stand elsewhere, nearer, or a little aside are no series. */
static void other_lamps_are_no_series(void **state)
{
    (void)state;
    scene *s = draw_places();
    weft_exposure_pair pair[PHOTOGRAPHS];
    weft_pose pose = weft_pose_of_view((weft_angles){0.1, 0.3}, 420);
    for (int i = 0; i < SCENES; i++)
        photograph(s, i, lamp_of(i), pose, exposure_of(lamp_of(i)), 0);
    weft_vec3 far = weft_scale(lamp_of(0), 1.5), aside = weft_add(lamp_of(0), weft_vec3_of(-90, 90, 0));
    photograph(s, SCENES, far, pose, exposure_of(far), 0);
    photograph(s, SCENES + 1, aside, pose, exposure_of(aside) / 2, 0);
    photograph(s, SCENES + 2, lamp_of(1), pose, exposure_of(lamp_of(1)) / 1.2, 0); /* no darker to speak of */
    photograph(s, SCENES + 3, lamp_of(2), pose, exposure_of(lamp_of(2)) / 2, 0);
    s->evidence[SCENES + 3].exposure = 0; /* the camera wrote none */
    weft_lamp_problem problem = problem_of(s, PHOTOGRAPHS);
    int count = -1;
    weft_error error = {0};
    assert_int_equal(weft_exposure_pairs_find(&problem, pair, &count, &error), WEFT_OK);
    for (int i = 0; i < count; i++)
        printf("%d and %d\n", pair[i].bright, pair[i].dark);
    assert_int_equal(count, 0);
    /* The same lamp is one, from the same place alone. */
    photograph(s, SCENES + 1, lamp_of(0), pose, exposure_of(lamp_of(0)) / 2, 0);
    assert_int_equal(weft_exposure_pairs_find(&problem, pair, &count, &error), WEFT_OK);
    assert_int_equal(count, 1);
    assert_true(pair[0].bright == 0 && pair[0].dark == SCENES + 1);
    photograph(s, SCENES + 1, lamp_of(0), weft_pose_of_view((weft_angles){0.14, 0.3}, 420), exposure_of(lamp_of(0)) / 2,
               0);
    assert_int_equal(weft_exposure_pairs_find(&problem, pair, &count, &error), WEFT_OK);
    assert_int_equal(count, 0);
    free(s);
}

/* Sixty is 64 to a camera, and 1/97 s is what a telephone means. */
static void round_numbers_are_thirds_of_a_stop(void **state)
{
    (void)state;
    const double written[][2] = {{1.0 / 60, 1.0 / 64},
                                 {1.0 / 125, 1.0 / 128},
                                 {1.0 / 15, 1.0 / 16},
                                 {1.0 / 8000, 1.0 / 8192},
                                 {1.0 / 100, 1 / 101.594},
                                 {1.0 / 13, 1 / 12.699},
                                 {0.4, 0.39685},
                                 {2.5, 2.5198},
                                 {0.3, 0.31498},
                                 {0.6, 0.62996},
                                 {0.8, 0.79370},
                                 {1.0 / 6, 1 / 6.3496},
                                 {30, 32},
                                 {1.0 / 97, 1.0 / 97},
                                 {1.0 / 300, 1.0 / 300},
                                 {1.0 / 121, 1.0 / 121}};
    for (size_t i = 0; i < sizeof written / sizeof *written; i++)
        assert_near(weft_exposure_meant(written[i][0]) / written[i][1], 1, 1e-4);
    /* Two stops, that the numbers make 4.17. */
    weft_exif slow = {.exposure_s = 1.0 / 60, .iso = 125, .f_number = 5.6}, fast = slow;
    fast.exposure_s = 1.0 / 250;
    assert_near(weft_exif_exposure(&slow) / weft_exif_exposure(&fast), 4, 1e-9);
    assert_near(weft_exif_exposure(&slow), 125.992 / 64 / (5.6 * 5.6), 1e-4);
    slow.f_number = 0;
    assert_near(weft_exif_exposure(&slow), 0, 0);
}

/* A series of three, and one that is blurred, whose darker darker is sharp. */
static void the_darker_of_a_pair_is_no_image(void **state)
{
    (void)state;
    weft_photographs_photograph photograph[5] = {
        {.name = "a"}, {.name = "b"}, {.name = "c"}, {.name = "d", .remark = "blurred"}, {.name = "e"}};
    weft_exposure_pair pair[] = {{2, 0, 1}, {0, 4, 1}, {3, 1, 1}};
    weft_photograph_set set = {.count = 5, .photograph = photograph, .pair_count = 3, .pair = pair};
    weft_photographs_leave_out_darker(&set);
    const bool used[] = {false, true, true, false, false};
    for (int i = 0; i < 5; i++)
        assert_int_equal(weft_photographs_used(&photograph[i]), used[i]);
    assert_true(photograph[0].is_darker_of_pair && photograph[4].is_darker_of_pair &&
                !photograph[3].is_darker_of_pair && !photograph[1].is_darker_of_pair);
    assert_non_null(strstr(photograph[4].remark, "it is 'a' with less exposure"));
    assert_int_equal(weft_photographs_darker_of_pair(&set, 2), 0);
    assert_int_equal(weft_photographs_darker_of_pair(&set, 0), 4);
    assert_int_equal(weft_photographs_darker_of_pair(&set, 4), -1);
}

static void the_darker_of_a_pair_tells_what_is_clipped(void **state)
{
    (void)state;
    enum { CLIPPED = WEFT_MASK_SATURATED, DARK = WEFT_MASK_DARK, BOTH = CLIPPED | WEFT_MASK_MISSING };
    const uint8_t darker_mask[] = {0, 0, CLIPPED, 0, 0};
    uint8_t mask[] = {0, CLIPPED, CLIPPED, DARK, BOTH};
    const weft_half darker[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    weft_half texel[15] = {0};
    assert_int_equal(weft_photographs_fill_saturated(darker, darker_mask, 5, texel, mask), 1);
    const uint8_t mask_after[] = {0, 0, CLIPPED, DARK, BOTH};
    const weft_half after[15] = {0, 0, 0, 4, 5, 6};
    assert_memory_equal(mask, mask_after, sizeof mask);
    assert_memory_equal(texel, after, sizeof texel);
}

int test_photographs_series(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exposures_tell_the_curve_and_so_the_lamps),
        cmocka_unit_test(grain_does_not_flatten_the_curve),
        cmocka_unit_test(the_size_of_balls_and_pin_tells_the_scale_of_the_print),
        cmocka_unit_test(a_highlight_too_low_for_the_pin_stops_nothing),
        cmocka_unit_test(other_lamps_are_no_series),
        cmocka_unit_test(round_numbers_are_thirds_of_a_stop),
        cmocka_unit_test(the_darker_of_a_pair_is_no_image),
        cmocka_unit_test(the_darker_of_a_pair_tells_what_is_clipped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
