/* Fits of one texel: truth recovered, joint against alternation, half the samples, another order of the images. */
#include "tests/support/alternation.h"
#include "texel_fixture.h"

#include <stdlib.h>
#include <string.h>

static weft_fit_options options_of(int lobes, bool table)
{
    weft_fit_options options = weft_fit_default_options();
    options.lobe_count = lobes;
    options.table = table;
    return options;
}

static void fit_cold(texel_fixture *fixture, int channel, const weft_fit_options *options, weft_fit *fit)
{
    weft_fit_cold(&fixture->bundle, &fixture->samples, channel, options, fixture->workspace, &fixture->frame, fit,
                  fixture->table);
}

static void truth_without_noise_is_recovered(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = options_of(2, true);
    options.tolerance = 1e-6;
    options.max_passes = 200;
    int recovered = 0;
    for (uint64_t material = 0; material < 6; material++) {
        texel_fixture_fill(fixture, SYNTHETIC_LAFORTUNE, 64 * material, 0);
        weft_fit fit, truth;
        double table[WEFT_UBO81_COUNT];
        fit_cold(fixture, 0, &options, &fit);
        synthetic_truth(&fixture->layout, 64 * material, &truth, table);
        assert_true(texel_fixture_error(fixture, 0, &fit, fixture->table) < 0.01);
        int sharp = fit.lobe[0].log_exponent > fit.lobe[1].log_exponent ? 0 : 1;
        double found = exp(fit.lobe[sharp].log_exponent), expected = exp(truth.lobe[0].log_exponent);
        bool same_ratio = true;
        for (int view = 1; view < WEFT_UBO81_COUNT; view++) {
            double ratio = fixture->table[view] / fixture->table[0] / (table[view] / table[0]);
            same_ratio = same_ratio && fabs(ratio - 1) < 0.02;
        }
        recovered += fabs(found / expected - 1) < 0.02 && same_ratio;
    }
    assert_true(recovered >= 5);
}

static void one_lobe_without_table_is_recovered_exactly(void **state)
{
    texel_fixture *fixture = *state;
    const weft_fit truth = {.diffuse = 0.2,
                            .lobe_count = 1,
                            .lobe = {{.c = {-0.8, -0.6, 1}, .log_exponent = log(12), .amplitude = 0.7}},
                            .frame = fixture->frame};
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 0, 0);
    weft_fit_options options = options_of(1, false);
    options.tolerance = 1e-9;
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double base = -0.8 * l.x * v.x - 0.6 * l.y * v.y + l.z * v.z;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * (truth.diffuse + (base > 0 ? 0.7 * pow(base, 12) : 0)));
    }
    texel_fixture_gather(fixture);
    weft_fit fit;
    fit_cold(fixture, 1, &options, &fit);
    double scale = fixture->samples.scale;
    assert_float_equal(fit.diffuse * scale, 0.2, 1e-4);
    assert_float_equal(fit.lobe[0].amplitude * scale, 0.7, 1e-3);
    assert_float_equal(exp(fit.lobe[0].log_exponent), 12, 0.01);
    assert_float_equal(fit.lobe[0].c[0], -0.8, 1e-3);
    assert_float_equal(fit.lobe[0].c[1], -0.6, 1e-3);
}

/* What fuzz does: more, by the cosine, the lower the lamp stands. Lobes about the mirror direction or the normal would
 * have to be negative, and vanish. */
static void light_thrown_back_along_the_surface_is_fitted(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 0, 0);
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double along_x = fmax(0.9 * l.x * v.x - 0.1 * l.z * v.z, 0),
               along_y = fmax(0.9 * l.y * v.y - 0.1 * l.z * v.z, 0);
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * (0.5 + along_x + along_y));
    }
    texel_fixture_gather(fixture);
    weft_fit_options options = options_of(2, true);
    weft_fit fit;
    fit_cold(fixture, 1, &options, &fit);
    assert_true(texel_fixture_error(fixture, 1, &fit, fixture->table) < 0.02);
}

static void a_turned_frame_is_found(void **state)
{
    texel_fixture *fixture = *state;
    weft_frame turned = weft_frame_of_normal(weft_unit(weft_vec3_of(0.25, -0.15, 1)), 0.6);
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 0, 0);
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double base = -weft_dot(turned.tangent, l) * weft_dot(turned.tangent, v) -
                      0.5 * weft_dot(turned.bitangent, l) * weft_dot(turned.bitangent, v) +
                      weft_dot(turned.normal, l) * weft_dot(turned.normal, v);
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * (0.2 + (base > 0 ? pow(base, 20) : 0)));
    }
    texel_fixture_gather(fixture);
    weft_fit_options options = options_of(1, true);
    weft_fit upright, free;
    fit_cold(fixture, WEFT_GREY, &options, &upright);
    options.fit_frame = true;
    options.tolerance = 1e-6;
    options.max_passes = 200;
    fit_cold(fixture, WEFT_GREY, &options, &free);
    assert_true(free.residual < 0.01 * upright.residual);
    assert_true(texel_fixture_error(fixture, WEFT_GREY, &free, fixture->table) < 0.01);
    assert_true(weft_dot(free.frame.normal, turned.normal) > cos(weft_rad_of_deg(1)));
}

/* A mirror that is sharper than what is allowed. */
static void no_exponent_exceeds_the_largest_one_asked_for(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 0, 0);
    for (int image = 0; image < fixture->layout.image_count; image++) {
        weft_vec3 l = fixture->layout.light[image], v = fixture->layout.view[fixture->layout.view_of_image[image]];
        double base = -l.x * v.x - l.y * v.y + l.z * v.z;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] = (float)(l.z * (0.2 + (base > 0 ? pow(base, 300) : 0)));
    }
    texel_fixture_gather(fixture);
    weft_fit_options options = options_of(1, true);
    for (options.max_exponent = 16; options.max_exponent < 200; options.max_exponent *= 3) {
        weft_fit fit;
        fit_cold(fixture, 0, &options, &fit);
        double exponent = exp(fit.lobe[0].log_exponent);
        assert_true(exponent <= options.max_exponent * (1 + 1e-9) && exponent > 0.9 * options.max_exponent);
    }
}

static void joint_fit_is_never_worse_than_alternation(void **state)
{
    texel_fixture *fixture = *state;
    for (synthetic_kind kind = 0; kind < SYNTHETIC_KINDS; kind++) {
        for (uint64_t material = 0; material < 4; material++) {
            texel_fixture_fill(fixture, kind, 64 * material + material, 0.01);
            weft_fit_options options = options_of(1 + (int)(material % 2), true);
            weft_fit joint, alternating;
            weft_error error = {0};
            fit_cold(fixture, 0, &options, &joint);
            double ours = texel_fixture_error(fixture, 0, &joint, fixture->table);
            assert_int_equal(weft_fit_alternate(&fixture->bundle, &fixture->samples, 0, &options, 0.1, 20,
                                                &fixture->frame, &alternating, fixture->table, &error),
                             WEFT_OK);
            double reference = texel_fixture_error(fixture, 0, &alternating, fixture->table);
            assert_true(ours * ours <= 1.005 * reference * reference);
        }
    }
}

static void reported_residual_is_that_of_the_samples_in_double(void **state)
{
    texel_fixture *fixture = *state;
    for (synthetic_kind kind = 0; kind < SYNTHETIC_KINDS; kind++) {
        for (int lobes = 0; lobes <= 3; lobes++) {
            texel_fixture_fill(fixture, kind, 130, 0.01);
            weft_fit_options options = options_of(lobes, lobes != 3);
            weft_fit fit;
            fit_cold(fixture, 2, &options, &fit);
            double exact = weft_fit_residual(&fixture->bundle, &fixture->samples, 2, &fit, fixture->table);
            assert_float_equal(fit.residual / exact, 1, 1e-3);
        }
    }
}

static void more_freedom_never_hurts(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_YARN, 70, 0.01);
    double last = INFINITY;
    for (int lobes = 0; lobes <= 3; lobes++) {
        weft_fit fit, plain;
        weft_fit_options with_table = options_of(lobes, true), without = options_of(lobes, false);
        fit_cold(fixture, 0, &without, &plain);
        fit_cold(fixture, 0, &with_table, &fit);
        assert_true(fit.residual < plain.residual);
        assert_true(fit.residual < 1.01 * last);
        last = fit.residual;
    }
}

static void a_start_from_the_neighbour_is_as_good_as_a_cold_one(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = options_of(2, true);
    double warm = 0, cold = 0;
    for (uint64_t material = 0; material < 5; material++) {
        weft_fit start, fit;
        double table[WEFT_UBO81_COUNT];
        texel_fixture_fill(fixture, SYNTHETIC_WARD, 64 * material, 0.01);
        fit_cold(fixture, 0, &options, &start);
        memcpy(table, fixture->table, sizeof table);
        texel_fixture_fill(fixture, SYNTHETIC_WARD, 64 * material + 1, 0.01);
        weft_fit_refine(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &start, table);
        warm += sqrt(start.residual / fixture->samples.energy[0]);
        fit_cold(fixture, 0, &options, &fit);
        cold += sqrt(fit.residual / fixture->samples.energy[0]);
    }
    assert_true(warm < 1.02 * cold);
}

/* Reverses the order of the images of the fixture's layout and samples. */
static void reverse_images(texel_fixture *fixture)
{
    weft_dataset_layout *layout = &fixture->layout;
    for (int a = 0, b = layout->image_count - 1; a < b; a++, b--) {
        weft_vec3 light = layout->light[a];
        int32_t view = layout->view_of_image[a];
        layout->light[a] = layout->light[b];
        layout->light[b] = light;
        layout->view_of_image[a] = layout->view_of_image[b];
        layout->view_of_image[b] = view;
        for (int k = 0; k < 3; k++) {
            float sample = fixture->sum[3 * a + k];
            fixture->sum[3 * a + k] = fixture->sum[3 * b + k];
            fixture->sum[3 * b + k] = sample;
        }
    }
}

static void order_of_the_images_leaves_no_trace(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = options_of(2, true);
    weft_fit forward, backward;
    weft_error error = {0};
    texel_fixture_fill(fixture, SYNTHETIC_YARN, 5, 0.01);
    fit_cold(fixture, 0, &options, &forward);
    reverse_images(fixture);
    weft_bundle_free(&fixture->bundle);
    assert_int_equal(weft_bundle_create(&fixture->layout, NULL, &fixture->bundle, &error), WEFT_OK);
    texel_fixture_gather(fixture);
    fit_cold(fixture, 0, &options, &backward);
    assert_memory_equal(&forward.lobe, &backward.lobe, sizeof forward.lobe);
    assert_true(forward.residual == backward.residual && forward.diffuse == backward.diffuse);
}

static void masked_samples_have_no_influence(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = options_of(2, true);
    weft_fit with_garbage, with_zeros;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 3, 0.01);
    for (int image = 0; image < fixture->layout.image_count; image += 3) {
        fixture->count[image] = 0;
        fixture->sum[3 * image] = 1e6f;
    }
    texel_fixture_gather(fixture);
    fit_cold(fixture, 0, &options, &with_garbage);
    for (int image = 0; image < fixture->layout.image_count; image += 3)
        fixture->sum[3 * image] = 0;
    texel_fixture_gather(fixture);
    fit_cold(fixture, 0, &options, &with_zeros);
    assert_memory_equal(&with_garbage.lobe, &with_zeros.lobe, sizeof with_zeros.lobe);
}

static void weights_act_as_repeated_samples(void **state)
{
    texel_fixture *fixture = *state;
    weft_fit_options options = options_of(1, true);
    options.tolerance = 1e-8;
    texel_fixture_fill(fixture, SYNTHETIC_YARN, 9, 0.01);
    /* Half the group valid: sums of 2 out of 4 texels weigh 1/2. */
    for (int image = 0; image < fixture->layout.image_count; image++) {
        float valid = image % 2 ? 2 : 4;
        fixture->count[image] = valid;
        for (int k = 0; k < 3; k++)
            fixture->sum[3 * image + k] *= valid;
    }
    weft_samples_gather(&fixture->bundle, fixture->layout.values, fixture->sum, fixture->count, 4, &fixture->samples);
    weft_fit fit;
    fit_cold(fixture, 0, &options, &fit);
    /* The diffuse gradient of the weighted problem vanishes, that of the unweighted one does not. */
    double weighted = 0, plain = 0, size = 0;
    for (int i = 0; i < fixture->bundle.sample_count; i++) {
        int image = fixture->bundle.image[i], view = fixture->bundle.view_of[i];
        if (image < 0)
            continue;
        weft_vec3 l = fixture->layout.light[image], v = fixture->bundle.view[view];
        const weft_fit_lobe *lobe = &fit.lobe[0];
        double base = lobe->c[0] * l.x * v.x + lobe->c[1] * l.y * v.y + lobe->c[2] * l.z * v.z;
        double model = fit.diffuse + (base > 0 ? lobe->amplitude * pow(base, exp(lobe->log_exponent)) : 0);
        double weight = image % 2 ? 0.5 : 1, t = fixture->table[view];
        double sample = (double)fixture->samples.value[0][i] / sqrt(weight);
        double gradient = t * l.z * (sample - t * l.z * model);
        weighted += weight * gradient;
        plain += gradient;
        size += weight * fabs(gradient);
    }
    assert_true(fabs(weighted) < 1e-3 * size);
    assert_true(fabs(plain) > 3 * fabs(weighted));
}

int test_fit(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(truth_without_noise_is_recovered),
        cmocka_unit_test(one_lobe_without_table_is_recovered_exactly),
        cmocka_unit_test(light_thrown_back_along_the_surface_is_fitted),
        cmocka_unit_test(a_turned_frame_is_found),
        cmocka_unit_test(no_exponent_exceeds_the_largest_one_asked_for),
        cmocka_unit_test(joint_fit_is_never_worse_than_alternation),
        cmocka_unit_test(reported_residual_is_that_of_the_samples_in_double),
        cmocka_unit_test(more_freedom_never_hurts),
        cmocka_unit_test(a_start_from_the_neighbour_is_as_good_as_a_cold_one),
        cmocka_unit_test(masked_samples_have_no_influence),
        cmocka_unit_test(weights_act_as_repeated_samples),
        cmocka_unit_test(order_of_the_images_leaves_no_trace),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
