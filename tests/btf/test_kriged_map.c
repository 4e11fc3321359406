/* Kriging on a square of nodes: exact, bounded, and without what it leaves out. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "btf/direction/kriged_map.h"
#include "tests/support/expect_ok.h"

#include <math.h>

/* Few places lie in cells of their own, so that nodes can be exact at all of them. */
enum { SIDE = 9, NODES = SIDE * SIDE, PLACES = 30, FEW = 8 };

static void spread(weft_place *place, int count)
{
    for (int i = 0; i < count; i++)
        place[i] = weft_place_of_direction(
            weft_direction_of_angles((weft_angles){1.1 * sqrt((i + 0.5) / count), 2.399963229728653 * i}));
}

static float bump(weft_place place)
{
    double x = (double)place.x - 0.4, y = (double)place.y - 0.6;
    return (float)(2 + exp(-30 * (x * x + y * y)));
}

static double at_place(const float *node, weft_place place)
{
    weft_square_cell cell = weft_square_cell_at(place, SIDE);
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += (double)cell.weight[k] * (double)node[cell.index[k]];
    return sum;
}

/* Nodes by `count` places of the bump, and a second set that is twice as large. */
static void krige(const weft_place *place, const float *noise, int count, float nugget, bool ordinary,
                  float node[2 * NODES], float *residual)
{
    weft_error error = {0};
    weft_kriged_grid grid;
    weft_kriged_map *map = NULL;
    float value[2 * PLACES];
    for (int i = 0; i < count; i++) {
        value[2 * i] = bump(place[i]);
        value[2 * i + 1] = 2 * value[2 * i];
    }
    expect_ok(weft_kriged_grid_create(SIDE, false, 0.8f, 0, &grid, &error), &error);
    expect_ok(
        weft_kriged_map_create(
            &(weft_kriged_places){
                .grid = &grid, .place = place, .noise = noise, .count = count, .nugget = nugget, .ordinary = ordinary},
            &map, &error),
        &error);
    expect_ok(weft_kriged_map_solve(map, value, 2, node, &error), &error);
    if (residual)
        expect_ok(weft_kriged_map_leave_out(map, value, 2, residual, &error), &error);
    weft_kriged_map_free(map);
    weft_kriged_grid_free(&grid);
}

static void without_noise_it_is_exact_at_its_places(void **state)
{
    (void)state;
    weft_place place[PLACES];
    float node[2 * NODES], first[NODES];
    spread(place, FEW);
    krige(place, NULL, FEW, 1e-6f, false, node, NULL);
    for (int i = 0; i < NODES; i++) {
        first[i] = node[2 * i];
        assert_float_equal(node[2 * i + 1], 2 * node[2 * i], 1e-3);
    }
    for (int i = 0; i < FEW; i++)
        assert_float_equal(at_place(first, place[i]), (double)bump(place[i]), 2e-3);
}

/* Far from its places it returns to 0, or to the mean where it is ordinary. */
static void far_away_it_returns_to_the_mean(void **state)
{
    (void)state;
    const weft_place place[] = {{0.5, 0.5}, {0.52, 0.5}, {0.5, 0.52}};
    float node[2 * NODES];
    krige(place, NULL, 3, 0.1f, true, node, NULL);
    assert_float_equal(node[0], ((double)bump(place[0]) + (double)bump(place[1]) + (double)bump(place[2])) / 3, 0.02);
    krige(place, NULL, 3, 0.1f, false, node, NULL);
    assert_true(node[0] < 0.9f * bump(place[0]));
}

/* A value of much noise says nothing. */
static void noise_takes_a_value_out(void **state)
{
    (void)state;
    weft_place place[PLACES];
    float noise[PLACES] = {0}, with[2 * NODES], without[2 * NODES];
    spread(place, PLACES);
    noise[PLACES - 1] = 1e6f;
    krige(place, noise, PLACES, 1e-3f, true, with, NULL);
    krige(place, NULL, PLACES - 1, 1e-3f, true, without, NULL);
    for (int i = 0; i < 2 * NODES; i++)
        assert_float_equal(with[i], without[i], 1e-3);
}

/* What is left out is what the others miss it by, found in one go. */
static void what_is_left_out_is_predicted_by_the_others(void **state)
{
    (void)state;
    for (int ordinary = 0; ordinary < 2; ordinary++) {
        weft_place place[PLACES];
        float node[2 * NODES], first[NODES], residual[2 * PLACES];
        spread(place, PLACES);
        krige(place, NULL, PLACES, 1e-3f, ordinary, node, residual);
        krige(place, NULL, PLACES - 1, 1e-3f, ordinary, node, NULL);
        for (int i = 0; i < NODES; i++)
            first[i] = node[2 * i];
        double missed = (double)bump(place[PLACES - 1]) - at_place(first, place[PLACES - 1]);
        assert_true(fabs(missed) > 1e-3);
        assert_float_equal(residual[2 * (PLACES - 1)], missed, 1e-3);
    }
}

/* Little where places are, all where none are. */
static void variances_grow_away_from_the_places(void **state)
{
    (void)state;
    weft_error error = {0};
    const weft_place place[] = {{0.5, 0.5}};
    float variance[NODES];
    weft_kriged_grid grid;
    weft_kriged_map *map = NULL;
    expect_ok(weft_kriged_grid_create(SIDE, true, 0.3f, 0, &grid, &error), &error);
    expect_ok(weft_kriged_map_create(&(weft_kriged_places){.grid = &grid, .place = place, .count = 1, .nugget = 1e-3f},
                                     &map, &error),
              &error);
    expect_ok(weft_kriged_map_variances(map, variance, &error), &error);
    assert_float_equal(variance[NODES / 2], 1e-3, 1e-4);
    assert_true(variance[0] > 0.98f && variance[0] <= 1.0001f);
    weft_kriged_map_free(map);
    weft_kriged_grid_free(&grid);
}

static void places_have_inverses(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        weft_vec3 d = weft_direction_of_angles((weft_angles){1.57 * sqrt((i + 0.5) / 200), 2.399963229728653 * i});
        weft_vec3 same = weft_direction_of_place(weft_place_of_direction(d));
        weft_vec3 half = weft_half_vector_of_place(weft_place_of_half_vector(d));
        assert_float_equal(weft_length(weft_subtract(d, same)), 0, 1e-12);
        assert_float_equal(weft_length(weft_subtract(d, half)), 0, 1e-7);
    }
}

int test_kriged_map(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_noise_it_is_exact_at_its_places),
        cmocka_unit_test(far_away_it_returns_to_the_mean),
        cmocka_unit_test(noise_takes_a_value_out),
        cmocka_unit_test(what_is_left_out_is_predicted_by_the_others),
        cmocka_unit_test(variances_grow_away_from_the_places),
        cmocka_unit_test(places_have_inverses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
