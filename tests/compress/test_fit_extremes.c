/* Texels that are no texels: whatever comes in, the fit is finite and does not shine where the samples are dark. */
#include "texel_fixture.h"

#include "compress/texel/pack.h"
#include "tests/support/alternation.h"

#include <float.h>
#include <stdlib.h>

static void assert_sensible(texel_fixture *fixture, const weft_fit *fit, int channel)
{
    double residual = weft_fit_residual(&fixture->bundle, &fixture->samples, channel, fit, fixture->table);
    assert_true(isfinite(residual));
    assert_true(residual <= fixture->samples.energy[channel] * (1 + 1e-5) + 1e-12);
    assert_true(isfinite(fit->diffuse) && fit->diffuse >= 0);
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        assert_true(isfinite(lobe->amplitude) && lobe->amplitude >= 0);
        assert_true(lobe->log_exponent >= 0 &&
                    lobe->log_exponent <= log(weft_fit_default_options().max_exponent) + 1e-9);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(lobe->c[k]) <= 1 + 1e-9);
    }
    for (int view = 0; view < fixture->bundle.view_count; view++)
        assert_true(isfinite(fixture->table[view]) && fixture->table[view] >= 0);
}

static void assert_packs(texel_fixture *fixture, const weft_fit_options *options, const weft_fit *fit, int channel)
{
    weft_packed packed;
    uint8_t code[WEFT_UBO81_COUNT];
    weft_pack_channel(&fixture->bundle, &fixture->samples, channel, options, fixture->workspace, fit, fixture->table,
                      &packed, code);
    weft_fit decoded = weft_unpack(&packed, fit->lobe_count, &fit->frame, fixture->samples.scale);
    assert_true(isfinite(decoded.diffuse) && decoded.diffuse >= 0);
    for (int i = 0; i < decoded.lobe_count; i++) {
        assert_true(isfinite(decoded.lobe[i].amplitude));
        assert_true((double)weft_float_of_half(packed.lobe[i][3]) >= 1);
    }
}

/* Fits 0 to 3 lobes with and without T, frame free or not. */
static void fit_all_models(texel_fixture *fixture)
{
    texel_fixture_gather(fixture);
    for (int variant = 0; variant < 16; variant++) {
        weft_fit_options options = weft_fit_default_options();
        options.lobe_count = variant % 4;
        options.table = variant & 4;
        options.fit_frame = variant & 8;
        weft_fit fit;
        weft_fit_cold(&fixture->bundle, &fixture->samples, variant % 3, &options, fixture->workspace, &fixture->frame,
                      &fit, fixture->table);
        assert_sensible(fixture, &fit, variant % 3);
        assert_packs(fixture, &options, &fit, variant % 3);
        weft_fit_refine(&fixture->bundle, &fixture->samples, WEFT_GREY, &options, fixture->workspace, &fit,
                        fixture->table);
        assert_sensible(fixture, &fit, WEFT_GREY);
    }
}

static void set_all(texel_fixture *fixture, float value, float count)
{
    for (int image = 0; image < fixture->layout.image_count; image++) {
        fixture->count[image] = count;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = count > 0 ? value * (float)fixture->layout.light[image].z : 0;
    }
}

static void scale_ward(texel_fixture *fixture, float factor)
{
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 1, 0.01);
    for (int i = 0; i < 3 * fixture->layout.image_count; i++)
        fixture->sum[i] *= factor;
}

static void all_zero(void **state)
{
    set_all(*state, 0, 1);
    fit_all_models(*state);
}

static void one_bright_spike(void **state)
{
    texel_fixture *fixture = *state;
    set_all(fixture, 0, 1);
    fixture->sum[3 * 3000] = fixture->sum[3 * 3000 + 1] = fixture->sum[3 * 3000 + 2] = 60000;
    fit_all_models(fixture);
}

static void constant_reflectance(void **state)
{
    set_all(*state, 0.5f, 1);
    fit_all_models(*state);
}

static void mirror_of_exponent_400(void **state)
{
    texel_fixture *fixture = *state;
    set_all(fixture, 0.01f, 1);
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double base = -l.x * v.x - l.y * v.y + l.z * v.z;
        for (int k = 0; k < 3 && base > 0; k++)
            fixture->sum[3 * image + k] += (float)(50 * pow(base, 400));
    }
    fit_all_models(fixture);
}

static void ten_thousand_times_brighter_than_white(void **state)
{
    scale_ward(*state, 1e4f);
    fit_all_models(*state);
}

static void a_millionth_of_white(void **state)
{
    scale_ward(*state, 1e-6f);
    fit_all_models(*state);
}

static void single_view(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 2, 0);
    for (int image = 0; image < fixture->layout.image_count; image++)
        fixture->count[image] = fixture->layout.view_of_image[image] == 40;
    fit_all_models(fixture);
}

static void half_masked(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_YARN, 2, 0.01);
    for (int image = 0; image < fixture->layout.image_count; image++)
        fixture->count[image] = image * 7 % 13 < 6;
    fit_all_models(fixture);
}

static void one_sample(void **state)
{
    texel_fixture *fixture = *state;
    set_all(fixture, 0.5f, 0);
    fixture->count[1234] = 1;
    fixture->sum[3 * 1234] = 0.25f;
    fit_all_models(fixture);
}

static void fully_masked(void **state)
{
    set_all(*state, 1, 0);
    fit_all_models(*state);
}

static void not_finite_samples_are_left_out(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 2, 0.01);
    int before = fixture->samples.valid_count;
    fixture->sum[3 * 100] = NAN;
    fixture->sum[3 * 200 + 1] = INFINITY;
    fixture->sum[3 * 300 + 2] = -INFINITY;
    texel_fixture_gather(fixture);
    assert_int_equal(fixture->samples.valid_count, before - 3);
    fit_all_models(fixture);
}

static void negative_samples(void **state)
{
    texel_fixture *fixture = *state;
    scale_ward(fixture, -1);
    fit_all_models(fixture);
    uint64_t seed = 1;
    for (int i = 0; i < 3 * fixture->layout.image_count; i++)
        fixture->sum[i] = (float)(synthetic_uniform(&seed) - 0.5);
    fit_all_models(fixture);
}

static void few_samples_afford_few_lobes(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 2, 0.01);
    assert_int_equal(weft_fit_affordable_lobes(&fixture->bundle, &fixture->samples, 3, true), 3);
    for (int image = 0; image < fixture->layout.image_count; image++)
        fixture->count[image] = fixture->layout.view_of_image[image] == 0 && image < 30;
    texel_fixture_gather(fixture);
    assert_int_equal(weft_fit_affordable_lobes(&fixture->bundle, &fixture->samples, 3, true), 1);
    fixture->count[0] = 1;
    for (int image = 1; image < fixture->layout.image_count; image++)
        fixture->count[image] = 0;
    texel_fixture_gather(fixture);
    assert_int_equal(weft_fit_affordable_lobes(&fixture->bundle, &fixture->samples, 3, true), 0);
}

int test_fit_extremes(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_zero),
        cmocka_unit_test(one_bright_spike),
        cmocka_unit_test(constant_reflectance),
        cmocka_unit_test(mirror_of_exponent_400),
        cmocka_unit_test(ten_thousand_times_brighter_than_white),
        cmocka_unit_test(a_millionth_of_white),
        cmocka_unit_test(single_view),
        cmocka_unit_test(half_masked),
        cmocka_unit_test(one_sample),
        cmocka_unit_test(fully_masked),
        cmocka_unit_test(not_finite_samples_are_left_out),
        cmocka_unit_test(negative_samples),
        cmocka_unit_test(few_samples_afford_few_lobes),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
