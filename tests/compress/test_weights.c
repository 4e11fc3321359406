/* Samples that count as a screen shows them. */
#include "texel_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { TEXELS = 24 };

/* Grey of a sample with its cosine, and its weight, as they were gathered. */
typedef struct gathered {
    double *grey, *weight;
    double scale;
} gathered;

static gathered copy_samples(const texel_fixture *fixture)
{
    const weft_samples *samples = &fixture->samples;
    size_t count = (size_t)samples->sample_count;
    gathered copy = {calloc(count, sizeof(double)), calloc(count, sizeof(double)), samples->scale};
    assert_true(copy.grey && copy.weight);
    for (size_t i = 0; i < count; i++) {
        double light_z = (double)fixture->bundle.light[2][i];
        double root = light_z > 0 ? (double)samples->cosine[i] / light_z : 0;
        copy.weight[i] = root * root;
        copy.grey[i] = root > 0 ? (double)samples->value[WEFT_GREY][i] / root * samples->scale : 0;
    }
    return copy;
}

static void free_copy(gathered *copy)
{
    free(copy->grey);
    free(copy->weight);
}

static void samples_stay_and_weights_fall_with_their_brightness(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_WARD, 5, 0.01);
    gathered even = copy_samples(fixture);
    weft_samples_weigh_for_screen(&fixture->bundle, &fixture->samples);
    gathered screen = copy_samples(fixture);
    double sum = 0, weight = 0;
    for (int i = 0; i < fixture->samples.sample_count; i++) {
        double expected = even.weight[i] / (1 + fmax(0, even.grey[i]) / (WEFT_SCREEN_TOE * even.scale));
        assert_true(fabs(screen.weight[i] - expected) <= 1e-5 * expected);
        assert_true(fabs(screen.grey[i] - even.grey[i]) <= 1e-5 * fabs(even.grey[i]));
        sum += screen.weight[i] * screen.grey[i] * screen.grey[i];
        weight += screen.weight[i];
    }
    assert_true(fabs(fixture->samples.weight - weight) <= 1e-5 * weight);
    assert_true(sum / weight < even.scale * even.scale);
    double energy = 0;
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        energy += fixture->samples.energy[channel];
    assert_true(fabs(energy / (WEFT_CHANNELS * weight) - 1) < 1e-5);
    free_copy(&even);
    free_copy(&screen);
}

/* Relative RMSE over the samples no brighter than half their rms, and over all. */
typedef struct two_errors {
    double dark, all;
} two_errors;

static two_errors fit_channel(texel_fixture *fixture, const gathered *even)
{
    const weft_fit_options options = weft_fit_default_options();
    const weft_bundle *bundle = &fixture->bundle;
    weft_samples *samples = &fixture->samples;
    weft_fit fit = {.passes = 0};
    double dark = 0, dark_error = 0, all = 0, all_error = 0;
    weft_fit_cold(bundle, samples, WEFT_GREY, &options, fixture->workspace, &fixture->frame, &fit, fixture->table);
    const float *model = weft_fit_evaluate(bundle, samples, fixture->workspace, &fit);
    for (int i = 0; i < samples->sample_count; i++) {
        if (!(samples->cosine[i] > 0))
            continue;
        double root = (double)(samples->cosine[i] / bundle->light[2][i]);
        double f = (double)model[i] * fixture->table[bundle->view_of[i]] / root * samples->scale;
        double error = (f - even->grey[i]) * (f - even->grey[i]), square = even->grey[i] * even->grey[i];
        all += square;
        all_error += error;
        if (even->grey[i] < 0.5 * even->scale) {
            dark += square;
            dark_error += error;
        }
    }
    return (two_errors){sqrt(dark_error / dark), sqrt(all_error / all)};
}

static void what_lies_beside_highlights_keeps_its_colour(void **state)
{
    texel_fixture *fixture = *state;
    for (synthetic_kind kind = SYNTHETIC_WARD; kind < SYNTHETIC_KINDS; kind++) {
        two_errors even = {0}, screen = {0};
        for (uint64_t texel = 0; texel < TEXELS; texel++) {
            texel_fixture_fill(fixture, kind, 65 * texel, 0.01);
            gathered copy = copy_samples(fixture);
            two_errors one = fit_channel(fixture, &copy);
            weft_samples_weigh_for_screen(&fixture->bundle, &fixture->samples);
            two_errors other = fit_channel(fixture, &copy);
            even = (two_errors){even.dark + one.dark / TEXELS, even.all + one.all / TEXELS};
            screen = (two_errors){screen.dark + other.dark / TEXELS, screen.all + other.all / TEXELS};
            free_copy(&copy);
        }
        print_message("kind %d: relative RMSE of dark samples %.3f, weighed %.3f; of all %.3f, weighed %.3f\n",
                      (int)kind, even.dark, screen.dark, even.all, screen.all);
        assert_true(screen.dark < 0.85 * even.dark);
        assert_true(screen.all >= even.all);
    }
}

static void what_the_model_can_say_is_found_all_the_same(void **state)
{
    texel_fixture *fixture = *state;
    texel_fixture_fill(fixture, SYNTHETIC_LAFORTUNE, 3, 0);
    gathered copy = copy_samples(fixture);
    weft_samples_weigh_for_screen(&fixture->bundle, &fixture->samples);
    assert_true(fit_channel(fixture, &copy).all < 0.01);
    free_copy(&copy);
}

static void extremes_stay_finite(void **state)
{
    texel_fixture *fixture = *state;
    const float value[] = {0, -1, 1e-30f, 1e4f, NAN, INFINITY};
    for (size_t k = 0; k < sizeof value / sizeof *value; k++) {
        texel_fixture_fill(fixture, SYNTHETIC_WARD, 1, 0.01);
        for (int i = 0; i < 3 * fixture->layout.image_count; i++)
            fixture->sum[i] = k < 3 || i % 7 == 0 ? value[k] : fixture->sum[i];
        texel_fixture_gather(fixture);
        weft_samples_weigh_for_screen(&fixture->bundle, &fixture->samples);
        assert_true(isfinite(fixture->samples.scale) && fixture->samples.scale > 0);
        weft_fit fit = {.passes = 0};
        const weft_fit_options options = weft_fit_default_options();
        weft_fit_cold(&fixture->bundle, &fixture->samples, 0, &options, fixture->workspace, &fixture->frame, &fit,
                      fixture->table);
        assert_true(isfinite(fit.residual) && isfinite(fit.diffuse));
    }
}

int test_weights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_stay_and_weights_fall_with_their_brightness),
        cmocka_unit_test(what_lies_beside_highlights_keeps_its_colour),
        cmocka_unit_test(what_the_model_can_say_is_found_all_the_same),
        cmocka_unit_test(extremes_stay_finite),
    };
    return cmocka_run_group_tests(tests, texel_fixture_setup, texel_fixture_teardown);
}
