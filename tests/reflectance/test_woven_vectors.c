/* The reference vectors of one yarn segment. Built twice: in double, and in single precision. */
#include "reflectance/woven/woven.h"
#include "tests/reflectance/vectors.h"

#include <string.h>

static weft_real real_at(const reference_vectors *v, int row, const char *column)
{
    return (weft_real)vectors_number(v, row, column);
}

static weft_segment segment_at(const reference_vectors *v, int row)
{
    return (weft_segment){.alpha = real_at(v, row, "alpha"),
                          .beta = real_at(v, row, "beta"),
                          .delta = real_at(v, row, "delta"),
                          .psi = real_at(v, row, "psi"),
                          .umax = real_at(v, row, "umax"),
                          .kappa = real_at(v, row, "kappa"),
                          .width = real_at(v, row, "w"),
                          .length = real_at(v, row, "l"),
                          .highlight_width = 1};
}

static void spine_radius_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("woven_R.csv", 260);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_segment segment = {.umax = real_at(&v, row, "umax"),
                                .kappa = real_at(&v, row, "kappa"),
                                .width = real_at(&v, row, "w"),
                                .length = real_at(&v, row, "l"),
                                .highlight_width = 1};
        vectors_check(&v, row, "R", weft_spine_radius(&segment, real_at(&v, row, "u")));
    }
    vectors_close(&v);
}

enum { OUTPUTS = 9 };

static const char *const output_column[OUTPUTS] = {"integrand", "solved", "nx", "ny", "nz", "R", "G", "fc", "A"};

static void point_outputs(const weft_segment *segment, weft_real coordinate, direction_pair at, double out[OUTPUTS])
{
    weft_yarn_point point = weft_yarn_highlight(segment, coordinate, at.light, at.view);
    const double value[OUTPUTS] = {point.integrand, point.solved,   point.normal.x, point.normal.y,   point.normal.z,
                                   point.radius,    point.geometry, point.phase,    point.attenuation};
    memcpy(out, value, sizeof value);
}

static void check_point(reference_vectors *v, int row)
{
    weft_segment segment = segment_at(v, row);
    weft_real coordinate = real_at(v, row, "coord");
    direction_pair at = {vectors_direction(v, row, "wi"), vectors_direction(v, row, "wo")};
    double out[OUTPUTS];
    point_outputs(&segment, coordinate, at, out);
    for (int i = 0; i < OUTPUTS; i++)
        vectors_check(v, row, output_column[i], out[i]);
}

static void highlight_point_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("woven_point.csv", 492);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_segment segment = segment_at(&v, row);
        bool active = weft_yarn_highlight(&segment, real_at(&v, row, "coord"), vectors_direction(&v, row, "wi"),
                                          vectors_direction(&v, row, "wo"))
                          .active;
        vectors_check_within(&v, row, "active", active, 0);
        check_point(&v, row);
    }
    vectors_close(&v);
}

static void segment_reflectance_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("woven_reflectance.csv", 323);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_segment segment = segment_at(&v, row);
        vectors_check(
            &v, row, "fs",
            weft_segment_reflectance(&segment, vectors_direction(&v, row, "wi"), vectors_direction(&v, row, "wo")));
    }
    vectors_close(&v);
}

static void segment_texture_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("woven_texture.csv", 360);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_segment segment = segment_at(&v, row);
        segment.highlight_width = real_at(&v, row, "hwidth");
        vectors_check(&v, row, "T",
                      weft_segment_texture(&segment, real_at(&v, row, "x"), real_at(&v, row, "y"),
                                           vectors_direction(&v, row, "wi"), vectors_direction(&v, row, "wo")));
    }
    vectors_close(&v);
}

int test_woven_vectors(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spine_radius_matches_every_row),
        cmocka_unit_test(highlight_point_matches_every_row),
        cmocka_unit_test(segment_reflectance_matches_every_row),
        cmocka_unit_test(segment_texture_matches_every_row),
    };
    return cmocka_run_group_tests_name("woven vectors", tests, NULL, NULL);
}
