/* The section of what a scene reaches: what is written is read back, what is wrong is named, and other readers skip it.
 */
#include "tests/support/cmocka_all.h"

#include "tests/btf/material/seen_example.h"
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
    seen_write_example(NAME);
    expect_ok(weft_material_read(NAME, &material, &error), &error);
    return material;
}

static void maps_are_read_back(void **state)
{
    (void)state;
    weft_material material = read_example();
    const weft_seen *seen = material.seen;
    assert_non_null(seen);
    assert_int_equal(seen->side, SEEN_EXAMPLE_SIDE);
    assert_int_equal(seen->level_count, material.level_count);
    assert_int_equal(seen->finer_levels, 2);
    assert_int_equal(seen->coarser_levels, 1);
    for (int i = 0; i < (2 + seen->level_count) * SEEN_EXAMPLE_SIDE * SEEN_EXAMPLE_SIDE; i++)
        assert_int_equal(seen->cell[i], seen_example_cell(i));
    weft_material_free(&material);
}

/* Straight up is the middle of the square, x = 1 its right side. */
static void directions_and_places_find_their_cells(void **state)
{
    (void)state;
    weft_seen *seen;
    weft_error error = {0};
    expect_ok(weft_seen_create(4, 2, &seen, &error), &error);
    weft_seen_cells(seen, WEFT_SEEN_VIEWS)[4 * 2 + 2] = 1;
    weft_seen_cells(seen, WEFT_SEEN_LIGHTS)[4 * 2 + 3] = 1;
    weft_seen_cells(seen, WEFT_SEEN_PLACES)[1] = weft_seen_cells(seen, WEFT_SEEN_PLACES + 1)[1] = 1;
    assert_true(weft_seen_direction(seen, WEFT_SEEN_VIEWS, weft_vec3_of(0.01, 0.01, 1)));
    assert_false(weft_seen_direction(seen, WEFT_SEEN_LIGHTS, weft_vec3_of(0.01, 0.01, 1)));
    assert_true(weft_seen_direction(seen, WEFT_SEEN_LIGHTS, weft_unit(weft_vec3_of(1, 0.05, 0.1))));
    assert_true(weft_seen_place(seen, 0.5, 3.3, 0.9));
    assert_false(weft_seen_place(seen, 0.5, 3.3, 0.6));
    assert_true(weft_seen_place(seen, -3, 0.3, -0.1));
    assert_true(weft_seen_place(seen, 7, 0.3, 0.9));
    seen->finer_levels = 1;
    assert_false(weft_seen_place(seen, -3, 0.3, 0.9));
    assert_true(weft_seen_place(seen, 7, 0.3, 0.9));
    seen->coarser_levels = 1;
    assert_false(weft_seen_place(seen, 7, 0.3, 0.9));
    weft_seen_drop_finest(seen);
    assert_int_equal(seen->level_count, 1);
    assert_int_equal(seen->finer_levels, 2);
    weft_seen_free(seen);
}

/* A reader from before there was pruning plays the material. */
static void maps_can_be_skipped(void **state)
{
    (void)state;
    size_t size;
    seen_write_example(NAME);
    unsigned char *bytes = scratch_load(NAME, &size);
    memcpy(weft_bytes_entry(bytes, weft_bytes_find(bytes, "SEEN", 0)) + ENTRY_TYPE, "XYZ ", 4);
    weft_bytes_repair(bytes, size, false);
    scratch_store(NAME, bytes, size);
    free(bytes);
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_read(NAME, &material, &error), &error);
    assert_null(material.seen);
    weft_material_free(&material);
}

/* ---- Damage ---- */

static const char *fault_of(size_t offset, uint8_t with, size_t shorter)
{
    weft_material material = read_example();
    size_t size = weft_seen_size(material.seen);
    const char *fault;
    weft_seen *seen = NULL;
    uint8_t *bytes = calloc(1, size);
    weft_seen_write(material.seen, bytes);
    bytes[offset] = with;
    weft_code code = weft_seen_read(bytes, size - shorter, material.level_count, &seen, &fault, NULL);
    assert_int_equal(code, fault ? WEFT_BAD_INPUT : WEFT_OK);
    weft_seen_free(seen);
    free(bytes);
    weft_material_free(&material);
    return fault;
}

static void damage_is_named(void **state)
{
    (void)state;
    assert_null(fault_of(0, SEEN_EXAMPLE_SIDE, 0));
    assert_non_null(strstr(fault_of(0, 3, 0), "4 to 128"));
    assert_non_null(strstr(fault_of(1, 1, 0), "4 to 128"));
    assert_non_null(strstr(fault_of(4, 1, 0), "levels of the material"));
    assert_non_null(strstr(fault_of(8, 17, 0), "more levels are missing"));
    assert_non_null(strstr(fault_of(16, 1, 0), "reserved"));
    assert_non_null(strstr(fault_of(32, 2, 0), "neither 0 nor 1"));
    assert_non_null(strstr(fault_of(0, SEEN_EXAMPLE_SIDE, 1), "size"));
    assert_non_null(strstr(fault_of(0, SEEN_EXAMPLE_SIDE + 1, 0), "size"));
}

int test_material_seen(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_read_back),
        cmocka_unit_test(directions_and_places_find_their_cells),
        cmocka_unit_test(maps_can_be_skipped),
        cmocka_unit_test(damage_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
