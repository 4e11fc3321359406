/* Lenses found again: of photographs that are made here of the printed pages, as poppler rasterises them, and of real
 * ones. What makes the photographs shares the formula of distortion with OpenCV, and nothing else. */
#include "base/picture/image.h"
#include "btf/session/target.h"
#include "capture/print/sheets.h"
#include "registration/lens/calibration.h"
#include "tests/registration/plate.h"
#include "tests/support/expect_ok.h"
#include "tests/support/run_weft.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDE = 960, HIGH = 720, DPI = 300, CELLS = (WIDE + 1) * (HIGH + 1) };

static const weft_camera truth = {.width = WIDE,
                                  .height = HIGH,
                                  .fx = 880,
                                  .fy = 882.4,
                                  .cx = 472,
                                  .cy = 370,
                                  .k1 = -0.12,
                                  .k2 = 0.06,
                                  .p1 = 0.0009,
                                  .p2 = -0.0007};

static float (*rays)[2]; /* [CELLS]: undistorted pixels of the corners of the camera's pixels */

typedef struct printed_page {
    double width_mm, height_mm;
    weft_image image;
} printed_page;

static printed_page board_page, sheet_page;
static char board_text[64];

static void rasterise(const weft_paper *paper, printed_page *made)
{
    weft_error error = {0};
    *made = (printed_page){.width_mm = paper->width_mm, .height_mm = paper->height_mm};
    if (system("pdftoppm -r 300 -gray -png -singlefile page.pdf page") != 0)
        fail_msg("pdftoppm failed");
    expect_ok(weft_image_read("page.png", &made->image, NULL, &error), &error);
}

static void print_pages(void)
{
    weft_error error = {0};
    weft_paper paper;
    weft_lens_board board;
    expect_ok(weft_paper_parse("A4", &paper, &error), &error);
    expect_ok(weft_lens_board_for(&paper, &board, &error), &error);
    expect_ok(weft_lens_board_print(&board, "page.pdf", &error), &error);
    strcpy(board_text, board.text);
    rasterise(&paper, &board_page);
    weft_target_sheet_settings sheet = {.paper = paper, .ball_mm = 20, .pin_mm = 30};
    expect_ok(weft_target_sheet_check(&sheet, &error), &error);
    expect_ok(weft_target_sheet_print(&sheet, "page.pdf", &error), &error);
    rasterise(&paper, &sheet_page);
}

static int set_up(void **state)
{
    scratch_folder_enter(state);
    print_pages();
    rays = malloc(CELLS * sizeof *rays);
    assert_non_null(rays);
    for (int i = 0; i < CELLS; i++) {
        weft_pixel at = {i % (WIDE + 1) - 0.5, i / (WIDE + 1) - 0.5}, in = weft_camera_undistort(&truth, at);
        rays[i][0] = (float)((in.x - truth.cx) / truth.fx);
        rays[i][1] = (float)((in.y - truth.cy) / truth.fy);
    }
    return 0;
}

static int tear_down(void **state)
{
    free(rays);
    weft_image_free(&board_page.image);
    weft_image_free(&sheet_page.image);
    return scratch_folder_leave(state);
}

/* ---- A camera in the hand ---- */

typedef struct shot {
    const printed_page *page;
    double tilt_deg, azimuth_deg, distance_mm, right_mm, down_mm; /* the last two: of the page, in the camera's frame */
    double blur_px;                                               /* side of the square that a pixel gathers from */
    double bend_mm;                                               /* how far the middle of the page stands up */
} shot;

/* Grey of the page, of a table beside it. */
static double page_at(const printed_page *page, double x, double y)
{
    double column = (x + page->width_mm / 2) * (DPI / 25.4), row = (page->height_mm / 2 - y) * (DPI / 25.4);
    bool inside = column >= 0 && row >= 0 && column < page->image.width && row < page->image.height;
    return inside ? 25 + 190 * (double)page->image.pixels[3 * ((long)row * page->image.width + (long)column)] : 90;
}

/* Where a ray of the camera meets the page, which is bent along x. */
static double see(const shot *s, weft_vec3 from, weft_vec3 along)
{
    double x = 0, y = 0, z = 0;
    for (int i = 0; i < (s->bend_mm > 0 ? 6 : 1); i++) {
        double t = (z - from.z) / along.z, across;
        x = from.x + t * along.x;
        y = from.y + t * along.y;
        across = 2 * x / s->page->width_mm;
        z = s->bend_mm * fmax(0, 1 - across * across);
    }
    return page_at(s->page, x, y);
}

/* The ray of a corner of a pixel, in the frame of the page. */
static weft_vec3 turned(const weft_pose *pose, const float ray[2])
{
    const double(*r)[3] = pose->rotation;
    double x = (double)ray[0], y = (double)ray[1];
    return weft_vec3_of(r[0][0] * x + r[1][0] * y + r[2][0], r[0][1] * x + r[1][1] * y + r[2][1],
                        r[0][2] * x + r[1][2] * y + r[2][2]);
}

static double gather(const shot *s, const weft_pose *pose, weft_vec3 from, int column, int row)
{
    int samples = s->blur_px > 4 ? 8 : 3;
    const float(*ray)[2] = (const float(*)[2])rays + (long)row * (WIDE + 1) + column;
    weft_vec3 corner = turned(pose, ray[0]);
    weft_vec3 right = weft_subtract(turned(pose, ray[1]), corner);
    weft_vec3 down = weft_subtract(turned(pose, ray[WIDE + 1]), corner);
    double sum = 0;
    for (int i = 0; i < samples * samples; i++) {
        double u = 0.5 + s->blur_px * ((i % samples + 0.5) / samples - 0.5);
        double v = 0.5 + s->blur_px * ((i / samples + 0.5) / samples - 0.5);
        sum += see(s, from, weft_add(corner, weft_add(weft_scale(right, u), weft_scale(down, v))));
    }
    return sum / (samples * samples);
}

static void take(const shot *s, const char *name)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_image_create(WIDE, HIGH, &image, &error), &error);
    weft_angles view = {weft_rad_of_deg(s->tilt_deg), weft_rad_of_deg(s->azimuth_deg)};
    weft_pose pose = weft_pose_of_view(view, s->distance_mm);
    pose.translation.x += s->right_mm;
    pose.translation.y += s->down_mm;
    weft_vec3 from = weft_pose_camera_position(&pose);
#pragma omp parallel for schedule(dynamic, 16)
    for (int row = 0; row < HIGH; row++) {
        unsigned state = (unsigned)row * 2654435761u + (unsigned)s->azimuth_deg;
        for (int column = 0; column < WIDE; column++) {
            double value = gather(s, &pose, from, column, row) + 2 * plate_normal(&state);
            for (int k = 0; k < 3; k++)
                image.pixels[3 * ((long)row * WIDE + column) + k] = (float)(value / 255);
        }
    }
    expect_ok(weft_image_write(name, &image, NULL, &error), &error);
    weft_image_free(&image);
}

static void take_named(const shot *s, weft_lines *names, const char *name)
{
    weft_error error = {0};
    take(s, name);
    expect_ok(weft_lines_add(names, &error, "%s", name), &error);
}

/* From all sides, near and far, in the middle and toward the corners. */
static weft_lines take_series(const printed_page *page, int count, double farthest_deg, double nearness, double bend_mm)
{
    weft_lines names = {0};
    for (int i = 0; i < count; i++) {
        char name[32];
        double tilt = farthest_deg * (0.35 + 0.65 * (i % 3) / 2), side = i % 4 < 2 ? -1 : 1, end = i % 2 ? -1 : 1;
        shot s = {page, tilt, 137.5 * i, (360 + 25 * (i % 3)) / nearness, 45 * side, 35 * end, 1.6, bend_mm};
        snprintf(name, sizeof name, "view%02d.png", i);
        take_named(&s, &names, name);
    }
    return names;
}

static weft_code calibrate(const char *board, bool full, const weft_lines *names, weft_lens_report *report,
                           weft_error *error)
{
    weft_lens_settings settings = {.full_model = full};
    expect_ok(weft_board_parse(board, &settings.board, error), error);
    return weft_lens_calibrate(&settings, names, NULL, report, error);
}

static bool warns(const weft_lens_report *report, const char *word)
{
    for (int i = 0; i < report->warnings.count; i++)
        if (strstr(report->warnings.line[i], word))
            return true;
    return false;
}

/* How far apart two lenses put the same direction, at most, within the photograph. */
static double apart_px(const weft_camera *a, const weft_camera *b)
{
    double worst = 0;
    for (int y = 0; y < HIGH; y += 50) {
        for (int x = 0; x < WIDE; x += 50) {
            weft_pixel at = {x, y}, in = weft_camera_undistort(a, at);
            weft_pixel same = {b->cx + b->fx * (in.x - a->cx) / a->fx, b->cy + b->fy * (in.y - a->cy) / a->fy};
            same = weft_camera_distort(b, same);
            worst = fmax(worst, hypot(same.x - at.x, same.y - at.y));
        }
    }
    return worst;
}

static void assert_lens_is_true(const weft_lens_report *report, double limit_px)
{
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++) {
        double value = weft_lens_parameter(&report->lens.camera, i), wanted = weft_lens_parameter(&truth, i);
        print_message("  %s %.5f, is %.5f, +- %.5f\n", weft_lens_parameter_name[i], value, wanted,
                      report->lens.standard_error[i]);
        if (i < 4)
            assert_true(fabs(value - wanted) < 5 * report->lens.standard_error[i]);
    }
    double apart = apart_px(&truth, &report->lens.camera);
    print_message("  RMS %.3f, pattern %.3f, noise %.3f; %.2f pixels apart at most; focal length to %.3f %%\n",
                  report->lens.rms_px, report->pattern, report->noise, apart, 100 * report->focal_error);
    assert_true(fabs(report->lens.camera.fx / truth.fx - 1) < 0.002);
    assert_true(apart < limit_px);
    for (int i = 0; i < report->warnings.count; i++)
        print_message("  %s\n", report->warnings.line[i]);
    assert_int_equal(report->warnings.count, 0);
}

static const char *reason_of(const weft_lens_report *report, const char *name)
{
    for (int i = 0; i < report->count; i++)
        if (strcmp(report->photograph[i].name, name) == 0)
            return report->photograph[i].left_out ? report->photograph[i].left_out : "";
    return "there is no such photograph";
}

static void the_lens_of_the_printed_board_is_found_and_bad_photographs_are_named(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lens_report report;
    weft_lines names = take_series(&board_page, 10, 45, 1, 0);
    take_named(&(shot){&board_page, 20, 77, 380, 0, 0, 7, 0}, &names, "blurred.png");
    take_named(&(shot){&sheet_page, 30, 10, 400, 0, 0, 1.6, 0}, &names, "other.png");
    scratch_store("broken.png", "no picture", 10);
    expect_ok(weft_lines_add(&names, &error, "broken.png"), &error);
    expect_ok(calibrate(board_text, false, &names, &report, &error), &error);
    assert_int_equal(report.used, 10);
    assert_lens_is_true(&report, 1.2);
    print_message("  blurred: %s\n", reason_of(&report, "blurred.png"));
    assert_non_null(strstr(reason_of(&report, "blurred.png"), "blurred"));
    assert_non_null(strstr(reason_of(&report, "other.png"), "no board"));
    assert_non_null(strstr(reason_of(&report, "broken.png"), "cannot be read"));
    char arguments[160];
    snprintf(arguments, sizeof arguments, "lens . --board %s --json -o lens.json", board_text);
    expect_weft(arguments, 0, "{\"event\":\"lens\",\"width\":960,");
    weft_lens_report_free(&report);
    weft_lines_free(&names);
}

static void a_photograph_that_does_not_fit_the_others_is_left_out(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lens_report report;
    weft_lines names = {0};
    for (int i = 0; i < 8; i++) /* of the series before */
        expect_ok(weft_lines_add(&names, &error, "view%02d.png", i), &error);
    shot s = {&board_page, 40, 30, 380, 0, 0, 1.6, 12}; /* the board had come off its plate */
    take_named(&s, &names, "odd.png");
    expect_ok(calibrate(board_text, false, &names, &report, &error), &error);
    print_message("  odd: %s\n", reason_of(&report, "odd.png"));
    assert_true(strstr(reason_of(&report, "odd.png"), "their predicted places") != NULL);
    assert_int_equal(report.used, 8);
    weft_lens_report_free(&report);
    weft_lines_free(&names);
}

static void the_target_itself_tells_the_lens(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lens_report report;
    weft_lines names = take_series(&sheet_page, 8, 45, 1.1, 0);
    expect_ok(calibrate("plate:50", false, &names, &report, &error), &error);
    print_message("  fx %.2f, RMS %.3f, focal length to %.3f %%\n", report.lens.camera.fx, report.lens.rms_px,
                  100 * report.focal_error);
    assert_int_equal(report.used, 8);
    assert_true(fabs(report.lens.camera.fx / truth.fx - 1) < 0.005);
    assert_true(fabs(report.lens.camera.cx - truth.cx) < 3 && fabs(report.lens.camera.cy - truth.cy) < 3);
    weft_lens_report_free(&report);
    weft_lines_free(&names);
}

static void what_the_photographs_cannot_tell_is_said(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_lens_report report;
    weft_lines names = take_series(&board_page, 4, 45, 1, 5);
    expect_ok(calibrate(board_text, false, &names, &report, &error), &error);
    print_message("  bent: RMS %.3f, pattern %.3f, noise %.3f\n", report.lens.rms_px, report.pattern, report.noise);
    assert_true(warns(&report, "flat"));
    weft_lens_report_free(&report);
    weft_lines_free(&names);
    names = take_series(&board_page, 4, 6, 0.55, 0);
    expect_ok(calibrate(board_text, false, &names, &report, &error), &error);
    assert_true(warns(&report, "few") && warns(&report, "one side") && warns(&report, "guessed beyond"));
    assert_true(warns(&report, "focal length"));
    weft_lens_report_free(&report);
    names.count = 2;
    assert_int_equal(calibrate(board_text, false, &names, &report, &error), WEFT_BAD_INPUT);
    assert_int_equal(report.count, 2);
    weft_lens_report_free(&report);
    names.count = 4;
    weft_lines_free(&names);
}

int test_lens(void)
{
    if (system("command -v pdftoppm >/dev/null") != 0) {
        puts("skipped: there is no pdftoppm");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lens_of_the_printed_board_is_found_and_bad_photographs_are_named),
        cmocka_unit_test(a_photograph_that_does_not_fit_the_others_is_left_out),
        cmocka_unit_test(the_target_itself_tells_the_lens),
        cmocka_unit_test(what_the_photographs_cannot_tell_is_said),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
