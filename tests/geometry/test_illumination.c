/* Light in shipped stitches. */
#include "btf/direction/direction.h"
#include "geometry/light/illumination.h"
#include "geometry/light/sample_sequence.h"
#include "tests/geometry/shipped_stitches.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SPHERE_LIGHTS = 384, COARSE = 40 };

typedef struct lit_stitch {
    weft_stitch stitch;
    weft_tile_mesh mesh;
    weft_illumination *illumination;
    int light_count;
    bool uniform_light;
} lit_stitch;

static void make_white(weft_stitch *stitch)
{
    for (int i = 0; i < stitch->yarn_count; i++) {
        stitch->yarn[i].fibre.diffuse = (weft_rgb){1, 1, 1};
        stitch->yarn[i].fibre.specular = (weft_rgb){0};
    }
}

static void light_up(lit_stitch *lit, const char *name, int resolution, bool white, const weft_vec3 *light,
                     int light_count, weft_illumination_options options)
{
    weft_error error = {0};
    shipped_stitch_open(name, resolution, &lit->stitch, &lit->mesh);
    if (white)
        make_white(&lit->stitch);
    lit->light_count = light_count;
    lit->uniform_light = options.uniform_light;
    if (weft_illumination_create(&lit->stitch, &lit->mesh, light, light_count, &options, &lit->illumination, &error))
        fail_msg("%s", error.message);
}

static void put_out(lit_stitch *lit)
{
    weft_illumination_free(lit->illumination);
    weft_tile_mesh_free(&lit->mesh);
    weft_stitch_free(&lit->stitch);
}

/* Mean radiance [lights][3], the uniform light last, over `paths` points of the tile, holes included; the covered part.
 */
static double mean_radiance(const lit_stitch *lit, weft_vec3 view, int paths, uint64_t seed, float (*mean)[3])
{
    long hits = 0;
    int rows = lit->light_count + lit->uniform_light;
    memset(mean, 0, (size_t)rows * sizeof *mean);
    for (int i = 0; i < paths; i++) {
        double point[2];
        weft_sequence_point(weft_sequence_key(seed, 0x10000), (uint32_t)i, point);
        weft_vec3 place = weft_vec3_of(point[0] * lit->stitch.width, point[1] * lit->stitch.height, 0);
        hits += weft_illumination_path(lit->illumination, place, view, seed, (uint32_t)i, mean, NULL);
    }
    for (int i = 0; i < rows; i++)
        for (int c = 0; c < 3; c++)
            mean[i][c] /= (float)paths;
    return (double)hits / paths;
}

/* All light that a white yarn gets leaves it again: what is missing was lost by the paths. */
static void white_cloth_vanishes_in_uniform_light(void **state)
{
    (void)state;
    const weft_vec3 up = {0, 0, 1};
    const weft_illumination_options options = {.bounces = WEFT_ILLUMINATION_MAX_BOUNCES, .uniform_light = true};
    for (int i = 0; i < SHIPPED_STITCHES; i += shipped_stitch_step()) {
        float mean[2][3];
        lit_stitch lit;
        light_up(&lit, shipped_stitch[i], 0, true, &up, 1, options);
        for (int k = 0; k < 3; k++) {
            double covered =
                mean_radiance(&lit, weft_direction_of_angles((weft_angles){0.6 * k, 1 + k}), 4096, 1, mean);
            print_message("%s: %.5f\n", shipped_stitch[i], (double)mean[1][1] / covered);
            assert_true(fabs((double)mean[1][1] / covered - 1) < 0.005);
        }
        put_out(&lit);
    }
}

/* Evenly spread over the whole sphere: a light stands for uniform light from 4 pi / N steradians. */
static void spread_over_sphere(weft_vec3 *light)
{
    for (int i = 0; i < SPHERE_LIGHTS; i++) {
        double z = 1 - 2 * (i + 0.5) / SPHERE_LIGHTS, phi = 2.39996322972865332 * i;
        light[i] = weft_vec3_of(sqrt(1 - z * z) * cos(phi), sqrt(1 - z * z) * sin(phi), z);
    }
}

static void lights_from_everywhere_make_uniform_light(void **state)
{
    (void)state;
    const weft_vec3 view = weft_direction_of_angles((weft_angles){0.6, 1});
    for (int exact = 0; exact < 2; exact++) {
        weft_vec3 light[SPHERE_LIGHTS];
        static float mean[SPHERE_LIGHTS + 1][3];
        lit_stitch lit;
        spread_over_sphere(light);
        light_up(&lit, "plain_knit", COARSE, false, light, SPHERE_LIGHTS,
                 (weft_illumination_options){.bounces = 3, .exact = exact, .uniform_light = true});
        mean_radiance(&lit, view, 16384, 1, mean);
        double sum = 0;
        for (int i = 0; i < SPHERE_LIGHTS; i++)
            sum += (double)mean[i][1] * 4 / SPHERE_LIGHTS;
        print_message("lights %.5f, uniform %.5f\n", sum, (double)mean[SPHERE_LIGHTS][1]);
        assert_true(fabs(sum / (double)mean[SPHERE_LIGHTS][1] - 1) < 0.005);
        put_out(&lit);
    }
}

/* Radiance over cosine of the light is the reflectance of the cloth as a whole. */
static void exchanging_light_and_view_changes_nothing_within_the_noise(void **state)
{
    (void)state;
    enum { SEEDS = 8, PATHS = 8192 };
    const weft_vec3 direction[2] = {weft_direction_of_angles((weft_angles){0.3, 0.5}),
                                    weft_direction_of_angles((weft_angles){1.2, 4})};
    for (int s = 0; s < SHIPPED_STITCHES; s += shipped_stitch_step()) {
        lit_stitch lit;
        light_up(&lit, shipped_stitch[s], COARSE + 30, false, direction, 2, (weft_illumination_options){.bounces = 3});
        double sum = 0, square = 0, level = 0;
        for (int i = 0; i < SEEDS; i++) {
            float from_first[2][3], from_second[2][3];
            mean_radiance(&lit, direction[0], PATHS, (uint64_t)i, from_first);
            mean_radiance(&lit, direction[1], PATHS, (uint64_t)i + 100, from_second);
            double one = (double)from_first[1][1] / direction[1].z, other = (double)from_second[0][1] / direction[0].z;
            sum += one - other;
            square += (one - other) * (one - other);
            level += one / SEEDS;
        }
        double mean = sum / SEEDS, error = sqrt((square / SEEDS - mean * mean) / (SEEDS - 1));
        print_message("%s: %.5f, exchanged %+.5f +- %.5f\n", shipped_stitch[s], level, mean, error);
        assert_true(fabs(mean) < 4 * error + 1e-4);
        assert_true(error < 0.02 * level);
        put_out(&lit);
    }
}

static void visibility_of_triangles_stands_for_shadow_rays(void **state)
{
    (void)state;
    enum { PATHS = 16384 };
    const weft_vec3 view = {0, 0, 1};
    const weft_vec3 light[3] = {
        {0, 0, 1}, weft_direction_of_angles((weft_angles){0.8, 2}), weft_direction_of_angles((weft_angles){1.3, 5})};
    float fast[3][3], exact[3][3], direct[3][3];
    lit_stitch lit;
    light_up(&lit, "plain_knit", 0, false, light, 3, (weft_illumination_options){.bounces = 3});
    mean_radiance(&lit, view, PATHS, 1, fast);
    put_out(&lit);
    light_up(&lit, "plain_knit", 0, false, light, 3, (weft_illumination_options){.bounces = 3, .exact = true});
    mean_radiance(&lit, view, PATHS, 1, exact);
    put_out(&lit);
    light_up(&lit, "plain_knit", 0, false, light, 3, (weft_illumination_options){.bounces = 0});
    mean_radiance(&lit, view, PATHS, 1, direct);
    put_out(&lit);
    for (int i = 0; i < 3; i++) {
        print_message("light %d: direct %.4f, all %.4f, with a shadow ray each %.4f\n", i, (double)direct[i][1],
                      (double)fast[i][1], (double)exact[i][1]);
        assert_true(fast[i][1] > 1.05f * direct[i][1]);
        assert_true(fabsf(fast[i][1] - exact[i][1]) < 0.01f * exact[i][1]);
    }
}

/* Looking along the normal, the cover of yarns of a width over a pitch is known. */
static void holes_are_seen_through(void **state)
{
    (void)state;
    const weft_vec3 up = {0, 0, 1};
    float mean[1][3];
    lit_stitch lit;
    weft_error error = {0};
    static const char text[] = "stitch { tile = {2, 1}, resolution = 80, yarn { radius = 0.2, diffuse = {1, 1, 1}, "
                               "points { {0, 0.5, 0}, {2, 0.5, 0} } } }";
    assert_int_equal(weft_stitch_parse(text, "bar", &lit.stitch, &error), WEFT_OK);
    assert_int_equal(weft_tile_mesh_create(&lit.stitch, 0, "bar", &lit.mesh, &error), WEFT_OK);
    lit.light_count = 1;
    lit.uniform_light = false;
    weft_illumination_options options = {.bounces = 0};
    assert_int_equal(weft_illumination_create(&lit.stitch, &lit.mesh, &up, 1, &options, &lit.illumination, &error),
                     WEFT_OK);
    double covered = mean_radiance(&lit, up, 4096, 1, mean);
    assert_true(fabs(covered - 0.4) < 0.004);
    /* A lit cylinder sends back the mean of its cosine, pi / 4. */
    assert_true(fabs((double)mean[0][0] / covered - WEFT_PI / 4) < 0.004);
    /* What is met first lies on the cylinder, with its normal and its fibres. */
    weft_first_hit first;
    assert_true(weft_illumination_path(lit.illumination, weft_vec3_of(0.7, 0.6, 5), up, 1, 0, mean, &first));
    assert_true(fabs(hypot(first.at.y - 0.5, first.at.z) - 0.2) < 1e-3 && fabs(first.at.y - 0.6) < 1e-5);
    assert_true(fabs(first.normal.y - 0.5) < 0.02 && fabs(first.tangent.x) > 0.9999 && first.yarn == 0);
    put_out(&lit);
}

/* Far beyond the middle tile: a light so low that its rays cross many tiles. */
static void low_lights_are_shadowed_by_far_copies(void **state)
{
    (void)state;
    const weft_vec3 up = {0, 0, 1}, low = weft_unit(weft_vec3_of(0, 1, 0.02));
    float mean[1][3];
    lit_stitch lit;
    weft_error error = {0};
    /* A wall every 0.4 mm: the light just touches the tops. */
    static const char text[] = "stitch { tile = {2, 1.2}, resolution = 80, yarn { radius = 0.1, diffuse = {1, 1, 1}, "
                               "points { {0, 0.5, 0}, {2, 0.5, 0} } }, yarn { radius = 0.1, diffuse = {1, 1, 1}, "
                               "points { {0, 0.9, -0.4}, {2, 0.9, -0.4} } } }";
    assert_int_equal(weft_stitch_parse(text, "walls", &lit.stitch, &error), WEFT_OK);
    assert_int_equal(weft_tile_mesh_create(&lit.stitch, 0, "walls", &lit.mesh, &error), WEFT_OK);
    lit.light_count = 1;
    lit.uniform_light = false;
    weft_illumination_options options = {.bounces = 0};
    assert_int_equal(weft_illumination_create(&lit.stitch, &lit.mesh, &low, 1, &options, &lit.illumination, &error),
                     WEFT_OK);
    /* The ray from height z meets a copy of the high yarn within 50 (z - 0.1) mm: the low yarn sees none of the light.
     */
    double low_sum = 0;
    for (int i = 0; i < 64; i++) {
        memset(mean, 0, sizeof mean);
        assert_true(weft_illumination_path(lit.illumination, weft_vec3_of(0.03 * i, 0.81 + 0.18 * i / 64, 0), up, 1,
                                           (uint32_t)i, mean, NULL));
        low_sum += (double)mean[0][0];
    }
    assert_true(low_sum == 0);
    /* The high yarn is lit on its top by at most 2 mm / 50 of height. */
    double covered = mean_radiance(&lit, up, 4096, 1, mean);
    assert_true(covered > 0.3 && mean[0][0] > 0.001f && mean[0][0] < 0.06f);
    put_out(&lit);
}

static void the_same_path_gives_the_same_light(void **state)
{
    (void)state;
    const weft_vec3 light[1] = {weft_direction_of_angles((weft_angles){0.5, 2})}, view = {0, 0, 1};
    float one[1][3], again[1][3];
    lit_stitch lit;
    light_up(&lit, "ribs", COARSE + 10, false, light, 1, (weft_illumination_options){.bounces = 3});
    mean_radiance(&lit, view, 200, 7, one);
    mean_radiance(&lit, view, 200, 7, again);
    assert_memory_equal(one, again, sizeof one);
    mean_radiance(&lit, view, 200, 8, again);
    assert_memory_not_equal(one, again, sizeof one);
    put_out(&lit);
}

int test_illumination(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_cloth_vanishes_in_uniform_light),
        cmocka_unit_test(lights_from_everywhere_make_uniform_light),
        cmocka_unit_test(exchanging_light_and_view_changes_nothing_within_the_noise),
        cmocka_unit_test(visibility_of_triangles_stands_for_shadow_rays),
        cmocka_unit_test(holes_are_seen_through),
        cmocka_unit_test(low_lights_are_shadowed_by_far_copies),
        cmocka_unit_test(the_same_path_gives_the_same_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
