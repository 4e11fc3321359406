/* Charts of a camera with a spectrum (tests/support/spectral_colour.h), and colours that are on no chart. */
#include "btf/session/colour.h"
#include "registration/colour/calibration.h"
#include "registration/colour/difference.h"
#include "tests/support/chart_picture.h"
#include "tests/support/expect_ok.h"
#include "tests/support/run_weft.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OTHERS = 200 };

/* ---- What colours are that are on no chart ---- */

/* Linear sRGB as `colour` makes it of what the camera shows, white being 1. */
static void through(const weft_colour *colour, const spectral_camera *camera, const spectral_lamp *lamp,
                    const spectral_reflectance *reflectance, double srgb[3])
{
    double white[3], rgb[3];
    float value[3];
    spectral_white(camera, lamp, white);
    spectral_see(camera, lamp, reflectance, rgb);
    for (int c = 0; c < 3; c++)
        value[c] = (float)(rgb[c] / white[c]);
    weft_colour_apply(colour, value, 1);
    for (int c = 0; c < 3; c++)
        srgb[c] = (double)value[c];
}

static double difference_to(const double srgb[3], const double lab_d50[3])
{
    double wanted[3], lab[3], lab_wanted[3];
    weft_linear_srgb_of_lab_d50(lab_d50, wanted);
    weft_lab_of_linear_srgb(wanted, lab_wanted);
    weft_lab_of_linear_srgb(srgb, lab);
    return weft_ciede2000(lab, lab_wanted);
}

/* Mean CIEDE2000 of reflectances at random to what they are. */
static double error_of_others(const weft_colour *colour, const spectral_camera *camera, const spectral_lamp *lamp)
{
    unsigned state = 99;
    double sum = 0;
    for (int i = 0; i < OTHERS; i++) {
        spectral_reflectance reflectance = spectral_random(&state);
        double lab[3], srgb[3];
        spectral_lab_d50(&reflectance, lab);
        through(colour, camera, lamp, &reflectance, srgb);
        sum += difference_to(srgb, lab) / OTHERS;
    }
    return sum;
}

/* Mean CIEDE2000 between what two cameras make of them. */
static double distance_of_cameras(const weft_colour *a, const weft_colour *b)
{
    unsigned state = 99;
    double sum = 0;
    for (int i = 0; i < OTHERS; i++) {
        spectral_reflectance reflectance = spectral_random(&state);
        double one[3], other[3], lab[3], lab_other[3];
        through(a, &spectral_cameras[0], &spectral_lamps[0], &reflectance, one);
        through(b, &spectral_cameras[1], &spectral_lamps[1], &reflectance, other);
        weft_lab_of_linear_srgb(one, lab);
        weft_lab_of_linear_srgb(other, lab_other);
        sum += weft_ciede2000(lab, lab_other) / OTHERS;
    }
    return sum;
}

/* ---- Charts ---- */

static weft_colour_report calibrate_as(bool linear, const char *path, int terms)
{
    weft_colour_report report;
    weft_error error = {0};
    const weft_colour_settings settings = {WEFT_CHART_CLASSIC, terms, linear};
    expect_ok(weft_colour_calibrate(path, &settings, &report, &error), &error);
    print_message("%s, %d terms: fitted %.2f (worst %.2f), left out %.2f (worst %.2f), lamp %.2f\n", path,
                  report.colour.terms, report.colour.fitted.mean, report.colour.fitted.worst,
                  report.colour.left_out.mean, report.colour.left_out.worst, report.lamp_range);
    return report;
}

static weft_colour_report calibrate(const char *path, int terms)
{
    return calibrate_as(false, path, terms);
}

static void a_chart_tells_the_colours_of_two_cameras(void **state)
{
    (void)state;
    const weft_colour none = {0};
    weft_colour found[2];
    for (int i = 0; i < 2; i++) {
        chart_picture picture = chart_picture_usual();
        picture.camera = &spectral_cameras[i];
        picture.lamp = &spectral_lamps[i];
        chart_picture_write_exr(&picture, "chart.exr");
        double before = error_of_others(&none, picture.camera, picture.lamp), after[2];
        for (int roots = 0; roots < 2; roots++) {
            weft_colour_report report = calibrate("chart.exr", roots ? 0 : WEFT_COLOUR_LINEAR_TERMS);
            after[roots] = error_of_others(&report.colour, picture.camera, picture.lamp);
            assert_int_equal(report.used, WEFT_CHART_PATCHES);
            assert_int_equal(report.colour.terms, roots ? WEFT_COLOUR_ROOT_TERMS : WEFT_COLOUR_LINEAR_TERMS);
            found[i] = report.colour;
            weft_colour_report_free(&report);
        }
        print_message("colours on no chart: %.2f by a matrix, %.2f by roots, %.2f before\n", after[0], after[1],
                      before);
        assert_true(after[0] < 0.35 * before && after[1] < 0.25 * before);
    }
    double apart = distance_of_cameras(&found[0], &found[1]), before = distance_of_cameras(&none, &none);
    print_message("the two cameras are %.2f apart, %.2f without matrices\n", apart, before);
    assert_true(apart < 0.5 * before);
}

/* ---- What a photograph may do to a chart ---- */

/* Mean CIEDE2000 of colours on no chart, by the chart in `picture`, whose camera and lamp are the first. */
static double error_by(const chart_picture *picture, weft_colour_report *report)
{
    chart_picture_write_exr(picture, "chart.exr");
    *report = calibrate("chart.exr", 0);
    double error = error_of_others(&report->colour, picture->camera, picture->lamp);
    print_message("colours on no chart: %.2f\n", error);
    weft_colour_report_free(report);
    return error;
}

/* The same of the usual chart, of which it is computed once. */
static double usual_error(void)
{
    static double error;
    const chart_picture usual = chart_picture_usual();
    weft_colour_report report;
    if (error == 0)
        error = error_by(&usual, &report);
    return error;
}

static void a_lamp_that_falls_off_is_taken_out(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    weft_colour_report report;
    picture.fall = 0.4; /* 1.2 at the left end, 0.8 at the right */
    double falling = error_by(&picture, &report);
    assert_true(fabs(report.lamp_range / 1.5 - 1) < 0.08);
    assert_true(falling < usual_error() + 0.5);
}

static void a_patch_that_glares_hardly_counts(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    weft_colour_report report;
    picture.stained_patch = 9;
    double stained = error_by(&picture, &report);
    assert_true(report.patch[9].fitted > 10 && report.patch[9].fitted == report.colour.fitted.worst);
    assert_true(stained < usual_error() + 0.5);
}

/* The corners are turned, the patches with them: the same matrix. */
static void a_chart_may_lie_any_way_up(void **state)
{
    (void)state;
    const chart_picture upright = chart_picture_usual();
    weft_colour_report report;
    for (int turn = 1; turn < 4; turn++) {
        chart_picture picture = upright;
        if (turn % 2) {
            picture.width = upright.height;
            picture.height = upright.width;
        }
        for (int i = 0; i < 4; i++) {
            double x = upright.corner[i][0], y = upright.corner[i][1];
            picture.corner[i][0] = turn == 1 ? upright.height - 1 - y : turn == 2 ? upright.width - 1 - x : y;
            picture.corner[i][1] = turn == 1 ? x : turn == 2 ? upright.height - 1 - y : upright.width - 1 - x;
        }
        assert_true(fabs(error_by(&picture, &report) - usual_error()) < 0.4);
        assert_true(hypot(report.patch[0].pixel[0] - picture.corner[0][0],
                          report.patch[0].pixel[1] - picture.corner[0][1]) < 80);
    }
}

/* Centres that are found lie where they were drawn. */
static void patches_are_found_where_they_are(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    const double square[4][2] = {{60, 50}, {450, 50}, {450, 310}, {60, 310}};
    weft_colour_report report;
    memcpy(picture.corner, square, sizeof square);
    error_by(&picture, &report);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        double x = 60 + 65 * (i % 6 + 0.5), y = 50 + 65 * (i / 6 + 0.5);
        assert_true(hypot(report.patch[i].pixel[0] - x, report.patch[i].pixel[1] - y) < 2);
    }
}

/* A tone curve that is not sRGB's is found from the greys. */
static void a_jpeg_is_taken_through_its_tone_curve(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    const weft_colour none = {0};
    chart_picture_write_jpeg(&picture, "chart.jpg");
    weft_colour_report report = calibrate("chart.jpg", 0);
    double error = error_of_others(&report.colour, picture.camera, picture.lamp);
    print_message("colours on no chart: %.2f\n", error);
    assert_true(error < 0.35 * error_of_others(&none, picture.camera, picture.lamp));
    weft_colour_report_free(&report);
}

/* ---- What cannot be used ---- */

static void assert_refused_as(bool linear, const char *path, const char *what)
{
    const weft_colour_settings settings = {.chart = WEFT_CHART_CLASSIC, .linear = linear};
    weft_colour_report report;
    weft_error error = {0};
    weft_code code = weft_colour_calibrate(path, &settings, &report, &error);
    if (weft_class_of(code) != WEFT_BAD_INPUT || !strstr(error.message, what) || !strstr(error.message, path))
        fail_msg("%s: %d, '%s', not '%s'", path, (int)code, error.message, what);
    weft_colour_report_free(&report);
}

static void assert_refused(const char *path, const char *what)
{
    assert_refused_as(false, path, what);
}

static void what_is_wrong_is_named_and_nothing_written(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    picture.exposure = 1.6;
    chart_picture_write_jpeg(&picture, "bright.jpg");
    assert_refused("bright.jpg", "the white patch of the chart is clipped");
    weft_image image = chart_picture_render(&picture);
    for (int i = 0; i < 3 * image.width * image.height; i++)
        image.pixels[i] = fminf(image.pixels[i], 1);
    assert_int_equal(weft_image_write("raw.exr", &image, NULL, NULL), WEFT_OK);
    weft_image_free(&image);
    assert_refused("raw.exr", "the white patch of the chart is clipped");
    picture.exposure = 0.03;
    chart_picture_write_jpeg(&picture, "dark.jpg");
    assert_refused("dark.jpg", "too dark");
    picture = chart_picture_usual();
    picture.covered_columns = 3;
    chart_picture_write_jpeg(&picture, "leaf.jpg");
    expect_weft("colour leaf.jpg -o no.json", 1, "'leaf.jpg': no complete colour chart was found in it");
    assert_true(access("no.json", F_OK) != 0);
    picture = chart_picture_usual();
    for (int i = 0; i < 4; i++)
        picture.corner[i][0] = picture.width - 1 - picture.corner[i][0];
    chart_picture_write_exr(&picture, "mirror.exr");
    assert_refused("mirror.exr", "the colour chart is mirrored");
    scratch_store("text.jpg", "no picture", 10);
    assert_refused("text.jpg", "text.jpg");
    weft_image strip; /* the finder would make it 600000 pixels long */
    assert_int_equal(weft_image_create(3000, 5, &strip, NULL), WEFT_OK);
    for (int i = 0; i < 3 * 3000 * 5; i++)
        strip.pixels[i] = (float)(i * 7919 % 1000) / 1000;
    assert_int_equal(weft_image_write("strip.exr", &strip, NULL, NULL), WEFT_OK);
    weft_image_free(&strip);
    assert_refused("strip.exr", "no complete colour chart was found");
    assert_refused("missing.jpg", "missing.jpg");
    assert_refused(".", "session.json");
    expect_weft("colour leaf.jpg -o ./leaf.jpg", 2, "would overwrite");
}

/* Linear values in an integer file, and a tone curve in one that was said to have none. */
static void a_tone_curve_is_not_mistaken(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    weft_image image = chart_picture_render(&picture);
    const weft_camera_notes notes = {"Test", "Chart", "2026:01:01 00:00:00", 1, 0.01, 4, 100, 50, 50};
    assert_int_equal(weft_snapshot_write("linear.tif", &image, &notes, NULL), WEFT_OK);
    weft_image_free(&image);
    assert_refused("linear.tif", "so the values are linear; pass --linear");
    weft_colour_report report = calibrate_as(true, "linear.tif", 0);
    weft_colour_report_free(&report);
    chart_picture_write_jpeg(&picture, "curved.jpg");
    assert_refused_as(true, "curved.jpg", "the values are not linear");
}

/* Glare clips half of a patch: it is left out, and named. */
static void a_patch_that_clips_is_left_out(void **state)
{
    (void)state;
    chart_picture picture = chart_picture_usual();
    picture.exposure = 1;
    picture.stained_patch = 15;
    chart_picture_write_jpeg(&picture, "chart.jpg");
    weft_colour_report report = calibrate("chart.jpg", WEFT_COLOUR_LINEAR_TERMS);
    assert_int_equal(report.used, WEFT_CHART_PATCHES - 1);
    assert_string_equal(report.patch[15].unused, "it is clipped");
    weft_colour_report_free(&report);
}

/* Greys alone tell nothing of colours. */
static void equations_that_are_singular_are_refused(void **state)
{
    (void)state;
    weft_chart_light chart = {.reference = weft_chart_reference(WEFT_CHART_CLASSIC)};
    weft_colour_fit fit;
    weft_error error = {0};
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        for (int c = 0; c < 3; c++)
            chart.decoded.rgb[i][c] = chart.reference.rgb[i][1];
        chart.used[i] = true;
    }
    assert_int_equal(weft_colour_fit_run(&chart, WEFT_COLOUR_LINEAR_TERMS, -1, "grey.jpg", &fit, &error),
                     WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'grey.jpg': the patches of the chart determine no colour matrix"));
}

/* What the program says to other programs, and what it writes. */
static void the_event_and_the_file_agree(void **state)
{
    (void)state;
    const chart_picture picture = chart_picture_usual();
    weft_colour colour;
    weft_error error = {0};
    chart_picture_write_exr(&picture, "chart.exr");
    expect_weft("colour chart.exr -o event.json --model linear --json > event.txt", 0, "");
    expect_ok(weft_colour_read("event.json", &colour, &error), &error);
    size_t size;
    char *said = (char *)scratch_load("event.txt", &size);
    said[size - 1] = 0;
    json_t *event = json_loads(strrchr(said, '\n'), 0, NULL);
    free(said);
    assert_non_null(event);
    assert_string_equal(json_string_value(json_object_get(event, "event")), "colour");
    assert_string_equal(json_string_value(json_object_get(event, "model")), "linear");
    assert_int_equal(json_array_size(json_object_get(event, "patches")), WEFT_CHART_PATCHES);
    json_t *first = json_array_get(json_array_get(json_object_get(event, "matrix"), 0), 0);
    assert_true(fabs(json_number_value(first) - colour.matrix[0][0]) < 1e-7);
    json_decref(event);
}

int test_colour(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chart_tells_the_colours_of_two_cameras),
        cmocka_unit_test(a_lamp_that_falls_off_is_taken_out),
        cmocka_unit_test(a_patch_that_glares_hardly_counts),
        cmocka_unit_test(a_chart_may_lie_any_way_up),
        cmocka_unit_test(patches_are_found_where_they_are),
        cmocka_unit_test(a_jpeg_is_taken_through_its_tone_curve),
        cmocka_unit_test(what_is_wrong_is_named_and_nothing_written),
        cmocka_unit_test(a_tone_curve_is_not_mistaken),
        cmocka_unit_test(a_patch_that_clips_is_left_out),
        cmocka_unit_test(equations_that_are_singular_are_refused),
        cmocka_unit_test(the_event_and_the_file_agree),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
