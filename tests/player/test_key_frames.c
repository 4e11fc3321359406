#include "player/settings/key_frames.h"

#include "base/atomic_file.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static weft_path read_path(const char *text)
{
    weft_path path;
    weft_error error = {0};
    assert_int_equal(weft_write_file("path.csv", text, strlen(text), &error), WEFT_OK);
    if (weft_path_read("path.csv", &path, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return path;
}

static void expect_refusal(const char *text, const char *part)
{
    weft_path path;
    weft_error error = {0};
    assert_int_equal(weft_write_file("path.csv", text, strlen(text), &error), WEFT_OK);
    assert_int_equal(weft_path_read("path.csv", &path, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, "path.csv") || !strstr(error.message, part))
        fail_msg("'%s' does not say '%s'", error.message, part);
}

static weft_scene scene_at(const weft_path *path, double time_s)
{
    weft_scene scene = weft_scene_default();
    weft_path_apply(path, time_s, &scene);
    return scene;
}

static double azimuth_at(const weft_path *path, double time_s)
{
    return weft_deg_of_rad(scene_at(path, time_s).orbit.azimuth_rad);
}

static void every_key_is_met_and_the_rest_of_the_scene_stays(void **state)
{
    (void)state;
    weft_path path = read_path("time_s,azimuth_deg,elevation_deg,distance,pan_right,pan_up,light_theta_deg,"
                               "light_phi_deg,exposure,environment_turn_deg\n"
                               "1,10,20,3,0.1,0.2,30,40,0.5,5\n3,15,25,4,0.3,0.1,35,60,2,9\n4,-5,5,2,0,0,0,0,1,0\n");
    weft_scene scene = scene_at(&path, 3);
    assert_float_equal(weft_deg_of_rad(scene.orbit.azimuth_rad), 15, 1e-12);
    assert_float_equal(weft_deg_of_rad(scene.orbit.elevation_rad), 25, 1e-12);
    assert_float_equal(scene.orbit.distance, 4, 1e-12);
    assert_float_equal(scene.orbit.pan_right, 0.3, 1e-12);
    assert_float_equal(scene.orbit.pan_up, 0.1, 1e-12);
    assert_float_equal(weft_deg_of_rad(scene.light[0].direction.theta_rad), 35, 1e-12);
    assert_float_equal(weft_deg_of_rad(scene.light[0].direction.phi_rad), 60, 1e-12);
    assert_float_equal(scene.exposure, 2, 1e-12);
    assert_float_equal(weft_deg_of_rad(scene.environment_turn_rad), 9, 1e-12);
    assert_float_equal(azimuth_at(&path, 0), 10, 1e-12);
    assert_float_equal(azimuth_at(&path, 9), -5, 1e-12);
    weft_path_free(&path);
    path = read_path("exposure,time_s\n4,0\n");
    scene = scene_at(&path, 0);
    assert_float_equal(scene.exposure, 4, 1e-12);
    assert_true(scene.orbit.distance == weft_scene_default().orbit.distance);
    weft_path_free(&path);
}

/* Slopes at uneven times: keys on a straight line stay on it, and no key has a corner. */
static void motion_is_straight_on_a_line_and_smooth_at_keys(void **state)
{
    (void)state;
    weft_path line = read_path("time_s,azimuth_deg\n0,0\n1,10\n4,40\n4.5,45\n");
    for (double t = 0; t <= 4.5; t += 0.01)
        assert_float_equal(azimuth_at(&line, t), 10 * t, 1e-9);
    weft_path_free(&line);
    weft_path bent = read_path("time_s,azimuth_deg\n0,0\n1,10\n4,-20\n5,90\n");
    for (double key = 1; key <= 4; key += 3) {
        double before = azimuth_at(&bent, key) - azimuth_at(&bent, key - 1e-6);
        double after = azimuth_at(&bent, key + 1e-6) - azimuth_at(&bent, key);
        assert_float_equal(before, after, 1e-9);
    }
    /* By hand: the middle of 1..4 s between 10 and -20 with slopes -5 and 20 deg/s. */
    assert_float_equal(azimuth_at(&bent, 2.5), -5 + 3.0 / 8 * (-5 - 20), 1e-9);
    weft_path_free(&bent);
}

static void exposure_and_distance_change_by_factors(void **state)
{
    (void)state;
    weft_path path = read_path("time_s,exposure,distance\n0,0.25,2\n1,4,5\n");
    weft_scene scene = scene_at(&path, 0.5);
    assert_float_equal(scene.exposure, 1, 1e-12);
    assert_float_equal(scene.orbit.distance, 3, 1e-12);
    weft_path_free(&path);
}

static void an_elevation_never_passes_the_zenith(void **state)
{
    (void)state;
    weft_path path = read_path("time_s,elevation_deg\n0,0\n1,90\n2,90\n3,0\n");
    for (double t = 0; t <= 3; t += 0.01)
        assert_true(scene_at(&path, t).orbit.elevation_rad <= weft_rad_of_deg(90));
    weft_path_free(&path);
}

static void frames_are_counted_with_both_ends(void **state)
{
    (void)state;
    int count;
    weft_error error = {0};
    weft_path path = read_path("time_s,exposure\n2,1\n2.3,1\n");
    assert_int_equal(weft_path_count_frames(&path, 10, &count, &error), WEFT_OK);
    assert_int_equal(count, 4);
    assert_int_equal(weft_path_count_frames(&path, 9.9, &count, &error), WEFT_OK);
    assert_int_equal(count, 3);
    weft_path_free(&path);
    path = read_path("time_s,exposure\n0,1\n1e9,1\n");
    assert_int_equal(weft_path_count_frames(&path, 25, &count, &error), WEFT_BAD_INPUT);
    weft_path_free(&path);
}

/* All that the scene is at random times of a span, some of which reach over keys and beyond the path, lies within its
 * bounds; those of a moment are the moment. */
static void a_span_holds_all_of_its_moments(void **state)
{
    (void)state;
    weft_path path = read_path("time_s,azimuth_deg,distance,exposure,light_phi_deg\n"
                               "1,10,3,0.5,40\n2,90,1.2,2,-60\n2.5,80,6,1,300\n5,-120,2,8,0\n");
    for (int i = 0; i < 400; i++) {
        double from = 6.0 * rand() / RAND_MAX, to = from + (i % 2 ? 0.3 : 2) * rand() / RAND_MAX;
        weft_scene low = weft_scene_default(), high = low;
        weft_path_span(&path, from, to, &low, &high);
        for (int k = 0; k <= 20; k++) {
            weft_scene at = scene_at(&path, from + (to - from) * k / 20);
            assert_true(at.orbit.azimuth_rad >= low.orbit.azimuth_rad - 1e-12);
            assert_true(at.orbit.azimuth_rad <= high.orbit.azimuth_rad + 1e-12);
            assert_true(at.orbit.distance >= low.orbit.distance - 1e-12);
            assert_true(at.orbit.distance <= high.orbit.distance + 1e-12);
            assert_true(at.exposure >= low.exposure - 1e-12 && at.exposure <= high.exposure + 1e-12);
            assert_true(at.light[0].direction.phi_rad >= low.light[0].direction.phi_rad - 1e-12);
            assert_true(at.light[0].direction.phi_rad <= high.light[0].direction.phi_rad + 1e-12);
        }
        weft_path_span(&path, from, from, &low, &high);
        assert_float_equal(low.orbit.azimuth_rad, scene_at(&path, from).orbit.azimuth_rad, 1e-12);
        assert_float_equal(high.orbit.azimuth_rad, low.orbit.azimuth_rad, 1e-12);
        assert_float_equal(high.orbit.elevation_rad, weft_scene_default().orbit.elevation_rad, 0);
    }
    weft_path_free(&path);
}

static void faults_are_named(void **state)
{
    (void)state;
    expect_refusal("azimuth_deg\n1\n", "no column 'time_s'");
    expect_refusal("time_s,azimut_deg\n0,1\n", "no column 'azimut_deg'");
    expect_refusal("time_s,distance\n0,3\n1,0.5\n", ":3: distance is 0.5");
    expect_refusal("time_s,elevation_deg\n0,91\n", ":2: elevation_deg is 91");
    expect_refusal("time_s,exposure\n0,1\n0,2\n", ":3: the time 0 s does not follow 0 s");
    expect_refusal("time_s,exposure\n0,bright\n", ":2:");
    expect_refusal("time_s,exposure\n0,nan\n", ":2:");
    expect_refusal("time_s,exposure\n", "0 key frames");
    expect_refusal("", "path.csv");
}

int test_key_frames(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_is_met_and_the_rest_of_the_scene_stays),
        cmocka_unit_test(motion_is_straight_on_a_line_and_smooth_at_keys),
        cmocka_unit_test(exposure_and_distance_change_by_factors),
        cmocka_unit_test(an_elevation_never_passes_the_zenith),
        cmocka_unit_test(frames_are_counted_with_both_ends),
        cmocka_unit_test(a_span_holds_all_of_its_moments),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
