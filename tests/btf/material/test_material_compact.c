/* Sections that leave out the texels without such a part. */
#include "btf/material/models.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, LOBES = 2, VIEWS = 9, LIGHTS = 5, TEXELS = SIDE * SIDE };

static uint8_t random_code(void)
{
    return (uint8_t)(rand() % 255);
}

static void fill_table(uint8_t *table, size_t texels, size_t texel, int count, bool has)
{
    for (size_t i = 0; i < (size_t)count; i++) {
        for (size_t c = 0; c < 3; c++)
            table[4 * (i * texels + texel) + c] = has ? random_code() : 255;
        table[4 * (i * texels + texel) + 3] = 255;
    }
}

static void fill_texel(weft_material *material, int k, size_t texel, int lobes, bool table, bool light_table)
{
    weft_material_level *level = &material->level[k];
    size_t texels = (size_t)level->width * (size_t)level->height;
    for (size_t plane = 0; plane < 3 * LOBES; plane++) {
        weft_half *lobe = level->lobe + 4 * (plane * texels + texel);
        for (int i = 0; i < 3; i++)
            lobe[i] = (int)plane / 3 < lobes ? (weft_half)(1 + rand() % 0x3c00) : 0;
        lobe[3] = weft_half_of_float((float)((int)plane / 3 < lobes ? 2 + rand() % 9 : 1));
    }
    fill_table(level->table, texels, texel, VIEWS, table);
    fill_table(level->light_table, texels, texel, LIGHTS, light_table);
}

/* Texels of all models, at random. */
static weft_material make_material(void)
{
    weft_material material;
    assert_int_equal(weft_material_create(SIDE, SIDE, LOBES, VIEWS, LIGHTS, 1, &material, NULL), WEFT_OK);
    for (int i = 0; i < VIEWS; i++)
        material.view[i] = weft_unit(weft_vec3_of(i, 1, 2));
    for (int i = 0; i < LIGHTS; i++)
        material.light[i] = weft_unit(weft_vec3_of(1, i, 3));
    srand(3);
    for (int k = 0; k < material.level_count; k++) {
        for (size_t texel = 0; texel < (size_t)material.level[k].width * (size_t)material.level[k].height; texel++)
            fill_texel(&material, k, texel, rand() % 3, rand() % 2, rand() % 2);
    }
    assert_int_equal(weft_material_find_models(&material, NULL), WEFT_OK);
    return material;
}

static void assert_reads_back(const char *name, const weft_material *material)
{
    weft_material read;
    weft_error error = {0};
    if (weft_material_read(name, &read, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *a = &material->level[k], *b = &read.level[k];
        size_t texels = (size_t)a->width * (size_t)a->height;
        assert_memory_equal(a->lobe, b->lobe, texels * LOBES * 12 * sizeof *a->lobe);
        assert_memory_equal(a->table, b->table, texels * VIEWS * 4);
        assert_memory_equal(a->light_table, b->light_table, texels * LIGHTS * 4);
        assert_memory_equal(a->model, b->model, texels);
    }
    weft_material_free(&read);
}

static uint64_t decoded_size(const char *name, const char *type)
{
    size_t size;
    unsigned char *bytes = scratch_load(name, &size);
    uint64_t decoded = weft_bytes_u64(weft_bytes_entry(bytes, weft_bytes_find(bytes, type, 0)) + ENTRY_DECODED);
    free(bytes);
    return decoded;
}

static void only_what_texels_have_is_stored_and_all_reads_back(void **state)
{
    (void)state;
    weft_material material = make_material();
    uint64_t lobe = 0, table = 0, light_table = 0;
    for (int texel = 0; texel < TEXELS; texel++) {
        weft_model_parts parts = weft_model_decode(material.level[0].model[texel]);
        lobe += (uint64_t)(24 * parts.lobe_count);
        table += parts.table_bits > 0 ? 4 * VIEWS : 0;
        light_table += parts.light_table_bits > 0 ? 4 * LIGHTS : 0;
    }
    assert_int_equal(weft_material_write("compact.weft", &material, NULL), WEFT_OK);
    assert_int_equal(decoded_size("compact.weft", "LOBE"), lobe);
    assert_int_equal(decoded_size("compact.weft", "TABL"), table);
    assert_int_equal(decoded_size("compact.weft", "STAB"), light_table);
    assert_reads_back("compact.weft", &material);
    weft_material_free(&material);
}

static void a_texel_without_t_keeps_its_holes(void **state)
{
    (void)state;
    weft_material material = make_material();
    size_t texel = 0;
    while (weft_model_decode(material.level[0].model[texel]).table_bits > 0)
        texel++;
    material.level[0].table[4 * (2 * TEXELS + texel) + 3] = 100;
    assert_int_equal(weft_material_write("holes.weft", &material, NULL), WEFT_OK);
    assert_int_equal(decoded_size("holes.weft", "TABL"), 4 * VIEWS * TEXELS);
    assert_reads_back("holes.weft", &material);
    weft_material_free(&material);
}

static void assert_bytes_refused(const unsigned char *bytes, size_t size, const char *cause)
{
    weft_material material;
    weft_error error = {0};
    scratch_store("damaged.weft", bytes, size);
    assert_int_equal(weft_material_read("damaged.weft", &material, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, cause))
        fail_msg("'%s' does not say '%s'", error.message, cause);
}

/* A map that gives one texel more or less than the sections hold. */
static void a_map_that_does_not_fit_the_sections_is_refused(void **state)
{
    (void)state;
    static const uint8_t flip[3] = {1, 3 << 2, 3 << 4};
    for (int i = 0; i < 3; i++) {
        size_t size;
        weft_bytes_write_example("example.weft");
        unsigned char *bytes = scratch_load("example.weft", &size);
        unsigned char *entry = weft_bytes_entry(bytes, weft_bytes_find(bytes, "MODL", 0));
        assert_int_equal(weft_bytes_u32(entry + ENTRY_CODEC), 0);
        bytes[weft_bytes_u64(entry + ENTRY_OFFSET) + 1] ^= flip[i];
        weft_bytes_repair(bytes, size, true);
        assert_bytes_refused(bytes, size, "does not fit the models");
        free(bytes);
    }
}

static void without_a_map_nothing_may_be_left_out(void **state)
{
    (void)state;
    size_t size;
    weft_bytes_write_example("example.weft");
    unsigned char *bytes = scratch_load("example.weft", &size);
    for (uint32_t level = 0; level < 4; level++)
        memcpy(weft_bytes_entry(bytes, weft_bytes_find(bytes, "MODL", level)), "NONE", 4);
    weft_bytes_repair(bytes, size, true);
    assert_bytes_refused(bytes, size, "its size does not fit the material");
    free(bytes);
}

static void set_decoded(unsigned char *bytes, const char *type, uint64_t decoded)
{
    unsigned char *entry = weft_bytes_entry(bytes, weft_bytes_find(bytes, type, 0));
    assert_int_equal(weft_bytes_u32(entry + ENTRY_CODEC), 1);
    weft_bytes_put_u64(entry + ENTRY_DECODED, decoded);
}

/* A material of many views, none of which a texel needs, enlarged by its header alone. */
static void a_small_file_that_expands_enormously_is_refused(void **state)
{
    (void)state;
    enum { SMALL = 48, LARGE = 64, MANY = 4096 };
    weft_material material;
    assert_int_equal(weft_material_create(SMALL, SMALL, 0, MANY, 0, 0, &material, NULL), WEFT_OK);
    memset(material.level[0].table, 255, 4 * (size_t)SMALL * SMALL * MANY);
    for (int i = 0; i < MANY; i++)
        material.view[i] = weft_vec3_of(0, 0, 1);
    assert_int_equal(weft_material_find_models(&material, NULL), WEFT_OK);
    assert_int_equal(weft_material_write("many.weft", &material, NULL), WEFT_OK);
    weft_material_free(&material);
    assert_int_equal(decoded_size("many.weft", "TABL"), 0);
    size_t size;
    unsigned char *bytes = scratch_load("many.weft", &size);
    assert_true(size < 100000);
    weft_bytes_put_u32(bytes + 24, LARGE);
    weft_bytes_put_u32(bytes + 28, LARGE);
    set_decoded(bytes, "FRAM", 6 * LARGE * LARGE);
    set_decoded(bytes, "RHO ", 8 * LARGE * LARGE);
    set_decoded(bytes, "MODL", LARGE * LARGE);
    weft_bytes_repair(bytes, size, true);
    assert_bytes_refused(bytes, size, "expand to more than 1024 times");
    free(bytes);
}

static void fewer_bits_take_the_nearest_code(void **state)
{
    (void)state;
    for (int bits = 4; bits <= 8; bits += 2) {
        int steps = (1 << bits) - 1;
        for (int code = 0; code <= 255; code++) {
            int rounded = weft_table_code_rounded((uint8_t)code, bits), least = 255;
            bool known = false;
            for (int i = 0; i <= steps; i++) {
                int candidate = (int)lround(255.0 * i / steps);
                known |= candidate == rounded;
                least = abs(candidate - code) < least ? abs(candidate - code) : least;
            }
            assert_true(known);
            assert_int_equal(abs(rounded - code), least);
        }
    }
}

int test_material_compact(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fewer_bits_take_the_nearest_code),
        cmocka_unit_test(only_what_texels_have_is_stored_and_all_reads_back),
        cmocka_unit_test(a_texel_without_t_keeps_its_holes),
        cmocka_unit_test(a_map_that_does_not_fit_the_sections_is_refused),
        cmocka_unit_test(without_a_map_nothing_may_be_left_out),
        cmocka_unit_test(a_small_file_that_expands_enormously_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
