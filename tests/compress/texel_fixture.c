#include "texel_fixture.h"
#include "tests/support/alternation.h"

#include <stdlib.h>

int texel_fixture_setup(void **state)
{
    texel_fixture *fixture = calloc(1, sizeof *fixture);
    weft_error error = {0};
    assert_non_null(fixture);
    assert_int_equal(synthetic_layout(1, 1, &fixture->layout, &error), WEFT_OK);
    assert_int_equal(weft_bundle_create(&fixture->layout, NULL, &fixture->bundle, &error), WEFT_OK);
    assert_int_equal(weft_samples_create(&fixture->bundle, &fixture->samples, &error), WEFT_OK);
    assert_int_equal(weft_fit_workspace_create(&fixture->bundle, &fixture->workspace, &error), WEFT_OK);
    size_t images = (size_t)fixture->layout.image_count;
    fixture->sum = calloc(3 * images, sizeof(float));
    fixture->count = calloc(images, sizeof(float));
    fixture->table = calloc((size_t)fixture->layout.view_count, sizeof(double));
    assert_true(fixture->sum && fixture->count && fixture->table);
    fixture->frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    *state = fixture;
    return 0;
}

int texel_fixture_teardown(void **state)
{
    texel_fixture *fixture = *state;
    free(fixture->sum);
    free(fixture->count);
    free(fixture->table);
    weft_fit_workspace_free(fixture->workspace);
    weft_samples_free(&fixture->samples);
    weft_bundle_free(&fixture->bundle);
    weft_dataset_layout_free(&fixture->layout);
    free(fixture);
    return 0;
}

void texel_fixture_gather(texel_fixture *fixture)
{
    weft_samples_gather(&fixture->bundle, fixture->layout.values, fixture->sum, fixture->count, 1, &fixture->samples);
}

void texel_fixture_fill(texel_fixture *fixture, synthetic_kind kind, uint64_t seed, double noise)
{
    synthetic_texel(&fixture->layout, kind, seed, noise, fixture->sum);
    for (int image = 0; image < fixture->layout.image_count; image++)
        fixture->count[image] = 1;
    texel_fixture_gather(fixture);
}

double texel_fixture_error(const texel_fixture *fixture, int channel, const weft_fit *fit, const double *table)
{
    double residual = weft_fit_residual(&fixture->bundle, &fixture->samples, channel, fit, table);
    return sqrt(residual / fixture->samples.energy[channel]);
}
