/* The section of heights: what is written is read back, what is wrong is named, and heights move with their texels. */
#include "tests/support/cmocka_all.h"

#include "btf/material/gather.h"
#include "tests/btf/material/heights_example.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME "heights.weft"

enum { WIDTH = 5, HEIGHT = 3 }; /* texels of the example */

static weft_material read_example(void)
{
    weft_error error = {0};
    weft_material material;
    heights_write_example(NAME);
    expect_ok(weft_material_read(NAME, &material, &error), &error);
    return material;
}

static void heights_are_read_back(void **state)
{
    (void)state;
    weft_material material = read_example();
    const weft_material_heights *heights = material.heights;
    assert_non_null(heights);
    assert_int_equal(heights->width, 10);
    assert_int_equal(heights->height, 6);
    assert_int_equal(heights->level_count, 2);
    assert_float_equal(heights->size_mm[0], 2.5, 0);
    assert_float_equal(heights->size_mm[1], 1.5, 0);
    for (int y = 0; y < heights->height; y++)
        for (int x = 0; x < heights->width; x++) {
            assert_int_equal(heights->code[y * heights->width + x], heights_example_code(x, y));
            assert_float_equal(weft_material_height_mm(heights, x, y), -0.75 + heights_example_code(x, y) * 1.25 / 255,
                               1e-6);
        }
    weft_material_free(&material);
}

/* HGHT of the example in memory. */
static uint8_t *take_section(size_t *size)
{
    weft_material material = read_example();
    *size = weft_material_heights_size(material.heights);
    uint8_t *bytes = malloc(*size);
    weft_material_heights_write(material.heights, bytes);
    weft_material_free(&material);
    return bytes;
}

/* A reader of its own finds them. */
static void the_section_is_as_the_document_says(void **state)
{
    (void)state;
    size_t size;
    float low;
    double width_mm;
    uint8_t *section = take_section(&size);
    assert_int_equal(size, 64 + 60);
    assert_int_equal(weft_bytes_u32(section), 10);
    assert_int_equal(weft_bytes_u32(section + 4), 6);
    assert_int_equal(weft_bytes_u32(section + 8), 2);
    memcpy(&width_mm, section + 16, sizeof width_mm);
    memcpy(&low, section + 32, sizeof low);
    assert_float_equal(width_mm, 2.5, 0);
    assert_float_equal(low, -0.75, 0);
    assert_int_equal(section[64 + 13], heights_example_code(3, 1));
    free(section);
}

/* ---- Damage ---- */

/* The section of the example with some bytes at `offset` overwritten. */
static void expect_damage(size_t offset, const void *with, size_t bytes, const char *said)
{
    size_t size;
    const char *fault;
    weft_error error = {0};
    weft_material_heights *heights = NULL;
    uint8_t *section = take_section(&size);
    memcpy(section + offset, with, bytes);
    assert_int_equal(weft_material_heights_read(section, size, &heights, &fault, &error), WEFT_BAD_INPUT);
    assert_null(heights);
    assert_string_equal(fault, said);
    free(section);
}

static void damaged_heights_are_named(void **state)
{
    (void)state;
    const uint32_t none = 0, many = 1u << 31, eleven = 11, seventeen = 17, one = 1;
    const double nan_mm = NAN, no_mm = 0, least_mm = 1e-7;
    const float deep = -6, above = 0.75f, not_a_number = NAN;
    expect_damage(0, &none, 4, "has too few or too many places");
    expect_damage(4, &many, 4, "has too few or too many places");
    expect_damage(0, &eleven, 4, "its size does not fit its counts");
    expect_damage(8, &none, 4, "has heights of no level, or of more than 16");
    expect_damage(8, &seventeen, 4, "has heights of no level, or of more than 16");
    expect_damage(12, &one, 4, "has reserved fields that are not zero");
    expect_damage(40, &one, 4, "has reserved fields that are not zero");
    expect_damage(16, &nan_mm, 8, "holds a size of the material out of range");
    expect_damage(24, &no_mm, 8, "holds a size of the material out of range");
    expect_damage(24, &least_mm, 8, "holds a size of the material out of range");
    expect_damage(32, &deep, 4, "holds heights out of range");
    expect_damage(32, &above, 4, "holds heights out of range");
    expect_damage(36, &not_a_number, 4, "holds heights out of range");
}

static void a_file_with_damaged_heights_is_refused_by_name(void **state)
{
    (void)state;
    size_t size;
    weft_error error = {0};
    weft_material material;
    heights_write_example(NAME);
    unsigned char *bytes = scratch_load(NAME, &size);
    weft_bytes_put_u32(weft_bytes_entry(bytes, weft_bytes_find(bytes, "HGHT", 0)) + ENTRY_LEVEL, 1);
    weft_bytes_repair(bytes, size, false);
    scratch_store(NAME, bytes, size);
    assert_int_equal(weft_class_of(weft_material_read(NAME, &material, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "section HGHT of level 1: the material has no such section"));
    free(bytes);
}

static void heights_that_no_file_holds_are_refused(void **state)
{
    (void)state;
    const double size_mm[2] = {2, 2};
    const float value[2] = {0, NAN}, deep[2] = {-5, 0};
    weft_error error = {0};
    weft_material_heights *heights;
    assert_int_equal(weft_material_heights_create(deep, 2, 1, 1, size_mm, &heights, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_material_heights_create(value, 2, 0, 1, size_mm, &heights, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_material_heights_create(value, 2, 1, 0, size_mm, &heights, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_material_heights_create(value, 2, 1, 1, size_mm, &heights, &error), WEFT_BAD_USAGE);
}

/* ---- Texels that move ---- */

static void heights_lose_a_level_with_the_material(void **state)
{
    (void)state;
    weft_material material = read_example();
    weft_material_drop_finest(&material);
    assert_int_equal(material.heights->level_count, 1);
    assert_float_equal(material.heights->size_mm[0], 2.5, 0);
    weft_material_drop_finest(&material);
    assert_null(material.heights);
    weft_material_free(&material);
}

/* Columns in reverse, two rows of three; the last texel is half of each of two. */
static void heights_move_with_their_texels(void **state)
{
    (void)state;
    enum { ROWS = 2 };
    weft_error error = {0};
    weft_material material = read_example(), moved;
    weft_texel_mix mix[ROWS][WIDTH] = {0};
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < WIDTH; x++)
            mix[y][x] = (weft_texel_mix){{{WIDTH - 1 - x, HEIGHT - 1 - y, 1}}};
    mix[ROWS - 1][WIDTH - 1] = (weft_texel_mix){{{0, 0, 0.5f}, {3, 2, 0.5f}}};
    expect_ok(weft_material_gather(&material, WIDTH, ROWS, mix[0], &moved, &error), &error);
    assert_int_equal(moved.heights->width, 2 * WIDTH);
    assert_int_equal(moved.heights->height, 2 * ROWS);
    assert_float_equal(moved.heights->size_mm[0], 2.5, 0);
    assert_float_equal(moved.heights->size_mm[1], 1, 1e-12);
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 2; x++) {
            /* Texel (1, 0) was (3, 2), and its places keep their sides. */
            float was = weft_material_height_mm(material.heights, 2 * 3 + x, 2 * 2 + y);
            assert_float_equal(weft_material_height_mm(moved.heights, 2 + x, y), was, 0.003);
            float other = weft_material_height_mm(material.heights, x, y);
            assert_float_equal(weft_material_height_mm(moved.heights, 2 * (WIDTH - 1) + x, 2 * (ROWS - 1) + y),
                               (was + other) / 2, 0.003);
        }
    weft_material_free(&moved);
    weft_material_free(&material);
}

static void a_plane_stays_a_plane(void **state)
{
    (void)state;
    const double size_mm[2] = {2.5, 1.5};
    const float plane_mm = -0.25f;
    weft_error error = {0};
    weft_material material = read_example(), moved;
    weft_material_heights *plane;
    weft_texel_mix mix[1][2] = {{{{{4, 1, 1}}}, {{{3, 1, 1}}}}};
    expect_ok(weft_material_heights_create(&plane_mm, 1, 1, 1, size_mm, &plane, &error), &error);
    weft_material_take_heights(&material, plane);
    expect_ok(weft_material_gather(&material, 2, 1, mix[0], &moved, &error), &error);
    assert_int_equal(moved.heights->width * moved.heights->height, 1);
    assert_float_equal(weft_material_height_mm(moved.heights, 0, 0), -0.25, 0);
    assert_float_equal(moved.heights->size_mm[0], 1, 1e-12);
    assert_float_equal(moved.heights->size_mm[1], 0.5, 1e-12);
    weft_material_free(&moved);
    weft_material_free(&material);
}

int test_material_heights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_are_read_back),
        cmocka_unit_test(the_section_is_as_the_document_says),
        cmocka_unit_test(damaged_heights_are_named),
        cmocka_unit_test(a_file_with_damaged_heights_is_refused_by_name),
        cmocka_unit_test(heights_that_no_file_holds_are_refused),
        cmocka_unit_test(heights_lose_a_level_with_the_material),
        cmocka_unit_test(heights_move_with_their_texels),
        cmocka_unit_test(a_plane_stays_a_plane),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
