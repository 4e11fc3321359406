#include "base/atomic_file.h"
#include "inspect/inspect.h"
#include "tests/compare/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static weft_rgb grey(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y, (void)light, (void)view;
    return (weft_rgb){0.5, 0.5, 0.5};
}

static weft_rgb dark(int x, int y)
{
    (void)x, (void)y;
    return (weft_rgb){0.1, 0.1, 0.1};
}

static long long number_in(const json_t *object, const char *group, const char *name)
{
    return json_integer_value(json_object_get(json_object_get(object, group), name));
}

static void a_dataset_says_what_it_holds_and_what_is_masked(void **state)
{
    (void)state;
    fixture_far_dataset("inspect.btf.h5", 3, 2, 2, grey, FIXTURE_MASK_ONE);
    json_t *description;
    weft_error error = {0};
    expect_ok(weft_verify("inspect.btf.h5", NULL, &description, &error), &error);
    assert_int_equal(json_integer_value(json_object_get(description, "images")), 49);
    assert_int_equal(json_integer_value(json_object_get(description, "views")), 7);
    assert_int_equal(json_integer_value(json_object_get(description, "half_float_bytes")), 6 * 49 * 3 * 2);
    assert_string_equal(json_string_value(json_object_get(json_object_get(description, "provenance"), "source")),
                        "fixture");
    assert_int_equal(number_in(description, "verified", "saturated"), 1);
    assert_int_equal(number_in(description, "verified", "valid_samples"), 6 * 49 - 1);
    json_decref(description);
    unlink("inspect.btf.h5");
}

/* Bits that Weft does not write make a sample invalid all the same, and are counted. */
static void a_mask_of_others_is_taken(void **state)
{
    (void)state;
    const uint8_t mask[2] = {4, 4 + WEFT_MASK_SATURATED};
    const weft_half samples[6] = {0};
    weft_dataset_layout layout = {.width = 2, .height = 1, .image_count = 1, .view_count = 1, .texel_pitch_mm = 1};
    weft_dataset_writer *writer;
    json_t *description;
    weft_error error = {0};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    layout.light[0] = layout.view[0] = weft_vec3_of(0, 0, 1);
    expect_ok(weft_dataset_writer_create("inspect.btf.h5", &layout, &writer, &error), &error);
    expect_ok(weft_dataset_writer_put_image(writer, 0, samples, mask, &error), &error);
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    weft_dataset_layout_free(&layout);
    expect_ok(weft_verify("inspect.btf.h5", NULL, &description, &error), &error);
    assert_int_equal(number_in(description, "verified", "valid_samples"), 0);
    assert_int_equal(number_in(description, "verified", "saturated"), 1);
    assert_int_equal(number_in(description, "verified", "masked_otherwise"), 2);
    json_decref(description);
    unlink("inspect.btf.h5");
}

static void expect_refusal(const char *path)
{
    json_t *description;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_verify(path, NULL, &description, &error)), WEFT_BAD_INPUT);
    assert_null(description);
    assert_non_null(strstr(error.message, path));
}

static void a_cut_dataset_is_refused(void **state)
{
    (void)state;
    fixture_far_dataset("inspect.btf.h5", 8, 8, 2, grey, FIXTURE_MASK_NONE);
    struct stat status;
    assert_int_equal(stat("inspect.btf.h5", &status), 0);
    for (int part = 1; part < 8; part++) {
        assert_int_equal(truncate("inspect.btf.h5", status.st_size - status.st_size * part / 8), 0);
        expect_refusal("inspect.btf.h5");
    }
    unlink("inspect.btf.h5");
}

static void a_material_with_a_flipped_bit_is_refused(void **state)
{
    (void)state;
    fixture_diffuse_material("inspect.weft", 6, 5, dark);
    json_t *description;
    weft_error error = {0};
    expect_ok(weft_verify("inspect.weft", NULL, &description, &error), &error);
    assert_int_equal(json_array_size(json_object_get(description, "levels")), 1);
    json_decref(description);
    char *bytes;
    size_t size;
    expect_ok(weft_read_file("inspect.weft", 1 << 20, &bytes, &size, &error), &error);
    bytes[size - 1] ^= 4;
    expect_ok(weft_write_file("inspect.weft", bytes, size, &error), &error);
    free(bytes);
    expect_refusal("inspect.weft");
    unlink("inspect.weft");
}

/* JSON has no infinity, and 0 dB would be a bad match. */
static void a_perfect_match_has_no_psnr_in_json(void **state)
{
    (void)state;
    json_t *description;
    weft_material material;
    weft_error error = {0};
    const double measured[] = {INFINITY, 40};
    for (int i = 0; i < 2; i++) {
        fixture_diffuse_material("inspect.weft", 6, 5, dark);
        expect_ok(weft_material_read("inspect.weft", &material, &error), &error);
        material.level[0].error.psnr_db = measured[i];
        expect_ok(weft_material_write("inspect.weft", &material, &error), &error);
        weft_material_free(&material);
        expect_ok(weft_inspect("inspect.weft", &description, &error), &error);
        const json_t *psnr = json_object_get(json_array_get(json_object_get(description, "levels"), 0), "psnr_db");
        assert_true(i == 0 ? json_is_null(psnr) : json_real_value(psnr) == 40);
        json_decref(description);
    }
    unlink("inspect.weft");
}

static void a_material_with_infinite_light_is_refused(void **state)
{
    (void)state;
    weft_material material;
    weft_error error = {0};
    expect_ok(weft_material_create(3, 2, 1, 0, 0, 0, &material, &error), &error);
    material.texel_pitch_mm = 1;
    material.level[0].diffuse[4 * 4 + 1] = 0x7c00;
    weft_code written = weft_material_write("inspect.weft", &material, &error);
    weft_material_free(&material);
    if (written == WEFT_OK)
        expect_refusal("inspect.weft");
    unlink("inspect.weft");
}

static void a_missing_file_and_a_strange_name_are_refused(void **state)
{
    (void)state;
    expect_refusal("none.weft");
    expect_ok(weft_write_file("inspect.txt", "x", 1, NULL), &(weft_error){0});
    expect_refusal("inspect.txt");
    unlink("inspect.txt");
}

int test_inspect(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dataset_says_what_it_holds_and_what_is_masked),
        cmocka_unit_test(a_mask_of_others_is_taken),
        cmocka_unit_test(a_cut_dataset_is_refused),
        cmocka_unit_test(a_material_with_a_flipped_bit_is_refused),
        cmocka_unit_test(a_perfect_match_has_no_psnr_in_json),
        cmocka_unit_test(a_material_with_infinite_light_is_refused),
        cmocka_unit_test(a_missing_file_and_a_strange_name_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
