/* What rounding to half floats and 8 bits costs. */
#include "texel_fixture.h"

#include "compress/fit/workspace.h"
#include "compress/texel/pack.h"

/* Error of a packed fit over the error of the fit. */
static double loss(texel_fixture *fixture, const weft_fit_options *options, const weft_fit *fit)
{
    weft_packed packed;
    uint8_t code[WEFT_UBO81_COUNT];
    double before = texel_fixture_error(fixture, 0, fit, fixture->table), decoded[WEFT_UBO81_COUNT];
    weft_pack_channel(&fixture->bundle, &fixture->samples, 0, options, fixture->workspace, fit, fixture->table, &packed,
                      code);
    for (int view = 0; view < WEFT_UBO81_COUNT; view++)
        decoded[view] = options->table ? weft_table_of_code(code[view]) : 1;
    weft_fit stored = weft_unpack(&packed, fit->lobe_count, &fit->frame, fixture->samples.scale);
    return texel_fixture_error(fixture, 0, &stored, decoded) / before;
}

static void rounding_costs_less_than_a_hundredth_of_the_error(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = weft_fit_default_options();
    for (synthetic_kind kind = SYNTHETIC_WARD; kind < SYNTHETIC_KINDS; kind++) {
        double sum = 0;
        for (uint64_t material = 0; material < 8; material++) {
            weft_fit fit;
            texel_fixture_fill(fixture, kind, 64 * material, 0.01);
            weft_fit_cold(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &fit,
                          fixture->table);
            sum += loss(fixture, &options, &fit);
        }
        print_message("kind %d: error after rounding / before = %.5f\n", (int)kind, sum / 8);
        assert_true(sum / 8 < 1.01);
    }
}

static void a_table_entry_gets_the_nearest_code(void **state)
{
    (void)state;
    for (int code = 0; code <= 255; code++) {
        double t = code / 255.0 * (code / 255.0);
        assert_int_equal(weft_code_of_table(t), code);
        assert_float_equal(weft_table_of_code((uint8_t)code), t, 1e-15);
        /* A little to either side of halfway to the next. */
        double below = (code + 0.49) / 255, above = (code + 0.51) / 255;
        assert_int_equal(weft_code_of_table(below * below), code);
        assert_int_equal(weft_code_of_table(above * above), code < 255 ? code + 1 : 255);
    }
    assert_int_equal(weft_code_of_table(-1), 0);
    assert_int_equal(weft_code_of_table(1e9), 255);
}

static void fill_mirror(texel_fixture *fixture, double exponent)
{
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double base = -l.x * v.x - l.y * v.y + l.z * v.z;
        double sum = 0.1 + (base > 0 ? 3 * pow(base, exponent) : 0);
        fixture->count[image] = 1;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * sum * (0.7 + 0.3 * v.z));
    }
    texel_fixture_gather(fixture);
}

static void sharp_lobes_survive_half_floats(void **state)
{
    texel_fixture *fixture = *state;
    const double exponents[] = {30, 100, 180, 200, 230, 260, 300, 340, 400, 450, 500};
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = 1;
    options.tolerance = 1e-8;
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        weft_fit fit;
        fill_mirror(fixture, exponents[i]);
        weft_fit_cold(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &fit,
                      fixture->table);
        assert_true(texel_fixture_error(fixture, 0, &fit, fixture->table) < 0.01);
        weft_packed packed;
        uint8_t code[WEFT_UBO81_COUNT];
        double decoded[WEFT_UBO81_COUNT];
        weft_pack_channel(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fit, fixture->table,
                          &packed, code);
        for (int view = 0; view < WEFT_UBO81_COUNT; view++)
            decoded[view] = weft_table_of_code(code[view]);
        weft_fit stored = weft_unpack(&packed, 1, &fit.frame, fixture->samples.scale);
        assert_true(texel_fixture_error(fixture, 0, &stored, decoded) < 0.005);
    }
}

static void largest_table_entry_uses_the_whole_range(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = weft_fit_default_options();
    weft_fit fit;
    weft_packed packed;
    uint8_t code[WEFT_UBO81_COUNT], largest = 0;
    texel_fixture_fill(fixture, SYNTHETIC_YARN, 11, 0.01);
    weft_fit_cold(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &fit,
                  fixture->table);
    weft_pack_channel(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fit, fixture->table,
                      &packed, code);
    for (int view = 0; view < WEFT_UBO81_COUNT; view++)
        largest = code[view] > largest ? code[view] : largest;
    assert_true(largest > 175);
}

/* Where light and view graze on the same side, the lobe is far below its peak: its amplitude lies beyond the bound of
 * the fit, and T has taken over the rest. */
static void amplitudes_take_back_what_a_large_table_had(void **state)
{
    texel_fixture *fixture = *state;
    const double exponent = 8, amplitude = 5e5;
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = 1;
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double base = (double)(l.x * v.x + l.y * v.y);
        fixture->count[image] = v.z > 0.95 ? 1 : 0;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] =
                (float)((double)(fixture->count[image] * l.z) * (base > 0 ? amplitude * pow(base, exponent) : 0));
    }
    texel_fixture_gather(fixture);
    double needed = amplitude / fixture->samples.scale, held = 5e4;
    assert_true(needed > 4e5);
    weft_fit fit = {.lobe_count = 1, .lobe = {{{1, 1, 0}, log(exponent), held}}, .frame = fixture->frame};
    for (int view = 0; view < WEFT_UBO81_COUNT; view++)
        fixture->table[view] = needed / held;
    assert_true(texel_fixture_error(fixture, 0, &fit, fixture->table) < 1e-4);
    weft_packed packed;
    uint8_t code[WEFT_UBO81_COUNT];
    double decoded[WEFT_UBO81_COUNT];
    weft_trial *trial = &fixture->workspace->trial[0];
    trial->fit = fit;
    weft_workspace_pass(&fixture->bundle, &fixture->samples, 0, &options,
                        weft_workspace_keep_table(&fixture->bundle, fixture->workspace, fixture->table), trial);
    weft_pack_channel(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fit, fixture->table,
                      &packed, code);
    for (int view = 0; view < WEFT_UBO81_COUNT; view++)
        decoded[view] = weft_table_of_code(code[view]);
    weft_fit stored = weft_unpack(&packed, 1, &fit.frame, fixture->samples.scale);
    assert_true(texel_fixture_error(fixture, 0, &stored, decoded) < 0.03);
}

static void frames_survive_packing(void **state)
{
    (void)state;
    weft_frame frame = weft_frame_of_normal(weft_unit(weft_vec3_of(0.3, -0.2, 0.9)), -2.5);
    int16_t code[3];
    weft_frame packed = weft_pack_frame(&frame, code);
    assert_true(weft_dot(packed.normal, frame.normal) > 1 - 1e-8);
    assert_true(weft_dot(packed.tangent, frame.tangent) > 1 - 1e-7);
    weft_frame again = weft_frame_decode(code);
    assert_memory_equal(&again, &packed, sizeof again);
}

int test_pack(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_table_entry_gets_the_nearest_code),
        cmocka_unit_test(rounding_costs_less_than_a_hundredth_of_the_error),
        cmocka_unit_test(sharp_lobes_survive_half_floats),
        cmocka_unit_test(largest_table_entry_uses_the_whole_range),
        cmocka_unit_test(amplitudes_take_back_what_a_large_table_had),
        cmocka_unit_test(frames_survive_packing),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
