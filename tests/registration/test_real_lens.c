/* The lenses of photographs that others took, against what was published of them. */
#include "registration/lens/calibration.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define REAL WEFT_SHARED "/real/"

static void add(weft_lines *names, const char *format, int number)
{
    char name[512];
    weft_error error = {0};
    snprintf(name, sizeof name, format, number);
    if (access(name, R_OK) == 0)
        expect_ok(weft_lines_add(names, &error, "%s", name), &error);
}

static weft_code calibrate(const char *board, bool full, weft_lines *names, weft_lens_report *report, weft_error *error)
{
    weft_lens_settings settings = {.full_model = full};
    expect_ok(weft_board_parse(board, &settings.board, error), error);
    weft_code code = weft_lens_calibrate(&settings, names, NULL, report, error);
    if (code == WEFT_OK)
        print_message("%s: %d used, RMS %.3f, fx %.2f fy %.2f cx %.2f cy %.2f k1 %.4f, focal length to %.2f %%\n",
                      board, report->used, report->lens.rms_px, report->lens.camera.fx, report->lens.camera.fy,
                      report->lens.camera.cx, report->lens.camera.cy, report->lens.camera.k1,
                      100 * report->focal_error);
    return code;
}

/* left_intrinsics.yml: fx = fy = 535.916, cx 342.283, cy 235.571, k1 -0.26637; 0.409 pixels is what OpenCV's own
 * refinement and calibration come to. */
static void opencv_s_chessboard_series(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lines names = {0};
    weft_lens_report chosen, full;
    for (int i = 1; i <= 14; i++)
        add(&names, REAL "target-chessboard/left%02d.jpg", i);
    expect_ok(calibrate("chessboard:9x6:25", false, &names, &chosen, &error), &error);
    expect_ok(calibrate("chessboard:9x6:25", true, &names, &full, &error), &error);
    const weft_camera *c = &chosen.lens.camera;
    assert_int_equal(chosen.used, 13);
    assert_true(chosen.lens.rms_px < 0.25 && chosen.lens.rms_px < 1.01 * full.lens.rms_px);
    assert_true(fabs(c->fx / 535.916 - 1) < 0.005 && fabs(c->fy / 535.916 - 1) < 0.005);
    assert_true(fabs(c->cx - 342.283) < 1.5 && fabs(c->cy - 235.571) < 2);
    assert_true(fabs(c->k1 - -0.26637) < 0.02);
    assert_int_equal(chosen.warnings.count, 0);
    weft_lens_report_free(&chosen);
    weft_lens_report_free(&full);
    weft_lines_free(&names);
}

/* tutorial_camera_charuco.yml: fx 452.51, fy 456.77. The four views differ by five degrees: they hardly tell. */
static void four_charuco_views_say_how_little_they_tell(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lines names = {0};
    weft_lens_report report;
    for (int i = 0; i < 4; i++)
        add(&names, REAL "target-charuco/img_%02d.jpg", i);
    expect_ok(calibrate("charuco:5x7:40,20:6X6_250", false, &names, &report, &error), &error);
    assert_int_equal(report.used, 4);
    assert_true(report.point_count >= 89);
    assert_true(report.lens.rms_px < 0.2);
    assert_true(fabs(report.lens.camera.fx - 452.51) < 2 * report.lens.standard_error[0]);
    assert_true(fabs(report.lens.camera.fx / 452.51 - 1) < 0.03);
    assert_true(report.focal_error > 0.01 && report.warnings.count >= 3);
    weft_lens_report_free(&report);
    weft_lines_free(&names);
}

/* Other markers, other boards and a sheet that is not flat among them: only photographs of the board are used. */
static void what_shows_another_board_is_left_out(void **state)
{
    (void)state;
    const char *const others[] = {"choriginal_2014.png", "gboriginal.jpg", "singlemarkersoriginal.jpg",
                                  "diamondmarkers.png"};
    weft_error error = {0};
    weft_lines names = {0};
    weft_lens_report report;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        expect_ok(weft_lines_add(&names, &error, REAL "target-charuco/%s", others[i]), &error);
    assert_int_equal(calibrate("charuco:5x7:40,20:6X6_250", false, &names, &report, &error), WEFT_BAD_INPUT);
    for (int i = 0; i < report.count; i++)
        assert_non_null(report.photograph[i].left_out);
    weft_lens_report_free(&report);
    weft_lines_free(&names);
}

/* One tag on a turntable, in the middle of the photographs: the lens beyond is a guess, and is said to be. */
static void a_tag_on_a_turntable(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lines names = {0};
    weft_lens_report report;
    for (int angle = -70; angle <= 70; angle += 10)
        add(&names, REAL "target-apriltag/test_image_rotation_%d.png", angle);
    expect_ok(calibrate("apriltag:1x1:65", false, &names, &report, &error), &error);
    assert_int_equal(report.used, 14);
    assert_true(report.lens.rms_px < 0.3);
    assert_true(fabs(report.lens.camera.fx / 329.873 - 1) < 0.05);
    assert_true(report.reach < 0.3 && report.warnings.count >= 1);
    weft_lens_report_free(&report);
    weft_lines_free(&names);
}

int test_real_lens(void)
{
    if (access(REAL "target-chessboard/left01.jpg", R_OK) != 0) {
        puts("skipped: the photographs of boards are not there");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opencv_s_chessboard_series),
        cmocka_unit_test(four_charuco_views_say_how_little_they_tell),
        cmocka_unit_test(what_shows_another_board_is_left_out),
        cmocka_unit_test(a_tag_on_a_turntable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
