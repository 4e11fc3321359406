/* Squares of directions: places, interpolation, and the smoothest map through scattered values. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "btf/direction/smooth_map.h"
#include "tests/support/expect_ok.h"

#include <stdlib.h>

/* An odd side: the columns of its matrix are no multiple of those that are solved together. */
enum { SIDE = 13, NODES = SIDE * SIDE, SCATTERED = 81 };

static double random_unit(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-53;
}

/* Uniform in area over the hemisphere. */
static weft_vec3 random_direction(void)
{
    double z = random_unit(), azimuth = 2 * WEFT_PI * random_unit(), radius = sqrt(1 - z * z);
    return weft_vec3_of(radius * cos(azimuth), radius * sin(azimuth), z);
}

static void the_paraboloid_is_a_disc_that_touches_the_sides(void **state)
{
    (void)state;
    weft_place normal = weft_place_of_direction(weft_vec3_of(0, 0, 1));
    assert_float_equal(normal.x, 0.5, 1e-15);
    assert_float_equal(normal.y, 0.5, 1e-15);
    for (int i = 0; i < 100; i++) {
        weft_vec3 d = random_direction();
        weft_place p = weft_place_of_direction(d);
        /* Stereographic projection: the radius is tan(theta / 2), the azimuth stays. */
        double radius = tan(acos((double)d.z) / 2) / 2;
        assert_float_equal(hypot(p.x - 0.5, p.y - 0.5), radius, 1e-12);
        assert_float_equal((p.x - 0.5) * d.y, (p.y - 0.5) * d.x, 1e-12);
    }
    assert_float_equal(weft_place_of_direction(weft_vec3_of(1, 0, 0)).x, 1, 1e-15);
}

/* As many half vectors, spread evenly over the hemisphere, fall into each part of the square as its area says. */
static void the_concentric_map_keeps_areas(void **state)
{
    (void)state;
    enum { PARTS = 6, COUNT = 200000 };
    int found[PARTS * PARTS] = {0};
    for (int i = 0; i < COUNT; i++) {
        weft_place p = weft_place_of_half_vector(random_direction());
        assert_true(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1);
        found[(int)fmin(p.y * PARTS, PARTS - 1) * PARTS + (int)fmin(p.x * PARTS, PARTS - 1)]++;
    }
    for (int i = 0; i < PARTS * PARTS; i++)
        assert_float_equal((double)found[i] * PARTS * PARTS / COUNT, 1, 0.06);
}

/* Steps of a direction are steps of its place: no seam between the quarters. */
static void the_concentric_map_is_continuous(void **state)
{
    (void)state;
    for (int i = 0; i < 2000; i++) {
        double azimuth = 2 * WEFT_PI * i / 2000, theta = 0.9;
        weft_place a = weft_place_of_half_vector(weft_direction_of_angles((weft_angles){theta, azimuth}));
        weft_place b = weft_place_of_half_vector(weft_direction_of_angles((weft_angles){theta, azimuth + 1e-4}));
        assert_true(hypot(a.x - b.x, a.y - b.y) < 2e-4);
    }
}

static double plane(weft_place p)
{
    return 0.3 + 2 * p.x - 0.7 * p.y;
}

static void cells_interpolate_planes_exactly(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        weft_place p = {1.2 * random_unit() - 0.1, 1.2 * random_unit() - 0.1};
        weft_place inside = {fmin(fmax(p.x, 0), 1), fmin(fmax(p.y, 0), 1)};
        weft_square_cell cell = weft_square_cell_at(p, SIDE);
        double value = 0, total = 0;
        for (int corner = 0; corner < 4; corner++) {
            int index = cell.index[corner];
            assert_true(index >= 0 && index < NODES && cell.weight[corner] >= 0);
            weft_place node = {index % SIDE / (double)(SIDE - 1), index / SIDE / (double)(SIDE - 1)};
            value += cell.weight[corner] * plane(node);
            total += cell.weight[corner];
        }
        assert_float_equal(total, 1, 1e-12);
        assert_float_equal(value, plane(inside), 1e-12);
    }
}

/* ---- Smooth maps ---- */

typedef struct scene {
    weft_place place[SCATTERED], zero[4];
    float value[SCATTERED], weight[SCATTERED];
} scene;

static scene make_scene(void)
{
    scene s = {.zero = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
    for (int i = 0; i < SCATTERED; i++) {
        s.place[i] = weft_place_of_direction(weft_direction_of_angles(weft_ubo81_angles(i)));
        s.value[i] = (float)(sin(5 * s.place[i].x) + random_unit());
        s.weight[i] = 0.1f + (float)(i % 5);
    }
    return s;
}

static double interpolated(const double *node, weft_place place)
{
    weft_square_cell cell = weft_square_cell_at(place, SIDE);
    double value = 0;
    for (int corner = 0; corner < 4; corner++)
        value += cell.weight[corner] * node[cell.index[corner]];
    return value;
}

static double squared(double x)
{
    return x * x;
}

/* What the header says the nodes minimise. */
static double objective(const scene *s, double smoothness, const double *f)
{
    double sum = 0, bend = 0;
    for (int i = 0; i < SCATTERED; i++)
        sum += (double)s->weight[i] * squared(interpolated(f, s->place[i]) - (double)s->value[i]);
    for (int i = 0; i < 4; i++)
        sum += squared(interpolated(f, s->zero[i]));
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double *at = f + y * SIDE + x;
            bend += x > 0 && x < SIDE - 1 ? squared(at[-1] - 2 * at[0] + at[1]) : 0;
            bend += y > 0 && y < SIDE - 1 ? squared(at[-SIDE] - 2 * at[0] + at[SIDE]) : 0;
            bend += x < SIDE - 1 && y < SIDE - 1 ? 2 * squared(at[0] - at[1] - at[SIDE] + at[SIDE + 1]) : 0;
        }
    return sum + smoothness * bend;
}

static weft_smooth_map *create(const scene *s, double smoothness)
{
    weft_error error = {0};
    weft_smooth_map *map = NULL;
    expect_ok(weft_smooth_map_create(&(weft_smooth_map_places){.side = SIDE,
                                                               .smoothness = smoothness,
                                                               .place = s->place,
                                                               .weight = s->weight,
                                                               .count = SCATTERED,
                                                               .zero = s->zero,
                                                               .zero_count = 4},
                                     &map, &error),
              &error);
    return map;
}

static void solve(const scene *s, double smoothness, const float *value, int series, float *node)
{
    weft_error error = {0};
    weft_smooth_map *map = create(s, smoothness);
    expect_ok(weft_smooth_map_solve(map, value, series, node, &error), &error);
    weft_smooth_map_free(map);
}

static void a_smooth_map_minimises_what_its_header_says(void **state)
{
    (void)state;
    const double smoothness = 0.02;
    scene s = make_scene();
    float found[NODES];
    double node[NODES], moved[NODES];
    solve(&s, smoothness, s.value, 1, found);
    for (int i = 0; i < NODES; i++)
        node[i] = (double)found[i];
    double least = objective(&s, smoothness, node);
    for (int i = 0; i < NODES; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            for (int j = 0; j < NODES; j++)
                moved[j] = node[j] + (i == j ? 0.01 * sign : 0);
            assert_true(objective(&s, smoothness, moved) > least);
        }
    }
}

/* The left half becomes the unit matrix, and the right one, which was that, the inverse: Gauss and Jordan. */
static void invert(double form[NODES][2 * NODES])
{
    for (int pivot = 0; pivot < NODES; pivot++) {
        double factor = 1 / form[pivot][pivot];
        for (int j = 0; j < 2 * NODES; j++)
            form[pivot][j] *= factor;
        for (int i = 0; i < NODES; i++) {
            double share = form[i][pivot];
            for (int j = 0; i != pivot && j < 2 * NODES; j++)
                form[i][j] -= share * form[pivot][j];
        }
    }
}

static void variances_are_the_diagonal_of_the_inverse(void **state)
{
    (void)state;
    static double form[NODES][2 * NODES], alone[NODES];
    const double smoothness = 0.02;
    weft_error error = {0};
    scene s = make_scene();
    float variance[NODES];
    for (int i = 0; i < SCATTERED; i++)
        s.value[i] = 0; /* then the objective is the quadratic form */
    for (int i = 0; i < NODES; i++) {
        double node[NODES] = {0};
        node[i] = 1;
        alone[i] = objective(&s, smoothness, node);
        form[i][NODES + i] = 1;
    }
    for (int i = 0; i < NODES; i++)
        for (int j = 0; j < NODES; j++) {
            double node[NODES] = {0};
            node[i]++;
            node[j]++;
            form[i][j] = i == j ? alone[i] : (objective(&s, smoothness, node) - alone[i] - alone[j]) / 2;
        }
    invert(form);
    weft_smooth_map *map = create(&s, smoothness);
    expect_ok(weft_smooth_map_variances(map, variance, &error), &error);
    weft_smooth_map_free(map);
    for (int i = 0; i < NODES; i++)
        assert_float_equal(variance[i], form[i][NODES + i], 1e-4 * form[i][NODES + i]);
}

static void a_plane_costs_nothing_and_goes_on_beyond_the_samples(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_smooth_map *map = NULL;
    scene s = make_scene();
    float value[SCATTERED], node[NODES];
    for (int i = 0; i < SCATTERED; i++)
        value[i] = (float)plane(s.place[i]);
    weft_smooth_map_places places = {.side = SIDE, .smoothness = 1e-2, .place = s.place, .count = SCATTERED};
    expect_ok(weft_smooth_map_create(&places, &map, &error), &error);
    expect_ok(weft_smooth_map_solve(map, value, 1, node, &error), &error);
    weft_smooth_map_free(map);
    for (int i = 0; i < NODES; i++)
        assert_float_equal(node[i], plane((weft_place){i % SIDE / (SIDE - 1.0), i / SIDE / (SIDE - 1.0)}), 1e-4);
}

static void sets_of_values_do_not_influence_each_other(void **state)
{
    (void)state;
    enum { SETS = 37 }; /* more than are solved for at once */
    scene s = make_scene();
    float many[SETS * SCATTERED], node[SETS * NODES], alone[NODES];
    for (int i = 0; i < SCATTERED; i++)
        for (int set = 0; set < SETS; set++)
            many[SETS * i + set] = (float)sin(set * i + 1.0) + s.value[i];
    solve(&s, 0.1, many, SETS, node);
    for (int set = 0; set < SETS; set++) {
        float own[SCATTERED];
        for (int i = 0; i < SCATTERED; i++)
            own[i] = many[SETS * i + set];
        solve(&s, 0.1, own, 1, alone);
        for (int i = 0; i < NODES; i++)
            assert_float_equal(node[SETS * i + set], alone[i], 0);
    }
}

static void a_map_without_places_is_zero_and_bad_sides_are_refused(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_smooth_map *map = NULL;
    float node[NODES];
    expect_ok(weft_smooth_map_create(&(weft_smooth_map_places){.side = SIDE, .smoothness = 1}, &map, &error), &error);
    expect_ok(weft_smooth_map_solve(map, NULL, 1, node, &error), &error);
    weft_smooth_map_free(map);
    for (int i = 0; i < NODES; i++)
        assert_true(node[i] >= 0 && node[i] <= 0);
    assert_int_equal(weft_smooth_map_create(&(weft_smooth_map_places){.side = 3, .smoothness = 1}, &map, &error),
                     WEFT_BAD_USAGE);
    assert_int_equal(weft_smooth_map_create(&(weft_smooth_map_places){.side = 8, .smoothness = 0}, &map, &error),
                     WEFT_BAD_USAGE);
}

int test_square_map(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_paraboloid_is_a_disc_that_touches_the_sides),
        cmocka_unit_test(the_concentric_map_keeps_areas),
        cmocka_unit_test(the_concentric_map_is_continuous),
        cmocka_unit_test(cells_interpolate_planes_exactly),
        cmocka_unit_test(a_smooth_map_minimises_what_its_header_says),
        cmocka_unit_test(variances_are_the_diagonal_of_the_inverse),
        cmocka_unit_test(a_plane_costs_nothing_and_goes_on_beyond_the_samples),
        cmocka_unit_test(sets_of_values_do_not_influence_each_other),
        cmocka_unit_test(a_map_without_places_is_zero_and_bad_sides_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
