/* The plane and the heights of a dataset: kept, replaced, taken away; and files of which they are damaged. */
#include "btf/dataset/dataset.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_dataset.h"

#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char path[] = "good.btf.h5", made_path[] = "heights.btf.h5", damaged[] = "damaged.btf.h5";
enum { WIDTH = 5, HEIGHT = 4, VIEWS = 3, LIGHTS = 2, PLACES = 4 * WIDTH * HEIGHT };

static weft_dataset_heights example(float value[PLACES])
{
    for (int i = 0; i < PLACES; i++)
        value[i] = 0.01f * (float)(i - 50);
    return (weft_dataset_heights){2 * WIDTH, 2 * HEIGHT, 2, value};
}

static weft_dataset *open_dataset(const char *name)
{
    weft_dataset *dataset;
    weft_error error = {0};
    expect_ok(weft_dataset_open(name, &dataset, &error), &error);
    return dataset;
}

static void heights_are_kept_beside_everything_else(void **state)
{
    (void)state;
    float value[PLACES];
    weft_dataset_heights heights = example(value), read;
    weft_error error = {0};
    expect_ok(weft_dataset_put_relief(path, made_path, -0.25, &heights, "{\"verdict\":\"relief\"}", &error), &error);
    weft_dataset *dataset = open_dataset(made_path), *before = open_dataset(path);
    assert_true(weft_dataset_has_heights(dataset));
    assert_false(weft_dataset_has_heights(before));
    assert_true(weft_dataset_get_layout(dataset)->plane_mm == -0.25);
    assert_true(weft_dataset_get_layout(before)->plane_mm == 0);
    expect_ok(weft_dataset_read_heights(dataset, &read, &error), &error);
    assert_int_equal(read.width, 2 * WIDTH);
    assert_int_equal(read.height, 2 * HEIGHT);
    assert_int_equal(read.level_count, 2);
    assert_memory_equal(read.value, value, sizeof value);
    weft_dataset_heights_free(&read);
    assert_non_null(strstr(weft_dataset_get_layout(dataset)->provenance, "\"relief\":{\"verdict\":\"relief\"}"));
    static weft_half sample[2][3 * WIDTH * HEIGHT * VIEWS * LIGHTS];
    for (int i = 0; i < 2; i++)
        expect_ok(weft_dataset_read_block(i ? before : dataset, 0, 0, WIDTH, HEIGHT, sample[i], NULL, &error), &error);
    assert_memory_equal(sample[0], sample[1], sizeof sample[0]);
    weft_dataset_close(dataset);
    weft_dataset_close(before);
}

static void heights_are_replaced_and_taken_away_in_place(void **state)
{
    (void)state;
    float value[PLACES];
    weft_dataset_heights heights = example(value), read;
    weft_error error = {0};
    expect_ok(weft_dataset_put_relief(path, made_path, 0.125, &heights, "{}", &error), &error);
    value[7] = 0.5f;
    expect_ok(weft_dataset_put_relief(made_path, made_path, 0.375, &heights, "{}", &error), &error);
    weft_dataset *dataset = open_dataset(made_path);
    expect_ok(weft_dataset_read_heights(dataset, &read, &error), &error);
    assert_true(read.value[7] == 0.5f);
    assert_true(weft_dataset_get_layout(dataset)->plane_mm == 0.375);
    weft_dataset_heights_free(&read);
    weft_dataset_close(dataset);
    expect_ok(weft_dataset_put_relief(made_path, made_path, 0, NULL, "{}", &error), &error);
    dataset = open_dataset(made_path);
    assert_false(weft_dataset_has_heights(dataset));
    assert_true(weft_dataset_get_layout(dataset)->plane_mm == 0);
    expect_ok(weft_dataset_read_heights(dataset, &read, &error), &error);
    assert_null(read.value);
    weft_dataset_close(dataset);
}

static void assert_not_put(const weft_dataset_heights *heights, double plane_mm, const char *cause)
{
    weft_error error = {0};
    int entries = scratch_folder_entries();
    assert_int_equal(weft_dataset_put_relief(path, "never.btf.h5", plane_mm, heights, "{}", &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, cause))
        fail_msg("message '%s', expected '%s'", error.message, cause);
    assert_int_equal(scratch_folder_entries(), entries);
}

static void heights_that_are_none_are_not_written(void **state)
{
    (void)state;
    float value[PLACES];
    weft_dataset_heights heights = example(value);
    value[13] = NAN;
    assert_not_put(&heights, 0, "height (3, 1) is nan");
    value[13] = 1e6f;
    assert_not_put(&heights, 0, "height (3, 1) is 1e+06 mm, must be within");
    heights = example(value);
    heights.width--;
    assert_not_put(&heights, 0, "9 x 8 heights");
    heights = example(value);
    heights.level_count = 0;
    assert_not_put(&heights, 0, "height_levels");
    assert_not_put(NULL, NAN, "plane_mm is nan");
}

/* ---- Files made wrong with the HDF5 library ---- */

static hid_t open_copy(void)
{
    float value[PLACES];
    weft_dataset_heights heights = example(value);
    weft_error error = {0};
    expect_ok(weft_dataset_put_relief(path, damaged, 0.125, &heights, "{}", &error), &error);
    return H5Fopen(damaged, H5F_ACC_RDWR, H5P_DEFAULT);
}

static void replace_heights(hid_t file, int rank, const hsize_t *size, float value)
{
    H5Ldelete(file, "height", H5P_DEFAULT);
    hid_t space = H5Screate_simple(rank, size, NULL);
    hid_t object = H5Dcreate2(file, "height", H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    size_t count = (size_t)H5Sget_simple_extent_npoints(space);
    float *values = malloc(count * sizeof *values);
    for (size_t i = 0; i < count; i++)
        values[i] = i == 3 ? value : 0;
    assert_true(H5Dwrite(object, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    free(values);
    H5Dclose(object);
    H5Sclose(space);
    H5Fclose(file);
}

static void put_number(hid_t file, const char *name, double value)
{
    if (H5Aexists(file, name) > 0)
        H5Adelete(file, name);
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Fclose(file);
}

static void assert_refused(const char *cause)
{
    weft_dataset *dataset;
    weft_dataset_heights heights;
    weft_error error = {0};
    weft_code code = weft_dataset_open(damaged, &dataset, &error);
    if (code == WEFT_OK)
        code = weft_dataset_read_heights(dataset, &heights, &error);
    weft_dataset_close(dataset);
    if (code != WEFT_BAD_INPUT || !strstr(error.message, cause) || !strstr(error.message, damaged))
        fail_msg("code %d, message '%s', expected '%s'", code, error.message, cause);
}

static void damaged_heights_are_named(void **state)
{
    (void)state;
    replace_heights(open_copy(), 2, (hsize_t[]){2 * HEIGHT, 2 * WIDTH - 1}, 0);
    assert_refused("9 x 8 heights, must be 1 to 8 times the 5 x 4 texels");
    replace_heights(open_copy(), 2, (hsize_t[]){16 * HEIGHT, 16 * WIDTH}, 0);
    assert_refused("80 x 64 heights");
    replace_heights(open_copy(), 1, (hsize_t[]){PLACES}, 0);
    assert_refused("'height' must be a numeric array of 2 dimensions; it has 1");
    replace_heights(open_copy(), 2, (hsize_t[]){2 * HEIGHT, 2 * WIDTH}, NAN);
    assert_refused("height (3, 0) is nan mm");
    replace_heights(open_copy(), 2, (hsize_t[]){2 * HEIGHT, 2 * WIDTH}, -1e3f);
    assert_refused("height (3, 0) is -1000 mm");
}

static void numbers_out_of_range_are_named(void **state)
{
    (void)state;
    static const double bad_levels[3] = {0, -1, NAN}, bad_aspect[3] = {-1, 1e9, NAN};
    for (int i = 0; i < 3; i++) {
        put_number(open_copy(), "height_levels", bad_levels[i]);
        assert_refused("height_levels is not 1 or more");
        put_number(open_copy(), "texel_aspect", bad_aspect[i]);
        assert_refused("texel_aspect is");
    }
    put_number(open_copy(), "plane_mm", INFINITY);
    assert_refused("plane_mm is inf");
    put_number(open_copy(), "texel_pitch_mm", 1e12);
    assert_refused("texel_pitch_mm is 1e+12");
}

static void the_shape_of_texels_is_kept(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, VIEWS, LIGHTS);
    weft_error error = {0};
    assert_true(weft_dataset_texel_aspect(&layout) == 1);
    layout.texel_aspect = 1.25;
    expect_ok(tiny_dataset_write("oblong.btf.h5", &layout, tiny_smooth, &error), &error);
    weft_dataset *dataset = open_dataset("oblong.btf.h5");
    assert_true(weft_dataset_texel_aspect(weft_dataset_get_layout(dataset)) == 1.25);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
}

static void a_full_disk_leaves_the_file_as_it_was(void **state)
{
    (void)state;
    float value[PLACES];
    weft_dataset_heights heights = example(value);
    weft_error error = {0};
    size_t size, size_after;
    unsigned char *before = scratch_load(path, &size);
    int entries = scratch_folder_entries();
    scratch_limit_file_size(size / 2);
    assert_int_equal(weft_dataset_put_relief(path, path, 0, &heights, "{}", &error), WEFT_SYSTEM);
    scratch_limit_file_size(0);
    assert_non_null(strstr(error.message, path));
    assert_int_equal(scratch_folder_entries(), entries);
    unsigned char *after = scratch_load(path, &size_after);
    assert_int_equal(size, size_after);
    assert_memory_equal(before, after, size);
    free(before);
    free(after);
}

static int enter(void **state)
{
    int code = scratch_folder_enter(state);
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, VIEWS, LIGHTS);
    if (code == 0)
        code = tiny_dataset_write(path, &layout, tiny_distinct, NULL) == WEFT_OK ? 0 : -1;
    weft_dataset_layout_free(&layout);
    return code;
}

int test_dataset_heights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_are_kept_beside_everything_else),
        cmocka_unit_test(heights_are_replaced_and_taken_away_in_place),
        cmocka_unit_test(heights_that_are_none_are_not_written),
        cmocka_unit_test(damaged_heights_are_named),
        cmocka_unit_test(numbers_out_of_range_are_named),
        cmocka_unit_test(the_shape_of_texels_is_kept),
        cmocka_unit_test(a_full_disk_leaves_the_file_as_it_was),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
