/* No texel is served better by a model that leaves out something of what it was allowed, however many samples it has.
 */
#include "texel_fixture.h"

#include "compress/texel/texel.h"

#include <stdlib.h>
#include <string.h>

#define ROUNDING 1.0001

/* The squared error that a texel is left with. */
static double left_of(texel_fixture *fixture, int lobe_count, bool table)
{
    weft_texel_source source = {
        .layout = &fixture->layout, .options = weft_fit_default_options(), .frames = WEFT_FRAMES_FITTED};
    source.options.lobe_count = lobe_count;
    source.options.table = table;
    weft_material material;
    weft_texel_fitter *fitter = NULL;
    weft_texel_counts counts = {0};
    assert_int_equal(
        weft_material_create(1, 1, lobe_count, table ? fixture->layout.view_count : 0, 0, 0, &material, NULL), WEFT_OK);
    assert_int_equal(weft_texel_fitter_create(&source, &fitter, NULL), WEFT_OK);
    weft_texel_fit(fitter, &material, 0, 0, 0, fixture->sum, fixture->count, &counts);
    weft_texel_fitter_free(fitter);
    weft_material_free(&material);
    return counts.sums.square_error;
}

/* Of the smaller models, the least that any leaves. */
static double left_of_smaller(texel_fixture *fixture, int most_lobes)
{
    double least = INFINITY;
    for (int lobes = 0; lobes <= most_lobes; lobes++) {
        for (int table = 0; table <= (lobes < most_lobes); table++)
            least = fmin(least, left_of(fixture, lobes, table));
    }
    return least;
}

/* A number of [low, high). */
static double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * synthetic_uniform(seed);
}

/* Two mirrors of which neither is seen or lit at grazing angles, which no lobe can follow; noise of 30 %. */
static void fill_facets(texel_fixture *fixture, uint64_t seed)
{
    weft_dataset_layout *layout = &fixture->layout;
    weft_vec3 normal[2];
    double exponent[2], amplitude[2];
    for (int i = 0; i < 2; i++) {
        normal[i] = weft_unit(weft_vec3_of(between(&seed, -0.5, 0.5), between(&seed, -0.5, 0.5), 1));
        exponent[i] = exp(between(&seed, 0, 4));
        amplitude[i] = between(&seed, 0.1, 1);
    }
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 light = layout->light[image], view = layout->view[layout->view_of_image[image]];
        double sum = 0.05;
        for (int i = 0; i < 2; i++) {
            double l = weft_dot(light, normal[i]), v = weft_dot(view, normal[i]);
            double base = 2 * l * v - weft_dot(light, view);
            if (l > 0.2 && v > 0.2 && base > 0)
                sum += amplitude[i] * pow(base, exponent[i]);
        }
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(light.z * sum * between(&seed, 0.7, 1.3));
        fixture->count[image] = 1;
    }
    texel_fixture_gather(fixture);
}

static void check(texel_fixture *fixture, int lobe_count, uint64_t first, uint64_t end)
{
    int better = 0;
    for (uint64_t texel = first; texel < end; texel++) {
        fill_facets(fixture, texel);
        double whole = left_of(fixture, lobe_count, true), smaller = left_of_smaller(fixture, lobe_count);
        if (whole > smaller * ROUNDING) {
            print_message("texel %d: %.4f of its smaller models\n", (int)texel, whole / smaller);
            better++;
        }
    }
    assert_int_equal(better, 0);
}

static void no_smaller_model_serves_better_than_two_lobes(void **state)
{
    check(*state, 2, 0, 200);
}

static void no_smaller_model_serves_better_than_three_lobes(void **state)
{
    check(*state, 3, 0, 80);
}

int test_smaller_models(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_smaller_model_serves_better_than_two_lobes),
        cmocka_unit_test(no_smaller_model_serves_better_than_three_lobes),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
