/* Stitches as samples under a camera: the same light as in a simulated dataset, path by path. */
#include "geometry/light/illumination.h"
#include "geometry/light/stitch_sample.h"
#include "tests/geometry/shipped_stitches.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BOUNCES = 3, PLACES = 200 };

static weft_stitch_sample *open_sample(const char *name, int bounces)
{
    char path[512];
    weft_stitch_sample *sample;
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/stitches/%s.stitch", WEFT_ASSETS, name);
    if (weft_stitch_sample_read(path, bounces, &sample, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return sample;
}

static weft_vec3 direction(double theta_deg, double phi_deg)
{
    double theta = theta_deg * WEFT_PI / 180, phi = phi_deg * WEFT_PI / 180;
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

/* Mean radiance of the tile by both, from different random numbers: PLACES x PLACES paths. */
static void the_light_is_that_of_the_simulation(void **state)
{
    (void)state;
    weft_stitch_sample *sample = open_sample("plain_knit", BOUNCES);
    const weft_stitch *stitch = weft_stitch_sample_stitch(sample);
    const weft_vec3 view = direction(50, 20), light = direction(40, 200);
    const weft_illumination_options options = {.bounces = BOUNCES, .exact = true};
    weft_tile_mesh mesh;
    weft_illumination *illumination;
    assert_int_equal(weft_tile_mesh_create(stitch, 0, "knit", &mesh, NULL), WEFT_OK);
    assert_int_equal(weft_illumination_create(stitch, &mesh, &light, 1, &options, &illumination, NULL), WEFT_OK);
    double one[3] = {0};
    float other[1][3] = {{0}};
    for (int i = 0; i < PLACES * PLACES; i++) {
        weft_seen_vertex vertex[1 + BOUNCES];
        double x = (i % PLACES + 0.5) / PLACES * stitch->width, y = (i / PLACES + 0.5) / PLACES * stitch->height;
        int count = weft_stitch_sample_see(sample, x, y, view, (uint64_t)i, 0, vertex);
        weft_rgb seen = weft_stitch_sample_light(sample, vertex, count, light);
        one[0] += seen.r;
        one[1] += seen.g;
        one[2] += seen.b;
        weft_illumination_path(illumination, weft_vec3_of(x, y, (weft_real)mesh.top), view, (uint64_t)(i + 7), 1, other,
                               NULL);
    }
    for (int channel = 0; channel < 3; channel++) {
        assert_true(one[channel] > 0.01 * PLACES * PLACES);
        assert_float_equal(one[channel] / (double)other[0][channel], 1, 0.02);
    }
    weft_illumination_free(illumination);
    weft_tile_mesh_free(&mesh);
    weft_stitch_sample_free(sample);
}

static void the_highest_yarn_touches_the_plane(void **state)
{
    (void)state;
    weft_stitch_sample *sample = open_sample("plain_knit", 0);
    const weft_stitch *stitch = weft_stitch_sample_stitch(sample);
    double highest = -INFINITY, lowest = INFINITY;
    for (int i = 0; i < PLACES * PLACES; i++) {
        weft_seen_vertex vertex;
        double x = (i % PLACES + 0.5) / PLACES * stitch->width, y = (i / PLACES + 0.5) / PLACES * stitch->height;
        if (weft_stitch_sample_see(sample, x, y, weft_vec3_of(0, 0, 1), 0, 0, &vertex) == 0)
            continue;
        highest = fmax(highest, (double)vertex.at[2]);
        lowest = fmin(lowest, (double)vertex.at[2]);
    }
    assert_true(highest <= 0 && highest > -0.01);
    weft_tile_mesh mesh;
    assert_int_equal(weft_tile_mesh_create(stitch, 0, "knit", &mesh, NULL), WEFT_OK);
    assert_true(lowest < -0.3 && lowest >= (double)mesh.bottom - (double)mesh.top);
    weft_tile_mesh_free(&mesh);
    weft_stitch_sample_free(sample);
}

/* Depth d at a slant of theta is seen d tan(theta) further on in the plane. */
static void a_slanting_ray_goes_down_to_what_it_sees(void **state)
{
    (void)state;
    weft_stitch_sample *sample = open_sample("plain_weave", 0);
    const weft_stitch *stitch = weft_stitch_sample_stitch(sample);
    const weft_vec3 view = direction(60, 0);
    for (int i = 0; i < PLACES; i++) {
        weft_seen_vertex vertex;
        double x = (i + 0.5) / PLACES * stitch->width, y = 0.3 * stitch->height;
        assert_int_equal(weft_stitch_sample_see(sample, x, y, view, 0, 0, &vertex), 1);
        double expected = x + (double)vertex.at[2] * tan(WEFT_PI / 3);
        double tiles = (expected - (double)vertex.at[0]) / stitch->width;
        assert_float_equal(tiles, round(tiles), 1e-4);
        assert_float_equal(vertex.at[1], y, 1e-4);
    }
    weft_stitch_sample_free(sample);
}

static void holes_are_seen_through(void **state)
{
    (void)state;
    weft_stitch_sample *sample = open_sample("open_weave", BOUNCES);
    const weft_stitch *stitch = weft_stitch_sample_stitch(sample);
    int holes = 0;
    for (int i = 0; i < PLACES * PLACES; i++) {
        weft_seen_vertex vertex[1 + BOUNCES];
        double x = (i % PLACES + 0.5) / PLACES * stitch->width, y = (i / PLACES + 0.5) / PLACES * stitch->height;
        int count = weft_stitch_sample_see(sample, x, y, weft_vec3_of(0, 0, 1), (uint64_t)i, 0, vertex);
        assert_true(count <= 1 + BOUNCES);
        holes += count == 0;
        if (count == 0)
            assert_true(weft_stitch_sample_light(sample, vertex, count, direction(30, 0)).g == 0);
    }
    assert_true(holes > PLACES * PLACES / 3 && holes < PLACES * PLACES * 3 / 4);
    weft_stitch_sample_free(sample);
}

static void a_file_that_is_no_stitch_is_refused(void **state)
{
    (void)state;
    weft_stitch_sample *sample;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_stitch_sample_read("absent.stitch", 3, &sample, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "absent.stitch"));
    assert_null(sample);
}

int test_stitch_sample(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_light_is_that_of_the_simulation),
        cmocka_unit_test(the_highest_yarn_touches_the_plane),
        cmocka_unit_test(a_slanting_ray_goes_down_to_what_it_sees),
        cmocka_unit_test(holes_are_seen_through),
        cmocka_unit_test(a_file_that_is_no_stitch_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
