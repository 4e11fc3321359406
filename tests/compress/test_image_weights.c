/* Images that count for less than others, on the way from the dataset to the material. */
#include "tests/support/cmocka_all.h"

#include "btf/material/material.h"
#include "compress/compress.h"
#include "compress/texel/pack.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 6, SPOILED = 4 };

/* One image of SPOILED, too many for lobes to follow, is how many times too bright. */
static double spoil;

static weft_vec3 any_direction(uint64_t *seed)
{
    double theta = 1.1 * sqrt(synthetic_uniform(seed)), phi = 2 * WEFT_PI * synthetic_uniform(seed);
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

/* A list of photographs: few make the sparse model, more the lobes without tables. With `table`, a grid that has one.
 */
static weft_dataset_layout list_layout(int views, int lights)
{
    uint64_t seed = 5;
    weft_dataset_layout layout = {.width = SIDE,
                                  .height = SIDE,
                                  .image_count = views * lights,
                                  .view_count = views,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = WEFT_FAR,
                                  .texel_pitch_mm = 1};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int view = 0; view < views; view++)
        layout.view[view] = any_direction(&seed);
    for (int i = 0; i < layout.image_count; i++) {
        layout.light[i] = any_direction(&seed);
        layout.view_of_image[i] = i / lights;
    }
    return layout;
}

static double albedo_of(int x, int y)
{
    return 0.2 + 0.02 * x + 0.01 * y;
}

static void fill(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    for (int image = 0; image < layout->image_count; image++) {
        double z = layout->light[image].z, wrong = image % SPOILED == 1 ? spoil : 1;
        for (int k = 0; k < 3; k++)
            samples[3 * image + k] = (float)(wrong * z * albedo_of(x, y));
    }
}

static void weigh(weft_dataset_layout *layout, double all, double spoiled)
{
    assert_int_equal(weft_dataset_layout_allocate_figure(layout, WEFT_IMAGE_WEIGHT, NULL), WEFT_OK);
    for (int i = 0; i < layout->image_count; i++)
        layout->figure[WEFT_IMAGE_WEIGHT][i] = i % SPOILED == 1 ? spoiled : all;
}

static weft_compress_report compress_to(const weft_dataset_layout *layout, weft_sample_weights weights,
                                        weft_material *material)
{
    synthetic_dataset_write("weighed.btf.h5", layout, fill);
    weft_dataset *dataset = synthetic_dataset_open("weighed.btf.h5");
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_compress_report report;
    weft_error error = {0};
    options.weights = weights;
    if (weft_compress(dataset, &options, NULL, material, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_dataset_close(dataset);
    return report;
}

/* Largest relative error of the diffuse term under every view, T included: the material is matt. */
static double worst_error(const weft_material *material)
{
    const weft_material_level *level = &material->level[0];
    int views = material->view_count > 0 ? material->view_count : 1;
    double worst = 0;
    for (size_t i = 0; i < (size_t)views * SIDE * SIDE; i++) {
        size_t texel = i % (SIDE * SIDE);
        double diffuse = (double)weft_float_of_half(level->diffuse[4 * texel + 1]);
        double t = material->view_count > 0 ? weft_table_of_code(level->table[4 * i + 1]) : 1;
        worst = fmax(worst, fabs(diffuse * t / albedo_of((int)texel % SIDE, (int)texel / SIDE) - 1));
    }
    return worst;
}

static double error_with(int views, int lights, weft_sample_weights weights, double spoiled_weight,
                         weft_compress_model model)
{
    weft_dataset_layout layout = list_layout(views, lights);
    weft_material material;
    if (spoiled_weight < 1)
        weigh(&layout, 2, 2 * spoiled_weight);
    weft_compress_report report = compress_to(&layout, weights, &material);
    assert_int_equal(report.model, model);
    double error = worst_error(&material);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
    return error;
}

static void a_gross_error_of_small_weight_does_no_harm(void **state)
{
    (void)state;
    static const struct {
        int views, lights;
        weft_sample_weights weights;
        weft_compress_model model;
    } row[] = {{9, 1, WEFT_WEIGHTS_EVEN, WEFT_COMPRESS_SPARSE},
               {40, 1, WEFT_WEIGHTS_EVEN, WEFT_COMPRESS_LOBES},
               {40, 1, WEFT_WEIGHTS_SCREEN, WEFT_COMPRESS_LOBES},
               {4, 30, WEFT_WEIGHTS_EVEN, WEFT_COMPRESS_TABLE}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        spoil = 6;
        double even = error_with(row[i].views, row[i].lights, row[i].weights, 1, row[i].model);
        double light = error_with(row[i].views, row[i].lights, row[i].weights, 1e-4, row[i].model);
        double none = error_with(row[i].views, row[i].lights, row[i].weights, 0, row[i].model);
        if (!(even > 0.002) || !(light < even / 4) || !(none < even / 4))
            fail_msg("row %zu: errors %g even, %g with small weight, %g without", i, even, light, none);
    }
}

static void same_bytes(weft_dataset_layout *layout)
{
    weft_material plain, weighed;
    compress_to(layout, WEFT_WEIGHTS_EVEN, &plain);
    weigh(layout, 1, 1);
    compress_to(layout, WEFT_WEIGHTS_EVEN, &weighed);
    assert_int_equal(weft_material_write("plain.weft", &plain, NULL), WEFT_OK);
    assert_int_equal(weft_material_write("weighed.weft", &weighed, NULL), WEFT_OK);
    size_t size, other;
    unsigned char *a = scratch_load("plain.weft", &size), *b = scratch_load("weighed.weft", &other);
    assert_int_equal(size, other);
    assert_memory_equal(a, b, size);
    free(a);
    free(b);
    weft_material_free(&plain);
    weft_material_free(&weighed);
}

static void weights_of_one_change_no_byte(void **state)
{
    (void)state;
    static const int count[3][2] = {{9, 1}, {40, 1}, {4, 30}};
    spoil = 1.2;
    for (int i = 0; i < 3; i++) {
        weft_dataset_layout layout = list_layout(count[i][0], count[i][1]);
        same_bytes(&layout);
        weft_dataset_layout_free(&layout);
    }
}

int test_image_weights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gross_error_of_small_weight_does_no_harm),
        cmocka_unit_test(weights_of_one_change_no_byte),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
