/* Where a ray meets a height field, and what the views around it count for, on shapes whose answers are known. */
#include "reflectance/relief/relief.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 64 };
static const double side_mm = 2;

/* A square pillar of 0.4 mm in the middle of the tile, its top half a mm above the ground. */
static float pillar[SIDE * SIDE];

static weft_height_field pillar_field(void)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x = (i % SIDE + 0.5) / SIDE * side_mm - 1, y = (i / SIDE + 0.5) / SIDE * side_mm - 1;
        pillar[i] = fabs(x) < 0.2 && fabs(y) < 0.2 ? -0.1f : -0.6f;
    }
    return weft_height_field_of(pillar, SIDE, SIDE, side_mm, side_mm);
}

static weft_vec3 tilted(double degrees, double phi_degrees)
{
    double theta = degrees * WEFT_PI / 180, phi = phi_degrees * WEFT_PI / 180;
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

static double seen_height(const weft_height_field *field, double x_mm, double y_mm, weft_vec3 view)
{
    weft_real slope[2];
    weft_relief_slope(field, view, slope);
    return weft_relief_march(field, x_mm / side_mm, y_mm / side_mm, slope);
}

static void a_ray_meets_the_first_of_what_it_could(void **state)
{
    (void)state;
    weft_height_field field = pillar_field();
    assert_true(fabs(seen_height(&field, 1, 1, tilted(0, 0)) + 0.1) < 1e-6);
    assert_true(fabs(seen_height(&field, 0.3, 1, tilted(0, 0)) + 0.6) < 1e-6);
    /* From the right at 45 degrees a point of the plane sees what lies to its left, as far away as it is deep. */
    assert_true(fabs(seen_height(&field, 1.15, 1, tilted(45, 0)) + 0.1) < 0.01);
    assert_true(fabs(seen_height(&field, 1.6, 1, tilted(45, 0)) + 0.4) < 0.05);
    assert_true(fabs(seen_height(&field, 1.95, 1, tilted(45, 0)) + 0.6) < 1e-6);
    /* From above in the picture, v counts up: below the pillar lies its shadow. */
    assert_true(fabs(seen_height(&field, 1, 1.6, tilted(45, 90)) + 0.4) < 0.05);
    assert_true(fabs(seen_height(&field, 1, 0.4, tilted(45, 90)) + 0.6) < 1e-6);
}

/* A view that looks past the pillar knows the ground behind it; one that looks at its side does not. */
static void a_view_that_sees_something_else_counts_little(void **state)
{
    (void)state;
    weft_height_field field = pillar_field();
    const weft_vec3 view[3] = {tilted(60, 0), tilted(60, 180), tilted(20, 0)};
    weft_relief relief;
    weft_relief_tap tap[3];
    weft_error error = {0};
    expect_ok(weft_relief_create(&field, view, 3, &relief, &error), &error);
    /* The ground 0.1 mm left of the pillar, seen from above. */
    weft_relief_taps(&relief, 1, 0.7 / side_mm, 0.5, tilted(0, 0), (int[]){0, 1, 2},
                     (weft_real[]){(weft_real)0.4, (weft_real)0.4, (weft_real)0.2}, tap);
    assert_true(fabs(tap[0].weight + tap[1].weight + tap[2].weight - 1) < 1e-6);
    assert_true(tap[0].weight < 0.1);
    assert_true(tap[1].weight > 0.6);
    /* A view from the left shows what lies 0.6 mm deep 0.6 tan(60) further left. */
    assert_true(fabs((tap[1].u - 0.35) * side_mm + 0.6 * tan(WEFT_PI / 3)) < 1e-3);
    assert_true(fabs(tap[1].v - 0.5) < 1e-6);
    weft_relief_free(&relief);
}

static void a_plane_moves_all_alike(void **state)
{
    (void)state;
    const float height = -0.25f;
    weft_height_field field = weft_height_field_of(&height, 1, 1, 2, 1);
    const weft_vec3 view[2] = {tilted(45, 0), tilted(45, 90)};
    weft_relief relief;
    weft_relief_tap tap[3];
    weft_error error = {0};
    expect_ok(weft_relief_create(&field, view, 2, &relief, &error), &error);
    weft_relief_taps(&relief, 1, (weft_real)0.5, (weft_real)0.5, tilted(0, 0), (int[]){0, 1, -1},
                     (weft_real[]){(weft_real)0.25, (weft_real)0.75, 0}, tap);
    assert_true(fabs(tap[0].u - 0.625) < 1e-6 && fabs(tap[0].v - 0.5) < 1e-6);
    assert_true(fabs(tap[1].u - 0.5) < 1e-6 && fabs(tap[1].v - 0.75) < 1e-6);
    assert_true(fabs(tap[0].weight - 0.25) < 1e-6 && fabs(tap[1].weight - 0.75) < 1e-6 && tap[2].weight == 0);
    /* Half of the height on a coarser level, none of it on the next. */
    weft_relief_taps(&relief, (weft_real)0.5, (weft_real)0.5, (weft_real)0.5, tilted(0, 0), (int[]){0, 1, -1},
                     (weft_real[]){(weft_real)0.25, (weft_real)0.75, 0}, tap);
    assert_true(fabs(tap[0].u - 0.5625) < 1e-6);
    weft_relief_free(&relief);
}

int test_relief_taps(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ray_meets_the_first_of_what_it_could),
        cmocka_unit_test(a_view_that_sees_something_else_counts_little),
        cmocka_unit_test(a_plane_moves_all_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
