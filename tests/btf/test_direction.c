#include "base/text/csv.h"
#include "btf/direction/direction.h"
#include "tests/support/cmocka_all.h"

static void ubo81_equals_the_reference_table(void **state)
{
    (void)state;
    weft_csv csv;
    weft_error error = {0};
    assert_int_equal(weft_csv_read(WEFT_TEST_DATA "/reference/directions81.csv", true, &csv, &error), WEFT_OK);
    assert_int_equal(csv.row_count, WEFT_UBO81_COUNT);
    for (int i = 0; i < csv.row_count; i++) {
        double row[6];
        for (int column = 0; column < 6; column++)
            assert_int_equal(weft_csv_number(&csv, i, column, &row[column], &error), WEFT_OK);
        weft_angles angles = weft_ubo81_angles((int)row[0]);
        assert_true(fabs(weft_deg_of_rad(angles.theta_rad) - row[1]) < 1e-7);
        assert_true(fabs(weft_deg_of_rad(angles.phi_rad) - row[2]) < 1e-6);
        weft_vec3 d = weft_direction_of_angles(angles);
        assert_true(fabs(d.x - row[3]) < 1e-9 && fabs(d.y - row[4]) < 1e-9 && fabs(d.z - row[5]) < 1e-9);
    }
    weft_csv_free(&csv);
}

/* Theta of the first direction of each ring, and its phi, as Bonn's readers have them. */
static void ubo151_has_the_rings_of_the_dome(void **state)
{
    (void)state;
    static const double known[][3] = {
        {0, 0, 0},       {1, 11, 15},   {7, 23.5, 0},      {19, 30, 15},   {31, 37.5, 0},     {43, 45, 0},
        {61, 52.5, 7.5}, {79, 60, 0},   {103, 67.5, 7.5},  {127, 75, 0},   {6, 11, 315},      {18, 23.5, 330},
        {30, 30, 345},   {60, 45, 340}, {78, 52.5, 347.5}, {150, 75, 345}, {126, 67.5, 352.5}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        weft_angles angles = weft_ubo151_angles((int)known[i][0]);
        assert_true(fabs(weft_deg_of_rad(angles.theta_rad) - known[i][1]) < 1e-9);
        assert_true(fabs(weft_deg_of_rad(angles.phi_rad) - known[i][2]) < 1e-9);
    }
}

static void angles_and_directions_are_inverse(void **state)
{
    (void)state;
    for (int i = 0; i < WEFT_UBO81_COUNT; i++) {
        weft_angles expected = weft_ubo81_angles(i);
        weft_angles angles = weft_angles_of_direction(weft_direction_of_angles(expected));
        assert_true(fabs(angles.theta_rad - expected.theta_rad) < 1e-14);
        assert_true(fabs(angles.phi_rad - expected.phi_rad) < 1e-14);
        assert_int_equal(weft_ubo81_ring(angles.theta_rad), (int)lround(weft_deg_of_rad(angles.theta_rad) / 15));
    }
}

int test_direction(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ubo81_equals_the_reference_table),
        cmocka_unit_test(ubo151_has_the_rings_of_the_dome),
        cmocka_unit_test(angles_and_directions_are_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
