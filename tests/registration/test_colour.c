/* Charts of a camera with a spectrum (tests/support/spectral_colour.h), and colours that are on no chart. */
#include "btf/session/colour.h"
#include "registration/colour/calibration.h"
#include "registration/colour/difference.h"
#include "tests/support/chart_picture.h"
#include "tests/support/expect_ok.h"
#include "tests/support/run_weft.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
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

static weft_colour_report calibrate(const char *path, int terms)
{
    weft_colour_report report;
    weft_error error = {0};
    const weft_colour_settings settings = {.chart = WEFT_CHART_CLASSIC, .terms = terms};
    expect_ok(weft_colour_calibrate(path, &settings, &report, &error), &error);
    print_message("%s, %d terms: fitted %.2f (worst %.2f), left out %.2f (worst %.2f), lamp %.2f\n", path,
                  report.colour.terms, report.colour.fitted.mean, report.colour.fitted.worst,
                  report.colour.left_out.mean, report.colour.left_out.worst, report.lamp_range);
    return report;
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
        for (int terms = 0; terms <= WEFT_COLOUR_ROOT_TERMS; terms += 3) {
            weft_colour_report report = calibrate("chart.exr", terms);
            double before = error_of_others(&none, picture.camera, picture.lamp);
            double after = error_of_others(&report.colour, picture.camera, picture.lamp);
            print_message("colours on no chart: %.2f, %.2f without the matrix\n", after, before);
            assert_int_equal(report.used, WEFT_CHART_PATCHES);
            assert_true(after < 0.5 * before);
            found[i] = report.colour;
            weft_colour_report_free(&report);
        }
    }
    double apart = distance_of_cameras(&found[0], &found[1]), before = distance_of_cameras(&none, &none);
    print_message("the two cameras are %.2f apart, %.2f without matrices\n", apart, before);
    assert_true(apart < 0.5 * before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chart_tells_the_colours_of_two_cameras),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
