#include "registration/colour/chart.h"
#include "registration/colour/difference.h"
#include "tests/support/cmocka_all.h"

#include <math.h>

/* Sharma, Wu and Dalal 2005, table 1: two colours and their difference. */
static const double pairs[][7] = {
    {50, 2.6772, -79.7751, 50, 0, -82.7485, 2.0425},
    {50, 3.1571, -77.2803, 50, 0, -82.7485, 2.8615},
    {50, 2.8361, -74.0200, 50, 0, -82.7485, 3.4412},
    {50, -1.3802, -84.2814, 50, 0, -82.7485, 1.0000},
    {50, -1.1848, -84.8006, 50, 0, -82.7485, 1.0000},
    {50, -0.9009, -85.5211, 50, 0, -82.7485, 1.0000},
    {50, 0, 0, 50, -1, 2, 2.3669},
    {50, -1, 2, 50, 0, 0, 2.3669},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0009, 7.1792},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0010, 7.1792},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0011, 7.2195},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0012, 7.2195},
    {50, -0.0010, 2.4900, 50, 0.0009, -2.4900, 4.8045},
    {50, -0.0010, 2.4900, 50, 0.0010, -2.4900, 4.8045},
    {50, -0.0010, 2.4900, 50, 0.0011, -2.4900, 4.7461},
    {50, 2.5, 0, 50, 0, -2.5, 4.3065},
    {50, 2.5, 0, 73, 25, -18, 27.1492},
    {50, 2.5, 0, 61, -5, 29, 22.8977},
    {50, 2.5, 0, 56, -27, -3, 31.9030},
    {50, 2.5, 0, 58, 24, 15, 19.4535},
    {50, 2.5, 0, 50, 3.1736, 0.5854, 1.0000},
    {50, 2.5, 0, 50, 3.2972, 0, 1.0000},
    {50, 2.5, 0, 50, 1.8634, 0.5757, 1.0000},
    {50, 2.5, 0, 50, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
};

/* BabelColor's table of the chart of 2005 as sRGB, 0 to 255; cyan has no red, which sRGB cannot show. */
static const int printed[WEFT_CHART_PATCHES][3] = {
    {115, 81, 67},   {199, 147, 129}, {91, 122, 156},  {90, 108, 64},   {130, 128, 176}, {92, 190, 172},
    {224, 124, 47},  {68, 91, 170},   {198, 82, 97},   {94, 58, 106},   {159, 189, 63},  {230, 162, 39},
    {35, 63, 147},   {67, 149, 74},   {180, 49, 57},   {238, 198, 20},  {193, 84, 151},  {0, 136, 170},
    {245, 245, 243}, {200, 202, 202}, {161, 163, 163}, {121, 121, 122}, {82, 84, 86},    {49, 49, 51}};

static void the_difference_is_the_published_one(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        assert_true(fabs(weft_ciede2000(pairs[i], pairs[i] + 3) - pairs[i][6]) < 6e-5);
        assert_true(fabs(weft_ciede2000(pairs[i] + 3, pairs[i]) - pairs[i][6]) < 6e-5);
        assert_true(weft_ciede2000(pairs[i], pairs[i]) == 0);
    }
}

static double encode(double linear)
{
    if (linear <= 0)
        return 0;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static void the_chart_has_the_colours_that_others_computed(void **state)
{
    (void)state;
    const weft_chart_colours reference = weft_chart_reference(WEFT_CHART_CLASSIC_2005);
    double sum = 0;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        for (int c = 0; c < 3; c++) {
            double off = 255 * encode(reference.rgb[i][c]) - printed[i][c];
            sum += fabs(off) / (3 * WEFT_CHART_PATCHES);
            if (fabs(off) > 2.5)
                fail_msg("%s, channel %d: %.1f, not %d", weft_chart_patch_name[i], c, 255 * encode(reference.rgb[i][c]),
                         printed[i][c]);
        }
    }
    print_message("mean distance from the printed sRGB values: %.2f of 255\n", sum);
    assert_true(sum < 1);
}

/* The charts of three kinds differ by a few units, no more: a row that is out of place would differ by tens. */
static void charts_of_one_maker_resemble_one_another(void **state)
{
    (void)state;
    const weft_chart_colours usual = weft_chart_reference(WEFT_CHART_CLASSIC);
    for (int kind = WEFT_CHART_CLASSIC_2005; kind <= WEFT_CHART_SG; kind++) {
        const weft_chart_colours other = weft_chart_reference((weft_chart_kind)kind);
        for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
            double a[3], b[3];
            weft_lab_of_linear_srgb(usual.rgb[i], a);
            weft_lab_of_linear_srgb(other.rgb[i], b);
            assert_true(weft_ciede2000(a, b) < (kind == WEFT_CHART_SG ? 9 : 3));
        }
    }
}

/* White is white, and Lab comes back. */
static void a_white_diffuser_is_one(void **state)
{
    (void)state;
    double rgb[3], lab[3];
    weft_linear_srgb_of_lab_d50((const double[3]){100, 0, 0}, rgb);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(rgb[c] - 1) < 2e-4);
    weft_lab_of_linear_srgb((const double[3]){1, 1, 1}, lab);
    assert_true(fabs(lab[0] - 100) < 0.01 && fabs(lab[1]) < 0.02 && fabs(lab[2]) < 0.02);
}

/* Small differences measured by the metric and by the whole formula. */
static void the_metric_measures_small_differences(void **state)
{
    (void)state;
    const weft_chart_colours reference = weft_chart_reference(WEFT_CHART_CLASSIC);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        const double *rgb = reference.rgb[i];
        double metric[3][3], here[3], there[3];
        weft_ciede2000_metric(rgb, metric);
        weft_lab_of_linear_srgb(rgb, here);
        for (int c = 0; c < 3; c++) {
            double moved[3] = {rgb[0], rgb[1], rgb[2]}, step = 0.002 * (fabs(rgb[c]) + 0.02);
            moved[c] += step;
            weft_lab_of_linear_srgb(moved, there);
            double length =
                step * sqrt(metric[0][c] * metric[0][c] + metric[1][c] * metric[1][c] + metric[2][c] * metric[2][c]);
            double whole = weft_ciede2000(here, there);
            if (!(fabs(length / whole - 1) < 0.05))
                fail_msg("%s, channel %d: %.4f by the metric, %.4f", weft_chart_patch_name[i], c, length, whole);
        }
    }
}

int test_colour_difference(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_difference_is_the_published_one),
        cmocka_unit_test(the_chart_has_the_colours_that_others_computed),
        cmocka_unit_test(charts_of_one_maker_resemble_one_another),
        cmocka_unit_test(a_white_diffuser_is_one),
        cmocka_unit_test(the_metric_measures_small_differences),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
