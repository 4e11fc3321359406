/* Datasets that cannot be used, and disks that cannot hold them. */
#include "btf/dataset/dataset.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_dataset.h"

#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char path[] = "good.btf.h5", damaged[] = "damaged.btf.h5";
enum { WIDTH = 5, HEIGHT = 4, VIEWS = 3, LIGHTS = 2, IMAGES = VIEWS * LIGHTS };

/* Which code a message goes with. */
static weft_code code_of_message(const char *message)
{
    if (strstr(message, "No such file"))
        return WEFT_MISSING;
    if (strstr(message, "' version "))
        return WEFT_NOT_SUPPORTED;
    return strstr(message, "as HDF5") ? WEFT_DAMAGED : WEFT_BAD_INPUT;
}

static void assert_refused(const char *name, const char *cause)
{
    weft_dataset *dataset;
    weft_error error = {0};
    weft_code code = weft_dataset_open(name, &dataset, &error);
    assert_null(dataset);
    if (code != code_of_message(error.message) || !strstr(error.message, name) || !strstr(error.message, cause))
        fail_msg("code %d, message '%s', expected '%s'", code, error.message, cause);
}

static void missing_foreign_and_empty_files_are_refused(void **state)
{
    (void)state;
    assert_refused("absent.btf.h5", "No such file");
    assert_refused(".", "not a regular file");
    scratch_store(damaged, "", 0);
    assert_refused(damaged, "as HDF5 (0 bytes)");
    scratch_store(damaged, "P6 this is a picture", 20);
    assert_refused(damaged, "as HDF5");
}

static void a_truncated_file_is_refused_at_any_length(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    for (size_t cut = 0; cut < size; cut += cut < 1024 ? 1 : 97) {
        scratch_store(damaged, bytes, cut);
        assert_refused(damaged, "as HDF5");
    }
    scratch_store(damaged, bytes, size - 1);
    assert_refused(damaged, "as HDF5");
    free(bytes);
}

/* ---- Files made wrong with the HDF5 library ---- */

static hid_t open_copy(void)
{
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    scratch_store(damaged, bytes, size);
    free(bytes);
    return H5Fopen(damaged, H5F_ACC_RDWR, H5P_DEFAULT);
}

static void put_text_attribute(hid_t file, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text) + 1);
    H5Adelete(file, name);
    hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, type, text) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}

static void put_number_attribute(hid_t file, const char *name, double value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    H5Adelete(file, name);
    hid_t attribute = H5Acreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
}

/* Replaces a dataset by zeros of another shape. */
static void put_shape(hid_t file, const char *name, int rank, const hsize_t *size)
{
    H5Ldelete(file, name, H5P_DEFAULT);
    hid_t space = H5Screate_simple(rank, size, NULL);
    hid_t object = H5Dcreate2(file, name, H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(object >= 0);
    H5Dclose(object);
    H5Sclose(space);
}

/* Sets element [at[0]][at[1]]... of a dataset. */
static void put_value(hid_t file, const char *name, int rank, const hsize_t *at, double value)
{
    static const hsize_t one[4] = {1, 1, 1, 1};
    hid_t object = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(object);
    hid_t memory = H5Screate_simple(rank, one, NULL);
    assert_true(H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, one, NULL) >= 0);
    assert_true(H5Dwrite(object, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value) >= 0);
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(object);
}

typedef struct text_edit {
    const char *name, *text, *cause;
} text_edit;

static void wrong_attributes_are_named(void **state)
{
    (void)state;
    static const text_edit edit[] = {{"format", "other", "format 'other'"},
                                     {"values", "radiance", "is 'radiance', must be"},
                                     {"distance", "", "is '', must be"},
                                     {"version", "1", "attribute 'version' is not one number"}};
    for (size_t i = 0; i < sizeof edit / sizeof edit[0]; i++) {
        hid_t file = open_copy();
        put_text_attribute(file, edit[i].name, edit[i].text);
        H5Fclose(file);
        assert_refused(damaged, edit[i].cause);
    }
    static const double pitch[3] = {0, -1, NAN};
    for (int i = 0; i < 3; i++) {
        hid_t file = open_copy();
        put_number_attribute(file, "texel_pitch_mm", pitch[i]);
        H5Fclose(file);
        assert_refused(damaged, "texel_pitch_mm is");
    }
    hid_t file = open_copy();
    put_number_attribute(file, "version", 2);
    H5Fclose(file);
    assert_refused(damaged, "version 2");
}

static void absent_parts_are_named(void **state)
{
    (void)state;
    static const char *const dataset[6] = {"samples", "mask", "light", "view", "view_of_image", "provenance"};
    static const char *const attribute[5] = {"format", "version", "values", "distance", "texel_pitch_mm"};
    for (int i = 0; i < 11; i++) {
        const char *name = i < 6 ? dataset[i] : attribute[i - 6];
        hid_t file = open_copy();
        assert_true((i < 6 ? H5Ldelete(file, name, H5P_DEFAULT) : H5Adelete(file, name)) >= 0);
        H5Fclose(file);
        assert_refused(damaged, name);
    }
}

typedef struct shape_edit {
    const char *name;
    int rank;
    hsize_t size[4];
    const char *cause;
} shape_edit;

static void shapes_that_disagree_are_refused(void **state)
{
    (void)state;
    static const shape_edit edit[] = {
        {"samples", 3, {HEIGHT, WIDTH, IMAGES}, "4 dimensions; it has 3"},
        {"samples", 4, {HEIGHT, WIDTH, IMAGES, 4}, "dimension 3 of 'samples' is 4"},
        {"samples", 4, {HEIGHT, WIDTH + 1, IMAGES, 3}, "dimension 1 of 'mask' is 5, must be 6"},
        {"samples", 4, {0, WIDTH, IMAGES, 3}, "'mask'"},
        {"mask", 3, {HEIGHT, WIDTH, IMAGES - 1}, "dimension 2 of 'mask'"},
        {"light", 2, {IMAGES, 2}, "dimension 1 of 'light'"},
        {"light", 2, {IMAGES + 1, 3}, "dimension 0 of 'light'"},
        {"view", 1, {VIEWS}, "'view' must be a numeric array of 2 dimensions"},
        {"view", 2, {VIEWS, 4}, "'view'"},
        {"view_of_image", 1, {IMAGES - 1}, "'view_of_image'"},
        {"opacity", 3, {HEIGHT, WIDTH, VIEWS + 1}, "'opacity'"},
        {"frame", 4, {HEIGHT, WIDTH, 3, 3}, "dimension 2 of 'frame' is 3, must be 2"},
        {"weight", 1, {IMAGES - 1}, "dimension 0 of 'weight' is 5, must be 6"},
        {"light_standard_error_deg", 2, {IMAGES, 1}, "must be a numeric array of 1 dimensions; it has 2"},
        {"view", 2, {1 << 24, 3}, "too few for"},
    };
    for (size_t i = 0; i < sizeof edit / sizeof edit[0]; i++) {
        hid_t file = open_copy();
        put_shape(file, edit[i].name, edit[i].rank, edit[i].size);
        H5Fclose(file);
        assert_refused(damaged, edit[i].cause);
    }
}

/* Sizes that are no more than claims: nothing of the kind is in the file. */
static void a_size_that_the_file_cannot_hold_is_refused(void **state)
{
    (void)state;
    const hsize_t samples[4] = {60000, 60000, 1 << 20, 3}, mask[3] = {60000, 60000, 1 << 20};
    hid_t file = open_copy();
    put_shape(file, "samples", 4, samples);
    put_shape(file, "mask", 3, mask);
    H5Fclose(file);
    assert_refused(damaged, "too few for 60000 x 60000 texels");
    file = open_copy();
    put_shape(file, "samples", 4, (hsize_t[]){70000, 1, 1, 3});
    put_shape(file, "mask", 3, (hsize_t[]){70000, 1, 1});
    H5Fclose(file);
    assert_refused(damaged, "height is 70000");
}

typedef struct value_edit {
    const char *name;
    int rank;
    hsize_t at[2];
    double value;
    const char *cause;
} value_edit;

static void directions_and_indices_out_of_range_are_named(void **state)
{
    (void)state;
    static const value_edit edit[] = {{"light", 2, {5, 0}, NAN, "light 5"},
                                      {"light", 2, {1, 2}, 2, "light 1"},
                                      {"light", 2, {0, 2}, -1, "light 0"},
                                      {"view", 2, {2, 1}, INFINITY, "view 2"},
                                      {"view_of_image", 1, {4}, 3, "image 4 has view 3 of 3"},
                                      {"view_of_image", 1, {4}, -1, "image 4 has view -1"}};
    for (size_t i = 0; i < sizeof edit / sizeof edit[0]; i++) {
        hid_t file = open_copy();
        put_value(file, edit[i].name, edit[i].rank, edit[i].at, edit[i].value);
        H5Fclose(file);
        assert_refused(damaged, edit[i].cause);
    }
}

static void put_figure(hid_t file, const char *name, const double value[IMAGES])
{
    const hsize_t size = IMAGES;
    hid_t space = H5Screate_simple(1, &size, NULL);
    hid_t object = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(object, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Dclose(object);
    H5Sclose(space);
}

static void figures_of_images_that_are_none_are_named(void **state)
{
    (void)state;
    static const char *const name[WEFT_IMAGE_FIGURES] = {"weight", "view_standard_error_deg",
                                                         "light_standard_error_deg", "value_relative_standard_error"};
    static const double wrong[3] = {NAN, -1, INFINITY};
    for (int i = 0; i < 3 * WEFT_IMAGE_FIGURES; i++) {
        double value[IMAGES] = {1, 1, wrong[i % 3], 1, 1, 1};
        char cause[96];
        hid_t file = open_copy();
        put_figure(file, name[i / 3], value);
        H5Fclose(file);
        snprintf(cause, sizeof cause, "%s of image 2 is", name[i / 3]);
        assert_refused(damaged, cause);
    }
    hid_t file = open_copy();
    put_figure(file, "weight", (double[IMAGES]){0});
    H5Fclose(file);
    assert_refused(damaged, "the weight of every image is 0");
}

static void a_valid_sample_that_is_not_finite_is_named_and_a_masked_one_cleared(void **state)
{
    (void)state;
    static const double bad[3] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        hid_t file = open_copy();
        put_value(file, "samples", 4, (hsize_t[]){2, 3, 4, 1}, bad[i]);
        put_value(file, "mask", 3, (hsize_t[]){2, 3, 4}, 0);
        put_value(file, "samples", 4, (hsize_t[]){1, 0, 5, 2}, bad[i]);
        put_value(file, "mask", 3, (hsize_t[]){1, 0, 5}, 4);
        H5Fclose(file);
        weft_dataset *dataset;
        weft_error error = {0};
        assert_int_equal(weft_dataset_open(damaged, &dataset, NULL), WEFT_OK);
        weft_half samples[WIDTH * HEIGHT * IMAGES * 3];
        uint8_t mask[WIDTH * HEIGHT * IMAGES];
        assert_int_equal(weft_dataset_read_block(dataset, 0, 0, WIDTH, HEIGHT, samples, mask, &error), WEFT_BAD_INPUT);
        assert_non_null(strstr(error.message, damaged));
        assert_non_null(strstr(error.message, "texel (3, 2), image 4"));
        assert_int_equal(weft_dataset_read_block(dataset, 1, 2, WIDTH - 1, 1, samples, NULL, &error), WEFT_BAD_INPUT);
        assert_int_equal(weft_dataset_read_block(dataset, 0, 0, WIDTH, 2, samples, NULL, &error), WEFT_OK);
        assert_int_equal(samples[(WIDTH * IMAGES + 5) * 3 + 2], 0);
        weft_dataset_close(dataset);
    }
}

static void opacity_out_of_range_is_refused(void **state)
{
    (void)state;
    hid_t file = open_copy();
    put_shape(file, "opacity", 3, (hsize_t[]){HEIGHT, WIDTH, VIEWS});
    put_value(file, "opacity", 3, (hsize_t[]){1, 1, 1}, 2);
    H5Fclose(file);
    weft_dataset *dataset;
    weft_error error = {0};
    float opacity[WIDTH * HEIGHT * VIEWS];
    assert_int_equal(weft_dataset_open(damaged, &dataset, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_read_opacity(dataset, 0, HEIGHT, opacity, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "row 1"));
    weft_dataset_close(dataset);
}

static void frames_that_are_none_are_refused(void **state)
{
    (void)state;
    /* Zeros but for the one value. */
    hid_t file = open_copy();
    put_shape(file, "frame", 4, (hsize_t[]){HEIGHT, WIDTH, 2, 3});
    put_value(file, "frame", 4, (hsize_t[]){0, 0, 0, 2}, 1);
    H5Fclose(file);
    weft_dataset *dataset;
    weft_error error = {0};
    float frames[WIDTH * HEIGHT * 6];
    assert_int_equal(weft_dataset_open(damaged, &dataset, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_read_frames(dataset, 0, HEIGHT, frames, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "damaged.btf.h5': frame of texel (0, 0)"));
    assert_int_equal(weft_dataset_read_frames(dataset, 2, 1, frames, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "frame of texel (0, 2)"));
    weft_dataset_close(dataset);
}

/* ---- Writing ---- */

static void impossible_layouts_are_refused_and_leave_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        weft_dataset_layout layout = tiny_layout(2, 2, 2, 2);
        layout.width = i == 0 ? 0 : 2;
        layout.height = i == 1 ? 65537 : 2;
        layout.texel_pitch_mm = i == 2 ? NAN : 1;
        layout.view_of_image[3] = i == 3 ? 2 : 1;
        layout.light[2].x += i == 4 ? 0.1 : 0;
        layout.view[1].z = i == 5 ? -0.5 : layout.view[1].z;
        layout.distance = i == 6 ? WEFT_NEAR : WEFT_FAR;
        layout.light[0].z = i == 6 ? 0 : layout.light[0].z;
        if (i == 7)
            strcpy(layout.provenance, "7");
        int entries = scratch_folder_entries();
        weft_dataset_writer *writer;
        weft_error error = {0};
        assert_int_equal(weft_dataset_writer_create("new.btf.h5", &layout, &writer, &error), WEFT_BAD_INPUT);
        assert_non_null(strstr(error.message, "new.btf.h5"));
        assert_null(writer);
        assert_int_equal(scratch_folder_entries(), entries);
        weft_dataset_layout_free(&layout);
    }
}

static void bad_images_are_refused(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(2, 1, 1, 1);
    weft_dataset_writer *writer;
    weft_error error = {0};
    assert_int_equal(weft_dataset_writer_create("new.btf.h5", &layout, &writer, NULL), WEFT_OK);
    weft_half samples[6] = {0, 0, 0, 0, 0x7e00, 0};
    const uint8_t mask[2] = {0, WEFT_MASK_SATURATED};
    assert_int_equal(weft_dataset_writer_put_image(writer, 0, samples, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "image 0, texel (1, 0)"));
    assert_int_equal(weft_dataset_writer_put_image(writer, 0, samples, mask, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_image(writer, 1, samples, mask, NULL), WEFT_BAD_USAGE);
    const float opacity[2] = {0, 1.5f};
    assert_int_equal(weft_dataset_writer_put_opacity(writer, opacity, NULL), WEFT_BAD_INPUT);
    const float sunken[12] = {0, 0, 1, 1, 0, 0, 0, 0, -1, 1, 0, 0}, skew[12] = {0, 0, 1, 0, 0.1f, 1, 0, 0, 1, 1, 0, 0};
    assert_int_equal(weft_dataset_writer_put_frames(writer, sunken, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "frame of texel (1, 0)"));
    assert_int_equal(weft_dataset_writer_put_frames(writer, skew, NULL), WEFT_BAD_INPUT);
    assert_int_equal(weft_dataset_writer_finish(writer, "not JSON", NULL), WEFT_BAD_USAGE);
    assert_int_equal(access("new.btf.h5", F_OK), -1);
    weft_dataset_layout_free(&layout);
}

/* At every size the limit strikes somewhere else: scratch file, empty dataset, samples, masks, provenance. */
static void a_full_disk_is_an_error_and_leaves_the_old_file_as_it_was(void **state)
{
    (void)state;
    size_t size, after_size;
    unsigned char *before = scratch_load(path, &size);
    weft_dataset_layout layout = tiny_layout(16, 16, 3, 9);
    int entries = scratch_folder_entries(), failures = 0;
    weft_error error = {0};
    for (size_t limit = 500; limit < 100000; limit += 1500) {
        scratch_limit_file_size(limit);
        weft_code code = tiny_dataset_write(path, &layout, tiny_distinct, &error);
        scratch_limit_file_size(0);
        assert_int_equal(scratch_folder_entries(), entries);
        if (code == WEFT_OK)
            break;
        assert_int_equal(code, WEFT_SYSTEM);
        assert_non_null(strstr(error.message, path));
        unsigned char *after = scratch_load(path, &after_size);
        assert_int_equal(after_size, size);
        assert_memory_equal(after, before, size);
        free(after);
        failures++;
    }
    assert_true(failures > 30);
    weft_dataset *dataset;
    assert_int_equal(weft_dataset_open(path, &dataset, &error), WEFT_OK);
    assert_int_equal(weft_dataset_get_layout(dataset)->width, 16);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    free(before);
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

int test_dataset_damage(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_foreign_and_empty_files_are_refused),
        cmocka_unit_test(a_truncated_file_is_refused_at_any_length),
        cmocka_unit_test(wrong_attributes_are_named),
        cmocka_unit_test(absent_parts_are_named),
        cmocka_unit_test(shapes_that_disagree_are_refused),
        cmocka_unit_test(a_size_that_the_file_cannot_hold_is_refused),
        cmocka_unit_test(directions_and_indices_out_of_range_are_named),
        cmocka_unit_test(figures_of_images_that_are_none_are_named),
        cmocka_unit_test(a_valid_sample_that_is_not_finite_is_named_and_a_masked_one_cleared),
        cmocka_unit_test(opacity_out_of_range_is_refused),
        cmocka_unit_test(frames_that_are_none_are_refused),
        cmocka_unit_test(impossible_layouts_are_refused_and_leave_nothing),
        cmocka_unit_test(bad_images_are_refused),
        cmocka_unit_test(a_full_disk_is_an_error_and_leaves_the_old_file_as_it_was),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
