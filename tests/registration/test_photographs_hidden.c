/* What the pin and the balls hide of the sample, against many points along the way to the lamp and the camera. */
#include "btf/dataset/dataset.h"
#include "registration/photographs/steps.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 20, STEPS = 500 };

/* Nothing stands higher. */
#define HIGHEST_MM 32.0

static weft_vec3 direction_of(double tilt_deg, double azimuth_deg, double distance)
{
    double tilt = tilt_deg * M_PI / 180, azimuth = azimuth_deg * M_PI / 180;
    return weft_vec3_of(distance * sin(tilt) * cos(azimuth), distance * sin(tilt) * sin(azimuth), distance * cos(tilt));
}

/* How near a point comes to the pin, whose head of 1.5 mm ends at its height, or to a ball. */
static double nearness(const weft_photographs_settings *settings, weft_vec3 at)
{
    double place[2], least = INFINITY;
    if (settings->pin_height_mm > 0) {
        weft_target_pin(&settings->target, place);
        double height = fmin(fmax(at.z, 0), settings->pin_height_mm - 1.5);
        least = sqrt(pow(at.x - place[0], 2) + pow(at.y - place[1], 2) + pow(at.z - height, 2)) - 1.5;
    }
    for (int i = 0; i < 2 && settings->ball_diameter_mm > 0; i++) {
        double radius = settings->ball_diameter_mm / 2;
        weft_target_ball(&settings->target, i, place);
        double centre = sqrt(pow(at.x - place[0], 2) + pow(at.y - place[1], 2) + pow(at.z - radius, 2));
        least = fmin(least, centre - radius);
    }
    return least;
}

/* The way comes so near to a body, `soft` of the way counted as near. */
static bool passes_near(const weft_photographs_settings *settings, weft_vec3 texel, weft_vec3 to, double soft,
                        double margin)
{
    weft_vec3 way = weft_subtract(to, texel);
    double end = fmin(1, HIGHEST_MM / to.z);
    for (int i = 0; i <= STEPS; i++) {
        double t = end * i / STEPS;
        if (nearness(settings, weft_add(texel, weft_scale(way, t))) < soft * t * weft_length(way) + margin)
            return true;
    }
    return false;
}

static weft_photographs_settings settings_of(double pin_mm, double ball_mm)
{
    weft_photographs_settings settings = weft_photographs_defaults();
    settings.width = SIDE;
    settings.height = SIDE;
    settings.pin_height_mm = pin_mm;
    settings.ball_diameter_mm = ball_mm;
    return settings;
}

/* Counts the texels that are masked; each must be hidden, and each that is hidden well must be masked. */
static long expect_as_along_the_way(const weft_photographs_settings *settings, weft_vec3 lamp, weft_vec3 eye)
{
    uint8_t mask[SIDE * SIDE] = {0};
    long hidden, masked = 0;
    weft_photographs_mask_hidden(settings, lamp, eye, mask, &hidden);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double side = settings->target.opening_mm;
        weft_vec3 texel =
            weft_vec3_of((i % SIDE + 0.5) / SIDE * side - side / 2, side / 2 - (i / SIDE + 0.5) / SIDE * side, 0);
        double margin = mask[i] ? 0.3 : -0.3; /* steps along the way, and the widening beyond its nearest point */
        bool is_near =
            passes_near(settings, texel, lamp, 0.03, margin) || passes_near(settings, texel, eye, 0.01, margin);
        assert_int_equal(is_near, mask[i] == WEFT_MASK_MISSING);
        masked += mask[i] != 0;
    }
    assert_int_equal(masked, hidden);
    return masked;
}

static void what_is_hidden_is_masked(void **state)
{
    (void)state;
    weft_photographs_settings both = settings_of(30, 20), pin = settings_of(30, 0), balls = settings_of(0, 20);
    long by_pin = 0, by_balls = 0, from_eye = 0;
    for (int azimuth = 0; azimuth < 360; azimuth += 15) {
        weft_vec3 low = direction_of(76, azimuth, 600), high = direction_of(20, azimuth, 600);
        by_pin += expect_as_along_the_way(&pin, low, high);
        by_balls += expect_as_along_the_way(&balls, direction_of(85, azimuth, 600), high);
        from_eye += expect_as_along_the_way(&both, high, low);
        assert_int_equal(expect_as_along_the_way(&both, high, high), 0);
    }
    assert_true(by_pin > 80);
    assert_true(by_balls > 40);
    assert_true(from_eye > 40);
}

static void what_does_not_stand_there_hides_nothing(void **state)
{
    (void)state;
    weft_photographs_settings none = settings_of(0, 0);
    for (int azimuth = 0; azimuth < 360; azimuth += 15)
        assert_int_equal(expect_as_along_the_way(&none, direction_of(80, azimuth, 600), direction_of(80, azimuth, 600)),
                         0);
}

static void what_was_masked_stays_and_is_not_counted_again(void **state)
{
    (void)state;
    weft_photographs_settings pin = settings_of(30, 0);
    double place[2];
    weft_target_pin(&pin.target, place);
    weft_vec3 lamp = direction_of(78, atan2(place[1], place[0]) * 180 / M_PI, 600);
    uint8_t mask[SIDE * SIDE];
    long first, again;
    memset(mask, 0, sizeof mask);
    weft_photographs_mask_hidden(&pin, lamp, direction_of(0, 0, 600), mask, &first);
    memset(mask, WEFT_MASK_SATURATED, sizeof mask);
    weft_photographs_mask_hidden(&pin, lamp, direction_of(0, 0, 600), mask, &again);
    long both = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        both += mask[i] == (WEFT_MASK_SATURATED | WEFT_MASK_MISSING);
    assert_true(first > 5);
    assert_int_equal(both, first);
    assert_int_equal(again, 0);
}

int test_photographs_hidden(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_hidden_is_masked),
        cmocka_unit_test(what_does_not_stand_there_hides_nothing),
        cmocka_unit_test(what_was_masked_stays_and_is_not_counted_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
