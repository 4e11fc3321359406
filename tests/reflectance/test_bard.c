/* BARD: the reference vectors, the properties of the map, and extremes. Built twice: in double, and in single
 * precision. */
#include "btf/direction/direction.h"
#include "reflectance/bard/bard.h"
#include "tests/reflectance/bard_fixture.h"

#include <string.h>

/* ---- Reference vectors ---- */

enum { ANGLES = 4, DIRECTIONS = 6, VALUES = 3, OUTPUTS = ANGLES + DIRECTIONS + VALUES };

static const char *const output_column[OUTPUTS] = {"theta_i", "beta", "beta_o",      "gain",        "vox",
                                                   "voy",     "voz",  "vox_printed", "voy_printed", "voz_printed",
                                                   "rho_o",   "f",    "f_printed"};

static void outputs_at(const weft_bard_grid *grid, weft_real rho_d, direction_pair at, double out[OUTPUTS])
{
    weft_bard_point point = weft_bard_locate(WEFT_BARD_IN_PLANE, at.light, at.view);
    weft_bard_point printed = weft_bard_locate(WEFT_BARD_PRINTED, at.light, at.view);
    const double value[OUTPUTS] = {
        point.theta_light_rad,
        point.beta_rad,
        point.beta_o_rad,
        point.gain,
        point.direction.x,
        point.direction.y,
        point.direction.z,
        printed.direction.x,
        printed.direction.y,
        printed.direction.z,
        weft_bard_grid_lookup(grid, point.direction),
        weft_bard_brdf(WEFT_BARD_IN_PLANE, rho_d, weft_bard_grid_lookup, grid, at.light, at.view),
        weft_bard_brdf(WEFT_BARD_PRINTED, rho_d, weft_bard_grid_lookup, grid, at.light, at.view),
    };
    memcpy(out, value, sizeof value);
}

static bool is_component(int output)
{
    return output >= ANGLES && output < ANGLES + DIRECTIONS;
}

/* The printed map counts azimuths from -pi to pi and jumps there. */
static const double jump = 0.01;

/* Where an output jumps under perturbations of the size of rounding and lands nearer to the expected value, the row
 * lies on the jump: `out` becomes that value. */
static void choose_side_of_jump(const reference_vectors *v, int row, const weft_bard_grid *grid, double out[OUTPUTS])
{
    direction_pair at = {vectors_direction(v, row, "wi"), vectors_direction(v, row, "wo")};
    weft_real rho_d = (weft_real)vectors_number(v, row, "rho_d");
    double other[OUTPUTS];
    for (unsigned sample = 0; sample < VECTORS_SAMPLES; sample++) {
        outputs_at(grid, rho_d, vectors_perturbed(at, sample, 2 * (double)WEFT_REAL_EPSILON), other);
        for (int i = 0; i < OUTPUTS; i++) {
            double expected = vectors_number(v, row, output_column[i]);
            if (fabs(other[i] - out[i]) > jump && fabs(other[i] - expected) < fabs(out[i] - expected))
                out[i] = other[i];
        }
    }
}

/* A component of a unit vector is judged relative to the vector. */
static void check_row(reference_vectors *v, int row, const weft_bard_grid *grid)
{
    direction_pair at = {vectors_direction(v, row, "wi"), vectors_direction(v, row, "wo")};
    double out[OUTPUTS], condition = vectors_number(v, row, "cond");
    outputs_at(grid, (weft_real)vectors_number(v, row, "rho_d"), at, out);
    choose_side_of_jump(v, row, grid, out);
    for (int i = 0; i < OUTPUTS; i++) {
        if (is_component(i))
            vectors_check_within(v, row, output_column[i], out[i],
                                 1e-6 + 20 * fmax(condition, 1) * (double)WEFT_REAL_EPSILON);
        else
            vectors_check(v, row, output_column[i], out[i]);
    }
}

static void map_and_value_match_every_row(void **state)
{
    (void)state;
    bard_table table;
    bard_table_read(&table);
    weft_bard_grid grid = bard_table_grid(&table);
    reference_vectors v = vectors_open("bard.csv", 330);
    for (int row = 0; row < v.csv.row_count; row++)
        check_row(&v, row, &grid);
    vectors_close(&v);
}

/* ---- Properties of the map ---- */

static const double rounding = 64 * (double)WEFT_REAL_EPSILON;

static double distance(weft_vec3 a, weft_vec3 b)
{
    return (double)weft_length(weft_subtract(a, b));
}

static void mirror_direction_looks_up_the_normal(void **state)
{
    (void)state;
    uint64_t random = 3;
    for (int i = 0; i < 100000; i++) {
        weft_vec3 light = random_direction(&random);
        if (weft_angles_of_direction(light).theta_rad > weft_rad_of_deg(85))
            continue;
        weft_bard_point point = weft_bard_locate(WEFT_BARD_IN_PLANE, light, weft_vec3_of(-light.x, -light.y, light.z));
        assert_true(distance(point.direction, weft_vec3_of(0, 0, 1)) < 40 * rounding);
    }
}

static void light_along_the_normal_looks_up_the_view(void **state)
{
    (void)state;
    uint64_t random = 5;
    for (int i = 0; i < 1000; i++) {
        weft_vec3 view = random_direction(&random);
        weft_bard_point point = weft_bard_locate(WEFT_BARD_IN_PLANE, weft_vec3_of(0, 0, 1), view);
        assert_true(distance(point.direction, view) == 0 && point.gain == 1);
        weft_vec3 nearly = weft_direction_of_angles((weft_angles){(weft_real)1e-5, random_between(&random, 0, 6)});
        assert_true(distance(weft_bard_locate(WEFT_BARD_IN_PLANE, nearly, view).direction, view) < 2e-5);
    }
}

/* At beta = elevation of the light, in every plane through the projection. */
static void map_is_continuous_where_its_branches_meet(void **state)
{
    (void)state;
    uint64_t random = 7;
    const weft_real step = 64 * (weft_real)WEFT_REAL_EPSILON;
    for (int i = 0; i < 100000; i++) {
        weft_real elevation = weft_rad_of_deg(random_between(&random, 3, 89));
        weft_real tilt = random_between(&random, 0.01, 3.1);
        weft_vec3 light = weft_vec3_of(-cos(elevation), 0, sin(elevation)), looked_up[2];
        for (int side = 0; side < 2; side++) {
            weft_real beta = elevation * (1 + (side ? step : -step));
            weft_vec3 view = weft_unit(weft_vec3_of(cos(beta), sin(beta) * cos(tilt), sin(beta) * sin(tilt)));
            looked_up[side] = weft_bard_locate(WEFT_BARD_IN_PLANE, light, view).direction;
        }
        assert_true(distance(looked_up[0], looked_up[1]) < 60 * rounding);
    }
}

/* beta 0 and pi stay, and the looked-up direction lies in the plane of projection and view. */
static void map_turns_in_the_plane_and_keeps_its_ends(void **state)
{
    (void)state;
    uint64_t random = 9;
    for (int i = 0; i < 100000; i++) {
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        weft_vec3 projection = weft_unit(weft_vec3_of(-light.x, -light.y, 0));
        weft_vec3 direction = weft_bard_locate(WEFT_BARD_IN_PLANE, light, view).direction;
        weft_real volume = weft_dot(weft_cross(projection, weft_unit(view)), direction);
        assert_true(fabs((double)volume) < 4 * rounding);
        for (int end = -1; end <= 1; end += 2) {
            weft_vec3 along = weft_scale(projection, end);
            assert_true(distance(weft_bard_locate(WEFT_BARD_IN_PLANE, light, along).direction, along) < rounding);
        }
    }
}

static void gain_stays_at_its_cap_beyond_87_degrees(void **state)
{
    (void)state;
    const weft_vec3 view = {0, 0, 1};
    for (int i = 0; i < 100; i++) {
        weft_vec3 light = weft_direction_of_angles((weft_angles){weft_rad_of_deg(87 + (weft_real)i * 3 / 100), 1});
        weft_bard_point point = weft_bard_locate(WEFT_BARD_IN_PLANE, light, view);
        assert_true(fabs((double)point.gain / 365.089777 - 1) < 1e-5);
    }
    weft_vec3 below = weft_direction_of_angles((weft_angles){weft_rad_of_deg(80), 1});
    assert_true(fabs((double)weft_bard_locate(WEFT_BARD_IN_PLANE, below, view).gain / 33.1634 - 1) < 1e-5);
}

/* ---- Measured views ---- */

/* Values that are linear in the direction are interpolated exactly on the triangles' planes, so a table of views gives
 * what a table of angles would. */
static void a_constant_table_of_views_gives_the_gain(void **state)
{
    (void)state;
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    weft_triangulation *views;
    weft_error error = {0};
    assert_int_equal(weft_triangulation_build(direction, WEFT_UBO81_COUNT, &views, &error), WEFT_OK);
    uint64_t random = 13;
    for (int i = 0; i < 10000; i++) {
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        weft_bard_point point = weft_bard_locate(WEFT_BARD_IN_PLANE, light, view);
        weft_bard_mix mix = weft_bard_mix_views(WEFT_BARD_IN_PLANE, views, light, view);
        weft_vec3 mean = {0, 0, 0};
        for (int k = 0; k < 3 && mix.at.index[k] >= 0; k++)
            mean = weft_add(mean, weft_scale(direction[mix.at.index[k]], mix.at.weight[k]));
        assert_true(mix.gain == point.gain);
        /* Within the outer ring the mean of the corners lies on the ray that was asked for. */
        if (point.direction.z > (weft_real)0.27)
            assert_true(distance(weft_unit(mean), point.direction) < 20 * rounding);
    }
    assert_true(weft_bard_mix_views(WEFT_BARD_IN_PLANE, views, weft_vec3_of(0, 0, -1), direction[0]).gain == 0);
    weft_triangulation_free(views);
}

/* ---- Extremes ---- */

static void below_the_horizon_there_is_nothing(void **state)
{
    (void)state;
    const weft_real value[] = {1, 1};
    const weft_bard_grid grid = {2, 1, value};
    const weft_vec3 up = {0, 0, 1}, down = {0, (weft_real)0.6, (weft_real)-0.8}, level = {1, 0, 0};
    assert_true(weft_bard_brdf(WEFT_BARD_IN_PLANE, 1, weft_bard_grid_lookup, &grid, up, down) == 0);
    assert_true(weft_bard_brdf(WEFT_BARD_IN_PLANE, 1, weft_bard_grid_lookup, &grid, down, up) == 0);
    assert_true(weft_bard_brdf(WEFT_BARD_IN_PLANE, 1, weft_bard_grid_lookup, &grid, level, up) == 0);
    assert_true(weft_bard_brdf(WEFT_BARD_IN_PLANE, 0, weft_bard_grid_lookup, &grid, up, up) == 1);
}

int test_bard(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(map_and_value_match_every_row),
        cmocka_unit_test(mirror_direction_looks_up_the_normal),
        cmocka_unit_test(light_along_the_normal_looks_up_the_view),
        cmocka_unit_test(map_is_continuous_where_its_branches_meet),
        cmocka_unit_test(map_turns_in_the_plane_and_keeps_its_ends),
        cmocka_unit_test(gain_stays_at_its_cap_beyond_87_degrees),
        cmocka_unit_test(a_constant_table_of_views_gives_the_gain),
        cmocka_unit_test(below_the_horizon_there_is_nothing),
    };
    return cmocka_run_group_tests_name("BARD", tests, NULL, NULL);
}
