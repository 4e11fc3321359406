/* Lafortune lobes, frames and the view table. Built twice: in double, and in single precision. */
#include "reflectance/lafortune/lafortune.h"
#include "tests/reflectance/vectors.h"

#include <stdio.h>

enum { ROWS = 426, FIT_ROWS = 220, FIT_SAMPLES = 8 };

static weft_real real_at(const reference_vectors *v, int row, const char *format, int lobe, char channel)
{
    char column[32];
    if (lobe > 0)
        snprintf(column, sizeof column, format, lobe, channel);
    else
        snprintf(column, sizeof column, format, channel);
    return (weft_real)vectors_number(v, row, column);
}

static weft_real channel_value(const reference_vectors *v, int row, char channel, weft_vec3 light, weft_vec3 view)
{
    weft_lobe lobes[2];
    int count = (int)vectors_number(v, row, "nlobes");
    for (int i = 0; i < count; i++)
        lobes[i] = (weft_lobe){real_at(v, row, "cx%d_%c", i + 1, channel), real_at(v, row, "cy%d_%c", i + 1, channel),
                               real_at(v, row, "cz%d_%c", i + 1, channel), real_at(v, row, "n%d_%c", i + 1, channel)};
    return real_at(v, row, "T_%c", 0, channel) *
           weft_lafortune(real_at(v, row, "rho_%c", 0, channel), lobes, count, light, view);
}

static void lobes_match_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("lafortune.csv", ROWS);
    for (int row = 0; row < ROWS; row++) {
        weft_vec3 light = vectors_direction(&v, row, "wi"), view = vectors_direction(&v, row, "wo");
        weft_frame frame = weft_frame_of_vectors(vectors_direction(&v, row, "n"), vectors_direction(&v, row, "t"));
        weft_vec3 l = weft_frame_local(&frame, light), o = weft_frame_local(&frame, view);
        bool above = light.z > 0 && view.z > 0;
        for (int i = 0; i < 3; i++) {
            char channel = "rgb"[i], f_column[] = {'f', '_', channel, '\0'},
                 cosine_column[] = {'f', 'l', 'z', '_', channel, '\0'};
            weft_real f = above ? channel_value(&v, row, channel, l, o) : 0;
            vectors_check(&v, row, f_column, f);
            vectors_check(&v, row, cosine_column, f * light.z);
        }
    }
    vectors_close(&v);
}

static void table_fit_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("view_table_fit.csv", FIT_ROWS);
    for (int row = 0; row < FIT_ROWS; row++) {
        weft_real f[FIT_SAMPLES], r[FIT_SAMPLES];
        double terms = 0, square = 0;
        for (int i = 0; i < FIT_SAMPLES; i++) {
            char f_column[] = {'f', (char)('0' + i), '\0'}, r_column[] = {'r', (char)('0' + i), '\0'};
            f[i] = (weft_real)vectors_number(&v, row, f_column);
            r[i] = (weft_real)vectors_number(&v, row, r_column);
            terms += fabs((double)f[i] * r[i]);
            square += (double)f[i] * f[i];
        }
        /* The file has no cond; that of a quotient of sums is the sum of absolute terms over the sum. */
        double largest = square > 0 ? terms / square : 0;
        vectors_check_within(&v, row, "T", weft_view_table_fit(f, r, FIT_SAMPLES),
                             1e-6 * fabs(vectors_number(&v, row, "T")) + 20 * (double)WEFT_REAL_EPSILON * largest);
    }
    vectors_close(&v);
}

static void power_is_finite_and_has_its_limits(void **state)
{
    (void)state;
    assert_true(weft_lobe_power(-1, 0) == 0);
    assert_true(weft_lobe_power((weft_real)-1e-30, (weft_real)2.5) == 0);
    assert_true(weft_lobe_power(0, 2) == 0);
    assert_true(weft_lobe_power(0, 0) == 1);
    assert_true(weft_lobe_power((weft_real)1e-30, 0) == 1);
    assert_true(isfinite(weft_lobe_power((weft_real)1.1, (weft_real)1e5)));
    assert_true(weft_lobe_power((weft_real)1.1, (weft_real)1e5) > (weft_real)0.99e30);
    assert_true(weft_lobe_power((weft_real)0.9, (weft_real)1e5) == 0);
}

static void frame_survives_a_tangent_along_the_normal(void **state)
{
    (void)state;
    const weft_vec3 normals[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {(weft_real)0.6, 0, (weft_real)0.8}};
    for (size_t i = 0; i < sizeof normals / sizeof *normals; i++) {
        weft_frame frame = weft_frame_of_vectors(normals[i], weft_scale(normals[i], -3));
        double tolerance = 8 * (double)WEFT_REAL_EPSILON;
        assert_true(fabs((double)weft_length(frame.tangent) - 1) < tolerance);
        assert_true(fabs((double)weft_dot(frame.tangent, frame.normal)) < tolerance);
        assert_true(fabs((double)weft_dot(weft_cross(frame.normal, frame.tangent), frame.bitangent) - 1) < tolerance);
    }
}

static void interpolation_weighs_colour_and_opacity_alike(void **state)
{
    (void)state;
    const weft_rgba values[3] = {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, (weft_real)0.5}};
    weft_rgba two =
        weft_view_table_interpolate(values, &(weft_barycentric){{2, 0, -1}, {(weft_real)0.25, (weft_real)0.75, 0}});
    assert_true(two.r == (weft_real)0.75 && two.g == 0 && two.b == (weft_real)0.25 && two.a == (weft_real)0.875);
}

int test_lafortune(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_match_every_row),
        cmocka_unit_test(table_fit_matches_every_row),
        cmocka_unit_test(power_is_finite_and_has_its_limits),
        cmocka_unit_test(frame_survives_a_tangent_along_the_normal),
        cmocka_unit_test(interpolation_weighs_colour_and_opacity_alike),
    };
    return cmocka_run_group_tests_name("lafortune", tests, NULL, NULL);
}
