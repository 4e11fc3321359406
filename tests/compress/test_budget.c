/* The least error in a file of given size. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "btf/material/models.h"
#include "compress/compress.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 6 };

/* Left to right: white, two lobes with T, Ward lobes, yarns, and again. */
static void fill_mixture(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    if (x % 4 > 0) {
        synthetic_texel(layout, (synthetic_kind)(x % 4 - 1), (uint64_t)(8 * x + y), 0.01, samples);
        return;
    }
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = (float)layout->light[i / 3].z;
}

static int write_mixture(void **state)
{
    (void)state;
    weft_dataset_layout layout;
    assert_int_equal(synthetic_layout(SIDE, SIDE, &layout, NULL), WEFT_OK);
    synthetic_dataset_write("budget.btf.h5", &layout, fill_mixture);
    weft_dataset_layout_free(&layout);
    return 0;
}

static weft_material compress_file(const weft_compress_options *options)
{
    weft_dataset *dataset = synthetic_dataset_open("budget.btf.h5");
    weft_material material;
    weft_error error = {0};
    if (weft_compress(dataset, options, NULL, &material, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_dataset_close(dataset);
    return material;
}

static long written_size(const weft_material *material)
{
    assert_int_equal(weft_material_write("budget.weft", material, NULL), WEFT_OK);
    return (long)weft_file_bytes("budget.weft");
}

static void a_larger_budget_is_kept_and_leaves_less_error(void **state)
{
    (void)state;
    static const int budget[5] = {8000, 11000, 14000, 18000, 1000000};
    double error = INFINITY;
    long size = 0;
    for (int i = 0; i < 5; i++) {
        weft_compress_options options = weft_compress_default_options();
        options.component_count = 0;
        options.budget_bytes = (uint64_t)budget[i];
        weft_material material = compress_file(&options);
        long bytes = written_size(&material);
        printf("budget %d: %ld bytes, relative RMSE %.4f\n", budget[i], bytes, material.level[0].error.relative_rmse);
        assert_true(bytes <= budget[i]);
        assert_true(bytes >= size);
        assert_true(material.level[0].error.relative_rmse <= error);
        size = bytes;
        error = material.level[0].error.relative_rmse;
        weft_material_free(&material);
    }
}

static void without_bounds_the_error_is_at_most_that_of_the_whole_model(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_material whole = compress_file(&options);
    options.budget_bytes = 1000000;
    weft_material chosen = compress_file(&options);
    for (int k = 0; k < whole.level_count; k++)
        assert_true(chosen.level[k].error.rmse <= whole.level[k].error.rmse * (1 + 1e-6));
    assert_false(whole.has_models);
    assert_true(chosen.has_models);
    weft_material_free(&whole);
    weft_material_free(&chosen);
}

static void the_error_that_is_said_is_that_of_the_stored_texels(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.budget_bytes = 13000;
    weft_material material = compress_file(&options);
    weft_table_directions directions;
    weft_dataset_layout layout;
    double square = 0, square_error = 0;
    assert_int_equal(weft_table_directions_create(&material, &directions, NULL), WEFT_OK);
    assert_int_equal(synthetic_layout(SIDE, SIDE, &layout, NULL), WEFT_OK);
    float *samples = calloc(3 * (size_t)layout.image_count, sizeof *samples);
    assert_non_null(samples);
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        fill_mixture(&layout, texel % SIDE, texel / SIDE, samples, NULL);
        for (int image = 0; image < layout.image_count; image++) {
            weft_vec3 light = layout.light[image], view = layout.view[layout.view_of_image[image]];
            weft_rgba value = weft_material_texel(&material, &directions, 0, texel % SIDE, texel / SIDE, light, view);
            const double rgb[3] = {value.r, value.g, value.b};
            for (int c = 0; c < 3; c++) {
                double sample = (double)samples[3 * image + c], left = rgb[c] * light.z - sample;
                square += sample * sample;
                square_error += left * left;
            }
        }
    }
    assert_float_equal(material.level[0].error.relative_rmse / sqrt(square_error / square), 1, 2e-3);
    assert_true(material.level[0].error.median_relative > 0);
    free(samples);
    weft_dataset_layout_free(&layout);
    weft_table_directions_free(&directions);
    weft_material_free(&material);
}

static void white_texels_stay_diffuse_while_others_have_tables(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.budget_bytes = 14000;
    weft_material material = compress_file(&options);
    int tables = 0;
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        weft_model_parts parts = weft_model_decode(material.level[0].model[texel]);
        if (texel % SIDE % 4 == 0)
            assert_true(parts.lobe_count == 0 && parts.table_bits == 0);
        tables += parts.table_bits > 0;
    }
    assert_true(tables > 0);
    weft_material_free(&material);
}

static void a_light_table_competes_too(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.budget_bytes = 1000000;
    options.levels = false;
    weft_material without = compress_file(&options);
    options.light_table = true;
    weft_material with = compress_file(&options);
    int lit = 0;
    for (int texel = 0; texel < SIDE * SIDE; texel++)
        lit += weft_model_decode(with.level[0].model[texel]).light_table_bits > 0;
    assert_true(lit > 0);
    assert_true(with.level[0].error.rmse < 0.9 * without.level[0].error.rmse);
    weft_material_free(&without);
    weft_material_free(&with);
}

static void impossible_budgets_are_refused(void **state)
{
    (void)state;
    weft_dataset *dataset = synthetic_dataset_open("budget.btf.h5");
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_material material;
    weft_error error = {0};
    options.budget_bytes = 1000;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "too small"));
    options.target_error = 0.1;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "exclude"));
    weft_dataset_close(dataset);
}

int test_budget(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_larger_budget_is_kept_and_leaves_less_error),
        cmocka_unit_test(without_bounds_the_error_is_at_most_that_of_the_whole_model),
        cmocka_unit_test(the_error_that_is_said_is_that_of_the_stored_texels),
        cmocka_unit_test(white_texels_stay_diffuse_while_others_have_tables),
        cmocka_unit_test(a_light_table_competes_too),
        cmocka_unit_test(impossible_budgets_are_refused),
    };
    return cmocka_run_group_tests(tests, write_mixture, NULL);
}
