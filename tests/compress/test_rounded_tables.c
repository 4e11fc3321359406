/* A budget may give a texel fewer bits of T. A code that is rounded up makes its view brighter: not beyond the limit
 * that every fit keeps to. */
#include "texel_fixture.h"

#include "compress/texel/texel.h"

#include <string.h>

#define WHITE 0.1 /* f of all samples; the limit is four times that */

enum { CANDIDATES = 3 };

static const int bits_of_candidate[CANDIDATES] = {4, 6, 8};

/* One diffuse texel whose T has the same code in all views. */
static weft_material material_of(const weft_dataset_layout *layout, uint8_t code, double rho)
{
    weft_material material;
    assert_int_equal(weft_material_create(1, 1, 0, layout->view_count, 0, false, &material, NULL), WEFT_OK);
    memcpy(material.view, layout->view, (size_t)layout->view_count * sizeof *layout->view);
    for (int channel = 0; channel < 3; channel++)
        material.level[0].diffuse[channel] = weft_half_of_float((float)rho);
    memset(material.level[0].table, code, 4 * (size_t)layout->view_count);
    const weft_frame surface = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&surface, material.level[0].frame);
    return material;
}

/* What the candidates leave: T in 4, 6 and 8 bits. */
static void judge(texel_fixture *fixture, uint8_t code, double rho, float left[CANDIDATES])
{
    weft_material material = material_of(&fixture->layout, code, rho);
    weft_candidate candidate[CANDIDATES];
    for (int i = 0; i < CANDIDATES; i++)
        candidate[i] = (weft_candidate){&material, {0, bits_of_candidate[i], 0}};
    const weft_judgement judgement = {CANDIDATES, candidate, {left}};
    const weft_texel_source source = {
        .layout = &fixture->layout, .options = weft_fit_default_options(), .judgement = &judgement};
    weft_texel_fitter *fitter;
    weft_texel_counts counts = {0};
    assert_int_equal(weft_texel_fitter_create(&source, &fitter, NULL), WEFT_OK);
    weft_texel_fit(fitter, &material, 0, 0, 0, fixture->sum, fixture->count, &counts);
    weft_texel_fitter_free(fitter);
    weft_material_free(&material);
}

static void fill_white(texel_fixture *fixture)
{
    for (int i = 0; i < fixture->layout.image_count; i++) {
        fixture->count[i] = 1;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * i + k] = (float)(WHITE * fixture->layout.light[i].z);
    }
}

/* Code 9 of 255 becomes 17 in 4 bits, 8 in 6 bits: T is 3.6 times as large, or smaller. */
static void bits_that_lift_a_texel_over_the_limit_are_not_for_sale(void **state)
{
    texel_fixture *fixture = *state;
    float left[CANDIDATES];
    fill_white(fixture);
    judge(fixture, 9, 3 * WHITE / (9 / 255.0 * (9 / 255.0)), left);
    assert_true(isinf(left[0]));
    assert_true(isfinite(left[1]) && isfinite(left[2]));
}

static void bits_that_keep_a_texel_below_it_are(void **state)
{
    texel_fixture *fixture = *state;
    float left[CANDIDATES];
    fill_white(fixture);
    judge(fixture, 9, WHITE / (9 / 255.0 * (9 / 255.0)), left);
    for (int i = 0; i < CANDIDATES; i++)
        assert_true(isfinite(left[i]));
    assert_true(left[0] > left[1] && left[1] > left[2]);
}

int test_rounded_tables(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_that_lift_a_texel_over_the_limit_are_not_for_sale),
        cmocka_unit_test(bits_that_keep_a_texel_below_it_are),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
