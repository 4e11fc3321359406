/* The printed sheet, seen by tools that are not ours: poppler and librsvg make pixels of the files, OpenCV finds the
 * markers in them. */
#include "base/picture/image.h"
#include "btf/direction/direction.h"
#include "btf/session/camera.h"
#include "btf/session/target.h"
#include "capture/print/sheets.h"
#include "registration/pose/opencv_bridge.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DPI = 300, WIDE = 3000, HIGH = 2000 };

static const double mm_per_dot = 25.4 / DPI;

typedef struct raster {
    int width, height;
    uint8_t *grey;
} raster;

static void run(const char *command)
{
    if (system(command) != 0)
        fail_msg("'%s' failed", command);
}

static weft_target_sheet_settings settings_with(const char *paper, double opening_mm, double ball_mm)
{
    weft_error error = {0};
    weft_target_sheet_settings settings = {.opening_mm = opening_mm, .ball_mm = ball_mm, .pin_mm = 30};
    expect_ok(weft_paper_parse(paper, &settings.paper, &error), &error);
    expect_ok(weft_target_sheet_check(&settings, &error), &error);
    return settings;
}

static weft_target_sheet_settings settings_for(const char *paper, double opening_mm)
{
    return settings_with(paper, opening_mm, 20);
}

static void print_sheet(const weft_target_sheet_settings *settings, const char *path)
{
    weft_error error = {0};
    expect_ok(weft_target_sheet_print(settings, path, &error), &error);
}

static raster load_raster(const char *path)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_image_read(path, &image, NULL, &error), &error);
    raster r = {image.width, image.height, malloc((size_t)image.width * (size_t)image.height)};
    assert_non_null(r.grey);
    for (long i = 0; i < (long)image.width * image.height; i++)
        r.grey[i] = (uint8_t)lround(255 * image.pixels[3 * i + 1]);
    weft_image_free(&image);
    return r;
}

static raster rasterised_pdf(const weft_target_sheet_settings *settings)
{
    print_sheet(settings, "sheet.pdf");
    run("pdftoppm -r 300 -gray -png -singlefile sheet.pdf sheet");
    return load_raster("sheet.png");
}

/* Of the page, whose middle is the origin, in dots: 0, 0 is the centre of the first. */
static weft_pixel dot_of(const weft_target_sheet_settings *settings, double x_mm, double y_mm)
{
    return (weft_pixel){(x_mm + settings->paper.width_mm / 2) / mm_per_dot - 0.5,
                        (settings->paper.height_mm / 2 - y_mm) / mm_per_dot - 0.5};
}

static int find(const raster *r, weft_marker *marker)
{
    int count;
    weft_error error = {0};
    expect_ok(weft_opencv_find_markers(NULL, r->grey, r->width, r->height, marker, WEFT_MARKERS_LIMIT, &count, &error),
              &error);
    return count;
}

/* Clockwise from the top left one. */
static void corner_of(const weft_target *target, int id, int corner, double place_mm[2])
{
    weft_rectangle m = weft_target_marker(target, id);
    place_mm[0] = corner == 0 || corner == 3 ? m.x0 : m.x1;
    place_mm[1] = corner < 2 ? m.y1 : m.y0;
}

static void assert_markers_at_true_size(const raster *r, const weft_target_sheet_settings *settings)
{
    weft_target target = weft_target_printed(settings->opening_mm);
    weft_marker marker[WEFT_MARKERS_LIMIT];
    assert_int_equal(find(r, marker), WEFT_SHEET_MARKER_COUNT);
    double worst = 0, along = 0, square = 0;
    for (int i = 0; i < WEFT_SHEET_MARKER_COUNT; i++) {
        assert_in_range(marker[i].id, 0, WEFT_SHEET_MARKER_COUNT - 1);
        for (int corner = 0; corner < 4; corner++) {
            double place[2];
            corner_of(&target, marker[i].id, corner, place);
            weft_pixel origin = dot_of(settings, 0, 0);
            double x = (marker[i].corner[corner][0] - origin.x) * mm_per_dot;
            double y = (origin.y - marker[i].corner[corner][1]) * mm_per_dot;
            worst = fmax(worst, hypot(x - place[0], y - place[1]));
            along += x * place[0] + y * place[1];
            square += place[0] * place[0] + place[1] * place[1];
        }
    }
    print_message("opening %.4g mm: worst corner %.4f mm, scale %.5f\n", settings->opening_mm, worst, along / square);
    assert_true(worst < 0.05);
    assert_true(fabs(along / square - 1) < 3e-4); /* poppler rounds edges to a quarter of a dot */
}

static void every_marker_lies_where_the_drawing_says(void **state)
{
    (void)state;
    const struct {
        const char *paper;
        double opening_mm, expected_mm;
    } sheet[] = {{"A4", 0, 50}, {"letter", 0, 50}, {"A4", 51.6, 51.6}, {"a4", 40, 40}, {"150x200", 0, 36.1}};
    for (size_t i = 0; i < sizeof sheet / sizeof sheet[0]; i++) {
        weft_target_sheet_settings settings = settings_with(sheet[i].paper, sheet[i].opening_mm, 15);
        assert_true(fabs(settings.opening_mm - sheet[i].expected_mm) < 1e-9);
        raster r = rasterised_pdf(&settings);
        assert_true(fabs(r.width * mm_per_dot - settings.paper.width_mm) <= 1.01 * mm_per_dot);
        assert_true(fabs(r.height * mm_per_dot - settings.paper.height_mm) <= 1.01 * mm_per_dot);
        assert_markers_at_true_size(&r, &settings);
        free(r.grey);
    }
}

static void an_svg_has_the_same_size(void **state)
{
    (void)state;
    weft_target_sheet_settings settings = settings_for("A4", 0);
    if (system("command -v rsvg-convert >/dev/null") != 0) {
        print_message("no rsvg-convert: the SVG is not looked at\n");
        skip();
    }
    print_sheet(&settings, "sheet.svg");
    run("rsvg-convert -d 300 -p 300 -b white sheet.svg -o svg.png");
    raster r = load_raster("svg.png");
    assert_true(fabs(r.width * mm_per_dot - settings.paper.width_mm) <= 1.01 * mm_per_dot);
    assert_markers_at_true_size(&r, &settings);
    free(r.grey);
}

/* Whether all of the drawing within 0.2 mm of a point has one reflectance. */
static bool is_plain(const weft_target *target, double x, double y, double value)
{
    for (int i = 0; i < 8; i++) {
        double dx = 0.2 * cos(i * WEFT_PI / 4), dy = 0.2 * sin(i * WEFT_PI / 4);
        if (weft_target_reflectance(target, x + dx, y + dy) != value)
            return false;
    }
    return true;
}

static void nothing_but_the_drawing_is_inside_the_plate(void **state)
{
    (void)state;
    weft_target_sheet_settings settings = settings_for("A4", 0);
    weft_target target = weft_target_printed(settings.opening_mm);
    raster r = rasterised_pdf(&settings);
    long wrong = 0, seen = 0, ink = 0;
    for (int row = 0; row < r.height; row++) {
        for (int column = 0; column < r.width; column++) {
            weft_pixel origin = dot_of(&settings, 0, 0);
            double x = (column - origin.x) * mm_per_dot, y = (origin.y - row) * mm_per_dot;
            double value = weft_target_reflectance(&target, x, y);
            if (value == 0 || !is_plain(&target, x, y, value))
                continue;
            seen++;
            ink += value == target.ink_reflectance;
            wrong += r.grey[(long)row * r.width + column] != (value == target.ink_reflectance ? 0 : 255);
        }
    }
    assert_true(seen > 2000000 && ink > 500000);
    assert_int_equal(wrong, 0);
    free(r.grey);
}

/* Middles of the dark runs along a line of dots. */
static int dark_runs(const uint8_t *first, long stride, int length, double *middle, int limit)
{
    int count = 0;
    for (int at = 0; at < length; at++) {
        int begin = at;
        while (at < length && first[at * stride] < 128)
            at++;
        if (at > begin && count < limit)
            middle[count++] = (begin + at - 1) / 2.0;
    }
    return count;
}

/* Whether the line crosses nothing but 11 ticks 10 mm apart: then their whole length, else 0. */
static double bar_across(const uint8_t *first, long stride, int length)
{
    double middle[64];
    if (dark_runs(first, stride, length, middle, 64) != 11)
        return 0;
    for (int i = 1; i < 11; i++)
        if (fabs((middle[i] - middle[i - 1]) * mm_per_dot - 10) > 0.15)
            return 0;
    return (middle[10] - middle[0]) * mm_per_dot;
}

static void both_bars_measure_100_mm(void **state)
{
    (void)state;
    weft_target_sheet_settings settings = settings_for("A4", 0);
    raster r = rasterised_pdf(&settings);
    double along = 0, across = 0;
    for (int row = r.height / 2; row < r.height; row++)
        across = fmax(across, bar_across(r.grey + (long)row * r.width, 1, r.width));
    for (int column = 0; column < r.width / 4; column++) /* past labels above and below */
        along = fmax(along, bar_across(r.grey + column + (long)r.width * r.height / 4, r.width, r.height / 2));
    print_message("bars of %.3f and %.3f mm\n", across, along);
    assert_true(fabs(across - 100) < 0.1);
    assert_true(fabs(along - 100) < 0.1);
    free(r.grey);
}

/* ---- A camera that looks at it ---- */

static double noise_of(unsigned *state)
{
    double sum = 0;
    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525u + 1013904223u;
        sum += *state / 4294967296.0;
    }
    return sum - 6;
}

static bool sheet_is_inside(const weft_camera *camera, const weft_homography *h, const weft_rectangle *sheet)
{
    for (int corner = 0; corner < 4; corner++) {
        weft_pixel p = weft_homography_apply(h, corner & 1 ? sheet->x0 : sheet->x1, corner & 2 ? sheet->y0 : sheet->y1);
        if (!(p.x > 20 && p.y > 20 && p.x < camera->width - 20 && p.y < camera->height - 20))
            return false;
    }
    return true;
}

/* From as near as shows the whole sheet. */
static weft_homography look_from(const weft_camera *camera, weft_angles view, const weft_rectangle *sheet)
{
    double distance = 100;
    weft_homography h;
    do {
        distance *= 1.01;
        weft_pose pose = weft_pose_of_view(view, distance);
        h = weft_homography_of_pose(camera, &pose);
    } while (distance < 2000 && (distance < sheet->y1 * 1.2 || !sheet_is_inside(camera, &h, sheet)));
    return h;
}

enum { SUBPIXELS = 4 };

/* `back` leads from a pixel to a dot of the page. */
static double area_of(const raster *r, const weft_homography *back, int x, int y)
{
    double sum = 0;
    for (int i = 0; i < SUBPIXELS * SUBPIXELS; i++) {
        weft_pixel dot = weft_homography_apply(back, x + (i % SUBPIXELS + 0.5) / SUBPIXELS - 0.5,
                                               y + (i / SUBPIXELS + 0.5) / SUBPIXELS - 0.5);
        bool on_paper = dot.x >= 0 && dot.y >= 0 && dot.x < r->width - 1 && dot.y < r->height - 1;
        sum += on_paper ? r->grey[(long)(dot.y + 0.5) * r->width + (long)(dot.x + 0.5)] : 60; /* a table */
    }
    return sum / (SUBPIXELS * SUBPIXELS);
}

/* From a pixel to a dot of the page, where `h` leads from the page in mm to a pixel. */
static weft_homography dots_of(const weft_target_sheet_settings *s, const weft_homography *h)
{
    weft_homography back = weft_homography_inverse(h);
    weft_pixel origin = dot_of(s, 0, 0);
    for (int k = 0; k < 3; k++) {
        back.m[0][k] = back.m[0][k] / mm_per_dot + origin.x * back.m[2][k];
        back.m[1][k] = -back.m[1][k] / mm_per_dot + origin.y * back.m[2][k];
    }
    return back;
}

/* Paper at 180 of 255, falling off to one side as under a lamp, with noise of 3. */
static void photograph(const raster *r, const weft_target_sheet_settings *s, const weft_homography *h, raster *picture)
{
    weft_homography back = dots_of(s, h);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < HIGH; y++) {
        unsigned state = (unsigned)y * 2654435761u + 1;
        for (int x = 0; x < WIDE; x++) {
            double light = 0.7 * (1 - 0.4 * x / WIDE), value = 8 + area_of(r, &back, x, y);
            picture->grey[(long)y * WIDE + x] = (uint8_t)fmin(255, fmax(0, light * value + 3 * noise_of(&state)));
        }
    }
}

static double worst_corner_px(const raster *picture, const weft_target *target, const weft_homography *h)
{
    weft_marker marker[WEFT_MARKERS_LIMIT];
    int count = find(picture, marker), found = 0;
    double worst = 0;
    for (int i = 0; i < count; i++) {
        if (marker[i].id >= WEFT_SHEET_MARKER_COUNT)
            continue;
        found++;
        for (int corner = 0; corner < 4; corner++) {
            double place[2];
            corner_of(target, marker[i].id, corner, place);
            weft_pixel p = weft_homography_apply(h, place[0], place[1]);
            worst = fmax(worst, hypot(p.x - marker[i].corner[corner][0], p.y - marker[i].corner[corner][1]));
        }
    }
    if (found != WEFT_SHEET_MARKER_COUNT)
        print_message("only %d markers\n", found);
    return found == WEFT_SHEET_MARKER_COUNT ? worst : INFINITY;
}

/* Of any sheet, at any opening: the bars, the balls and what is written keep off the markers and the paper that their
 * finder needs round them. */
static void nothing_runs_into_a_marker(void **state)
{
    (void)state;
    static const struct {
        const char *paper;
        double opening_mm, ball_mm;
    } sheet[] = {{"A4", 35, 20}, {"A4", 24, 10}, {"A4", 42, 0}, {"legal", 35, 20}, {"A5", 25, 8}};
    for (size_t i = 0; i < sizeof sheet / sizeof sheet[0]; i++) {
        weft_target_sheet_settings settings = settings_with(sheet[i].paper, sheet[i].opening_mm, sheet[i].ball_mm);
        weft_target target = weft_target_printed(settings.opening_mm);
        raster r = rasterised_pdf(&settings);
        weft_pixel origin = dot_of(&settings, 0, 0);
        long wrong = 0;
        for (int id = WEFT_TARGET_MARKER_COUNT; id < WEFT_SHEET_MARKER_COUNT; id++) { /* those outside the plate */
            weft_rectangle o = weft_target_marker(&target, id);
            double cell = (o.x1 - o.x0) / 6;
            for (double y = o.y0 - 0.9 * cell; y < o.y1 + 0.9 * cell; y += mm_per_dot) {
                for (double x = o.x0 - 0.9 * cell; x < o.x1 + 0.9 * cell; x += mm_per_dot) {
                    long at = lround(origin.y - y / mm_per_dot) * r.width + lround(origin.x + x / mm_per_dot);
                    bool is_paper = x < o.x0 - 0.1 * cell || x > o.x1 + 0.1 * cell || y < o.y0 - 0.1 * cell ||
                                    y > o.y1 + 0.1 * cell;
                    wrong += is_paper && r.grey[at] < 200 &&
                             weft_target_sheet_reflectance(&target, x, y) != target.ink_reflectance;
                }
            }
        }
        if (wrong > 0)
            fail_msg("%ld dots too many on %s with an opening of %g mm", wrong, sheet[i].paper, sheet[i].opening_mm);
        free(r.grey);
    }
}

/* Who has neither balls nor a pin prints neither, and gets a larger opening on the same paper. */
static void a_sheet_may_have_neither_balls_nor_pin(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_target_sheet_settings settings = {.opening_mm = 40};
    expect_ok(weft_paper_parse("A3", &settings.paper, &error), &error);
    expect_ok(weft_target_sheet_check(&settings, &error), &error);
    print_sheet(&settings, "bare.pdf");
    run("pdftotext bare.pdf bare.txt && ! grep -qi 'mirror ball\\|pin, \\|balls [0-9]* mm' bare.txt");
    run("grep -q -e '--balls 0 --pin 0' bare.txt && grep -q 'opening 40 mm' bare.txt");
}

static void every_corner_is_found_from_75_degrees(void **state)
{
    (void)state;
    weft_target_sheet_settings settings = settings_for("A4", 0);
    weft_target target = weft_target_printed(settings.opening_mm);
    weft_rectangle sheet = weft_target_sheet(&target);
    weft_camera camera = {.width = WIDE, .height = HIGH, .fx = 3600, .fy = 3600, .cx = 1499.5, .cy = 999.5};
    raster r = rasterised_pdf(&settings), picture = {WIDE, HIGH, malloc((size_t)WIDE * HIGH)};
    assert_non_null(picture.grey);
    double worst = 0;
    for (int azimuth = 10; azimuth < 360; azimuth += 90) {
        weft_angles view = {weft_rad_of_deg(75), weft_rad_of_deg(azimuth)};
        weft_homography h = look_from(&camera, view, &sheet);
        photograph(&r, &settings, &h, &picture);
        double here = worst_corner_px(&picture, &target, &h);
        print_message("azimuth %d: worst corner %.2f pixels\n", azimuth, here);
        worst = fmax(worst, here);
    }
    assert_true(worst < 1);
    free(picture.grey);
    free(r.grey);
}

/* ---- The pin ---- */

/* Where the lamp throws the shadow of a place above the sheet. */
static weft_pixel shadow_of(const double foot[2], double height, weft_vec3 lamp)
{
    double part = height / (lamp.z - height);
    return (weft_pixel){foot[0] + (foot[0] - lamp.x) * part, foot[1] + (foot[1] - lamp.y) * part};
}

static bool is_inside(weft_rectangle r, weft_pixel place, double margin)
{
    return place.x > r.x0 - margin && place.x < r.x1 + margin && place.y > r.y0 - margin && place.y < r.y1 + margin;
}

/* As docs/guide/target.md says of a sheet with the default opening and a pin of 30 mm. */
static void the_shadow_of_the_pin_ends_on_the_sheet_and_not_on_the_sample(void **state)
{
    (void)state;
    weft_target target = weft_target_printed(weft_target_default_opening_mm);
    weft_rectangle sheet = weft_target_sheet(&target);
    double foot[2], half = target.opening_mm / 2;
    weft_target_pin(&target, foot);
    for (int azimuth = 0; azimuth < 360; azimuth += 5) {
        weft_angles high = {weft_rad_of_deg(35), weft_rad_of_deg(azimuth)}, low = {weft_rad_of_deg(65), high.phi_rad};
        weft_pixel end = shadow_of(foot, 28.5, weft_scale(weft_direction_of_angles(high), 700));
        assert_true(is_inside(sheet, end, -1.5));
        weft_vec3 lamp = weft_scale(weft_direction_of_angles(low), 700);
        for (double height = 0; height <= 30; height += 0.5)
            assert_false(is_inside((weft_rectangle){-half, -half, half, half}, shadow_of(foot, height, lamp), 2));
    }
    for (int id = 0; id < WEFT_SHEET_MARKER_COUNT; id++)
        assert_false(is_inside(weft_target_marker(&target, id), (weft_pixel){foot[0], foot[1]}, 10));
}

/* ---- What is written, and what is refused ---- */

static void the_same_sheet_has_the_same_bytes_and_says_what_to_do(void **state)
{
    (void)state;
    weft_target_sheet_settings settings = settings_for("A4", 0);
    print_sheet(&settings, "a.pdf");
    print_sheet(&settings, "b.pdf");
    run("cmp a.pdf b.pdf && grep -aq 'CreationDate (19700101000000Z)' a.pdf");
    setenv("SOURCE_DATE_EPOCH", "86400", 1);
    print_sheet(&settings, "b.pdf");
    unsetenv("SOURCE_DATE_EPOCH");
    run("grep -aq 'CreationDate (19700102000000Z)' b.pdf");
    run("pdftotext -layout a.pdf a.txt && grep -q 'at 100 %' a.txt && grep -q 'ruler' a.txt && "
        "grep -q -- '--opening 50' a.txt && grep -q 'mirror ball, 20 mm' a.txt && grep -q 'pin, 30 mm' a.txt && "
        "grep -q 'paper A4' a.txt");
    print_sheet(&settings, "a.svg");
    print_sheet(&settings, "b.svg");
    /* Cairo counts the surfaces of a process in the names that it gives them in an SVG. */
    run("sed -i 's/surface[0-9]*//' a.svg b.svg && cmp a.svg b.svg");
}

static void assert_refused(const char *paper, double opening_mm, double ball_mm, const char *word)
{
    weft_error error = {0};
    weft_target_sheet_settings settings = {.opening_mm = opening_mm, .ball_mm = ball_mm, .pin_mm = 30};
    expect_ok(weft_paper_parse(paper, &settings.paper, &error), &error);
    assert_int_equal(weft_target_sheet_check(&settings, &error), WEFT_BAD_USAGE);
    if (!strstr(error.message, word))
        fail_msg("'%s' does not say '%s'", error.message, word);
}

static void what_does_not_fit_is_refused_with_the_largest_that_does(void **state)
{
    (void)state;
    assert_refused("A4", 51.7, 20, "the largest that fits is 51.6");
    assert_refused("letter", 52, 20, "the largest that fits is 51.3");
    assert_refused("60x80", 0, 20, "too small");
    assert_refused("A4", 50, 45, "the largest is ");
    weft_paper paper;
    const char *const bad[] = {"A5x", "A6", "200", "200x", "200x300x2", "-200x300", "nanx300", "1e9x1e9", ""};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_int_equal(weft_paper_parse(bad[i], &paper, NULL), WEFT_BAD_USAGE);
}

int test_print(void)
{
    if (system("command -v pdftoppm >/dev/null && command -v pdftotext >/dev/null") != 0) {
        puts("skipped: there is no pdftoppm");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_marker_lies_where_the_drawing_says),
        cmocka_unit_test(an_svg_has_the_same_size),
        cmocka_unit_test(nothing_but_the_drawing_is_inside_the_plate),
        cmocka_unit_test(both_bars_measure_100_mm),
        cmocka_unit_test(nothing_runs_into_a_marker),
        cmocka_unit_test(a_sheet_may_have_neither_balls_nor_pin),
        cmocka_unit_test(every_corner_is_found_from_75_degrees),
        cmocka_unit_test(the_shadow_of_the_pin_ends_on_the_sheet_and_not_on_the_sample),
        cmocka_unit_test(the_same_sheet_has_the_same_bytes_and_says_what_to_do),
        cmocka_unit_test(what_does_not_fit_is_refused_with_the_largest_that_does),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
