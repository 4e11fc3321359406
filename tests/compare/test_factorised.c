/* Photographs as products of matrices: what these restore exactly, and what they must not see. */
#include "tests/compare/fixture.h"

#include "base/half.h"
#include "compare/tradeoff/tradeoff.h"
#include "compress/hold_out/texel_subset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 8, RINGS = 4, HELD = 5 };

static const char *const path = "factorised.btf.h5", *const scratch = "factorised_scratch.btf.h5";

/* Five products of a function of the place and one of the directions, and a colour that goes with the place. */
static weft_rgb of_five_products(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double value = 0.4 + 0.02 * x * light.x + 0.02 * y * view.y + 0.002 * x * y * light.x * view.x +
                   0.001 * (x - y) * (x - y) * view.x * view.x;
    return (weft_rgb){value, value * (0.5 + 0.01 * light.x), value * 0.3};
}

/* The logarithm of the luminance is five products, of values that are very many. */
static weft_rgb of_powers(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double right = x / 3.5 - 1, down = y / 3.5 - 1;
    double power = right * light.x + down * light.y + right * down * view.x + right * right * view.y +
                   down * down * light.x * view.y;
    double value = 0.1 * exp(3 * power) / light.z;
    return (weft_rgb){0.8 * value, value, 0.6 * value};
}

/* The relative RMSE of what is fitted. What is held out is 40 in what the matrices see, and stays so. */
static double error_of(weft_factorised_kind kind, const weft_texel_subset *given)
{
    weft_error error = {0};
    const weft_dataset_layout *layout = &given->layout;
    size_t images = (size_t)layout->image_count, count = 3 * SIDE * SIDE * images;
    weft_texel_subset subset = *given;
    uint8_t *left_out = calloc(images, 1);
    weft_half *restored = malloc(count * sizeof *restored);
    double sum = 0, square = 0;
    subset.samples = malloc(count * sizeof *subset.samples);
    memcpy(subset.samples, given->samples, count * sizeof *subset.samples);
    for (size_t i = 0; i < images; i++)
        left_out[i] = i % HELD == 1;
    for (size_t i = 0; i < count; i++)
        subset.samples[i] = left_out[i / 3 % images] ? weft_half_of_float(40) : subset.samples[i];
    memcpy(restored, subset.samples, count * sizeof *restored);
    expect_ok(weft_factorised_restore(kind, &subset, left_out, restored, &error), &error);
    for (size_t i = 0; i < count; i++) {
        double wanted = (double)weft_float_of_half(given->samples[i]), is = (double)weft_float_of_half(restored[i]);
        if (left_out[i / 3 % images]) {
            assert_float_equal(is, 40, 0);
            continue;
        }
        sum += (is - wanted) * (is - wanted);
        square += wanted * wanted;
    }
    free(subset.samples);
    free(restored);
    free(left_out);
    return sqrt(sum / square);
}

static void read_subset(fixture_reflectance reflectance, fixture_mask masked, weft_texel_subset *subset)
{
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, SIDE, SIDE, RINGS, reflectance, masked);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, SIDE, subset, &error), &error);
    weft_dataset_close(dataset);
    unlink(path);
}

static void few_products_are_restored(void **state)
{
    (void)state;
    const fixture_reflectance reflectance[] = {of_five_products, of_powers};
    static const double least[2][WEFT_FACTORISED_KINDS] = {{0}, {0.01, 0, 0.01, 0}};
    static const double most[2][WEFT_FACTORISED_KINDS] = {{1e-3, 1e-2, 1e-3, 1e-2}, {1, 2e-3, 1, 2e-3}};
    for (int i = 0; i < 2; i++) {
        weft_texel_subset subset;
        read_subset(reflectance[i], FIXTURE_MASK_NONE, &subset);
        for (weft_factorised_kind kind = 0; kind < WEFT_FACTORISED_KINDS; kind++) {
            double error = error_of(kind, &subset);
            print_message("%s: %.5f\n", weft_factorised_name(kind), error);
            assert_true(error < most[i][kind] && error > least[i][kind]);
        }
        weft_texel_subset_free(&subset);
    }
}

/* Masked samples are 0: seen as such, they would be restored as something in between. */
static void what_is_masked_is_not_seen(void **state)
{
    (void)state;
    weft_texel_subset subset;
    read_subset(of_five_products, FIXTURE_MASK_FIFTH, &subset);
    assert_true(error_of(WEFT_FACTORISED_LINEAR, &subset) < 0.01);
    weft_texel_subset_free(&subset);
}

static const weft_priced_model *find(const weft_priced_model *model, int count, const char *name)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(model[i].name, name) == 0)
            return &model[i];
    }
    fail_msg("no model %s", name);
    return NULL;
}

static double held_error(weft_held_bench *bench, const weft_priced_model *model)
{
    weft_held_error measured;
    weft_error error = {0};
    expect_ok(weft_held_bench_measure(bench, model, &measured, &error), &error);
    double held = measured.held[WEFT_SAMPLES_ALL].relative_rmse;
    weft_held_error_free(&measured);
    return held;
}

/* Exact matrices say of what is held out what the photographs say, interpolated. */
static void rows_are_measured_and_weighed(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_held_bench *bench;
    weft_price_shop *shop;
    weft_price price;
    weft_error error = {0};
    weft_priced_model model[WEFT_PRICED_MOST];
    const weft_priced_dataset flat = {0};
    fixture_far_dataset(path, SIDE, SIDE, RINGS, of_five_products, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    int count = weft_priced_models_list(layout, &flat, model);
    const weft_priced_model *matrices = find(model, count, "full matrix, linear");
    expect_ok(weft_held_bench_create(dataset, WEFT_TEXEL_SUBSET_BLOCK, SIDE, (weft_splits_asked){0, 1}, scratch, &bench,
                                     &error),
              &error);
    double raw = held_error(bench, find(model, count, "the photographs, interpolated"));
    assert_float_equal(held_error(bench, matrices), raw, 0.001 + 0.02 * raw);
    weft_held_bench_free(bench);
    expect_ok(weft_price_shop_open(dataset, SIDE, scratch, NULL, &shop, &error), &error);
    expect_ok(weft_price_ask(shop, matrices, &price, &error), &error);
    assert_float_equal(price.bytes, 2 * 16 * (SIDE * SIDE + 3 * layout->image_count), 0);
    expect_ok(weft_price_ask(shop, find(model, count, "matrix per channel, linear"), &price, &error), &error);
    assert_float_equal(price.bytes, 2 * 16 * (SIDE * SIDE + layout->image_count), 0);
    weft_price_shop_close(shop);
    weft_dataset_close(dataset);
    unlink(path);
}

int test_factorised(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_products_are_restored),
        cmocka_unit_test(what_is_masked_is_not_seen),
        cmocka_unit_test(rows_are_measured_and_weighed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
