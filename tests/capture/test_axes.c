/* Where axes must stand for a pose, against rotations of vectors; and how long they take. */
#include "capture/axes/axes.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <string.h>

static weft_axis axis_of(const char *name, weft_body body, weft_turn turn, int channel, double low, double high)
{
    weft_axis axis = {.moves = body,
                      .angle = turn,
                      .channel = channel,
                      .low_deg = low,
                      .high_deg = high,
                      .speed_deg_s = 10,
                      .acceleration_deg_s2 = 20,
                      .settle_s = 0.5};
    snprintf(axis.name, sizeof axis.name, "%s", name);
    return axis;
}

static weft_axes goniometer(void)
{
    return (weft_axes){.count = 4,
                       .together = true,
                       .axis = {axis_of("ct", WEFT_BODY_CAMERA, WEFT_TURN_THETA, 0, 0, 85),
                                axis_of("cp", WEFT_BODY_CAMERA, WEFT_TURN_PHI, 1, 0, 360),
                                axis_of("lt", WEFT_BODY_LIGHT, WEFT_TURN_THETA, 2, 0, 89),
                                axis_of("lp", WEFT_BODY_LIGHT, WEFT_TURN_PHI, 3, 0, 360)}};
}

/* Camera on an arc at phi 30, turntable, light at a fixed azimuth of the laboratory, which needs the camera's ring. */
static weft_axes turntable(void)
{
    weft_axes axes = {.count = 4,
                      .together = true,
                      .axis = {axis_of("arc", WEFT_BODY_CAMERA, WEFT_TURN_THETA, 0, 0, 85),
                               axis_of("table", WEFT_BODY_SAMPLE, WEFT_TURN_PHI, 1, -180, 180),
                               axis_of("lt", WEFT_BODY_LIGHT, WEFT_TURN_THETA, 2, 0, 89),
                               axis_of("lp", WEFT_BODY_LIGHT, WEFT_TURN_PHI, 3, 0, 360)}};
    axes.fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_PHI] = 30;
    axes.axis[1].reversed = true;
    axes.axis[1].zero_deg = 12;
    axes.axis[3].zero_deg = 90;
    return axes;
}

/* The angle at which a body stands, by its axis or as it is fixed. */
static double angle_of(const weft_axes *axes, const weft_axis_positions *p, weft_body body, weft_turn turn)
{
    for (int k = 0; k < axes->count; k++) {
        const weft_axis *axis = &axes->axis[k];
        if (axis->moves == body && axis->angle == turn)
            return (axis->reversed ? -1 : 1) * (p->deg[k] - axis->zero_deg);
    }
    return axes->fixed_deg[body][turn];
}

/* Turned about y by theta and about z by phi, then back with the sample. */
static weft_vec3 seen_from(const weft_axes *axes, const weft_axis_positions *p, weft_body body)
{
    double theta = weft_rad_of_deg(angle_of(axes, p, body, WEFT_TURN_THETA));
    double phi = weft_rad_of_deg(angle_of(axes, p, body, WEFT_TURN_PHI));
    double turn = weft_rad_of_deg(angle_of(axes, p, WEFT_BODY_SAMPLE, WEFT_TURN_PHI));
    double x = sin(theta), z = cos(theta);
    double laboratory[2] = {x * cos(phi), x * sin(phi)};
    return weft_vec3_of(cos(turn) * laboratory[0] + sin(turn) * laboratory[1],
                        -sin(turn) * laboratory[0] + cos(turn) * laboratory[1], z);
}

static void assert_pose(const weft_axes *axes, weft_angles view, weft_angles light)
{
    weft_axis_positions p;
    weft_error error = {0};
    if (weft_axes_solve(axes, view, light, &p, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_vec3 camera = seen_from(axes, &p, WEFT_BODY_CAMERA), lamp = seen_from(axes, &p, WEFT_BODY_LIGHT);
    assert_true(weft_length(weft_subtract(camera, weft_direction_of_angles(view))) < 1e-9);
    assert_true(weft_length(weft_subtract(lamp, weft_direction_of_angles(light))) < 1e-9);
    for (int i = 0; i < WEFT_BODY_COUNT * WEFT_TURN_COUNT; i++) {
        weft_body body = (weft_body)(i / WEFT_TURN_COUNT);
        weft_turn turn = (weft_turn)(i % WEFT_TURN_COUNT);
        assert_true(fabs(weft_axes_angle(axes, &p, body, turn) - angle_of(axes, &p, body, turn)) < 1e-9);
    }
}

static void every_pair_of_ubo81_stands_where_it_should(void **state)
{
    (void)state;
    weft_axes rigs[3] = {goniometer(), turntable(), goniometer()};
    rigs[2].axis[0].low_deg = -85; /* beyond the zenith, but half a turn is enough */
    rigs[2].axis[1].high_deg = 185;
    for (int rig = 0; rig < 3; rig++) {
        for (int i = 0; i < 81 * 81; i++)
            assert_pose(&rigs[rig], weft_ubo81_angles(i / 81), weft_ubo81_angles(i % 81));
    }
}

static void a_pose_out_of_reach_names_the_axis(void **state)
{
    (void)state;
    weft_axes axes = goniometer();
    weft_axis_positions p;
    weft_error error = {0};
    weft_angles low = {weft_rad_of_deg(87), 0}, zenith = {0, 0};
    assert_int_equal(weft_axes_solve(&axes, low, zenith, &p, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "axis 'ct' would have to turn to 87 degrees; its range is 0 to 85"));
    axes.axis[0].backlash_deg = 0.5; /* 0 can only be taken up from below 0 */
    assert_int_equal(weft_axes_solve(&axes, zenith, zenith, &p, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "its range is 0.5 to 85"));
    axes = turntable();
    axes.count = 2;
    assert_int_equal(weft_axes_solve(&axes, zenith, low, &p, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "the light stands at theta 0 degrees and cannot turn to 87"));
}

static void a_rig_with_more_than_one_way_is_refused(void **state)
{
    (void)state;
    weft_axes axes = goniometer();
    assert_int_equal(weft_axes_check(&axes, "rig.conf", NULL), WEFT_OK);
    axes.axis[4] = axis_of("table", WEFT_BODY_SAMPLE, WEFT_TURN_PHI, 4, 0, 360);
    axes.count = 5;
    weft_error error = {0};
    assert_int_equal(weft_axes_check(&axes, "rig.conf", &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "all turn in phi"));
}

static void a_lamp_of_the_laboratory_turns_back_with_the_sample(void **state)
{
    (void)state;
    weft_axes axes = turntable();
    weft_axis_positions p = {.deg = {20, 12 - 50, 0, 0}}; /* reversed: turned by 50 degrees */
    weft_angles lamp = {weft_rad_of_deg(40), weft_rad_of_deg(20)};
    weft_angles light = weft_axes_light_on_sample(&axes, &p, lamp);
    assert_float_equal(weft_deg_of_rad(light.theta_rad), 40, 1e-9);
    assert_float_equal(weft_deg_of_rad(light.phi_rad), 330, 1e-9);
}

/* A move against its acceleration, integrated in small steps. */
static double integrated(double distance, double speed, double acceleration)
{
    const double step = 1e-5;
    double at = 0, v = 0, t = 0;
    while (at < distance) {
        bool brake = v * v / (2 * acceleration) >= distance - at;
        v = brake ? v - acceleration * step : fmin(v + acceleration * step, speed);
        if (v <= 0)
            break;
        at += v * step;
        t += step;
    }
    return t;
}

static void a_leg_takes_as_long_as_its_motion(void **state)
{
    (void)state;
    weft_axis axis = axis_of("a", WEFT_BODY_LIGHT, WEFT_TURN_PHI, 0, 0, 360);
    for (double distance = 0.5; distance < 200; distance *= 1.7)
        assert_float_equal(weft_axis_leg_s(&axis, -distance), integrated(distance, 10, 20), 0.01);
    assert_float_equal(weft_axis_leg_s(&axis, 0), 0, 0);
}

static void backlash_is_taken_up_from_one_side(void **state)
{
    (void)state;
    weft_axis axis = axis_of("a", WEFT_BODY_LIGHT, WEFT_TURN_PHI, 0, 0, 360);
    axis.backlash_deg = 0.5;
    assert_float_equal(weft_axis_first_leg(&axis, 10, 20), 20, 0);
    assert_float_equal(weft_axis_first_leg(&axis, 10, 10.4), 9.9, 1e-12); /* too near to take it up on the way */
    assert_float_equal(weft_axis_first_leg(&axis, 30, 20), 19.5, 1e-12);
    assert_float_equal(weft_axis_first_leg(&axis, NAN, 20), 19.5, 1e-12);
    axis.approach_down = true;
    assert_float_equal(weft_axis_first_leg(&axis, 10, 20), 20.5, 1e-12);
    assert_float_equal(weft_axis_first_leg(&axis, 30, 20), 20, 0);
}

static void axes_turn_together_or_one_after_another_and_settle_once(void **state)
{
    (void)state;
    weft_axes axes = goniometer();
    weft_axis_positions from = {{0}}, to = {{10, 20, 0, 0}};
    axes.axis[1].settle_s = 2;
    double first = weft_axis_leg_s(&axes.axis[0], 10), second = weft_axis_leg_s(&axes.axis[1], 20);
    assert_float_equal(weft_axes_move_s(&axes, &from, &to), second + 2, 1e-12);
    axes.together = false;
    assert_float_equal(weft_axes_move_s(&axes, &from, &to), first + second + 2, 1e-12);
    axes.axis[0].backlash_deg = 0.5;
    assert_float_equal(weft_axes_move_s(&axes, &from, &to), first + second + 2, 1e-12);
    assert_float_equal(weft_axes_move_s(&axes, &to, &from),
                       weft_axis_leg_s(&axes.axis[0], 10.5) + weft_axis_leg_s(&axes.axis[0], 0.5) + second + 2, 1e-12);
    assert_float_equal(weft_axes_move_s(&axes, &to, &to), 0, 0);
}

int test_axes(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_of_ubo81_stands_where_it_should),
        cmocka_unit_test(a_pose_out_of_reach_names_the_axis),
        cmocka_unit_test(a_rig_with_more_than_one_way_is_refused),
        cmocka_unit_test(a_lamp_of_the_laboratory_turns_back_with_the_sample),
        cmocka_unit_test(a_leg_takes_as_long_as_its_motion),
        cmocka_unit_test(backlash_is_taken_up_from_one_side),
        cmocka_unit_test(axes_turn_together_or_one_after_another_and_settle_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
