/* How far heights are looked for, on textures whose period the test knows, and heights of cloth of many tiles: marks on
 * bumps, traced ray by ray. */
#include "relief/height_map.h"
#include "tests/support/expect_ok.h"

#include "btf/direction/direction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 12, TILES = 8, SIDE = TILE * TILES, VIEWS = 37 };

static const double pitch_mm = 0.1, tile_mm = TILE * 0.1;

static weft_vec3 direction[VIEWS];

/* ---- Textures ---- */

/* The value of feature k at a place of a view, in texels. */
typedef double texture_function(double x, double y, int k);

static double random_at(int x, int y, int k)
{
    uint32_t h = (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)k * 83492791u;
    h = (h ^ h >> 16) * 2246822519u;
    h = (h ^ h >> 13) * 3266489917u;
    return (double)(h >> 8) * 0x1p-24 - 0.5;
}

/* Repeats after a tile along x and two thirds of one along y, under as much noise as there is texture. */
static double repeating(double x, double y, int k)
{
    double u = 2 * WEFT_PI * x / TILE, v = 2 * WEFT_PI * y / 8;
    return 1 + cos(u + k) + 0.5 * cos(2 * u - v) + sin(v + 2 * k) + 3 * random_at((int)x, (int)y, k);
}

static double ribs(double x, double y, int k)
{
    (void)y;
    return 1 + cos(2 * WEFT_PI * x / TILE + k);
}

static double noise(double x, double y, int k)
{
    return 1 + random_at((int)x, (int)y, k);
}

static weft_features textured(texture_function *texture, int width, int height)
{
    weft_features features = {.width = width,
                              .height = height,
                              .view_count = 1,
                              .width_mm = width * pitch_mm,
                              .height_mm = height * pitch_mm,
                              .direction = direction};
    size_t texels = (size_t)width * (size_t)height;
    features.value = malloc(texels * WEFT_FEATURES * sizeof *features.value);
    assert_non_null(features.value);
    for (size_t i = 0; i < texels * WEFT_FEATURES; i++)
        features.value[i] = (float)texture((double)(i / WEFT_FEATURES % (size_t)width),
                                           (double)(i / WEFT_FEATURES / (size_t)width), (int)(i % WEFT_FEATURES));
    return features;
}

static double period_of(const weft_features *features)
{
    weft_error error = {0};
    double period;
    expect_ok(weft_relief_period(features, &period, &error), &error);
    return period;
}

static double reach_of(const weft_features *features)
{
    weft_error error = {0};
    double reach;
    expect_ok(weft_relief_reach(features, &reach, &error), &error);
    return reach;
}

/* ---- Period and reach ---- */

static void the_shorter_period_is_found_under_noise(void **state)
{
    (void)state;
    weft_features features = textured(repeating, SIDE, SIDE);
    assert_float_equal(period_of(&features), 0.8, 0.02);
    assert_float_equal(reach_of(&features), 1.0, 0.03);
    weft_features_free(&features);
}

static void what_is_masked_does_not_count(void **state)
{
    (void)state;
    weft_features features = textured(repeating, SIDE, SIDE);
    features.known = malloc(SIDE * SIDE);
    assert_non_null(features.known);
    memset(features.known, 1, SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        int x = i % SIDE, y = i / SIDE;
        if ((x / 20 + y / 20) % 3)
            continue;
        features.known[i] = 0;
        for (int k = 0; k < WEFT_FEATURES; k++)
            features.value[WEFT_FEATURES * i + k] = 30;
    }
    assert_float_equal(period_of(&features), 0.8, 0.02);
    weft_features_free(&features);
}

/* Along ribs nothing changes: their distance counts. */
static void ribs_repeat_along_one_axis(void **state)
{
    (void)state;
    weft_features features = textured(ribs, SIDE, 40);
    assert_float_equal(period_of(&features), tile_mm, 0.02);
    weft_features_free(&features);
}

static void where_nothing_repeats_the_size_bounds_the_search(void **state)
{
    (void)state;
    weft_features features = textured(noise, SIDE, 60);
    assert_true(isinf(period_of(&features)));
    assert_float_equal(reach_of(&features), 0.25 * 60 * pitch_mm, 1e-9);
    features.repeats = true;
    assert_float_equal(reach_of(&features), 1.25 * 60 * pitch_mm, 1e-9);
    weft_features_free(&features);
    features = textured(noise, 160, 160);
    assert_float_equal(reach_of(&features), 24 * pitch_mm, 1e-9);
    weft_features_free(&features);
    features = textured(repeating, TILE, 16);
    assert_true(period_of(&features) > 0.7);
    weft_features_free(&features);
}

/* ---- Heights of many tiles ---- */

static double bumps(double x, double y)
{
    double k = 2 * WEFT_PI / tile_mm;
    return -0.35 + 0.2 * cos(k * x) * cos(k * y) + 0.06 * sin(2 * k * x + 1);
}

static double mark(double x, double y, int k)
{
    double u = 2 * WEFT_PI * x / tile_mm, v = 2 * WEFT_PI * y / tile_mm;
    return 1 + 0.8 * sin(u + 2 * sin(v) + 0.8 * k) * cos(v + sin(u) + 1.3 * k);
}

/* Where the sight line through (x, y) of the plane z = 0 meets the bumps. */
static double height_seen(double x, double y, weft_vec3 view)
{
    double z = 0;
    while (z > bumps(x + z * view.x / view.z, y + z * view.y / view.z))
        z -= 0.001;
    return z;
}

static void fill_texel(weft_features *features, int view, int x, int y)
{
    weft_vec3 v = direction[view];
    double px = (x + 0.5) * pitch_mm, py = features->height_mm - (y + 0.5) * pitch_mm, z = height_seen(px, py, v);
    for (int k = 0; k < WEFT_FEATURES; k++) {
        float value = (float)mark(px + z * v.x / v.z, py + z * v.y / v.z, k);
        for (int tile = 0; tile < TILES * TILES; tile++) {
            size_t row = (size_t)view * SIDE + (size_t)(y + tile / TILES * TILE);
            features->value[WEFT_FEATURES * (row * SIDE + (size_t)(x + tile % TILES * TILE)) + (size_t)k] = value;
        }
    }
}

static weft_features bumpy_cloth(void)
{
    weft_features features = {.width = SIDE,
                              .height = SIDE,
                              .view_count = VIEWS,
                              .width_mm = TILES * tile_mm,
                              .height_mm = TILES * tile_mm,
                              .direction = direction,
                              .repeats = true};
    features.value = malloc((size_t)VIEWS * SIDE * SIDE * WEFT_FEATURES * sizeof *features.value);
    assert_non_null(features.value);
    for (int i = 0; i < VIEWS * TILE * TILE; i++)
        fill_texel(&features, i / (TILE * TILE), i % TILE, i / TILE % TILE);
    return features;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_error(const weft_height_map *map)
{
    static double apart[SIDE * SIDE];
    assert_int_equal(map->width * map->height, SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++)
        apart[i] = fabs((double)map->value[i] - bumps((i % SIDE + 0.5) * pitch_mm, (SIDE - i / SIDE - 0.5) * pitch_mm));
    qsort(apart, SIDE * SIDE, sizeof *apart, compare_doubles);
    return apart[SIDE * SIDE / 2];
}

/* Eight tiles side by side are no deeper than one. */
static void cloth_of_many_tiles_is_searched_as_deep_as_one(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_features features = bumpy_cloth();
    int view[VIEWS];
    for (int i = 0; i < VIEWS; i++)
        view[i] = i;
    double reach = reach_of(&features), low = -reach, high = reach;
    assert_float_equal(reach, 1.25 * tile_mm, 0.02);
    expect_ok(weft_height_range_find(&features, view, VIEWS, &low, &high, &error), &error);
    print_message("from %.3f to %.3f mm\n", low, high);
    assert_true(low > -0.8 && low < -0.45 && high > -0.35 && high < 0.1);
    weft_height_map map;
    const weft_height_search search = {&features, view, VIEWS, 64, 1, low, high};
    expect_ok(weft_height_map_find(&search, &map, &error), &error);
    print_message("median error %.4f mm\n", median_error(&map));
    assert_true(median_error(&map) < 0.03);
    weft_height_map_free(&map);
    weft_features_free(&features);
}

static int enter(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    return 0;
}

int test_relief_reach(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_shorter_period_is_found_under_noise),
        cmocka_unit_test(what_is_masked_does_not_count),
        cmocka_unit_test(ribs_repeat_along_one_axis),
        cmocka_unit_test(where_nothing_repeats_the_size_bounds_the_search),
        cmocka_unit_test(cloth_of_many_tiles_is_searched_as_deep_as_one),
    };
    return cmocka_run_group_tests(tests, enter, NULL);
}
