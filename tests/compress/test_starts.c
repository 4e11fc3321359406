/* The starts of the fit against random starts, each run to convergence. The truths are of the model itself: this tests
 * the search, not the model. bench_starts measures the same on many more, and on cloth. */
#include "texel_fixture.h"

#include "base/processor.h"

#include "tests/support/alternation.h"
#include "tests/support/random_starts.h"

#include <math.h>
#include <stdlib.h>

#define NOISE 0.01 /* relative */

enum { VIEWS = 40, LIGHTS = 60, TEXELS = 60, STARTS = 25, MANY_STARTS = 60, LOBES = 3 };

static int setup(void **state)
{
    texel_fixture *fixture = calloc(1, sizeof *fixture);
    weft_error error = {0};
    assert_non_null(fixture);
    assert_int_equal(random_truth_layout(VIEWS, LIGHTS, &fixture->layout, &error), WEFT_OK);
    assert_int_equal(weft_bundle_create(&fixture->layout, NULL, &fixture->bundle, &error), WEFT_OK);
    assert_int_equal(weft_samples_create(&fixture->bundle, &fixture->samples, &error), WEFT_OK);
    assert_int_equal(weft_fit_workspace_create(&fixture->bundle, &fixture->workspace, &error), WEFT_OK);
    fixture->sum = calloc((size_t)(3 * VIEWS * LIGHTS), sizeof(float));
    fixture->count = calloc((size_t)(VIEWS * LIGHTS), sizeof(float));
    fixture->table = calloc(VIEWS, sizeof(double));
    assert_true(fixture->sum && fixture->count && fixture->table);
    for (int i = 0; i < VIEWS * LIGHTS; i++)
        fixture->count[i] = 1;
    fixture->frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    *state = fixture;
    return 0;
}

/* Whether a texel ends more than 2 % above the best of random starts, and above a relative error of `noise`. */
static bool is_above(texel_fixture *fixture, uint64_t texel, int lobes, int starts, double noise)
{
    weft_fit_options options = weft_fit_default_options();
    weft_fit fit, best;
    options.lobe_count = lobes;
    random_truth_samples(&fixture->layout, texel, NOISE, fixture->sum);
    texel_fixture_gather(fixture);
    weft_fit_cold(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &fit,
                  fixture->table);
    double left = weft_fit_residual(&fixture->bundle, &fixture->samples, 0, &fit, fixture->table);
    double least = random_starts_best(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace,
                                      &fixture->frame, texel, starts, &best, fixture->table);
    return left > 1.02 * 1.02 * fmax(least, noise * noise * fixture->samples.energy[0]);
}

/* A model with more lobes than the truth has follows the noise wherever it happens to look: what lies within the noise
 * is not counted. */
static int count_above(texel_fixture *fixture, int lobes)
{
    int above = 0;
    for (uint64_t texel = 0; texel < TEXELS; texel++)
        above += is_above(fixture, texel, lobes, STARTS, NOISE);
    print_message("%d lobes: %d of %d above\n", lobes, above, TEXELS);
    return above;
}

static void few_texels_end_above_random_starts(void **state)
{
    static const int most[LOBES] = {1, 1, 1}; /* from a mirror and a broad lobe alone: 6, 7, 6 */
    for (int lobes = 1; lobes <= LOBES; lobes++)
        assert_true(count_above(*state, lobes) <= most[lobes - 1]);
}

/* A truth, and the number of lobes of its fit. */
typedef struct hard_fit {
    int texel, lobes;
} hard_fit;

/* Some fits are let off: which they are depends on the last bits of a pass. */
static void assert_most_are_found(texel_fixture *fixture, const hard_fit *fit, int count, int let_off)
{
    int above = 0;
    for (int i = 0; i < count; i++)
        above += is_above(fixture, (uint64_t)fit[i].texel, fit[i].lobes, MANY_STARTS, 0);
    print_message("%d of %d above\n", above, count);
    assert_true(above <= let_off);
}

/* All of these ended above where two lobes of the screen were followed beside others. */
static void the_third_lobe_of_the_screen_is_followed(void **state)
{
    static const hard_fit fit[] = {{910, 2},   {10012, 2}, {12678, 2}, {20740, 2}, {29907, 2},
                                   {40195, 2}, {48061, 2}, {55408, 2}, {60219, 2}, {66266, 2},
                                   {41365, 3}, {50272, 3}, {50662, 3}, {54693, 3}, {58399, 3}};
    assert_most_are_found(*state, fit, (int)(sizeof fit / sizeof fit[0]), 5);
}

/* All of these ended above where a fit stopped at the first step that brought little. */
static void a_short_step_is_not_the_last(void **state)
{
    static const hard_fit fit[] = {{29647, 1}, {780, 2}, {125947, 2}, {910, 3}, {48842, 3}, {60219, 3}};
    assert_most_are_found(*state, fit, (int)(sizeof fit / sizeof fit[0]), 2);
}

/* All of these ended above where the search looked at 1640 of the 2400 samples. */
static void few_samples_are_all_looked_at(void **state)
{
    static const hard_fit fit[] = {{1170, 1},  {6566, 1},  {17489, 1}, {28737, 1}, {40130, 1}, {44030, 1},
                                   {48972, 1}, {55148, 1}, {9362, 2},  {11312, 2}, {14888, 2}, {24315, 2}};
    assert_most_are_found(*state, fit, (int)(sizeof fit / sizeof fit[0]), 4);
}

/* Of crossed yarns and Ward lobes, with a fitted frame. Where a further lobe began in the frame of the
 * surface, it ended above the fit with fewer in some. */
static void a_further_lobe_leaves_no_more(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = weft_fit_default_options();
    int above = 0;
    options.fit_frame = true;
    for (uint64_t texel = 0; texel < TEXELS; texel++) {
        double before = INFINITY;
        synthetic_texel(&fixture->layout, texel % 2 ? SYNTHETIC_WARD : SYNTHETIC_YARN, texel, 0.1, fixture->sum);
        texel_fixture_gather(fixture);
        for (options.lobe_count = 1; options.lobe_count <= LOBES; options.lobe_count++) {
            weft_fit fit;
            weft_fit_cold(&fixture->bundle, &fixture->samples, WEFT_GREY, &options, fixture->workspace, &fixture->frame,
                          &fit, fixture->table);
            above += fit.residual > 1.001 * before;
            before = fit.residual;
        }
    }
    print_message("%d above\n", above);
    assert_int_equal(above, 0);
}

int test_starts(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_texels_end_above_random_starts),
        cmocka_unit_test(the_third_lobe_of_the_screen_is_followed), cmocka_unit_test(a_short_step_is_not_the_last),
        cmocka_unit_test(few_samples_are_all_looked_at), cmocka_unit_test(a_further_lobe_leaves_no_more)};
    unsigned denormals = weft_denormals_off();
    int failed = cmocka_run_group_tests(tests, setup, texel_fixture_teardown);
    weft_denormals_restore(denormals);
    return failed;
}
