/* The axes of a goniometer out of 20 shots, against what they truly are. The shots come from the virtual goniometer:
 * what is fitted are lines in the frame of the plate. */
#include "registration/axes/calibration.h"
#include "tests/support/axes_series.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHOTS = AXES_SERIES_SHOTS, TEXELS = 64 };

/* How far a turn moves a point, for a turn of one rad: its distance from the line. */
static double off_line_mm(const weft_pose *turn, weft_vec3 point)
{
    const double(*r)[3] = turn->rotation;
    weft_vec3 there = {r[0][0] * point.x + r[0][1] * point.y + r[0][2] * point.z,
                       r[1][0] * point.x + r[1][1] * point.y + r[1][2] * point.z,
                       r[2][0] * point.x + r[2][1] * point.y + r[2][2] * point.z};
    double angle = acos((r[0][0] + r[1][1] + r[2][2] - 1) / 2);
    return weft_length(weft_subtract(weft_add(there, turn->translation), point)) / (2 * sin(angle / 2));
}

typedef struct errors {
    double line_deg[2], line_mm[2];       /* of the axes of theta and phi */
    double view_deg, texels;              /* root mean squares over the views of ubo81, of poses without scatter */
    double worst_deg;                     /* of a view's direction */
    double expected_texels, expected_deg; /* the same root mean squares, as calibration expects them */
} errors;

static double shift_texels(const weft_virtual_world *rest, const weft_pose *truth, const weft_rig_poses *found,
                           const weft_pose *pose)
{
    weft_homography seen = weft_homography_of_pose(&rest->camera, truth);
    weft_homography map = weft_homography_of_pose(&found->camera, pose), back = weft_homography_inverse(&map);
    double sum = 0, opening = rest->settings.rig.opening_mm;
    for (int i = 0; i < 25; i++) {
        double x = opening * ((i % 5 + 0.5) / 5 - 0.5), y = opening * ((i / 5 + 0.5) / 5 - 0.5);
        weft_pixel at = weft_camera_distort(&rest->camera, weft_homography_apply(&seen, x, y));
        at = weft_camera_undistort(&found->camera, at);
        weft_pixel place = weft_homography_apply(&back, at.x, at.y);
        sum += (place.x - x) * (place.x - x) + (place.y - y) * (place.y - y);
    }
    return sqrt(sum / 25) * TEXELS / opening;
}

static errors compare(const axes_series *s, const weft_axes_report *report)
{
    weft_virtual_world rest = axes_at_rest(&s->world);
    const weft_rig_poses *found = &report->file.poses;
    errors e = {0};
    weft_axes_fit still = report->fit;
    still.scatter.rotation_rad = still.scatter.translation_mm = 0;
    const weft_pose turn[2] = {axes_true_turn(&rest, axes_degrees(0, 0), axes_degrees(60, 0)),
                               axes_true_turn(&rest, axes_degrees(0, 0), axes_degrees(0, 90))};
    for (int k = 0; k < 2; k++) {
        e.line_deg[k] = axes_angle_deg(axes_direction(&turn[k]), found->joint[k].direction);
        e.line_mm[k] = off_line_mm(&turn[k], found->joint[k].point);
    }
    for (int i = 0; i < WEFT_UBO81_COUNT; i++) {
        weft_angles view = weft_ubo81_angles(i);
        weft_turns turns = weft_turns_of_view(view);
        weft_pose truth = weft_virtual_world_pose(&rest, view, 0), pose = weft_rig_poses_at(found, &turns);
        double angle = axes_angle_deg(weft_pose_camera_position(&truth), weft_pose_camera_position(&pose));
        double texels = shift_texels(&rest, &truth, found, &pose);
        weft_expected_pose expected =
            weft_axes_expect_pose(&still, &s->nominal, rest.settings.rig.opening_mm, TEXELS, &turns);
        e.view_deg += angle * angle / WEFT_UBO81_COUNT;
        e.texels += texels * texels / WEFT_UBO81_COUNT;
        e.expected_texels += expected.texels * expected.texels / WEFT_UBO81_COUNT;
        e.expected_deg += pow(weft_deg_of_rad(expected.direction_rad), 2) / WEFT_UBO81_COUNT;
        e.worst_deg = fmax(e.worst_deg, angle);
    }
    e.view_deg = sqrt(e.view_deg);
    e.texels = sqrt(e.texels);
    e.expected_texels = sqrt(e.expected_texels);
    e.expected_deg = sqrt(e.expected_deg);
    return e;
}

static weft_axes_report calibrate(axes_series *s)
{
    weft_axes_report report;
    weft_error error = {0};
    weft_code code = weft_axes_calibrate(s->shot, SHOTS, &s->nominal, false, &report, &error);
    if (code != WEFT_OK)
        fail_msg("%s", error.message);
    return report;
}

/* Root mean squares over seeds. */
static errors calibrate_seeds(const weft_virtual_settings *settings, int seeds, const char *name)
{
    errors sum = {0};
    for (int seed = 1; seed <= seeds; seed++) {
        axes_series s = axes_series_take(settings, (uint64_t)seed, 1);
        weft_axes_report report = calibrate(&s);
        errors e = compare(&s, &report);
        sum.line_deg[0] += e.line_deg[0] * e.line_deg[0] / seeds;
        sum.line_deg[1] += e.line_deg[1] * e.line_deg[1] / seeds;
        sum.line_mm[0] = fmax(sum.line_mm[0], e.line_mm[0]);
        sum.line_mm[1] = fmax(sum.line_mm[1], e.line_mm[1]);
        sum.view_deg += e.view_deg * e.view_deg / seeds;
        sum.texels += e.texels * e.texels / seeds;
        sum.expected_texels += e.expected_texels * e.expected_texels / seeds;
        sum.expected_deg += e.expected_deg * e.expected_deg / seeds;
        sum.worst_deg = fmax(sum.worst_deg, e.worst_deg);
        assert_int_equal(report.used, SHOTS);
        weft_axes_report_free(&report);
    }
    sum.line_deg[0] = sqrt(sum.line_deg[0]);
    sum.line_deg[1] = sqrt(sum.line_deg[1]);
    sum.view_deg = sqrt(sum.view_deg);
    sum.texels = sqrt(sum.texels);
    sum.expected_texels = sqrt(sum.expected_texels);
    sum.expected_deg = sqrt(sum.expected_deg);
    print_message(
        "%s: lines %.4f %.4f degrees, %.3f %.3f mm; views %.4f (expected %.4f), worst of all %.4f degrees; %.4f texels "
        "(expected %.4f)\n",
        name, sum.line_deg[0], sum.line_deg[1], sum.line_mm[0], sum.line_mm[1], sum.view_deg, sum.expected_deg,
        sum.worst_deg, sum.texels, sum.expected_texels);
    return sum;
}

/* Half a degree off, one millimetre, and everything else that is off in a rig: without scatter and with a little.
 * Measured over 24 seeds with the scatter of the virtual rig, 0.05 degrees a component: lines 0.040 and 0.017 degrees,
 * views 0.025. */
static void lines_are_found(void **state)
{
    (void)state;
    weft_virtual_settings s = axes_off_settings();
    s.viewpoint_rotation_deg = s.viewpoint_translation_mm = 0;
    errors still = calibrate_seeds(&s, 2, "without scatter");
    assert_true(still.line_deg[0] < 0.006 && still.line_deg[1] < 0.003);
    assert_true(still.line_mm[0] < 0.05 && still.line_mm[1] < 0.02);
    assert_true(still.view_deg < 0.005 && still.texels < 0.01);
    s.viewpoint_rotation_deg = 0.02;
    s.viewpoint_translation_mm = 0.05;
    errors little = calibrate_seeds(&s, 3, "scatter of 0.02 degrees, 0.05 mm");
    assert_true(little.line_deg[0] < 0.04 && little.line_deg[1] < 0.012);
    assert_true(little.view_deg < 0.02);
    /* What is expected is what comes. */
    assert_true(little.view_deg < 2 * little.expected_deg && little.expected_deg < 2 * little.view_deg);
    assert_true(little.texels < 2 * little.expected_texels && little.expected_texels < 2 * little.texels);
}

/* The scatter is found, too: without it, standard errors would be a tenth of what they are. */
static void scatter_is_found(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    axes_series s = axes_series_take(&settings, 3, 1);
    weft_axes_report report = calibrate(&s);
    const weft_poses_file *file = &report.file;
    print_message("scatter %.4f degrees, %.4f mm, %.4f pixels\n", weft_deg_of_rad(file->scatter_rad), file->scatter_mm,
                  file->point_px);
    assert_true(fabs(weft_deg_of_rad(file->scatter_rad) / 0.05 - 1) < 0.3);
    assert_true(fabs(file->scatter_mm / 0.1 - 1) < 0.3);
    assert_true(fabs(file->point_px / 0.01 - 1) < 0.5);
    assert_true(file->held_out_rms_px > file->rms_px && file->held_out_rms_px < 1.5 * file->rms_px);
    weft_axes_report_free(&report);
}

/* The wobble has a third harmonic that the model has not. */
static void bearings_are_found_where_they_are_told(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    settings.axis_scale = 0.002;
    settings.axis_uneven_deg = settings.axis_wobble_deg = 0.1;
    settings.viewpoint_rotation_deg = 0.01;
    settings.viewpoint_translation_mm = 0.02;
    axes_series s = axes_series_take(&settings, 1, 1);
    weft_axes_report report = calibrate(&s);
    errors e = compare(&s, &report);
    const weft_joint *phi = &report.file.poses.joint[WEFT_CAMERA_PHI];
    double uneven_deg = weft_deg_of_rad(hypot(phi->uneven[0], phi->uneven[1]));
    double wobble_deg = weft_deg_of_rad(hypot(phi->wobble[2], phi->wobble[3]));
    print_message("scale %.5f, uneven %.4f, wobble %.4f degrees; views off by %.4f degrees\n", phi->scale, uneven_deg,
                  wobble_deg, e.view_deg);
    assert_true(fabs(fabs(phi->scale) - 0.002) < 0.0003);
    assert_true(fabs(uneven_deg - 0.1) < 0.03);
    /* A lean to and fro in one plane, of the part that carries the joint, is two that go round, of half of it: one of
     * them is only another line, the other goes round twice for the part that is carried. */
    assert_true(fabs(wobble_deg - 0.05) < 0.02);
    assert_true(e.view_deg < 0.05);
    /* An axis that turns by 75 degrees says little of what comes once a turn, and that is told. */
    assert_false(report.fit.terms.free[weft_term_index(WEFT_TERM_WOBBLE, WEFT_CAMERA_THETA)]);
    assert_true(report.undetermined.count >= 2);
    weft_axes_report_free(&report);
}

/* Somebody touches the target for one shot. */
static void a_bumped_target_is_left_out(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    axes_series s = axes_series_take(&settings, 2, 1);
    for (int i = 0; i < WEFT_AXES_POINTS; i++)
        s.shot[7].point[i].pixel[0] += 8;
    weft_axes_report report = calibrate(&s);
    assert_int_equal(report.used, SHOTS - 1);
    assert_non_null(strstr(s.shot[7].left_out, "it was moved"));
    assert_true(report.file.rms_px < 1);
    weft_axes_report_free(&report);
}

/* A lens that is 1 % too long, with a middle 6 pixels off. */
static void the_lens_is_found_where_it_may(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    settings.focal_length_error = 0.01;
    settings.principal_point_error_px = 6;
    settings.viewpoint_rotation_deg = 0.01;
    settings.viewpoint_translation_mm = 0.02;
    axes_series s = axes_series_take(&settings, 4, 1);
    weft_axes_report report;
    weft_error error = {0};
    assert_int_equal(weft_axes_calibrate(s.shot, SHOTS, &s.nominal, true, &report, &error), WEFT_OK);
    const weft_camera *found = &report.file.poses.camera, *truth = &s.world.camera;
    print_message("fx %.2f (%.2f), cx %.2f (%.2f), standard errors %.2f %.2f\n", found->fx, truth->fx, found->cx,
                  truth->cx, report.file.lens_error[0], report.file.lens_error[2]);
    assert_true(report.file.lens_error[0] > 0);
    assert_true(fabs(found->fx - truth->fx) < 4 * report.file.lens_error[0]);
    assert_true(fabs(found->cx - truth->cx) < 4 * report.file.lens_error[2]);
    assert_true(fabs(found->fx / truth->fx - 1) < 0.003);
    weft_axes_report_free(&report);
}

/* The same goniometer, told as an arm and a turntable: a sample that turns by s is seen from phi - s. */
static void a_turntable_is_found(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    settings.viewpoint_rotation_deg = settings.viewpoint_translation_mm = 0;
    axes_series s = axes_series_take(&settings, 5, 1);
    for (int i = 0; i < SHOTS; i++) {
        s.shot[i].turns.deg[WEFT_SAMPLE_PHI] = -s.shot[i].turns.deg[WEFT_CAMERA_PHI];
        s.shot[i].turns.deg[WEFT_CAMERA_PHI] = 0;
    }
    weft_axes_report report = calibrate(&s);
    weft_virtual_world rest = axes_at_rest(&s.world);
    weft_pose turn = axes_true_turn(&rest, axes_degrees(0, 0), axes_degrees(0, 90));
    weft_vec3 truth = weft_scale(axes_direction(&turn), -1);
    assert_true(axes_angle_deg(truth, report.file.poses.joint[WEFT_SAMPLE_PHI].direction) < 0.005);
    assert_true(report.file.error[WEFT_CAMERA_PHI].direction_rad == 0);
    assert_string_equal(report.undetermined.line[0],
                        "camera phi does not turn in these shots: its line is as specified");
    weft_turns turns;
    assert_true(weft_axes_turns_like(s.shot, SHOTS, axes_degrees(50, 100), &turns));
    assert_true(fabs(turns.deg[WEFT_CAMERA_THETA] - 50) < 1e-9 && fabs(turns.deg[WEFT_SAMPLE_PHI] + 100) < 1e-9);
    /* A turntable that goes from 0 to 360 stands at 290 where another stands at -70. */
    for (int i = 0; i < SHOTS; i++)
        s.shot[i].turns.deg[WEFT_SAMPLE_PHI] += 180;
    assert_true(weft_axes_turns_like(s.shot, SHOTS, axes_degrees(50, 70), &turns));
    assert_true(fabs(turns.deg[WEFT_SAMPLE_PHI] - 290) < 1e-9);
    assert_false(weft_axes_turns_like(s.shot, 1, axes_degrees(50, 70), &turns));
    weft_axes_report_free(&report);
}

/* What is not seen is not known, and is the worst, whatever is known of the other poses. */
static void what_is_expected_is_the_worst_and_the_median(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    axes_series s = axes_series_take(&settings, 7, 1);
    weft_axes_report report = calibrate(&s);
    /* From the zenith the opening is in front of this camera; from the side it is not. */
    const weft_turns turns[] = {{{0, 0, 0}}, {{170, 0, 0}}, {{10, 0, 0}}};
    weft_expectation e;
    weft_error error = {0};
    /* The worst comes first, so that neither end stands for all. */
    const weft_turns steep_first[] = {{{75, 0, 0}}, {{0, 0, 0}}, {{40, 0, 0}}};
    weft_expected_pose one[3];
    for (int i = 0; i < 3; i++)
        one[i] = weft_axes_expect_pose(&report.fit, &s.nominal, 36, TEXELS, &steep_first[i]);
    assert_true(one[0].texels > one[2].texels && one[2].texels > one[1].texels);
    assert_int_equal(weft_axes_expect(&report.fit, &s.nominal, 36, TEXELS, steep_first, 3, &e, &error), WEFT_OK);
    assert_true(e.worst.texels == one[0].texels && e.median_texels == one[2].texels);
    assert_true(e.direction_rad == fmax(one[0].direction_rad, fmax(one[1].direction_rad, one[2].direction_rad)));
    assert_true(one[2].direction_rad < e.direction_rad);
    report.fit.poses.home.translation.z = 1;
    assert_int_equal(weft_axes_expect(&report.fit, &s.nominal, 36, TEXELS, turns, 3, &e, &error), WEFT_OK);
    assert_true(isinf(e.worst.texels) && e.worst.turns.deg[0] == 170);
    weft_axes_report_free(&report);
}

static void shots_that_tell_too_little_are_refused(void **state)
{
    (void)state;
    weft_virtual_settings settings = axes_off_settings();
    axes_series s = axes_series_take(&settings, 6, 1);
    weft_axes_report report;
    weft_error error = {0};
    assert_int_equal(weft_axes_calibrate(s.shot, 7, &s.nominal, false, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "found in 7 of 7 shots: at least 8"));
    weft_axes_report_free(&report);
    for (int i = 0; i < SHOTS; i++)
        axes_see(&s.world, axes_degrees(30, 40), i, &s.shot[i]);
    assert_int_equal(weft_axes_calibrate(s.shot, SHOTS, &s.nominal, false, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "all 20 shots are of one pose"));
    weft_axes_report_free(&report);
}

/* Without errors a goniometer is where the view says, and lines through the origin say the same. */
static void a_perfect_rig_is_the_nominal_one(void **state)
{
    (void)state;
    weft_virtual_settings settings = weft_virtual_settings_default();
    weft_camera camera = weft_rig_settings_camera(&settings.rig);
    weft_rig_poses nominal = weft_rig_poses_nominal(&camera, 500);
    settings.axes = 1;
    settings.mounting_rotation_deg = settings.mounting_translation_mm = 0;
    settings.viewpoint_rotation_deg = settings.viewpoint_translation_mm = 0;
    weft_virtual_world world = weft_virtual_world_of_camera(&settings, 1, 0);
    for (int i = 0; i < WEFT_UBO81_COUNT; i++) {
        weft_angles view = weft_ubo81_angles(i);
        weft_turns turns = weft_turns_of_view(view);
        weft_pose by_view = weft_pose_of_view(view, 500), by_parts = weft_virtual_world_pose(&world, view, 0);
        weft_pose by_lines = weft_rig_poses_at(&nominal, &turns);
        for (int k = 0; k < 9; k++) {
            assert_true(fabs(by_parts.rotation[k / 3][k % 3] - by_view.rotation[k / 3][k % 3]) < 1e-9);
            assert_true(fabs(by_lines.rotation[k / 3][k % 3] - by_view.rotation[k / 3][k % 3]) < 1e-9);
        }
        assert_true(weft_length(weft_subtract(by_parts.translation, by_view.translation)) < 1e-6);
        assert_true(weft_length(weft_subtract(by_lines.translation, by_view.translation)) < 1e-6);
    }
}

int test_axes(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_perfect_rig_is_the_nominal_one),
        cmocka_unit_test(lines_are_found),
        cmocka_unit_test(scatter_is_found),
        cmocka_unit_test(bearings_are_found_where_they_are_told),
        cmocka_unit_test(a_bumped_target_is_left_out),
        cmocka_unit_test(the_lens_is_found_where_it_may),
        cmocka_unit_test(a_turntable_is_found),
        cmocka_unit_test(what_is_expected_is_the_worst_and_the_median),
        cmocka_unit_test(shots_that_tell_too_little_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
