/* Charts that others photographed (WEFT_SHARED/real/colour-charts): all that a person can read are found. */
#include "registration/colour/calibration.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

#define REAL WEFT_SHARED "/real/colour-charts/"

static weft_colour_report calibrate(const char *name, weft_chart_kind chart, bool linear)
{
    char path[512];
    const weft_colour_settings settings = {.chart = chart, .linear = linear};
    weft_colour_report report;
    weft_error error = {0};
    snprintf(path, sizeof path, REAL "%s", name);
    expect_ok(weft_colour_calibrate(path, &settings, &report, &error), &error);
    print_message("%s: %d patches, %d terms, fitted %.2f (worst %.2f), left out %.2f (worst %.2f), lamp %.2f\n", name,
                  report.used, report.colour.terms, report.colour.fitted.mean, report.colour.fitted.worst,
                  report.colour.left_out.mean, report.colour.left_out.worst, report.lamp_range);
    assert_true(report.colour.fitted.mean < 3);
    assert_true(report.colour.left_out.mean < 4.5);
    weft_lines_free(&report.warnings);
    return report;
}

static void assert_seen_at(const weft_colour_report *report, int patch, double x, double y, double reach)
{
    const double *pixel = report->patch[patch].pixel;
    if (!(hypot(pixel[0] - x, pixel[1] - y) < reach))
        fail_msg("%s is seen at %.0f, %.0f, not at %.0f, %.0f", report->patch[patch].name, pixel[0], pixel[1], x, y);
}

/* Linear values with a cast of green; places as read off it by its README. */
static void a_chart_in_a_light_booth(void **state)
{
    (void)state;
    const weft_colour_report report = calibrate("d65_colorchecker.jpg", WEFT_CHART_CLASSIC, true);
    assert_int_equal(report.used, WEFT_CHART_PATCHES);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        assert_seen_at(&report, i, 679 + 259 * (i % 6), 726 + 247 * (i / 6), 60);
}

/* Upside down, outdoors, as the camera rendered it, with colours that clip; printed in June 2009. */
static void a_chart_upside_down_out_of_doors(void **state)
{
    (void)state;
    const weft_colour_report report = calibrate("passport.jpg", WEFT_CHART_CLASSIC_2005, false);
    assert_true(report.used >= 18);
    assert_seen_at(&report, 0, 711, 309, 15);
    assert_seen_at(&report, 18, 711, 97, 15);
    assert_seen_at(&report, 23, 357, 97, 15);
}

/* 140 patches, of which the middle ones are the colours of the small chart. */
static void a_chart_of_140_patches(void **state)
{
    (void)state;
    const weft_colour_report report = calibrate("dsg.png", WEFT_CHART_SG, false);
    assert_true(report.used >= 18);
    assert_seen_at(&report, 0, 507 * 1920.0 / 1344, 211 * 1920.0 / 1344, 15);
    assert_seen_at(&report, 23, 846 * 1920.0 / 1344, 413 * 1920.0 / 1344, 15);
}

int test_real_colour(void)
{
    if (access(REAL "passport.jpg", R_OK) != 0) {
        puts("skipped: the photographs of colour charts are not there");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chart_in_a_light_booth),
        cmocka_unit_test(a_chart_upside_down_out_of_doors),
        cmocka_unit_test(a_chart_of_140_patches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
