/* Few images: the model that borrows from its neighbours, and near lights. */
#include "tests/support/cmocka_all.h"

#include "compress/compress.h"
#include "compress/sparse/sparse.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"
#include "weft/import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 24 };

/* Flash and camera at the same places above a sheet of SIDE mm. */
static weft_dataset_layout flash_layout(int images)
{
    weft_dataset_layout layout = {.width = SIDE,
                                  .height = SIDE,
                                  .image_count = images,
                                  .view_count = images,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = WEFT_NEAR,
                                  .texel_pitch_mm = 1};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    uint64_t seed = 3;
    for (int i = 0; i < images; i++) {
        double x = 24 * synthetic_uniform(&seed) - 12, y = 24 * synthetic_uniform(&seed) - 12;
        layout.light[i] = layout.view[i] = weft_vec3_of(x, y, 60);
        layout.view_of_image[i] = i;
    }
    return layout;
}

/* Left half exponent 16, right half 64; albedo varies from texel to texel; the brightest samples are masked. */
static void fill_foil(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    uint64_t seed = (uint64_t)(y * SIDE + x);
    double albedo = 0.1 + 0.2 * synthetic_uniform(&seed), exponent = x < SIDE / 2 ? 16 : 64;
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 l = weft_dataset_light_direction(layout, image, x, y);
        weft_vec3 v = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
        double base = -l.x * v.x - l.y * v.y + l.z * v.z;
        for (int k = 0; k < 3; k++) {
            samples[3 * image + k] = (float)(l.z * (albedo * (1 + 0.5 * k) + 2 * pow(fmax(base, 0), exponent)));
            mask[image] |= samples[3 * image + k] > 2.2f ? WEFT_MASK_SATURATED : 0;
        }
    }
}

static weft_material compress_file(const char *path, const uint8_t *held_out, weft_compress_report *report)
{
    weft_dataset *dataset = synthetic_dataset_open(path);
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_material material;
    weft_error error = {0};
    options.held_out = held_out;
    options.levels = !held_out;
    if (weft_compress(dataset, &options, NULL, &material, report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_dataset_close(dataset);
    return material;
}

static double exponent_at(const weft_material *material, int x, int y)
{
    size_t texel = (size_t)(y * material->level[0].width + x);
    return (double)weft_float_of_half(material->level[0].lobe[4 * texel + 3]);
}

static void nine_images_give_one_lobe_with_the_exponent_of_the_region(void **state)
{
    (void)state;
    weft_dataset_layout layout = flash_layout(9);
    synthetic_dataset_write("foil.btf.h5", &layout, fill_foil);
    weft_compress_report report;
    weft_material material = compress_file("foil.btf.h5", NULL, &report);
    assert_int_equal(report.model, WEFT_COMPRESS_SPARSE);
    assert_int_equal(material.lobe_count, 1);
    assert_int_equal(material.view_count, 0);
    assert_int_equal(material.level_count, 6);
    assert_float_equal(exponent_at(&material, 4, 12), 16, 1);
    assert_float_equal(exponent_at(&material, 20, 12), 64, 4);
    assert_true(material.level[0].error.median_relative < 0.03);
    assert_non_null(strstr(material.metadata, "sparse"));
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

/* The error of a material over the valid samples of one image. */
static weft_error_summary error_of_image(const char *path, const weft_material *material, int image);

static void a_held_out_image_is_predicted(void **state)
{
    (void)state;
    weft_dataset_layout layout = flash_layout(9);
    synthetic_dataset_write("foil.btf.h5", &layout, fill_foil);
    for (int image = 0; image < 9; image += 4) {
        uint8_t held_out[9] = {0};
        held_out[image] = 1;
        weft_material material = compress_file("foil.btf.h5", held_out, NULL);
        weft_error_summary error = error_of_image("foil.btf.h5", &material, image);
        assert_true(error.relative_rmse < 0.2);
        assert_true(error.median_relative < 0.1);
        weft_material_free(&material);
    }
    weft_dataset_layout_free(&layout);
}

static void three_images_are_diffuse(void **state)
{
    (void)state;
    weft_dataset_layout layout = flash_layout(3);
    synthetic_dataset_write("three.btf.h5", &layout, fill_foil);
    weft_compress_report report;
    weft_material material = compress_file("three.btf.h5", NULL, &report);
    assert_int_equal(report.model, WEFT_COMPRESS_SPARSE);
    assert_true(exponent_at(&material, 4, 4) >= 1);
    assert_true(weft_float_of_half(material.level[0].lobe[0]) == 0);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

static void many_near_images_are_fitted_with_the_directions_of_each_texel(void **state)
{
    (void)state;
    weft_dataset_layout layout = flash_layout(60);
    synthetic_dataset_write("near.btf.h5", &layout, fill_foil);
    weft_compress_report report;
    weft_material material = compress_file("near.btf.h5", NULL, &report);
    assert_int_equal(report.model, WEFT_COMPRESS_LOBES);
    assert_int_equal(material.view_count, 0);
    assert_true(material.level[0].error.relative_rmse < 0.08);
    assert_true(material.level[0].error.median_relative < 0.01);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

static weft_error_summary error_of_image(const char *path, const weft_material *material, int image)
{
    weft_dataset *dataset = synthetic_dataset_open(path);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t images = (size_t)layout->image_count, row = (size_t)layout->width * images;
    weft_half *samples = malloc(3 * row * sizeof *samples);
    uint8_t *mask = malloc(row);
    weft_compared *value = malloc(3 * (size_t)(layout->width * layout->height) * sizeof *value);
    size_t count = 0;
    weft_error_summary summary;
    for (int y = 0; y < layout->height; y++) {
        assert_int_equal(weft_dataset_read_block(dataset, 0, y, layout->width, 1, samples, mask, NULL), WEFT_OK);
        for (int x = 0; x < layout->width; x++) {
            size_t at = (size_t)x * images + (size_t)image;
            if (mask[at])
                continue;
            weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
            weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
            weft_rgba found = weft_material_texel(material, NULL, 0, x, y, light, view);
            const double rgb[3] = {found.r * light.z, found.g * light.z, found.b * light.z};
            for (size_t k = 0; k < 3; k++)
                value[count++] =
                    (weft_compared){.sample = weft_float_of_half(samples[3 * at + k]), .prediction = (float)rgb[k]};
        }
    }
    assert_int_equal(weft_error_summary_of(value, count, &summary, NULL), WEFT_OK);
    free(value);
    free(samples);
    free(mask);
    weft_dataset_close(dataset);
    return summary;
}

/* The nine flash photographs of a card, reduced so that the test stays quick. */
static void real_flash_photographs_predict_the_one_left_out(void **state)
{
    (void)state;
    if (access(WEFT_SHARED "/real/cards-blue/00.png", R_OK) != 0) {
        print_message("no " WEFT_SHARED "/real/cards-blue: skipped\n");
        skip();
    }
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_error error = {0};
    options.width = 32;
    assert_int_equal(weft_import(WEFT_SHARED "/real/cards-blue", "cards.btf.h5", &options, NULL, &report, &error),
                     WEFT_OK);
    weft_import_report_free(&report);
    double rmse = 0, median = 0;
    for (int image = 0; image < 9; image++) {
        uint8_t held_out[9] = {0};
        held_out[image] = 1;
        weft_material material = compress_file("cards.btf.h5", held_out, NULL);
        weft_error_summary own = error_of_image("cards.btf.h5", &material, image);
        rmse += own.relative_rmse / 9;
        median += own.median_relative / 9;
        weft_material_free(&material);
    }
    print_message("32 x 32, leave one out: relative RMSE %.3f, median relative error %.3f\n", rmse, median);
    assert_true(rmse < 0.45);
    assert_true(median < 0.35);
}

int test_sparse(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nine_images_give_one_lobe_with_the_exponent_of_the_region),
        cmocka_unit_test(a_held_out_image_is_predicted),
        cmocka_unit_test(three_images_are_diffuse),
        cmocka_unit_test(many_near_images_are_fitted_with_the_directions_of_each_texel),
        cmocka_unit_test(real_flash_photographs_predict_the_one_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
