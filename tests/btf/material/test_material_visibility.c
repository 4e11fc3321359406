/* The section of what a scene reaches: what is written is read back, and what is wrong is named. */
#include "tests/support/cmocka_all.h"

#include "tests/btf/material/visibility_example.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>
#include <string.h>

#define NAME "seen.weft"

static weft_material read_example(void)
{
    weft_error error = {0};
    weft_material material;
    visibility_write_example(NAME);
    expect_ok(weft_material_read(NAME, &material, &error), &error);
    return material;
}

static void maps_are_read_back(void **state)
{
    (void)state;
    weft_material material = read_example();
    const weft_material_visibility *visibility = material.visibility;
    assert_non_null(visibility);
    assert_int_equal(visibility->side, VISIBILITY_EXAMPLE_SIDE);
    assert_int_equal(visibility->level_count, material.level_count);
    assert_int_equal(visibility->finer_levels, 2);
    assert_int_equal(visibility->coarser_levels, 1);
    for (int i = 0; i < (2 + visibility->level_count) * VISIBILITY_EXAMPLE_SIDE * VISIBILITY_EXAMPLE_SIDE; i++)
        assert_int_equal(visibility->cell[i], visibility_example_cell(i));
    weft_material_free(&material);
}

/* Straight up is the middle of the square, x = 1 its right side. */
static void directions_and_places_find_their_cells(void **state)
{
    (void)state;
    weft_material_visibility *visibility;
    weft_error error = {0};
    expect_ok(weft_material_visibility_create(4, 2, &visibility, &error), &error);
    weft_material_visibility_cells(visibility, WEFT_MATERIAL_VISIBILITY_VIEWS)[4 * 2 + 2] = 1;
    weft_material_visibility_cells(visibility, WEFT_MATERIAL_VISIBILITY_LIGHTS)[4 * 2 + 3] = 1;
    weft_material_visibility_cells(visibility, WEFT_MATERIAL_VISIBILITY_PLACES)[1] =
        weft_material_visibility_cells(visibility, WEFT_MATERIAL_VISIBILITY_PLACES + 1)[1] = 1;
    assert_true(
        weft_material_visibility_direction(visibility, WEFT_MATERIAL_VISIBILITY_VIEWS, weft_vec3_of(0.01, 0.01, 1)));
    assert_false(
        weft_material_visibility_direction(visibility, WEFT_MATERIAL_VISIBILITY_LIGHTS, weft_vec3_of(0.01, 0.01, 1)));
    assert_true(weft_material_visibility_direction(visibility, WEFT_MATERIAL_VISIBILITY_LIGHTS,
                                                   weft_unit(weft_vec3_of(1, 0.05, 0.1))));
    assert_true(weft_material_visibility_place(visibility, 0.5, 3.3, 0.9));
    assert_false(weft_material_visibility_place(visibility, 0.5, 3.3, 0.6));
    assert_true(weft_material_visibility_place(visibility, -3, 0.3, -0.1));
    assert_true(weft_material_visibility_place(visibility, 7, 0.3, 0.9));
    visibility->finer_levels = 1;
    assert_false(weft_material_visibility_place(visibility, -3, 0.3, 0.9));
    assert_true(weft_material_visibility_place(visibility, 7, 0.3, 0.9));
    visibility->coarser_levels = 1;
    assert_false(weft_material_visibility_place(visibility, 7, 0.3, 0.9));
    weft_material_visibility_drop_finest(visibility);
    assert_int_equal(visibility->level_count, 1);
    assert_int_equal(visibility->finer_levels, 2);
    weft_material_visibility_free(visibility);
}

/* ---- Damage ---- */

static const char *fault_of(size_t offset, uint8_t with, size_t shorter)
{
    weft_material material = read_example();
    size_t size = weft_material_visibility_size(material.visibility);
    const char *fault;
    weft_material_visibility *visibility = NULL;
    uint8_t *bytes = calloc(1, size);
    weft_material_visibility_write(material.visibility, bytes);
    bytes[offset] = with;
    weft_code code =
        weft_material_visibility_read(bytes, size - shorter, material.level_count, &visibility, &fault, NULL);
    assert_int_equal(code, fault ? WEFT_BAD_INPUT : WEFT_OK);
    weft_material_visibility_free(visibility);
    free(bytes);
    weft_material_free(&material);
    return fault;
}

static void damage_is_named(void **state)
{
    (void)state;
    assert_null(fault_of(0, VISIBILITY_EXAMPLE_SIDE, 0));
    assert_non_null(strstr(fault_of(0, 3, 0), "4 to 128"));
    assert_non_null(strstr(fault_of(1, 1, 0), "4 to 128"));
    assert_non_null(strstr(fault_of(4, 1, 0), "levels of the material"));
    assert_non_null(strstr(fault_of(8, 17, 0), "more levels are missing"));
    assert_non_null(strstr(fault_of(16, 1, 0), "reserved"));
    assert_non_null(strstr(fault_of(32, 2, 0), "neither 0 nor 1"));
    assert_non_null(strstr(fault_of(0, VISIBILITY_EXAMPLE_SIDE, 1), "size"));
    assert_non_null(strstr(fault_of(0, VISIBILITY_EXAMPLE_SIDE + 1, 0), "size"));
}

int test_material_visibility(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_read_back),
        cmocka_unit_test(directions_and_places_find_their_cells),
        cmocka_unit_test(damage_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
