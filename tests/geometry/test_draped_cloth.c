/* The geometry of stitches laid over surfaces. */
#include "geometry/drape/draped_cloth.h"
#include "geometry/light/illumination.h"
#include "geometry/light/sample_sequence.h"
#include "tests/geometry/shipped_stitches.h"
#include "tests/support/cmocka_all.h"

#include <string.h>

enum { COARSE = 20, BOUNCES = 2, PATHS = 16384 };

/* A turn about the axis (1, 1, 1): x becomes y, y becomes z, z becomes x. */
static weft_vec3 turn(weft_vec3 a)
{
    return weft_vec3_of(a.z, a.x, a.y);
}

static weft_vec3 keep(weft_vec3 a)
{
    return a;
}

/* A flat patch: the cloth [x, x + width] x [0, height] lies at (0, 0, z). */
static void set_patch(weft_base_vertex vertex[4], uint32_t triangle[2][3], uint32_t first, weft_real x, weft_real z,
                      weft_real width, weft_real height)
{
    const uint32_t corner[2][3] = {{0, 1, 3}, {0, 3, 2}};
    for (int i = 0; i < 4; i++) {
        weft_real u = i % 2 * width, v = i / 2 * height;
        vertex[i] = (weft_base_vertex){weft_vec3_of(u, v, z), weft_vec3_of(0, 0, 1), x + u, v};
    }
    for (int i = 0; i < 6; i++)
        triangle[i / 3][i % 3] = first + corner[i / 3][i % 3];
}

typedef struct laid_stitch {
    weft_stitch stitch;
    weft_tile_mesh mesh;
    weft_draped_cloth *cloth;
} laid_stitch;

/* Lays `tiles` x `tiles` flat, then turned. */
static void lay_flat(laid_stitch *laid, const char *name, int tiles, weft_vec3 (*turned)(weft_vec3))
{
    weft_base_vertex vertex[4];
    uint32_t triangle[2][3];
    weft_error error = {0};
    shipped_stitch_open(name, COARSE, &laid->stitch, &laid->mesh);
    set_patch(vertex, triangle, 0, 0, 0, tiles * laid->stitch.width, tiles * laid->stitch.height);
    for (int i = 0; i < 4; i++) {
        vertex[i].position = turned(vertex[i].position);
        vertex[i].normal = turned(vertex[i].normal);
    }
    const weft_base_surface surface = {4, 2, vertex, (const uint32_t(*)[3])triangle, 0};
    if (weft_draped_cloth_create(&laid->stitch, &laid->mesh, &surface, &laid->cloth, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(weft_draped_cloth_triangle_count(laid->cloth), tiles * tiles * laid->mesh.triangle_count);
}

static void take_up(laid_stitch *laid)
{
    weft_draped_cloth_free(laid->cloth);
    weft_tile_mesh_free(&laid->mesh);
    weft_stitch_free(&laid->stitch);
}

/* Mean radiance of the middle tile, holes included, seen from afar; returns the covered part. */
static double mean_of_tile(const laid_stitch *laid, int tiles, weft_vec3 view, const weft_draped_light *light,
                           weft_vec3 (*turned)(weft_vec3), weft_draped_radiance *mean)
{
    int hits = 0;
    *mean = (weft_draped_radiance){0};
    for (uint32_t i = 0; i < PATHS; i++) {
        double point[2];
        weft_sequence_point(7, i, point);
        weft_vec3 place =
            weft_vec3_of((tiles / 2 + point[0]) * laid->stitch.width, (tiles / 2 + point[1]) * laid->stitch.height, 0);
        weft_vec3 origin = weft_add(place, weft_scale(view, 40));
        hits += weft_draped_cloth_path(laid->cloth, turned(origin), turned(weft_scale(view, -1)), light, 8, i, mean);
    }
    for (int c = 0; c < 3; c++) {
        mean->all[c] /= PATHS;
        mean->near[c] /= PATHS;
    }
    return (double)hits / PATHS;
}

static double mean_of_endless(const laid_stitch *laid, weft_vec3 view, weft_vec3 light, float mean[3])
{
    weft_illumination *illumination;
    weft_illumination_options options = {.bounces = BOUNCES, .exact = true};
    weft_error error = {0};
    int hits = 0;
    float sum[1][3] = {{0}};
    if (weft_illumination_create(&laid->stitch, &laid->mesh, &light, 1, &options, &illumination, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (uint32_t i = 0; i < PATHS; i++) {
        double point[2];
        weft_sequence_point(9, i, point);
        weft_vec3 place =
            weft_vec3_of(point[0] * laid->stitch.width, point[1] * laid->stitch.height, (weft_real)laid->mesh.top);
        hits += weft_illumination_path(illumination, place, view, 10, i, sum, NULL);
    }
    for (int c = 0; c < 3; c++)
        mean[c] = sum[0][c] / PATHS;
    weft_illumination_free(illumination);
    return (double)hits / PATHS;
}

static void flat_cloth_looks_as_endless_cloth_does(void **state)
{
    (void)state;
    const char *const name[] = {"plain_knit", "open_weave"};
    const weft_vec3 view[] = {{0, 0, 1}, weft_unit(weft_vec3_of(0.7, -0.5, 0.6))};
    enum { TILES = 15 };
    for (int i = 0; i < 4; i++) {
        laid_stitch laid;
        weft_draped_radiance mean;
        float expected[3];
        weft_draped_light light = {weft_unit(weft_vec3_of(-0.6, 0.3, 0.7)), BOUNCES, 1000};
        lay_flat(&laid, name[i % 2], TILES, keep);
        double covered = mean_of_tile(&laid, TILES, view[i / 2], &light, keep, &mean);
        double endless = mean_of_endless(&laid, view[i / 2], light.direction, expected);
        assert_float_equal(covered, endless, 0.01);
        for (int c = 0; c < 3; c++) {
            /* Two means of 16384 well spread paths each; the spread between keys is below 0.5 %. */
            assert_float_equal((double)mean.all[c], (double)expected[c], 0.02 * (double)expected[c]);
            assert_float_equal((double)mean.near[c], (double)mean.all[c], 1e-6);
        }
        take_up(&laid);
    }
}

static void turning_everything_changes_nothing(void **state)
{
    (void)state;
    enum { TILES = 5 };
    laid_stitch level, turned;
    weft_draped_radiance one, other;
    const weft_vec3 view = weft_unit(weft_vec3_of(0.3, -0.5, 0.6));
    weft_draped_light light = {weft_unit(weft_vec3_of(-0.6, 0.3, 0.7)), BOUNCES, 2};
    lay_flat(&level, "satin", TILES, keep);
    lay_flat(&turned, "satin", TILES, turn);
    mean_of_tile(&level, TILES, view, &light, keep, &one);
    light.direction = turn(light.direction);
    mean_of_tile(&turned, TILES, view, &light, turn, &other);
    for (int c = 0; c < 3; c++) {
        assert_true(one.all[c] > 0);
        assert_float_equal((double)one.all[c], (double)other.all[c], 2e-3 * (double)one.all[c]);
        assert_float_equal((double)one.near[c], (double)other.near[c], 2e-3 * (double)one.all[c]);
    }
    take_up(&level);
    take_up(&turned);
}

/* A second cloth far above the first stands in the light, but not within reach. */
static void distant_cloth_casts_shadows_beyond_reach_only(void **state)
{
    (void)state;
    enum { TILES = 5 };
    weft_base_vertex vertex[8];
    uint32_t triangle[4][3];
    weft_error error = {0};
    laid_stitch laid;
    shipped_stitch_open("plain_weave", COARSE, &laid.stitch, &laid.mesh);
    weft_real side = TILES * laid.stitch.width;
    set_patch(vertex, triangle, 0, 0, 0, side, side);
    set_patch(vertex + 4, triangle + 2, 4, side + laid.stitch.width, 30, side, side);
    const weft_base_surface surface = {8, 4, vertex, (const uint32_t(*)[3])triangle, 0};
    assert_int_equal(weft_draped_cloth_create(&laid.stitch, &laid.mesh, &surface, &laid.cloth, &error), WEFT_OK);
    weft_draped_light light = {weft_vec3_of(0, 0, 1), 0, 5};
    weft_draped_radiance mean;
    double covered = mean_of_tile(&laid, TILES, weft_unit(weft_vec3_of(0.8, 0, 0.5)), &light, keep, &mean);
    assert_true(covered > 0.9);
    /* Some light comes through the open places of the cloth above. */
    assert_true(mean.near[1] > 0.1f && mean.all[1] < 0.2f * mean.near[1]);
    light.reach_mm = 50;
    mean_of_tile(&laid, TILES, weft_unit(weft_vec3_of(0.8, 0, 0.5)), &light, keep, &mean);
    assert_true(mean.near[1] == mean.all[1]);
    take_up(&laid);
}

/* Half a tile has no more than the triangles that lie on it, and nothing beside it. */
static void cloth_ends_at_its_hem(void **state)
{
    (void)state;
    weft_base_vertex vertex[4];
    uint32_t triangle[2][3];
    weft_error error = {0};
    laid_stitch laid;
    shipped_stitch_open("plain_weave", COARSE, &laid.stitch, &laid.mesh);
    set_patch(vertex, triangle, 0, 0, 0, laid.stitch.width / 2, laid.stitch.height);
    const weft_base_surface surface = {4, 2, vertex, (const uint32_t(*)[3])triangle, 0};
    assert_int_equal(weft_draped_cloth_create(&laid.stitch, &laid.mesh, &surface, &laid.cloth, &error), WEFT_OK);
    int count = weft_draped_cloth_triangle_count(laid.cloth);
    assert_true(count > 0.4 * laid.mesh.triangle_count && count < 0.6 * laid.mesh.triangle_count);
    const weft_draped_light light = {{0, 0, 1}, 0, 5};
    for (uint32_t i = 0; i < 100; i++) {
        weft_draped_radiance radiance = {0};
        weft_vec3 beside = weft_vec3_of(0.51 * laid.stitch.width, 0.01 * i * laid.stitch.height, 10);
        assert_false(weft_draped_cloth_path(laid.cloth, beside, weft_vec3_of(0, 0, -1), &light, 1, i, &radiance));
    }
    take_up(&laid);
}

/* A ray just above the surface passes over cloth whose top lies on it, and meets cloth of which a deeper plane does. */
static void a_plane_in_the_cloth_may_lie_on_the_surface(void **state)
{
    (void)state;
    const weft_draped_light light = {{0, 0, 1}, 0, 5};
    for (int deeper = 0; deeper < 2; deeper++) {
        weft_base_vertex vertex[4];
        uint32_t triangle[2][3];
        weft_error error = {0};
        weft_draped_radiance radiance = {0};
        laid_stitch laid;
        shipped_stitch_open("plain_weave", COARSE, &laid.stitch, &laid.mesh);
        weft_real depth = (weft_real)(laid.mesh.top - laid.mesh.bottom), side = 2 * laid.stitch.width;
        set_patch(vertex, triangle, 0, 0, 0, side, side);
        const weft_base_surface surface = {4, 2, vertex, (const uint32_t(*)[3])triangle, -deeper * depth / 2};
        assert_int_equal(weft_draped_cloth_create(&laid.stitch, &laid.mesh, &surface, &laid.cloth, &error), WEFT_OK);
        weft_vec3 place = weft_vec3_of(-1, side / 2 + 0.01, depth / 8);
        assert_true(weft_draped_cloth_path(laid.cloth, place, weft_vec3_of(1, 0, 0), &light, 1, 0, &radiance) ==
                    deeper);
        take_up(&laid);
    }
}

static void surfaces_without_sense_are_refused(void **state)
{
    (void)state;
    weft_base_vertex vertex[4];
    uint32_t triangle[2][3];
    weft_error error = {0};
    laid_stitch laid;
    shipped_stitch_open("plain_weave", COARSE, &laid.stitch, &laid.mesh);
    const weft_base_surface surface = {4, 2, vertex, (const uint32_t(*)[3])triangle, 0};
    set_patch(vertex, triangle, 0, 0, 0, 4000, 4000);
    assert_int_equal(weft_draped_cloth_create(&laid.stitch, &laid.mesh, &surface, &laid.cloth, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "16000000 tiles"));
    set_patch(vertex, triangle, 0, 0, 0, 4, 4);
    triangle[1][1] = 2;
    triangle[1][2] = 3;
    assert_int_equal(weft_draped_cloth_create(&laid.stitch, &laid.mesh, &surface, &laid.cloth, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "triangle 2 of the surface"));
    assert_null(laid.cloth);
    take_up(&laid);
}

int test_draped_cloth(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_cloth_looks_as_endless_cloth_does),
        cmocka_unit_test(turning_everything_changes_nothing),
        cmocka_unit_test(distant_cloth_casts_shadows_beyond_reach_only),
        cmocka_unit_test(cloth_ends_at_its_hem),
        cmocka_unit_test(a_plane_in_the_cloth_may_lie_on_the_surface),
        cmocka_unit_test(surfaces_without_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
