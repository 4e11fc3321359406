/* Built twice: in double, and in single precision. */
#include "base/text/csv.h"
#include "btf/direction/direction.h"
#include "btf/direction/triangulation.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>
#include <string.h>

/* Acceptance rule of the reference vectors (README section 8); cond is 1 for an interpolation. */
static const double relative_tolerance = 1e-6 + 20 * WEFT_REAL_EPSILON;

enum { MAX_SET = 128, MANY = 4096 };

typedef struct view_table {
    int count;
    weft_vec3 direction[MAX_SET];
    double value[MAX_SET][4];
} view_table;

static double number(const weft_csv *csv, int row, const char *column)
{
    double value;
    weft_error error = {0};
    assert_int_equal(weft_csv_number(csv, row, weft_csv_column(csv, column), &value, &error), WEFT_OK);
    return value;
}

static weft_vec3 direction_at(const weft_csv *csv, int row, const char *const column[3])
{
    return weft_unit(
        weft_vec3_of(number(csv, row, column[0]), number(csv, row, column[1]), number(csv, row, column[2])));
}

static weft_csv reference(const char *path)
{
    weft_csv csv;
    weft_error error = {0};
    assert_int_equal(weft_csv_read(path, true, &csv, &error), WEFT_OK);
    return csv;
}

static view_table read_table(const weft_csv *sets, const char *name)
{
    static const char *const axis[3] = {"x", "y", "z"}, *const channel[4] = {"r", "g", "b", "a"};
    view_table table = {0};
    for (int row = 0; row < sets->row_count; row++) {
        if (strcmp(weft_csv_text(sets, row, 0), name) != 0)
            continue;
        table.direction[table.count] = direction_at(sets, row, axis);
        for (int i = 0; i < 4; i++)
            table.value[table.count][i] = number(sets, row, channel[i]);
        table.count++;
    }
    return table;
}

static weft_triangulation *triangulate(const weft_vec3 *direction, int count)
{
    weft_triangulation *triangulation;
    weft_error error = {0};
    assert_int_equal(weft_triangulation_build(direction, count, &triangulation, &error), WEFT_OK);
    return triangulation;
}

static double interpolate(const view_table *table, const weft_barycentric *at, int channel)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += at->index[i] < 0 ? 0 : at->weight[i] * table->value[at->index[i]][channel];
    return sum;
}

static void every_reference_row_is_reproduced(void **state)
{
    (void)state;
    static const char *const axis[3] = {"vx", "vy", "vz"}, *const channel[4] = {"r", "g", "b", "a"};
    weft_csv sets = reference(WEFT_TEST_DATA "/reference/view_table_sets.csv");
    weft_csv rows = reference(WEFT_TEST_DATA "/reference/view_table_eval.csv");
    assert_int_equal(rows.row_count, 300);
    for (int row = 0; row < rows.row_count; row++) {
        view_table table = read_table(&sets, weft_csv_text(&rows, row, 1));
        weft_triangulation *triangulation = triangulate(table.direction, table.count);
        weft_barycentric at = weft_triangulation_lookup(triangulation, direction_at(&rows, row, axis));
        for (int i = 0; i < 4; i++) {
            double expected = number(&rows, row, channel[i]);
            double found = interpolate(&table, &at, i);
            if (!(fabs(found - expected) <= relative_tolerance * fabs(expected)))
                fail_msg("row %d channel %d: %.9g, expected %.9g", row, i, found, expected);
        }
        weft_triangulation_free(triangulation);
    }
    weft_csv_free(&sets);
    weft_csv_free(&rows);
}

static weft_real weight_sum(const weft_barycentric *at)
{
    assert_true(at->weight[0] >= 0 && at->weight[1] >= 0 && at->weight[2] >= 0);
    return at->weight[0] + at->weight[1] + at->weight[2];
}

static double weight_of(const weft_barycentric *at, int index)
{
    double weight = 0;
    for (int i = 0; i < 3; i++)
        weight += at->index[i] == index ? (double)at->weight[i] : 0;
    return weight;
}

static weft_vec3 fibonacci(int index, int count, double lowest_z)
{
    double z = 1 - (1 - lowest_z) * (index + 0.5) / count, phi = index * 2.399963229728653;
    return weft_unit(weft_vec3_of(sqrt(1 - z * z) * cos(phi), sqrt(1 - z * z) * sin(phi), z));
}

/* A planar subdivision without holes: V - E + F = 1, with 3 F = 2 E - border. */
static void check_disc(const weft_vec3 *direction, int count, int border)
{
    weft_triangulation *triangulation = triangulate(direction, count);
    assert_int_equal(weft_triangulation_triangle_count(triangulation), 2 * count - 2 - border);
    for (int i = 0; i < count; i++) {
        weft_barycentric at = weft_triangulation_lookup(triangulation, direction[i]);
        assert_true(weight_of(&at, i) > 1 - 1e-4);
    }
    weft_triangulation_free(triangulation);
}

static void ubo81_is_a_disc_with_24_border_edges(void **state)
{
    (void)state;
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    check_disc(direction, WEFT_UBO81_COUNT, 24);
}

/* Rings of equal size: every cell between two rings has its four corners on one circle. */
static void cocircular_rings_give_a_closed_disc(void **state)
{
    (void)state;
    enum { RINGS = 9, SECTORS = 36 };
    weft_vec3 direction[1 + RINGS * SECTORS] = {{0, 0, 1}};
    for (int i = 0; i < RINGS * SECTORS; i++) {
        weft_angles angles = {weft_rad_of_deg(8 + 8 * (i / SECTORS)), weft_rad_of_deg(10 * (i % SECTORS))};
        direction[1 + i] = weft_direction_of_angles(angles);
    }
    check_disc(direction, 1 + RINGS * SECTORS, SECTORS);
    check_disc(direction + 1, RINGS * SECTORS, SECTORS);
    check_disc(direction + 1, SECTORS, SECTORS);
}

static void order_of_rows_does_not_disturb_a_disc(void **state)
{
    (void)state;
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i * 32 % WEFT_UBO81_COUNT] = weft_direction_of_angles(weft_ubo81_angles(i));
    check_disc(direction, WEFT_UBO81_COUNT, 24);
}

static void weights_reproduce_the_query_inside(void **state)
{
    (void)state;
    static weft_vec3 direction[MANY];
    for (int i = 0; i < MANY; i++)
        direction[i] = fibonacci(i, MANY, 0.05);
    weft_triangulation *triangulation = triangulate(direction, MANY);
    for (int i = 0; i < 20000; i++) {
        weft_vec3 query = fibonacci(i, 20000, 0.1), sum = {0, 0, 0};
        weft_barycentric at = weft_triangulation_lookup(triangulation, query);
        for (int k = 0; k < 3; k++)
            sum = weft_add(sum, weft_scale(direction[at.index[k]], at.weight[k]));
        assert_true(fabs(weight_sum(&at) - 1) < 1e-6);
        assert_true(weft_length(weft_subtract(weft_unit(sum), query)) < 1e-6 + 100 * WEFT_REAL_EPSILON);
        assert_true(weft_length(weft_subtract(direction[at.index[0]], query)) < 0.15);
    }
    weft_triangulation_free(triangulation);
}

static void one_direction_is_a_constant(void **state)
{
    (void)state;
    weft_vec3 direction = {0, 0, 1};
    weft_triangulation *triangulation = triangulate(&direction, 1);
    weft_barycentric at = weft_triangulation_lookup(triangulation, weft_unit(weft_vec3_of(1, 2, 1)));
    assert_int_equal(at.index[0], 0);
    assert_true(at.weight[0] == 1 && at.index[1] == -1 && at.index[2] == -1);
    weft_triangulation_free(triangulation);
}

static void two_directions_are_an_arc(void **state)
{
    (void)state;
    weft_vec3 direction[2] = {{0, 0, 1}, {1, 0, 0}};
    weft_triangulation *triangulation = triangulate(direction, 2);
    weft_barycentric at = weft_triangulation_lookup(triangulation, weft_unit(weft_vec3_of(1, 2, 3)));
    assert_true(fabs(weight_of(&at, 0) - 0.75) < 1e-6 && fabs(weight_of(&at, 1) - 0.25) < 1e-6);
    at = weft_triangulation_lookup(triangulation, weft_unit(weft_vec3_of(-1, 2, 3)));
    assert_true(weight_of(&at, 0) == 1);
    weft_triangulation_free(triangulation);
}

static void three_directions_are_one_triangle(void **state)
{
    (void)state;
    weft_vec3 direction[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    weft_triangulation *triangulation = triangulate(direction, 3);
    assert_int_equal(weft_triangulation_triangle_count(triangulation), 1);
    weft_barycentric at = weft_triangulation_lookup(triangulation, weft_unit(weft_vec3_of(1, 2, 5)));
    assert_true(fabs(weight_of(&at, 0) - 0.125) < 1e-6 && fabs(weight_of(&at, 2) - 0.625) < 1e-6);
    weft_triangulation_free(triangulation);
}

/* Directions measured in one plane only, as a gonioreflectometer does, in any order. */
static void a_great_circle_becomes_a_chain_of_arcs(void **state)
{
    (void)state;
    static const int theta_deg[7] = {30, -60, 0, 60, -30, 75, -75};
    weft_vec3 direction[7];
    for (int i = 0; i < 7; i++)
        direction[i] = weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg[i]), weft_rad_of_deg(20)});
    weft_triangulation *triangulation = triangulate(direction, 7);
    assert_int_equal(weft_triangulation_triangle_count(triangulation), 0);
    weft_vec3 query = weft_direction_of_angles((weft_angles){weft_rad_of_deg(-45), weft_rad_of_deg(20)});
    weft_barycentric at = weft_triangulation_lookup(triangulation, query);
    assert_true(fabs(weight_of(&at, 1) - 0.5) < 1e-5 && fabs(weight_of(&at, 4) - 0.5) < 1e-5);
    weft_triangulation_free(triangulation);
}

static void repeated_directions_are_merged_with_the_first(void **state)
{
    (void)state;
    weft_vec3 direction[8] = {{0, 0, 1}, {1, 0, 1}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {-1, 0, 1}, {0, -1, 1}, {0, 1, 1}};
    for (int i = 0; i < 8; i++)
        direction[i] = weft_unit(direction[i]);
    weft_triangulation *triangulation = triangulate(direction, 8);
    assert_int_equal(weft_triangulation_triangle_count(triangulation), 4);
    weft_barycentric at = weft_triangulation_lookup(triangulation, direction[4]);
    assert_true(fabs(weight_of(&at, 1) - 1) < 1e-6);
    weft_triangulation_free(triangulation);

    weft_vec3 same[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    triangulation = triangulate(same, 3);
    at = weft_triangulation_lookup(triangulation, direction[1]);
    assert_true(weight_of(&at, 0) == 1);
    weft_triangulation_free(triangulation);
}

static void any_query_has_weights_that_sum_to_one(void **state)
{
    (void)state;
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    weft_triangulation *triangulation = triangulate(direction, WEFT_UBO81_COUNT);
    for (int i = 0; i < 10000; i++) {
        weft_vec3 query = fibonacci(i, 10000, -1);
        weft_barycentric at = weft_triangulation_lookup(triangulation, query);
        assert_true(fabs(weight_sum(&at) - 1) < 1e-6);
        if (query.z < 0.2)
            assert_int_equal(at.index[2], -1);
    }
    weft_triangulation_free(triangulation);
}

/* The share of the second end of an arc at the foot of `query` on it, by solid angles, in double. */
static double share_on_arc(weft_vec3 a, weft_vec3 b, weft_vec3 query)
{
    const double A[3] = {a.x, a.y, a.z}, B[3] = {b.x, b.y, b.z}, q[3] = {query.x, query.y, query.z};
    double aa = 0, bb = 0, ab = 0, aq = 0, bq = 0;
    for (int i = 0; i < 3; i++) {
        aa += A[i] * A[i];
        bb += B[i] * B[i];
        ab += A[i] * B[i];
        aq += A[i] * q[i];
        bq += B[i] * q[i];
    }
    double of_a = bb * aq - ab * bq, of_b = aa * bq - ab * aq;
    return of_b / (of_a + of_b);
}

/* There the distances to a foot on an arc and to its end differ by less than rounding. */
static void weights_next_to_a_corner_of_the_border_are_those_of_the_foot(void **state)
{
    (void)state;
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    weft_triangulation *t = triangulate(direction, WEFT_UBO81_COUNT);
    enum { RING = 57, CORNERS = 24, STEPS = 100 };
    for (int i = 0; i < CORNERS * STEPS; i++) {
        int corner = i / STEPS, next = RING + (corner + 1) % CORNERS;
        weft_real phi_deg = 15 * (weft_real)corner + (weft_real)(i % STEPS) / 100;
        weft_vec3 query = weft_direction_of_angles((weft_angles){weft_rad_of_deg(89), weft_rad_of_deg(phi_deg)});
        weft_barycentric at = weft_triangulation_lookup(t, query);
        double expected = fmax(share_on_arc(direction[RING + corner], direction[next], query), 0), share = 0;
        for (int k = 0; k < 3; k++)
            share += at.index[k] == next ? (double)at.weight[k] : 0;
        assert_float_equal(share, expected, 64 * (double)WEFT_REAL_EPSILON);
    }
    weft_triangulation_free(t);
}

static void bad_directions_are_refused_with_their_number(void **state)
{
    (void)state;
    weft_triangulation *triangulation;
    weft_error error = {0};
    weft_vec3 direction[2] = {{0, 0, 1}, {0, 0, 0}};
    assert_int_equal(weft_triangulation_build(direction, 0, &triangulation, &error), WEFT_BAD_INPUT);
    assert_int_equal(weft_triangulation_build(direction, 2, &triangulation, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "direction 1 of 2"));
    direction[1] = weft_vec3_of((weft_real)NAN, 0, 1);
    assert_int_equal(weft_triangulation_build(direction, 2, &triangulation, &error), WEFT_BAD_INPUT);
    assert_null(triangulation);
    weft_triangulation_free(triangulation);
}

int test_triangulation(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_reference_row_is_reproduced),
        cmocka_unit_test(ubo81_is_a_disc_with_24_border_edges),
        cmocka_unit_test(cocircular_rings_give_a_closed_disc),
        cmocka_unit_test(order_of_rows_does_not_disturb_a_disc),
        cmocka_unit_test(weights_reproduce_the_query_inside),
        cmocka_unit_test(one_direction_is_a_constant),
        cmocka_unit_test(two_directions_are_an_arc),
        cmocka_unit_test(three_directions_are_one_triangle),
        cmocka_unit_test(a_great_circle_becomes_a_chain_of_arcs),
        cmocka_unit_test(repeated_directions_are_merged_with_the_first),
        cmocka_unit_test(any_query_has_weights_that_sum_to_one),
        cmocka_unit_test(weights_next_to_a_corner_of_the_border_are_those_of_the_foot),
        cmocka_unit_test(bad_directions_are_refused_with_their_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
