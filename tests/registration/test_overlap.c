#include "registration/resample/resample.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

static void a_quadrangle_around_a_pixel_covers_it_wholly(void **state)
{
    (void)state;
    const weft_pixel corner[4] = {{1, 1}, {5, 0}, {6, 6}, {0, 5}};
    assert_near(weft_overlap_area(corner, 3, 3), 1, 1e-12);
}

static void a_distant_pixel_is_not_covered(void **state)
{
    (void)state;
    const weft_pixel corner[4] = {{1, 1}, {5, 0}, {6, 6}, {0, 5}};
    assert_near(weft_overlap_area(corner, 9, 3), 0, 0);
    assert_near(weft_overlap_area(corner, 3, -4), 0, 0);
}

static void a_shift_changes_the_area_by_exactly_as_much(void **state)
{
    (void)state;
    for (int step = 0; step <= 1000; step++) {
        double shift = step / 1000.0;
        const weft_pixel corner[4] = {{2.5 + shift, 1}, {9, 1}, {9, 7}, {2.5 + shift, 7}};
        assert_near(weft_overlap_area(corner, 3, 3), 1 - shift, 1e-12);
    }
}

static void the_areas_over_all_pixels_sum_to_that_of_the_quadrangle(void **state)
{
    (void)state;
    const weft_pixel corner[4] = {{2.31, 1.77}, {6.9, 3.05}, {5.62, 8.43}, {0.94, 5.1}};
    double sum = 0, twice = 0;
    for (int y = -1; y < 12; y++) {
        for (int x = -1; x < 12; x++)
            sum += weft_overlap_area(corner, x, y);
    }
    for (int i = 0; i < 4; i++)
        twice += corner[i].x * corner[(i + 1) % 4].y - corner[i].y * corner[(i + 1) % 4].x;
    assert_near(sum, twice / 2, 1e-12);
}

static void the_sense_of_rotation_does_not_matter(void **state)
{
    (void)state;
    const weft_pixel one[4] = {{2.31, 1.77}, {6.9, 3.05}, {5.62, 8.43}, {0.94, 5.1}};
    const weft_pixel other[4] = {one[3], one[2], one[1], one[0]};
    assert_near(weft_overlap_area(one, 2, 2), weft_overlap_area(other, 2, 2), 1e-14);
}

int test_overlap(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quadrangle_around_a_pixel_covers_it_wholly),
        cmocka_unit_test(a_distant_pixel_is_not_covered),
        cmocka_unit_test(a_shift_changes_the_area_by_exactly_as_much),
        cmocka_unit_test(the_areas_over_all_pixels_sum_to_that_of_the_quadrangle),
        cmocka_unit_test(the_sense_of_rotation_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
