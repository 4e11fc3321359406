/* The computed environments: skies and a studio. */
#include "player/scene/surroundings.h"
#include "studio.h"

#include <math.h>

static double green_at(const weft_image *map, double theta_deg, double phi_deg)
{
    int row = (int)(theta_deg / 180 * map->height), column = (int)((0.75 - phi_deg / 360) * map->width);
    column = (column % map->width + map->width) % map->width;
    return (double)map->pixels[3 * (row * map->width + column) + 1];
}

/* Over pi, on level ground: the mean of cos theta over bands of equal solid angle. */
static double irradiance_up(const weft_image *map)
{
    double sum = 0;
    for (int row = 0; row < map->height / 2; row++) {
        double top = WEFT_PI * row / map->height, bottom = WEFT_PI * (row + 1) / map->height, mean = 0;
        for (int x = 0; x < map->width; x++)
            mean += (double)map->pixels[3 * (row * map->width + x) + 1] / map->width;
        sum += mean * (pow(sin(bottom), 2) - pow(sin(top), 2));
    }
    return sum;
}

/* Moon and Spencer: three times as bright above as at the horizon; irradiance 7/9 pi of the zenith's radiance. */
static void the_overcast_sky_is_three_times_as_bright_above(void **state)
{
    (void)state;
    weft_image map = studio_map("overcast");
    assert_float_equal(green_at(&map, 1, 0) / green_at(&map, 89, 0), 3, 0.15);
    assert_float_equal(irradiance_up(&map) / green_at(&map, 1, 0), 7.0 / 9, 0.02);
    assert_float_equal(green_at(&map, 60, 10), green_at(&map, 60, 200), 1e-6);
    weft_image_free(&map);
}

/* Brightest round the sun, as bright on either side of it, darkest about 90 degrees from it, brighter at the horizon.
 */
static void the_clear_sky_is_bright_round_its_sun(void **state)
{
    (void)state;
    weft_scene scene = weft_scene_default();
    weft_image map = studio_map("sky");
    weft_surroundings_light("sky", &scene);
    double theta = weft_deg_of_rad(scene.light[0].direction.theta_rad),
           phi = weft_deg_of_rad(scene.light[0].direction.phi_rad);
    double beside = green_at(&map, theta, phi + 30), across = green_at(&map, 90 - theta, phi + 180);
    assert_true(green_at(&map, theta, phi) > 2 * beside && beside > 1.5 * across);
    assert_float_equal(green_at(&map, theta, phi - 30) / beside, 1, 0.05);
    assert_true(green_at(&map, 88, phi + 180) > 1.5 * across);
    weft_image_free(&map);
}

static void only_the_overcast_sky_has_no_key_light(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_image map;
    for (int i = 0; weft_surroundings_names[i]; i++) {
        weft_scene scene = weft_scene_default();
        weft_surroundings_light(weft_surroundings_names[i], &scene);
        assert_true(scene.environment && weft_surroundings_are(weft_surroundings_names[i]));
        assert_int_equal(scene.light_count, i == 1 ? 0 : 1);
    }
    assert_false(weft_surroundings_are("studio.hdr"));
    assert_int_equal(weft_surroundings_map("beach", &map, &error), WEFT_BAD_USAGE);
}

int test_surroundings(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_overcast_sky_is_three_times_as_bright_above),
        cmocka_unit_test(the_clear_sky_is_bright_round_its_sun),
        cmocka_unit_test(only_the_overcast_sky_has_no_key_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
