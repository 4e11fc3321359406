/* The exposure that a picture gets by itself: it follows the picture without a step. */
#include "player/settings/exposure.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>

enum { PIXELS = 2000, STEPS = 450 };

/* Some cloth: grey with a spread, a share of it in highlights, a share in folds that no light reaches. */
typedef struct cloth {
    double grey, highlight, shine, folds;
} cloth;

static void picture_of(const cloth *c, float *value)
{
    for (int i = 0; i < PIXELS; i++) {
        double place = (i + 0.5) / PIXELS, usual = c->grey * (0.4 + 1.2 * place);
        double lit = place > 1 - c->shine ? usual + c->highlight : usual;
        value[(i * 1009) % PIXELS] = (float)(place < c->folds ? 0 : lit);
    }
}

static double exposure_of(const cloth *c, bool has_ground)
{
    float *value = malloc(PIXELS * sizeof *value);
    picture_of(c, value);
    double exposure = weft_exposure_for_picture(value, PIXELS, has_ground);
    free(value);
    return exposure;
}

/* All of a picture darker or brighter by a factor: its exposure changes by no more than that factor, and never makes
 * the brighter one the darker. */
static void a_brighter_picture_is_shown_no_darker(void **state)
{
    (void)state;
    const double step = 1.02, highlight[] = {0, 1, 5, 40};
    for (int k = 0; k < 4; k++)
        for (int ground = 0; ground < 2; ground++) {
            double before = 0;
            for (int i = 0; i < STEPS; i++) {
                double grey = 0.0005 * pow(step, i);
                cloth c = {grey, highlight[k] * grey, 0.04, 0.1};
                double exposure = exposure_of(&c, ground), ratio = i > 0 ? exposure / before : 1;
                assert_true(ratio <= 1 + 1e-5 && ratio >= 1 / step - 1e-5);
                before = exposure;
            }
        }
}

/* A highlight, a fold that grow by a pixel, over all sizes. A pixel is 1/80 of the brightest that count, and 9 times
 * as bright as the others. */
static void nothing_in_a_picture_tips_it_over(void **state)
{
    (void)state;
    const double grey[] = {0.01, 0.1, 0.25, 0.6};
    for (int k = 0; k < 4; k++)
        for (int ground = 0; ground < 2; ground++) {
            double before[2] = {0};
            for (int i = 0; i < PIXELS / 4; i++) {
                double share = (double)i / PIXELS;
                cloth shining = {grey[k], 8 * grey[k], share, 0}, folded = {grey[k], grey[k], 0.02, share};
                double exposure[2] = {exposure_of(&shining, ground), exposure_of(&folded, ground)};
                for (int m = 0; m < 2; m++) {
                    assert_true(i == 0 || fabs(log(exposure[m] / before[m])) < 0.12);
                    before[m] = exposure[m];
                }
            }
        }
}

static void what_is_bright_enough_shows_reflectance(void **state)
{
    (void)state;
    cloth light = {0.52, 0, 0, 0}, dark = {0.02, 0, 0, 0}, glaring = {1, 10, 0.2, 0}, dull = {0.02, 3, 0.06, 0};
    assert_float_equal(exposure_of(&light, true), 1, 1e-9);
    /* 97 % of the way: 1.6 times the grey, less what is above it. */
    assert_float_equal(exposure_of(&dark, false) * 0.02 * (0.4 + 1.2 * 0.97), 0.7, 0.01);
    assert_float_equal(exposure_of(&glaring, true) * (0.4 + 1.2 * 0.97 + 10), 1, 0.01);
    double toned = exposure_of(&dark, true), glossy = exposure_of(&dull, true);
    assert_true(toned > 1 && toned < exposure_of(&dark, false));
    assert_float_equal(glossy, 1, 1e-9); /* its highlights may glare, the rest is dark enough */
}

static void a_picture_without_light_is_no_trouble(void **state)
{
    (void)state;
    cloth black = {0};
    float one = 0.02f;
    assert_float_equal(exposure_of(&black, true), 1, 0);
    assert_float_equal(weft_exposure_for_picture(NULL, 0, true), 1, 0);
    assert_float_equal(weft_exposure_for_picture(&one, 1, false), 35, 0.01);
}

int test_exposure(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_brighter_picture_is_shown_no_darker),
        cmocka_unit_test(nothing_in_a_picture_tips_it_over),
        cmocka_unit_test(what_is_bright_enough_shows_reflectance),
        cmocka_unit_test(a_picture_without_light_is_no_trouble),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
