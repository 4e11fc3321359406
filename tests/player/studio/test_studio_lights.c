/* The lights of one frame: places on the disc of the key light, directions of the environment. */
#include "player/draw/lighting.h"
#include "studio.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void the_key_light_fills_its_disc_and_starts_in_the_middle(void **state)
{
    (void)state;
    enum { FRAMES = 200 };
    weft_scene scene = weft_scene_default();
    scene.key_size_rad = weft_rad_of_deg(9);
    weft_vec3 middle = weft_direction_of_angles(scene.light[0].direction), sum = weft_vec3_of(0, 0, 0);
    double widest = 0, square = 0;
    for (int i = 0; i < FRAMES; i++) {
        weft_lighting lighting = weft_lighting_of(&scene, NULL, i);
        const float *d = lighting.direction[0];
        weft_vec3 at = weft_vec3_of((weft_real)d[0], (weft_real)d[1], (weft_real)d[2]);
        double angle = acos(fmin((double)weft_dot(at, middle), 1));
        assert_true(i > 0 || angle < 1e-3);
        widest = fmax(widest, angle);
        square += angle * angle / FRAMES;
        sum = weft_add(sum, at);
    }
    assert_true(widest < weft_rad_of_deg(9.1) && widest > weft_rad_of_deg(8.5));
    assert_float_equal(square, pow(weft_rad_of_deg(9), 2) / 2, 0.05 * square); /* of an even disc */
    assert_true(weft_dot(weft_unit(sum), middle) > cos(weft_rad_of_deg(0.3)));
}

/* 16 frames, which half a second has time for, leave no more than one of 64 shadows to a band. */
static void the_shadows_of_the_key_light_come_from_all_of_its_disc(void **state)
{
    (void)state;
    enum { FRAMES = 16, ALL = FRAMES * WEFT_KEY_PLACES };
    weft_scene scene = weft_scene_default();
    weft_vec3 middle = weft_direction_of_angles(scene.light[0].direction), at[ALL];
    assert_int_equal(weft_lighting_of(&scene, NULL, 3).key_count, 1);
    scene.key_size_rad = weft_rad_of_deg(9);
    assert_int_equal(weft_lighting_of(&scene, NULL, -1).key_count, 1);
    for (int frame = 0; frame < FRAMES; frame++) {
        weft_lighting lighting = weft_lighting_of(&scene, NULL, frame);
        assert_int_equal(lighting.key_count, WEFT_KEY_PLACES);
        memcpy(at + frame * WEFT_KEY_PLACES, lighting.key, sizeof lighting.key);
    }
    double square = 0;
    for (int i = 0; i < ALL; i++) {
        square += pow(acos(fmin((double)weft_dot(at[i], middle), 1)), 2) / ALL;
        for (int k = 0; k < i; k++)
            assert_true(acos(fmin((double)weft_dot(at[i], at[k]), 1)) > weft_rad_of_deg(0.3));
    }
    assert_float_equal(square, pow(weft_rad_of_deg(9), 2) / 2, 0.1 * square);
    scene.light_count = 0;
    assert_int_equal(weft_lighting_of(&scene, NULL, 0).key_count, 0);
}

/* Half of the light comes from one side: so do half of the directions. */
static void the_fill_comes_from_where_the_environment_is_bright(void **state)
{
    (void)state;
    enum { FRAMES = 128 };
    weft_error error = {0};
    weft_environment *environment = calloc(1, sizeof *environment);
    weft_scene scene = weft_scene_default();
    weft_image map;
    expect_ok(weft_image_create(64, 32, &map, &error), &error);
    for (int i = 0; i < 64 * 32; i++) {
        int x = i % 64, y = i / 64;
        for (int c = 0; c < 3; c++)
            map.pixels[3 * i + c] = y >= 16 ? 0.3f : x < 32 ? 3 : 1; /* below the horizon; x < 0; x > 0 */
    }
    expect_ok(weft_environment_of_image(&map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, environment, &error), &error);
    scene.environment = true;
    double left = 0, all = 0;
    for (int i = 0; i < FRAMES; i++) {
        weft_lighting lighting = weft_lighting_of(&scene, environment, i);
        assert_int_equal(lighting.sample_count, WEFT_ENVIRONMENT_SAMPLES);
        for (int k = 0; k < lighting.sample_count; k++, all++) {
            assert_true(lighting.sample[k].z > 0);
            left += lighting.sample[k].x < 0;
        }
    }
    assert_float_equal(left / all, 0.75, 0.08);
    weft_image_free(&map);
    free(environment);
}

int test_studio_lights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_key_light_fills_its_disc_and_starts_in_the_middle),
        cmocka_unit_test(the_shadows_of_the_key_light_come_from_all_of_its_disc),
        cmocka_unit_test(the_fill_comes_from_where_the_environment_is_bright),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
