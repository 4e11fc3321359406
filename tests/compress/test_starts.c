/* The starts of the fit against random starts, each run to convergence. The truths are of the model itself: this tests
 * the search, not the model. bench_starts measures the same on many more, and on cloth. */
#include "texel_fixture.h"

#include "base/processor.h"

#include "tests/support/alternation.h"
#include "tests/support/random_starts.h"

#include <math.h>
#include <stdlib.h>

#define NOISE 0.01 /* relative */

enum { VIEWS = 40, LIGHTS = 60, TEXELS = 60, STARTS = 25, LOBES = 3 };

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

/* How many of the texels end more than 2 % above the best of random starts, and above what noise leaves: a model with
 * more lobes than the truth has follows the noise wherever it happens to look. */
static int count_above(texel_fixture *fixture, int lobes)
{
    weft_fit_options options = weft_fit_default_options();
    int above = 0;
    options.lobe_count = lobes;
    for (uint64_t texel = 0; texel < TEXELS; texel++) {
        weft_fit fit, best;
        random_truth_samples(&fixture->layout, texel, NOISE, fixture->sum);
        texel_fixture_gather(fixture);
        weft_fit_cold(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &fit,
                      fixture->table);
        double left = weft_fit_residual(&fixture->bundle, &fixture->samples, 0, &fit, fixture->table);
        double least = random_starts_best(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace,
                                          &fixture->frame, texel, STARTS, &best, fixture->table);
        double noise = NOISE * NOISE * fixture->samples.energy[0];
        above += left > 1.02 * 1.02 * fmax(least, noise);
    }
    print_message("%d lobes: %d of %d above\n", lobes, above, TEXELS);
    return above;
}

static void few_texels_end_above_random_starts(void **state)
{
    static const int most[LOBES] = {1, 1, 1}; /* from a mirror and a broad lobe alone: 6, 7, 6 */
    for (int lobes = 1; lobes <= LOBES; lobes++)
        assert_true(count_above(*state, lobes) <= most[lobes - 1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(few_texels_end_above_random_starts)};
    unsigned denormals = weft_denormals_off();
    int failed = cmocka_run_group_tests(tests, setup, texel_fixture_teardown);
    weft_denormals_restore(denormals);
    return failed;
}
