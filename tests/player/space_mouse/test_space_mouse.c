/* What the cap does to a camera, and the reports of devices. */
#include "player/window/space_mouse.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const weft_orbit start = {.azimuth_rad = 0.4, .elevation_rad = 0.3, .distance = 3};

static weft_orbit moved(weft_space_motion motion, double elapsed_s)
{
    weft_orbit orbit = start;
    weft_space_mouse_move(&orbit, &motion, elapsed_s);
    return orbit;
}

/* ---- The camera ---- */

static void a_point_follows_the_cap(void **state)
{
    (void)state;
    /* Where a point of the object lands in the picture, before and after. */
    const weft_vec3 point = {0.3, -0.2, 0.4}, centre = {0, 0, 0};
    float before[16], after[16];
    for (int axis = 0; axis < 2; axis++) {
        weft_space_motion motion = {0};
        motion.translation[axis] = 1;
        weft_orbit orbit = moved(motion, 0.05);
        weft_orbit_clip_of_world(&start, centre, 1, 1.5, 0, 0, before);
        weft_orbit_clip_of_world(&orbit, centre, 1, 1.5, 0, 0, after);
        double shift[2];
        for (int row = 0; row < 2; row++) {
            double at[2][2];
            const float *matrix[2] = {before, after};
            for (int k = 0; k < 2; k++) {
                const float *m = matrix[k];
                at[k][0] = m[row] * point.x + m[4 + row] * point.y + m[8 + row] * point.z + m[12 + row];
                at[k][1] = m[3] * point.x + m[7] * point.y + m[11] * point.z + m[15];
            }
            shift[row] = at[1][0] / at[1][1] - at[0][0] / at[0][1];
        }
        assert_true(shift[axis] > 0.01);
        assert_true(fabs(shift[1 - axis]) < 1e-5);
    }
}

static void turning_the_cap_turns_the_object(void **state)
{
    (void)state;
    /* Anticlockwise from above: the camera goes round the other way. The top toward the user: seen from higher up. */
    assert_true(moved((weft_space_motion){.rotation = {0, 1, 0}}, 0.1).azimuth_rad < start.azimuth_rad);
    assert_true(moved((weft_space_motion){.rotation = {1, 0, 0}}, 0.1).elevation_rad > start.elevation_rad);
    assert_true(moved((weft_space_motion){.translation = {0, 0, 1}}, 0.1).distance < start.distance);
    weft_orbit turned = moved((weft_space_motion){.rotation = {0, 1, 0}}, 0.1);
    assert_float_equal(start.azimuth_rad - turned.azimuth_rad, 0.1 * WEFT_PI, 1e-12);
}

static void a_cap_at_rest_or_within_the_dead_zone_moves_nothing(void **state)
{
    (void)state;
    const weft_space_motion faint = {.translation = {0.039, -0.039, 0.03}, .rotation = {-0.039, 0.02, 1}};
    weft_orbit orbit = start;
    assert_false(weft_space_mouse_move(&orbit, &faint, 0.1)); /* there is no roll */
    assert_memory_equal(&orbit, &start, sizeof orbit);
    const weft_space_motion push = {.translation = {1, 1, 1}, .rotation = {1, 1, 1}};
    assert_false(weft_space_mouse_move(&orbit, &push, 0));
    assert_memory_equal(&orbit, &start, sizeof orbit);
    const weft_space_motion broken = {.translation = {NAN, NAN, NAN}, .rotation = {NAN, NAN, NAN}};
    assert_false(weft_space_mouse_move(&orbit, &broken, 0.1));
}

static void two_short_steps_make_a_long_one(void **state)
{
    (void)state;
    const weft_space_motion motion = {.translation = {0, 0, 0.7}, .rotation = {0.3, -0.6, 0}};
    weft_orbit once = moved(motion, 0.08), twice = moved(motion, 0.04);
    weft_space_mouse_move(&twice, &motion, 0.04);
    assert_float_equal(once.azimuth_rad, twice.azimuth_rad, 1e-12);
    assert_float_equal(once.elevation_rad, twice.elevation_rad, 1e-12);
    assert_float_equal(once.distance, twice.distance, 1e-12);
}

/* A loop that stood still for a minute does not hurl the camera away. */
static void a_pause_is_no_long_push(void **state)
{
    (void)state;
    const weft_space_motion motion = {.translation = {0, 0, 1}};
    assert_float_equal(moved(motion, 60).distance, moved(motion, 0.1).distance, 0);
    weft_orbit orbit = start;
    for (int step = 0; step < 10000; step++)
        weft_space_mouse_move(&orbit, &motion, 0.1);
    assert_true(orbit.distance > 1 && orbit.distance < 2);
}

/* ---- Reports of devices ---- */

static void axes_of_reports_are_those_of_the_picture(void **state)
{
    (void)state;
    /* x 350 right, y -350 away from the user, z 175 down */
    const unsigned char translation[] = {1, 0x5e, 0x01, 0xa2, 0xfe, 0xaf, 0x00};
    const unsigned char rotation[] = {2, 0, 0, 0, 0, 0x5e, 0x01};
    weft_space_motion motion = {0};
    weft_space_mouse_report(translation, sizeof translation, &motion);
    assert_float_equal(motion.translation[0], 1, 1e-12);
    assert_float_equal(motion.translation[1], -0.5, 1e-12);
    assert_float_equal(motion.translation[2], -1, 1e-12);
    weft_space_mouse_report(rotation, sizeof rotation, &motion);
    assert_float_equal(motion.rotation[1], -1, 1e-12);
    assert_float_equal(motion.translation[0], 1, 1e-12);
}

static void a_combined_report_holds_all_six_axes(void **state)
{
    (void)state;
    const unsigned char report[] = {1, 0x5e, 0x01, 0, 0, 0, 0, 0xa2, 0xfe, 0, 0, 0, 0};
    weft_space_motion motion = {0};
    weft_space_mouse_report(report, sizeof report, &motion);
    assert_float_equal(motion.translation[0], 1, 1e-12);
    assert_float_equal(motion.rotation[0], -1, 1e-12);
}

static void buttons_are_bits_of_report_three(void **state)
{
    (void)state;
    weft_space_motion motion = {0};
    weft_space_mouse_report((const unsigned char[]){3, 2, 1}, 3, &motion);
    assert_int_equal(motion.buttons, 0x102);
    weft_space_mouse_report((const unsigned char[]){3, 0, 0, 0, 0, 9, 9}, 7, &motion);
    assert_int_equal(motion.buttons, 0);
}

static void short_and_unknown_reports_change_nothing(void **state)
{
    (void)state;
    const weft_space_motion before = {.translation = {0.5, 0, 0}, .buttons = 1};
    const unsigned char bytes[64] = {0};
    for (int number = 0; number < 256; number++) {
        unsigned char report[64];
        memcpy(report, bytes, sizeof report);
        report[0] = (unsigned char)number;
        for (size_t size = 0; size <= sizeof report; size++) {
            weft_space_motion motion = before;
            weft_space_mouse_report(report, size, &motion);
            bool known = (number >= 1 && number <= 2 && size >= 7) || (number == 3 && size >= 2);
            if (!known)
                assert_memory_equal(&motion, &before, sizeof motion);
        }
    }
}

/* ---- No device ---- */

static weft_space_mouse *new_mouse(void)
{
    weft_space_mouse *mouse = NULL;
    weft_error error;
    assert_int_equal(weft_space_mouse_create(&mouse, &error), WEFT_OK);
    return mouse;
}

static void without_a_device_nothing_happens(void **state)
{
    (void)state;
    weft_space_mouse *mouse = new_mouse();
    weft_space_motion motion;
    assert_int_equal(weft_space_mouse_poll(mouse, 0, &motion), WEFT_SPACE_MOUSE_ABSENT);
    assert_string_equal(weft_space_mouse_message(mouse), "");
    weft_space_mouse_free(mouse);
}

int test_space_mouse(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_follows_the_cap),
        cmocka_unit_test(turning_the_cap_turns_the_object),
        cmocka_unit_test(a_cap_at_rest_or_within_the_dead_zone_moves_nothing),
        cmocka_unit_test(two_short_steps_make_a_long_one),
        cmocka_unit_test(a_pause_is_no_long_push),
        cmocka_unit_test(axes_of_reports_are_those_of_the_picture),
        cmocka_unit_test(a_combined_report_holds_all_six_axes),
        cmocka_unit_test(buttons_are_bits_of_report_three),
        cmocka_unit_test(short_and_unknown_reports_change_nothing),
        cmocka_unit_test(without_a_device_nothing_happens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
