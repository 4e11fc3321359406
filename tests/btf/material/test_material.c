#include "base/atomic_file.h"
#include "btf/material/material.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char path[] = "example.weft";

static weft_material read_material(const char *name)
{
    weft_material material;
    weft_error error = {0};
    weft_code code = weft_material_read(name, &material, &error);
    if (code != WEFT_OK)
        fail_msg("%s", error.message);
    return material;
}

static size_t level_texels(const weft_material_level *level)
{
    return (size_t)level->width * (size_t)level->height;
}

static void assert_levels_equal(const weft_material *a, const weft_material *b, int k)
{
    const weft_material_level *p = &a->level[k], *q = &b->level[k];
    size_t texels = level_texels(p), lobes = (size_t)a->lobe_count, views = (size_t)a->view_count;
    assert_int_equal(p->width, q->width);
    assert_int_equal(p->height, q->height);
    assert_memory_equal(p->frame, q->frame, texels * 3 * sizeof *p->frame);
    assert_memory_equal(p->diffuse, q->diffuse, texels * 4 * sizeof *p->diffuse);
    if (lobes > 0)
        assert_memory_equal(p->lobe, q->lobe, texels * lobes * 12 * sizeof *p->lobe);
    if (views > 0)
        assert_memory_equal(p->table, q->table, texels * views * 4);
    assert_null(p->light_table);
    assert_int_equal(a->has_lobes, b->has_lobes);
    assert_memory_equal(&p->error, &q->error, sizeof p->error);
}

static void fill_directions(weft_vec3 *direction, int count)
{
    for (int i = 0; i < count; i++)
        direction[i] = weft_unit(weft_vec3_of(rand() % 100 - 50, rand() % 100 - 50, 1 + rand() % 100));
}

static void assert_same_directions(const weft_vec3 *a, const weft_vec3 *b, int count)
{
    for (int i = 0; i < count; i++)
        assert_true(weft_length(weft_subtract(a[i], b[i])) < 1e-7);
}

static void fill_randomly(weft_material *material)
{
    srand(1);
    fill_directions(material->view, material->view_count);
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        for (size_t i = 0; i < level_texels(level) * 3; i++)
            level->frame[i] = (int16_t)(rand() % 65536 - 32768);
        for (size_t i = 0; i < level_texels(level) * 4; i++)
            level->diffuse[i] = (weft_half)(rand() % 0x7c00);
        for (size_t i = 0; i < level_texels(level) * 12 * (size_t)material->lobe_count; i++)
            level->lobe[i] = (weft_half)(rand() % 0x7c00);
        for (size_t i = 0; i < level_texels(level) * 4 * (size_t)material->view_count; i++)
            level->table[i] = (uint8_t)(rand() % 8);
        level->error = (weft_error_summary){k, 1, 2, 3, INFINITY, 0};
    }
}

static void a_material_of_any_shape_reads_back_as_written(void **state)
{
    (void)state;
    static const int shape[6][5] = {{1, 1, 0, 0, 1},  {7, 5, 0, 0, 1},    {16, 16, 1, 0, 1},
                                    {33, 2, 3, 1, 0}, {64, 48, 2, 81, 1}, {3, 100, 0, 9, 1}};
    for (int i = 0; i < 6; i++) {
        weft_material written;
        assert_int_equal(
            weft_material_create(shape[i][0], shape[i][1], shape[i][2], shape[i][3], 0, shape[i][4], &written, NULL),
            WEFT_OK);
        fill_randomly(&written);
        written.texel_pitch_mm = 0.1 + i;
        assert_int_equal(weft_material_write("shape.weft", &written, NULL), WEFT_OK);
        weft_material read = read_material("shape.weft");
        struct stat status;
        uint64_t size;
        assert_int_equal(stat("shape.weft", &status), 0);
        assert_int_equal(weft_material_size(&written, &size, NULL), WEFT_OK);
        assert_int_equal(size, status.st_size);
        assert_int_equal(read.level_count, written.level_count);
        assert_int_equal(read.lobe_count, written.lobe_count);
        assert_int_equal(read.view_count, written.view_count);
        assert_true(read.texel_pitch_mm == written.texel_pitch_mm);
        assert_string_equal(read.metadata, "{}");
        assert_same_directions(read.view, written.view, read.view_count);
        for (int k = 0; k < read.level_count; k++)
            assert_levels_equal(&read, &written, k);
        weft_material_free(&read);
        weft_material_free(&written);
    }
    remove("shape.weft");
}

static void levels_halve_rounding_up_to_one_texel(void **state)
{
    (void)state;
    static const int width[4] = {5, 3, 2, 1}, height[4] = {3, 2, 1, 1};
    weft_material material;
    assert_int_equal(weft_material_create(5, 3, 0, 0, 0, 1, &material, NULL), WEFT_OK);
    assert_int_equal(material.level_count, 4);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(material.level[k].width, width[k]);
        assert_int_equal(material.level[k].height, height[k]);
    }
    weft_material_free(&material);
}

static void impossible_shapes_are_refused(void **state)
{
    (void)state;
    static const int shape[9][5] = {{0, 1, 0, 0, 0},  {1, -1, 0, 0, 0},   {16385, 1, 0, 0, 0},
                                    {1, 1, 4, 0, 0},  {1, 1, -1, 0, 0},   {1, 1, 0, 4097, 0},
                                    {1, 1, 0, -1, 0}, {1, 1, 0, 0, 4097}, {1, 1, 0, 0, -1}};
    for (int i = 0; i < 9; i++) {
        weft_material material;
        weft_error error = {0};
        assert_int_equal(
            weft_material_create(shape[i][0], shape[i][1], shape[i][2], shape[i][3], shape[i][4], 1, &material, &error),
            WEFT_BAD_USAGE);
        assert_non_null(strstr(error.message, "must be"));
    }
}

static void metadata_and_errors_of_the_fit_are_kept(void **state)
{
    (void)state;
    weft_material material = read_material(path);
    assert_string_equal(material.metadata, "{\"provenance\": \"made by a test\"}");
    assert_true(material.level[1].error.median_relative == 1.01 && material.level[2].error.psnr_db == 52);
    weft_material_free(&material);
}

/* Codec of the metadata of `count` bytes, {"a":"xx..x"}, which are read back as they were. */
static uint32_t codec_of_metadata(size_t count)
{
    weft_material material = read_material(path);
    free(material.metadata);
    material.metadata = malloc(count + 1);
    memset(material.metadata, 'x', count);
    memcpy(material.metadata, "{\"a\":\"", 6);
    strcpy(material.metadata + count - 2, "\"}");
    assert_int_equal(weft_material_write("long.weft", &material, NULL), WEFT_OK);
    weft_material read = read_material("long.weft");
    assert_string_equal(read.metadata, material.metadata);
    size_t size;
    unsigned char *bytes = scratch_load("long.weft", &size);
    uint32_t codec = weft_bytes_u32(weft_bytes_entry(bytes, weft_bytes_find(bytes, "META", 0)) + ENTRY_CODEC);
    free(bytes);
    weft_material_free(&read);
    weft_material_free(&material);
    return codec;
}

static void long_metadata_are_compressed(void **state)
{
    (void)state;
    assert_int_equal(codec_of_metadata(4096), 0);
    assert_int_equal(codec_of_metadata(4097), 1);
}

static void an_all_black_material_is_no_bomb(void **state)
{
    (void)state;
    weft_material black;
    assert_int_equal(weft_material_create(128, 128, 2, 81, 0, 0, &black, NULL), WEFT_OK);
    for (int i = 0; i < black.view_count; i++)
        black.view[i] = weft_vec3_of(0, 0, 1);
    assert_int_equal(weft_material_write("black.weft", &black, NULL), WEFT_OK);
    weft_material read = read_material("black.weft");
    assert_levels_equal(&black, &read, 0);
    /* 5 MB of zeros: no section is stored as it is for being compressed too well. */
    assert_true(weft_file_bytes("black.weft") < 8192);
    weft_material_free(&read);
    weft_material_free(&black);
    remove("black.weft");
}

/* ---- Damaged files ---- */

/* Which code a message goes with. */
static weft_code code_of_message(const char *message)
{
    if (strstr(message, "No such file"))
        return WEFT_MISSING;
    if (strstr(message, "newer Weft"))
        return WEFT_NOT_SUPPORTED;
    bool is_other = strstr(message, "regular file") || strstr(message, "is no .weft file") ||
                    strstr(message, "is a dataset") || strstr(message, "are read");
    return is_other ? WEFT_BAD_INPUT : WEFT_DAMAGED;
}

static void assert_refused(const char *name, const char *cause)
{
    weft_material material;
    weft_error error = {0};
    weft_code code = weft_material_read(name, &material, &error);
    if (code != code_of_message(error.message) || !strstr(error.message, name) || !strstr(error.message, cause))
        fail_msg("code %d, message '%s', expected '%s'", code, error.message, cause);
    assert_null(material.metadata);
    assert_null(material.view);
}

static void assert_bytes_refused(const unsigned char *bytes, size_t size, const char *cause)
{
    scratch_store("damaged.weft", bytes, size);
    assert_refused("damaged.weft", cause);
}

static void missing_files_and_folders_are_refused(void **state)
{
    (void)state;
    assert_refused("absent.weft", "No such file");
    assert_int_equal(mkdir("folder.weft", 0777), 0);
    assert_refused("folder.weft", "not a regular file");
    remove("folder.weft");
}

static void a_file_cut_anywhere_is_refused(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    for (size_t cut = 0; cut < size; cut++)
        assert_bytes_refused(bytes, cut, "cut");
    bytes[size] = 0;
    assert_bytes_refused(bytes, size + 1, "too long");
    free(bytes);
}

/* As above, but with a header that admits the loss: what is left must be noticed by the sections. */
static void a_file_cut_at_a_section_boundary_is_refused_though_its_header_agrees(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    int sections = (int)weft_bytes_u32(bytes + 12);
    assert_int_equal(sections, 3 + 4 * 4);
    for (int i = 0; i < sections; i++) {
        const unsigned char *entry = weft_bytes_entry(bytes, i);
        uint64_t start = weft_bytes_u64(entry + ENTRY_OFFSET);
        weft_bytes_put_u64(bytes + 16, start);
        weft_bytes_repair(bytes, start, false);
        assert_bytes_refused(bytes, start, "reaches beyond the end");
    }
    free(bytes);
}

static void a_flipped_bit_anywhere_is_noticed(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    for (size_t i = 0; i < size; i++) {
        bytes[i] ^= (unsigned char)(1 << i % 8);
        assert_bytes_refused(bytes, size, "");
        bytes[i] ^= (unsigned char)(1 << i % 8);
    }
    free(bytes);
}

static void bytes_that_belong_to_no_section_are_refused(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    bytes[size] = 0;
    weft_bytes_put_u64(bytes + 16, size + 1);
    weft_bytes_repair(bytes, size + 1, false);
    assert_bytes_refused(bytes, size + 1, "1 bytes follow");
    weft_bytes_put_u64(bytes + 16, size);
    weft_bytes_repair(bytes, size, false);
    bytes[weft_bytes_u64(weft_bytes_entry(bytes, 0) + ENTRY_OFFSET) - 1] = 1;
    assert_bytes_refused(bytes, size, "bytes before it are not zero");
    free(bytes);
}

typedef struct header_edit {
    int offset;
    uint32_t value;
    const char *cause;
} header_edit;

static void impossible_headers_are_refused_with_right_checksums(void **state)
{
    (void)state;
    static const header_edit edit[] = {
        {0, 0x12345678, "no .weft file"},
        {8, 0, "version 0"},
        {8, 3, "newer Weft: version 3"},
        {12, 0, "0 sections"},
        {12, 4097, "4097 sections"},
        {12, 4096, "table of 4096"},
        {24, 0, "width"},
        {24, 0xffffffff, "width"},
        {28, 16385, "height"},
        {32, 0, "levels"},
        {32, 5, "number of levels is 5"},
        {36, 4, "lobes"},
        {40, 4097, "views"},
        {52, 0x7ff80000, "pitch"},
        {52, 0xbff00000, "pitch"},
        {24, 6, "size does not fit"},
        {36, 1, "size does not fit"},
        {40, 3, "size does not fit"},
        {40, 0, "number of views is 0"},
        {32, 3, "no such section"},
        {44, 0, "neither lobes nor components"},
        {44, 0x8d, "newer Weft: it needs features 0x80"},
        {44, 0x0f, "number of components is 0"},
        {44, 0x09, "number of views is 4"},
        {44, 0x01, "number of views is 4"},
        {44, 0x05, "section ALPH of level 0: the material has no such section"},
        {44, 0x1000d, "section HGHT of level 0 is missing"},
        {44, 0x2000d, "section VISI of level 0 is missing"},
        {56, 4, "number of components is 4"},
    };
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    for (size_t i = 0; i < sizeof edit / sizeof edit[0]; i++) {
        uint32_t before = weft_bytes_u32(bytes + edit[i].offset);
        weft_bytes_put_u32(bytes + edit[i].offset, edit[i].value);
        weft_bytes_repair(bytes, size, false);
        assert_bytes_refused(bytes, size, edit[i].cause);
        weft_bytes_put_u32(bytes + edit[i].offset, before);
    }
    free(bytes);
}

typedef struct section_edit {
    const char *type;
    uint32_t level;
    int offset;
    uint32_t value;
    const char *cause;
} section_edit;

static void impossible_sections_are_refused_with_right_checksums(void **state)
{
    (void)state;
    static const section_edit edit[] = {
        {"LOBE", 0, ENTRY_LEVEL, 1, "occurs twice"},
        {"ERRO", 0, ENTRY_LEVEL, 1, "no such section"},
        {"FRAM", 0, ENTRY_LEVEL, 4, "no such section"},
        {"FRAM", 0, ENTRY_TYPE, 0x58585858, "FRAM of level 0 is missing"},
        {"FRAM", 0, ENTRY_CODEC, 7, "unknown codec"},
        {"FRAM", 0, ENTRY_CODEC, 2, "unknown codec"},
        {"FRAM", 0, ENTRY_OFFSET, 1, "does not follow"},
        {"FRAM", 0, ENTRY_OFFSET, 64, "does not follow"},
        {"FRAM", 0, ENTRY_STORED, 0xffffffff, "beyond the end"},
        {"FRAM", 0, ENTRY_STORED + 4, 0xffffffff, "beyond the end"},
        {"FRAM", 0, ENTRY_DECODED, 91, ""},
        {"TABL", 0, ENTRY_DECODED + 4, 1, ""},
        {"META", 0, ENTRY_LEVEL, 1, "no such section"},
        {"VIEW", 0, ENTRY_LEVEL, 1, "no such section"},
        {"ALPH", 2, ENTRY_TYPE, 0x58585858, "ALPH of level 2 is missing"},
        {"ALPH", 1, ENTRY_DECODED + 4, 1, ""},
    };
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    for (size_t i = 0; i < sizeof edit / sizeof edit[0]; i++) {
        unsigned char *entry = weft_bytes_entry(bytes, weft_bytes_find(bytes, edit[i].type, edit[i].level));
        uint32_t before = weft_bytes_u32(entry + edit[i].offset);
        weft_bytes_put_u32(entry + edit[i].offset, edit[i].value);
        weft_bytes_repair(bytes, size, false);
        assert_bytes_refused(bytes, size, edit[i].cause);
        weft_bytes_put_u32(entry + edit[i].offset, before);
    }
    free(bytes);
}

/* A header of 16384 x 16384 texels with one tiny compressed section each: refused by arithmetic alone. */
static void a_decompression_bomb_is_refused_before_it_is_allocated(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    weft_bytes_put_u32(bytes + 24, 16384);
    weft_bytes_put_u32(bytes + 28, 16384);
    for (uint32_t level = 0; level < 4; level++) {
        uint64_t side = 16384 >> level;
        unsigned char *entry = weft_bytes_entry(bytes, weft_bytes_find(bytes, "FRAM", level));
        weft_bytes_put_u32(entry + ENTRY_CODEC, 1);
        weft_bytes_put_u64(entry + ENTRY_DECODED, side * side * 6);
    }
    weft_bytes_repair(bytes, size, true);
    assert_bytes_refused(bytes, size, "more than 1024 times");
    free(bytes);
}

/* The size that is claimed is right, but the compressed bytes give another one. */
static void a_section_that_decodes_to_another_size_is_refused(void **state)
{
    (void)state;
    weft_material flat;
    assert_int_equal(weft_material_create(64, 64, 0, 0, 0, 0, &flat, NULL), WEFT_OK);
    assert_int_equal(weft_material_write("flat.weft", &flat, NULL), WEFT_OK);
    weft_material_free(&flat);
    size_t size;
    unsigned char *bytes = scratch_load("flat.weft", &size);
    unsigned char *frame = weft_bytes_entry(bytes, weft_bytes_find(bytes, "FRAM", 0));
    assert_int_equal(weft_bytes_u32(frame + ENTRY_CODEC), 1);
    bytes[weft_bytes_u64(frame + ENTRY_OFFSET) + 6] ^= 0x10;
    weft_bytes_repair(bytes, size, true);
    assert_bytes_refused(bytes, size, "cannot be decoded");
    free(bytes);
    remove("flat.weft");
}

static void put_half(unsigned char *bytes, const char *type, uint32_t level, int index, weft_half value)
{
    unsigned char *entry = weft_bytes_entry(bytes, weft_bytes_find(bytes, type, level));
    assert_int_equal(weft_bytes_u32(entry + ENTRY_CODEC), 0);
    memcpy(bytes + weft_bytes_u64(entry + ENTRY_OFFSET) + 2 * index, &value, 2);
}

static void contents_that_are_not_finite_or_negative_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *type;
        uint32_t level;
        int index;
        weft_half value;
        const char *cause;
    } edit[] = {{"LOBE", 3, 1, 0x7e00, "not finite"}, {"LOBE", 3, 0, 0xbc00, "negative"},
                {"LOBE", 3, 3, 0xbc00, "negative"},   {"LOBE", 3, 7, 0xbc00, "negative"},
                {"LOBE", 3, 6, 0x7c00, "not finite"}, {"VIEW", 0, 1, 0x7fc0, "unit vector"},
                {"ERRO", 0, 3, 0x7ff8, "NaN"},        {"ERRO", 0, 39, 0xfff0, "minus infinity"}};
    for (size_t i = 0; i < sizeof edit / sizeof edit[0]; i++) {
        size_t size;
        unsigned char *bytes = scratch_load(path, &size);
        put_half(bytes, edit[i].type, edit[i].level, edit[i].index, edit[i].value);
        weft_bytes_repair(bytes, size, true);
        assert_bytes_refused(bytes, size, edit[i].cause);
        free(bytes);
    }
}

static void unknown_sections_are_skipped(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    int sections = (int)weft_bytes_u32(bytes + 12);
    size_t table = WEFT_BYTES_HEADER + (size_t)sections * WEFT_BYTES_ENTRY;
    size_t first = weft_bytes_u64(weft_bytes_entry(bytes, 0) + ENTRY_OFFSET);
    size_t shift = (table + WEFT_BYTES_ENTRY + 63) / 64 * 64 - first, start = (size + 63) / 64 * 64 + shift;
    unsigned char *longer = calloc(1, start + 5);
    assert_non_null(longer);
    memcpy(longer, bytes, table);
    memcpy(longer + first + shift, bytes + first, size - first);
    for (int i = 0; i < sections; i++) {
        unsigned char *entry = weft_bytes_entry(longer, i);
        weft_bytes_put_u64(entry + ENTRY_OFFSET, weft_bytes_u64(entry + ENTRY_OFFSET) + shift);
    }
    unsigned char *added = weft_bytes_entry(longer, sections);
    memcpy(added, "NEW!", 4);
    weft_bytes_put_u32(added + ENTRY_LEVEL, 99);
    weft_bytes_put_u64(added + ENTRY_OFFSET, start);
    weft_bytes_put_u64(added + ENTRY_STORED, 5);
    weft_bytes_put_u64(added + ENTRY_DECODED, 5);
    weft_bytes_put_u32(longer + 12, (uint32_t)sections + 1);
    weft_bytes_put_u64(longer + 16, start + 5);
    weft_bytes_repair(longer, start + 5, true);
    scratch_store("newer.weft", longer, start + 5);
    weft_material newer = read_material("newer.weft"), material = read_material(path);
    for (int k = 0; k < material.level_count; k++)
        assert_levels_equal(&newer, &material, k);
    weft_material_free(&newer);
    weft_material_free(&material);
    free(longer);
    free(bytes);
    remove("newer.weft");
}

/* ---- Writing ---- */

static void a_full_disk_leaves_the_old_file_as_it_was(void **state)
{
    (void)state;
    size_t size, size_after;
    unsigned char *before = scratch_load(path, &size);
    int entries = scratch_folder_entries();
    weft_material material = read_material(path);
    weft_error error = {0};
    scratch_limit_file_size(1000);
    weft_code code = weft_material_write(path, &material, &error);
    scratch_limit_file_size(0);
    assert_int_equal(code, WEFT_SYSTEM);
    assert_non_null(strstr(error.message, path));
    unsigned char *after = scratch_load(path, &size_after);
    assert_int_equal(size, size_after);
    assert_memory_equal(before, after, size);
    assert_int_equal(scratch_folder_entries(), entries);
    free(before);
    free(after);
    weft_material_free(&material);
}

static void assert_not_written(const weft_material *material, const char *cause)
{
    weft_error error = {0};
    assert_int_equal(weft_material_write("refused.weft", material, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, cause));
}

static void what_could_not_be_read_is_not_written(void **state)
{
    (void)state;
    weft_material material;
    assert_int_equal(weft_material_create(4, 4, 1, 1, 0, 0, &material, NULL), WEFT_OK);
    assert_not_written(&material, "unit vector");
    material.view[0] = weft_vec3_of(0, 0, 1);
    material.level[0].lobe[3] = weft_half_of_float(-1);
    assert_not_written(&material, "negative");
    material.level[0].lobe[3] = 0;
    material.level[0].diffuse[1] = weft_half_of_float(NAN);
    assert_not_written(&material, "not finite");
    material.level[0].diffuse[1] = 0;
    material.texel_pitch_mm = 0;
    assert_not_written(&material, "pitch");
    material.texel_pitch_mm = 1;
    strcpy(material.metadata, "[]");
    assert_not_written(&material, "JSON");
    weft_material_free(&material);
    assert_int_equal(weft_material_create(4, 4, 0, 0, 1, 0, &material, NULL), WEFT_OK);
    assert_not_written(&material, "light table");
    weft_material_free(&material);
    assert_int_equal(weft_material_create_without_lobes(4, 4, 0, 0, &material, NULL), WEFT_OK);
    assert_not_written(&material, "neither lobes nor components");
    weft_material_free(&material);
}

/* Features from bit 16 on can be done without: those that are not known are not looked at. */
static void unknown_optional_features_are_ignored(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    weft_bytes_put_u32(bytes + 44, weft_bytes_u32(bytes + 44) | 0x80100000);
    weft_bytes_repair(bytes, size, false);
    scratch_store("newer.weft", bytes, size);
    weft_material newer = read_material("newer.weft"), material = read_material(path);
    assert_levels_equal(&newer, &material, 0);
    weft_material_free(&newer);
    weft_material_free(&material);
    free(bytes);
    remove("newer.weft");
}

static int enter(void **state)
{
    int code = scratch_folder_enter(state);
    if (code == 0)
        weft_bytes_write_example(path);
    return code;
}

int test_material(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_material_of_any_shape_reads_back_as_written),
        cmocka_unit_test(levels_halve_rounding_up_to_one_texel),
        cmocka_unit_test(impossible_shapes_are_refused),
        cmocka_unit_test(metadata_and_errors_of_the_fit_are_kept),
        cmocka_unit_test(long_metadata_are_compressed),
        cmocka_unit_test(an_all_black_material_is_no_bomb),
        cmocka_unit_test(missing_files_and_folders_are_refused),
        cmocka_unit_test(a_file_cut_anywhere_is_refused),
        cmocka_unit_test(a_file_cut_at_a_section_boundary_is_refused_though_its_header_agrees),
        cmocka_unit_test(a_flipped_bit_anywhere_is_noticed),
        cmocka_unit_test(bytes_that_belong_to_no_section_are_refused),
        cmocka_unit_test(impossible_headers_are_refused_with_right_checksums),
        cmocka_unit_test(impossible_sections_are_refused_with_right_checksums),
        cmocka_unit_test(a_decompression_bomb_is_refused_before_it_is_allocated),
        cmocka_unit_test(a_section_that_decodes_to_another_size_is_refused),
        cmocka_unit_test(contents_that_are_not_finite_or_negative_are_refused),
        cmocka_unit_test(unknown_sections_are_skipped),
        cmocka_unit_test(unknown_optional_features_are_ignored),
        cmocka_unit_test(a_full_disk_leaves_the_old_file_as_it_was),
        cmocka_unit_test(what_could_not_be_read_is_not_written),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
