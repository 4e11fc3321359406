/* A block of a material is seen through the heights of all of it. */
#include "evaluate/error/predictor.h"
#include "tests/support/expect_ok.h"

#include <math.h>

enum { ACROSS = 8, DOWN = 4 }; /* texels of a mm of the whole; the window has 4 x 2 of them, from (3, 1) on */
static const weft_predicted_window window = {3, 1, ACROSS, DOWN};

/* 1 mm deep in the left half, 0.5 mm in the right one. */
static const float depth[2] = {-1, -0.5f};

static void expect_tap(const weft_relief *relief, weft_vec3 view, int x, int y, double column, double row)
{
    weft_relief_tap tap[3];
    weft_window_taps(relief, &window, 4, 2, x, y, view, (int[]){0, -1, -1}, (weft_real[]){1, 0, 0}, tap);
    assert_true(fabs(tap[0].u * 4 - column) < 0.005);
    assert_true(fabs((1 - tap[0].v) * 2 - row) < 0.005);
}

static void a_texel_of_a_window_has_the_height_where_it_lies(void **state)
{
    (void)state;
    weft_relief relief;
    weft_error error = {0};
    const weft_height_field field = weft_height_field_of(depth, 2, 1, ACROSS, DOWN);
    const weft_vec3 above = {0, 0, 1}, stored = weft_unit(weft_vec3_of(-1, 0, 1));
    expect_ok(weft_relief_create(&field, &stored, 1, &relief, &error), &error);
    /* The middle of the window's last texel is 6.5 of 8 across the whole: half a texel beyond the middle of the right
     * half, where heights fall towards those of the left one again, by an eighth of their difference. The stored view
     * leans to the left by 45 degrees, and shows that point as far to the left as it is deep. */
    expect_tap(&relief, above, 3, 1, 3.5 - (0.5 + 0.5 / 8), 1.5);
    /* The stored view itself shows each texel where it is. */
    expect_tap(&relief, stored, 3, 0, 3.5, 0.5);
    expect_tap(&relief, stored, 2, 1, 2.5, 1.5);
    weft_relief_free(&relief);
}

static void nobody_knows_what_lies_beside_a_window(void **state)
{
    (void)state;
    weft_relief relief;
    weft_relief_tap tap[3];
    weft_error error = {0};
    const float deep = -1;
    const weft_height_field field = weft_height_field_of(&deep, 1, 1, ACROSS, DOWN);
    const weft_vec3 above = {0, 0, 1}, stored = weft_unit(weft_vec3_of(-1, 0, 1));
    expect_ok(weft_relief_create(&field, &stored, 1, &relief, &error), &error);
    weft_window_taps(&relief, &window, 4, 2, 0, 0, above, (int[]){0, -1, -1}, (weft_real[]){1, 0, 0}, tap);
    assert_true(isnan(tap[0].u));
    weft_relief_free(&relief);
}

int test_window(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texel_of_a_window_has_the_height_where_it_lies),
        cmocka_unit_test(nobody_knows_what_lies_beside_a_window),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
