/* Tables by principal components, from dataset to material. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "compress/compress.h"
#include "tests/support/synthetic_dataset.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 12, VIEWS = 37, LIGHTS = 37 };

static const char dataset_path[] = "table_pca.btf.h5";

/* T is built of three functions of the view: four components and a mean hold all of its square root but a little. */
static double table(weft_vec3 v, int x, int y)
{
    double a = sin(x * 1.7) * sin(y * 0.9), b = cos(x * 0.6 + y * 1.1), c = sin(x + 2.3 * y);
    double root = 0.65 + 0.15 * a * (double)v.x + 0.15 * b * (double)v.y + 0.1 * c * (double)(v.z - 0.7);
    return root * root;
}

static void fill(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 l = layout->light[image], v = layout->view[layout->view_of_image[image]];
        double gloss = fmax(0, (double)(l.z * v.z - l.x * v.x - l.y * v.y));
        for (int c = 0; c < 3; c++) {
            double f = 0.1 + 0.05 * c + 0.02 * sin(x + c) + (0.4 + 0.1 * cos(y)) * pow(gloss, 9);
            samples[3 * image + c] = (float)(table(v, x, y) * f * (double)l.z);
        }
    }
}

static int write_dataset(void **state)
{
    (void)state;
    weft_dataset_layout layout = {.width = SIDE,
                                  .height = SIDE,
                                  .image_count = VIEWS * LIGHTS,
                                  .view_count = VIEWS,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .texel_pitch_mm = 0.5};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int i = 0; i < VIEWS * LIGHTS; i++) {
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % LIGHTS));
        layout.view[i / LIGHTS] = weft_direction_of_angles(weft_ubo81_angles(i / LIGHTS));
        layout.view_of_image[i] = i / LIGHTS;
    }
    synthetic_dataset_write(dataset_path, &layout, fill);
    weft_dataset_layout_free(&layout);
    return 0;
}

static int remove_dataset(void **state)
{
    (void)state;
    return unlink(dataset_path);
}

static weft_material compress(int components, bool light_table)
{
    weft_material material;
    weft_error error = {0};
    weft_compress_options options = weft_compress_default_options();
    options.table_components = components;
    options.light_table = light_table;
    options.frames = WEFT_FRAMES_SURFACE;
    weft_dataset *dataset = synthetic_dataset_open(dataset_path);
    if (weft_compress(dataset, &options, NULL, &material, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_dataset_close(dataset);
    return material;
}

static void a_few_components_suffice_where_tables_are_alike(void **state)
{
    (void)state;
    const int components[] = {0, 1, 4};
    double rmse[3], size[3];
    for (int i = 0; i < 3; i++) {
        uint64_t bytes;
        weft_material material = compress(components[i], false);
        rmse[i] = material.level[0].error.relative_rmse;
        assert_int_equal(weft_material_size(&material, &bytes, NULL), WEFT_OK);
        size[i] = (double)bytes;
        assert_int_equal(material.has_table_bases, i > 0);
        weft_material_free(&material);
    }
    print_message("relative RMSE: 8 bits %.5f, 1 component %.5f, 4 components %.5f; %.3f of the size\n", rmse[0],
                  rmse[1], rmse[2], size[2] / size[0]);
    assert_true(rmse[1] > 1.5 * rmse[0]);
    assert_true(rmse[2] < 1.1 * rmse[0] + 0.002);
    assert_true(size[2] < 0.65 * size[0]);
}

static void a_light_table_is_reduced_alike(void **state)
{
    (void)state;
    weft_material whole = compress(0, true), reduced = compress(6, true);
    assert_non_null(reduced.level[0].light_table_basis);
    assert_int_equal(reduced.level[0].light_table_basis->direction_count, LIGHTS);
    print_message("relative RMSE: 8 bits %.5f, 6 components %.5f\n", whole.level[0].error.relative_rmse,
                  reduced.level[0].error.relative_rmse);
    assert_true(reduced.level[0].error.relative_rmse < 1.3 * whole.level[0].error.relative_rmse + 0.002);
    weft_material_free(&whole);
    weft_material_free(&reduced);
}

static void write_with_threads(int threads, const char *path)
{
    int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    weft_material material = compress(3, false);
    omp_set_num_threads(before);
    assert_int_equal(weft_material_write(path, &material, NULL), WEFT_OK);
    weft_material_free(&material);
}

static void threads_do_not_change_a_byte(void **state)
{
    (void)state;
    write_with_threads(1, "one.weft");
    write_with_threads(5, "five.weft");
    assert_int_equal(system("cmp one.weft five.weft"), 0);
    unlink("one.weft");
    unlink("five.weft");
}

static void components_and_a_target_exclude_each_other(void **state)
{
    (void)state;
    weft_material material;
    weft_error error = {0};
    weft_compress_options options = weft_compress_default_options();
    options.table_components = 4;
    options.target_error = 0.1;
    weft_dataset *dataset = synthetic_dataset_open(dataset_path);
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    options.target_error = 0;
    options.table_components = WEFT_BASIS_MAX_COMPONENTS + 1;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    weft_dataset_close(dataset);
}

int test_table_pca(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_few_components_suffice_where_tables_are_alike),
        cmocka_unit_test(a_light_table_is_reduced_alike),
        cmocka_unit_test(threads_do_not_change_a_byte),
        cmocka_unit_test(components_and_a_target_exclude_each_other),
    };
    return cmocka_run_group_tests(tests, write_dataset, remove_dataset);
}
