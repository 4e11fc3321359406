/* Environment maps as lights. */
#include "player/draw/lighting.h"
#include "player/scene/surroundings.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 128, HEIGHT = WIDTH / 2 };

static weft_image map_of(float value)
{
    weft_error error = {0};
    weft_image image;
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, &image, &error), WEFT_OK);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] = value;
    return image;
}

static weft_environment *environment_of(const weft_image *image)
{
    weft_error error = {0};
    weft_environment *environment = malloc(sizeof *environment);
    assert_non_null(environment);
    assert_int_equal(weft_environment_of_image(image, WEFT_ENVIRONMENT_REGIONS, environment, &error), WEFT_OK);
    return environment;
}

/* Over pi, on a surface with this normal. */
static double irradiance_on(const weft_distant_light *light, int count, weft_vec3 normal)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += (double)light[i].irradiance[1] * fmax(0, (double)weft_dot(light[i].direction, normal));
    return sum;
}

static void a_uniform_sky_lights_every_surface_with_its_radiance(void **state)
{
    (void)state;
    const weft_vec3 normal[] = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    weft_image image = map_of(1);
    weft_environment *environment = environment_of(&image);
    for (int i = 0; i < 4; i++)
        assert_float_equal(irradiance_on(environment->region, WEFT_ENVIRONMENT_REGIONS, normal[i]), 1, 0.03);
    free(environment);
    weft_image_free(&image);
}

static weft_image uneven_map(void)
{
    weft_image image = map_of(0.2f);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] *= 1 + (float)(i % 97) / 20;
    for (int c = 0; c < 3; c++)
        image.pixels[3 * (20 * WIDTH + 40) + c] = 5000;
    return image;
}

static void the_parts_of_a_region_carry_its_power_in_equal_shares(void **state)
{
    (void)state;
    weft_image image = uneven_map();
    weft_environment *environment = environment_of(&image);
    for (int region = 0; region < WEFT_ENVIRONMENT_REGIONS; region++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0, whole = (double)environment->region[region].irradiance[c];
            for (int part = 0; part < WEFT_ENVIRONMENT_STRATA; part++)
                sum += (double)environment->stratum[part][region].irradiance[c] / WEFT_ENVIRONMENT_STRATA;
            assert_float_equal(sum, whole, 1e-4 * whole);
        }
        for (int part = 0; part < WEFT_ENVIRONMENT_STRATA; part++) {
            const weft_distant_light *light = &environment->stratum[part][region], *all = &environment->region[region];
            double power = (double)(light->irradiance[0] + light->irradiance[1] + light->irradiance[2]);
            double mean = (double)(all->irradiance[0] + all->irradiance[1] + all->irradiance[2]);
            assert_float_equal(power, mean, 1e-3 * mean);
        }
    }
    free(environment);
    weft_image_free(&image);
}

static void a_bright_pixel_becomes_a_light_where_the_map_has_it(void **state)
{
    (void)state;
    weft_image image = uneven_map();
    weft_environment *environment = environment_of(&image);
    double theta_rad = WEFT_PI * 20.5 / HEIGHT, phi_rad = 2 * WEFT_PI * (0.75 - 40.5 / WIDTH), nearest = -1, power = 0;
    weft_vec3 sun = weft_direction_of_angles((weft_angles){theta_rad, phi_rad});
    for (int i = 0; i < WEFT_ENVIRONMENT_REGIONS; i++) {
        double cosine = (double)weft_dot(environment->region[i].direction, sun);
        if (cosine > nearest) {
            nearest = cosine;
            power = (double)environment->region[i].irradiance[0];
        }
    }
    double solid_angle = 2 * WEFT_PI / WIDTH * WEFT_PI / HEIGHT * sin(theta_rad);
    assert_true(nearest > cos(WEFT_PI / HEIGHT));
    assert_float_equal(power, 5000 * solid_angle / WEFT_PI, 0.02 * power);
    free(environment);
    weft_image_free(&image);
}

static weft_environment *studio(void)
{
    weft_error error = {0};
    weft_image map;
    weft_environment *environment = malloc(sizeof *environment);
    assert_int_equal(weft_surroundings_map("studio", &map, &error), WEFT_OK);
    assert_int_equal(weft_environment_of_image(&map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, environment, &error), WEFT_OK);
    weft_image_free(&map);
    return environment;
}

/* How far from the middle of a region its first parts lie in the mean, as a share of how far one does. */
static double lean(const weft_environment *environment, int region, int first)
{
    weft_vec3 of_first = weft_vec3_of(0, 0, 0), middle = weft_vec3_of(0, 0, 0);
    double spread = 0;
    for (int part = 0; part < WEFT_ENVIRONMENT_STRATA; part++) {
        weft_vec3 at = environment->stratum[part][region].direction;
        middle = weft_add(middle, weft_scale(at, 1.0 / WEFT_ENVIRONMENT_STRATA));
        of_first = weft_add(of_first, weft_scale(at, part < first ? 1.0 / first : 0));
    }
    for (int part = 0; part < WEFT_ENVIRONMENT_STRATA; part++)
        spread += (double)weft_length(weft_subtract(environment->stratum[part][region].direction, middle));
    return (double)weft_length(weft_subtract(of_first, middle)) * WEFT_ENVIRONMENT_STRATA / spread;
}

/* Highlights and shadows would wander while a picture comes to rest. */
static void the_first_frames_lean_to_no_corner_of_a_region(void **state)
{
    (void)state;
    static const int first[] = {1, 4, 8};
    static const double most[] = {1, 0.4, 0.2};
    weft_environment *environment = studio();
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int region = 0; region < WEFT_ENVIRONMENT_SMOOTH_REGIONS; region++)
            sum += lean(environment, region, first[i]) / WEFT_ENVIRONMENT_SMOOTH_REGIONS;
        printf("%d frames lean by %.3f\n", first[i], sum);
        assert_true(sum < most[i]);
    }
    free(environment);
}

static void the_shadows_of_a_frame_come_from_elsewhere_than_those_before(void **state)
{
    (void)state;
    enum { FRAMES = 32 };
    weft_environment *environment = studio();
    weft_scene scene = weft_scene_default();
    int stays = 0;
    scene.environment = true;
    for (int frame = 1; frame <= FRAMES; frame++) {
        weft_lighting before = weft_lighting_of(&scene, environment, frame - 1),
                      now = weft_lighting_of(&scene, environment, frame);
        assert_int_equal(now.sample_count, WEFT_ENVIRONMENT_SAMPLES);
        for (int i = 0; i < now.sample_count; i++)
            stays += weft_dot(before.sample[i], now.sample[i]) > cos(weft_rad_of_deg(3));
    }
    printf("%d of %d directions stay where they are\n", stays, FRAMES * WEFT_ENVIRONMENT_SAMPLES);
    assert_true(stays < FRAMES * WEFT_ENVIRONMENT_SAMPLES / 4);
    free(environment);
}

/* Of all directions of the environment's shadows in the first frames: how far the nearest other one lies, in the mean.
 */
static double gap_deg(const weft_environment *environment, int frames)
{
    enum { MOST = 16 * WEFT_ENVIRONMENT_SAMPLES };
    weft_vec3 at[MOST];
    weft_scene scene = weft_scene_default();
    int count = frames * WEFT_ENVIRONMENT_SAMPLES;
    double sum = 0;
    scene.environment = true;
    for (int frame = 0; frame < frames; frame++) {
        weft_lighting now = weft_lighting_of(&scene, environment, frame);
        memcpy(at + frame * WEFT_ENVIRONMENT_SAMPLES, now.sample, sizeof now.sample);
    }
    for (int i = 0; i < count; i++) {
        double nearest = -1;
        for (int k = 0; k < count; k++)
            nearest = k == i ? nearest : fmax(nearest, (double)weft_dot(at[i], at[k]));
        sum += weft_deg_of_rad(acos(fmin(nearest, 1))) / count;
    }
    return sum;
}

/* 6.0 degrees where each region is gone through in the order of its frames. */
static void the_shadows_of_sixteen_frames_leave_no_gap(void **state)
{
    (void)state;
    weft_environment *environment = studio();
    double gap = gap_deg(environment, 16);
    printf("the next shadow lies %.2f degrees away\n", gap);
    assert_true(gap > 6.4);
    free(environment);
}

static weft_vec3 light_of_kind(const weft_lighting *l, int region, int kind)
{
    const float *d = l->direction[l->scene_count + region * l->interleave_count + kind];
    return weft_vec3_of((weft_real)d[0], (weft_real)d[1], (weft_real)d[2]);
}

/* How far the mean of lights of a region is from that of all its parts. */
static double off_centre(const weft_environment *environment, int region, weft_vec3 mean)
{
    weft_vec3 all = weft_vec3_of(0, 0, 0);
    for (int part = 0; part < WEFT_ENVIRONMENT_STRATA; part++)
        all = weft_add(all, weft_scale(environment->stratum[part][region].direction, 1.0 / WEFT_ENVIRONMENT_STRATA));
    return (double)weft_length(weft_subtract(mean, all));
}

/* Of lights of one kind of pixels, or of all where it is -1, in the first frames; largest over the regions. */
static double off_after(const weft_environment *environment, int frames, int kind)
{
    weft_scene scene = weft_scene_default();
    double largest = 0;
    scene.environment = true;
    for (int region = 0; region < environment->region_count; region++) {
        weft_vec3 sum = weft_vec3_of(0, 0, 0);
        int count = 0;
        for (int frame = 0; frame < frames; frame++) {
            weft_lighting l = weft_lighting_of(&scene, environment, frame);
            assert_int_equal(l.interleave_count, WEFT_INTERLEAVED_LIGHTS);
            for (int k = 0; k < l.interleave_count; k++) {
                if (kind < 0 || k == kind) {
                    sum = weft_add(sum, light_of_kind(&l, region, k));
                    count++;
                }
            }
        }
        largest = fmax(largest, off_centre(environment, region, weft_scale(sum, (weft_real)(1.0 / count))));
    }
    return largest;
}

/* Sixteen frames of neighbours hold every part once, and each pixel sees every part in 128. */
static void neighbouring_pixels_complete_each_other(void **state)
{
    (void)state;
    weft_environment *environment = studio();
    assert_true(off_after(environment, 16, -1) < 1e-5);
    for (int kind = 0; kind < WEFT_INTERLEAVED_LIGHTS; kind++) {
        assert_true(off_after(environment, WEFT_ENVIRONMENT_STRATA, kind) < 1e-5);
        assert_true(off_after(environment, 16, kind) > 1e-4);
    }
    /* In one frame already. */
    double one = off_after(environment, 1, -1), alone = off_after(environment, 1, 0);
    printf("one frame is %.3f off, one pixel of it %.3f\n", one, alone);
    assert_true(one < 0.3 * alone);
    free(environment);
}

static void a_tinted_light_is_that_of_its_neighbours(void **state)
{
    (void)state;
    weft_environment *environment = studio();
    weft_scene scene = weft_scene_default();
    scene.environment = scene.show_extrapolation = true;
    assert_int_equal(weft_lighting_of(&scene, environment, 3).interleave_count, 1);
    scene.show_extrapolation = false;
    assert_int_equal(weft_lighting_of(&scene, environment, -1).interleave_count, 1);
    free(environment);
}

static void expect_refused(const weft_image *image)
{
    weft_error error = {0};
    weft_environment *environment = malloc(sizeof *environment);
    assert_int_equal(weft_environment_of_image(image, WEFT_ENVIRONMENT_REGIONS, environment, &error), WEFT_BAD_INPUT);
    assert_true(error.message[0] != 0);
    free(environment);
}

static void black_and_square_maps_are_refused_and_spoilt_pixels_are_black(void **state)
{
    (void)state;
    weft_image image = map_of(0);
    expect_refused(&image);
    image.pixels[0] = NAN;
    image.pixels[1] = -1;
    image.pixels[2] = INFINITY;
    expect_refused(&image);
    image.pixels[3] = 1;
    weft_environment *environment = environment_of(&image);
    for (int i = 0; i < WEFT_ENVIRONMENT_REGIONS; i++)
        assert_true(isfinite(environment->region[i].irradiance[0]));
    free(environment);
    image.width = image.height;
    expect_refused(&image);
    weft_image_free(&image);
}

static void expect_finite(const weft_distant_light *light)
{
    assert_float_equal(weft_length(light->direction), 1, 1e-6);
    for (int c = 0; c < 3; c++)
        assert_true(isfinite(light->irradiance[c]) && light->irradiance[c] >= 0);
}

static void maps_of_two_pixels_and_of_enormous_values_give_finite_lights(void **state)
{
    (void)state;
    weft_image image = map_of(3e38f);
    for (int width = WIDTH; width >= 2; width = width == WIDTH ? 2 : 0) {
        image.width = width;
        image.height = width / 2;
        weft_environment *environment = environment_of(&image);
        for (int region = 0; region < WEFT_ENVIRONMENT_REGIONS; region++) {
            expect_finite(&environment->region[region]);
            for (int part = 0; part < WEFT_ENVIRONMENT_STRATA; part++)
                expect_finite(&environment->stratum[part][region]);
        }
        free(environment);
    }
    weft_image_free(&image);
}

static void the_scene_lists_its_lights_before_those_of_the_map(void **state)
{
    (void)state;
    weft_image image = map_of(1);
    weft_environment *environment = environment_of(&image);
    weft_scene scene = weft_scene_default();
    assert_int_equal(weft_lighting_of(&scene, environment, 0).count, 1);
    scene.environment = true;
    scene.environment_strength = 2;
    weft_lighting lighting = weft_lighting_of(&scene, environment, -1);
    assert_int_equal(lighting.count, 1 + WEFT_ENVIRONMENT_REGIONS);
    assert_int_equal(lighting.count, weft_lighting_count(&scene, environment));
    assert_float_equal(lighting.irradiance[0][0], 1, 0);
    assert_float_equal(lighting.irradiance[1][0], 2 * environment->region[0].irradiance[0], 1e-6);
    scene.light_count = 0;
    scene.environment = false;
    assert_int_equal(weft_lighting_of(&scene, environment, 0).count, 1);
    assert_float_equal(weft_lighting_of(&scene, environment, 0).irradiance[0][0], 0, 0);
    free(environment);
    weft_image_free(&image);
}

int test_environment(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_uniform_sky_lights_every_surface_with_its_radiance),
        cmocka_unit_test(the_parts_of_a_region_carry_its_power_in_equal_shares),
        cmocka_unit_test(a_bright_pixel_becomes_a_light_where_the_map_has_it),
        cmocka_unit_test(the_first_frames_lean_to_no_corner_of_a_region),
        cmocka_unit_test(the_shadows_of_a_frame_come_from_elsewhere_than_those_before),
        cmocka_unit_test(the_shadows_of_sixteen_frames_leave_no_gap),
        cmocka_unit_test(neighbouring_pixels_complete_each_other),
        cmocka_unit_test(a_tinted_light_is_that_of_its_neighbours),
        cmocka_unit_test(black_and_square_maps_are_refused_and_spoilt_pixels_are_black),
        cmocka_unit_test(maps_of_two_pixels_and_of_enormous_values_give_finite_lights),
        cmocka_unit_test(the_scene_lists_its_lights_before_those_of_the_map),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
