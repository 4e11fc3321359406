/* Tables stored by components: their decoding, and files that hold them. */
#include "btf/direction/direction.h"
#include "btf/material/material.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 5, HEIGHT = 3, VIEWS = 4, LIGHTS = 3, COMPONENTS = 2 };

static const char path[] = "bases.weft";

static void codes_are_the_mean_and_multiples_of_the_components(void **state)
{
    (void)state;
    weft_table_basis *basis;
    uint8_t table[2 * 1 * 4] = {0, 0, 0, 77, 0, 0, 0, 78};
    assert_int_equal(weft_table_basis_create(1, 2, 1, &basis, NULL), WEFT_OK);
    basis->mean[0] = 100 * WEFT_BASIS_MEAN_UNIT;
    basis->mean[1] = 10 * WEFT_BASIS_MEAN_UNIT;
    basis->component[0] = WEFT_BASIS_COMPONENT_UNIT;
    basis->component[1] = -WEFT_BASIS_COMPONENT_UNIT / 2;
    basis->coefficient[0] = 20;
    basis->coefficient[1] = -20;
    basis->coefficient[2] = 127;
    weft_table_basis_decode(basis, table);
    const uint8_t expected[2 * 4] = {120, 80, 227, 77, 0, 20, 0, 78};
    assert_memory_equal(table, expected, sizeof table);
    weft_table_basis_free(basis);
}

static void the_size_tells_the_number_of_components(void **state)
{
    (void)state;
    for (int components = 1; components <= WEFT_BASIS_MAX_COMPONENTS; components++) {
        uint64_t size = weft_table_basis_size(components, 81, 1000);
        assert_int_equal(weft_table_basis_components(size, 81, 1000), components);
        assert_int_equal(weft_table_basis_components(size + 1, 81, 1000), 0);
    }
    assert_int_equal(weft_table_basis_components(0, 81, 1000), 0);
    assert_int_equal(weft_table_basis_components(2 * 81, 81, 1000), 0);
    assert_int_equal(weft_table_basis_components(weft_table_basis_size(65, 81, 1000), 81, 1000), 0);
}

static weft_table_basis *random_basis(int directions, size_t texels)
{
    weft_table_basis *basis;
    assert_int_equal(weft_table_basis_create(COMPONENTS, directions, texels, &basis, NULL), WEFT_OK);
    for (size_t i = 0; i < basis->size; i++)
        basis->bytes[i] = (uint8_t)rand();
    for (int d = 0; d < directions; d++)
        basis->mean[d] = (int16_t)(rand() % (255 * WEFT_BASIS_MEAN_UNIT));
    return basis;
}

static weft_material material_of_bases(bool holes)
{
    weft_material material;
    assert_int_equal(weft_material_create(WIDTH, HEIGHT, 1, VIEWS, LIGHTS, 1, &material, NULL), WEFT_OK);
    for (int i = 0; i < VIEWS; i++)
        material.view[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    for (int i = 0; i < LIGHTS; i++)
        material.light[i] = weft_direction_of_angles(weft_ubo81_angles(i + 1));
    srand(5);
    for (int k = 0; k < material.level_count; k++) {
        weft_material_level *level = &material.level[k];
        size_t texels = (size_t)level->width * (size_t)level->height;
        level->table_basis = random_basis(VIEWS, texels);
        level->light_table_basis = random_basis(LIGHTS, texels);
        memset(level->table, 255, texels * VIEWS * 4);
        memset(level->light_table, 255, texels * LIGHTS * 4);
        for (size_t i = 0; holes && i < texels * VIEWS; i++)
            level->table[4 * i + 3] = (uint8_t)(i * 31);
        weft_table_basis_decode(level->table_basis, level->table);
        weft_table_basis_decode(level->light_table_basis, level->light_table);
    }
    material.has_table_bases = true;
    material.has_opacity = weft_material_has_holes(&material);
    return material;
}

static void check_round_trip(bool holes)
{
    weft_material written = material_of_bases(holes), read;
    weft_error error = {0};
    uint64_t size;
    assert_int_equal(weft_material_write(path, &written, NULL), WEFT_OK);
    assert_int_equal(weft_material_size(&written, &size, NULL), WEFT_OK);
    if (weft_material_read(path, &read, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_true(read.has_table_bases);
    assert_int_equal(read.has_opacity, holes);
    for (int k = 0; k < read.level_count; k++) {
        const weft_material_level *a = &written.level[k], *b = &read.level[k];
        size_t texels = (size_t)a->width * (size_t)a->height;
        assert_memory_equal(a->table, b->table, texels * VIEWS * 4);
        assert_memory_equal(a->light_table, b->light_table, texels * LIGHTS * 4);
        assert_memory_equal(a->table_basis->bytes, b->table_basis->bytes, a->table_basis->size);
    }
    weft_material_free(&written);
    weft_material_free(&read);
}

static void materials_with_bases_read_back_as_written(void **state)
{
    (void)state;
    check_round_trip(false);
    check_round_trip(true);
    remove(path);
}

static unsigned char *read_bytes(size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    unsigned char *bytes = malloc(1 << 16);
    *size = fread(bytes, 1, 1 << 16, file);
    fclose(file);
    return bytes;
}

static weft_code try_bytes(const unsigned char *bytes, size_t size, weft_error *error)
{
    weft_material material;
    FILE *file = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    weft_code code = weft_material_read(path, &material, error);
    if (code == WEFT_OK)
        weft_material_free(&material);
    return code;
}

static void spoilt_files_are_refused_or_read_but_never_believed_blindly(void **state)
{
    (void)state;
    size_t size;
    weft_material material = material_of_bases(true);
    assert_int_equal(weft_material_write(path, &material, NULL), WEFT_OK);
    weft_material_free(&material);
    unsigned char *bytes = read_bytes(&size), *spoilt = malloc(size);
    int refused = 0;
    for (int i = 0; i < 6000; i++) {
        weft_error error = {0};
        memcpy(spoilt, bytes, size);
        for (int flips = 1 + rand() % 3; flips > 0; flips--)
            spoilt[rand() % 4 == 0 ? rand() % (int)size : rand() % 1200] = (unsigned char)rand();
        weft_bytes_repair(spoilt, size, true);
        weft_code code = try_bytes(spoilt, size, &error);
        assert_true(code == WEFT_OK || (code == WEFT_BAD_INPUT && strstr(error.message, path)));
        refused += code != WEFT_OK;
    }
    assert_true(refused > 1000);
    free(bytes);
    free(spoilt);
    remove(path);
}

/* Turns one section into another type and expects to hear of it. */
static void expect_refused(const char from[4], const char to[4], const char *complaint)
{
    size_t size;
    weft_error error = {0};
    weft_material material = material_of_bases(true);
    assert_int_equal(weft_material_write(path, &material, NULL), WEFT_OK);
    weft_material_free(&material);
    unsigned char *bytes = read_bytes(&size);
    memcpy(weft_bytes_entry(bytes, weft_bytes_find(bytes, from, 1)), to, 4);
    weft_bytes_repair(bytes, size, true);
    assert_int_equal(try_bytes(bytes, size, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, complaint))
        fail_msg("'%s' does not say '%s'", error.message, complaint);
    free(bytes);
    remove(path);
}

static void sections_that_do_not_go_together_are_named(void **state)
{
    (void)state;
    expect_refused("TPCA", "ZZZZ", "section TPCA of level 1 is missing");
    expect_refused("TPCA", "TABL", "section TPCA of level 1 is missing");
    expect_refused("ALPH", "ZZZZ", "section ALPH of level 1 is missing");
    expect_refused("SPCA", "TPCA", "occurs twice");
}

int test_table_basis(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_are_the_mean_and_multiples_of_the_components),
        cmocka_unit_test(the_size_tells_the_number_of_components),
        cmocka_unit_test(materials_with_bases_read_back_as_written),
        cmocka_unit_test(spoilt_files_are_refused_or_read_but_never_believed_blindly),
        cmocka_unit_test(sections_that_do_not_go_together_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
