/* Files that are cut short or damaged are named, never taken for photographs; and the colours that only a container
 * says. Their bytes are written here, after the descriptions of the formats. */
#include "base/atomic_file.h"
#include "base/picture/colour_claim.h"
#include "base/picture/container.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct bytes {
    uint8_t data[65536];
    size_t count;
} bytes;

static void put(bytes *file, const void *data, size_t count)
{
    assert_true(file->count + count <= sizeof file->data);
    memcpy(file->data + file->count, data, count);
    file->count += count;
}

static void put_number(bytes *file, uint32_t value, int count, bool big_endian)
{
    for (int i = 0; i < count; i++) {
        uint8_t byte = (uint8_t)(value >> 8 * (big_endian ? count - 1 - i : i));
        put(file, &byte, 1);
    }
}

static void save(const bytes *file, const char *path)
{
    assert_int_equal(weft_write_file(path, file->data, file->count, NULL), WEFT_OK);
}

static void assert_refused(const char *path, const char *reason)
{
    weft_image image;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_image_read(path, &image, NULL, &error)), WEFT_BAD_INPUT);
    if (!strstr(error.message, reason) || !strstr(error.message, path) || strchr(error.message, '\n'))
        fail_msg("'%s' does not say '%s' or not of which file", error.message, reason);
}

static void read_bytes(const char *path, bytes *file)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    file->count = fread(file->data, 1, sizeof file->data, stream);
    assert_true(file->count < sizeof file->data);
    fclose(stream);
}

/* ---- PNG ---- */

enum { WIDTH = 16, HEIGHT = 4 };

static void put_chunk(bytes *file, const char *type, const void *data, size_t size)
{
    put_number(file, (uint32_t)size, 4, true);
    size_t begin = file->count;
    put(file, type, 4);
    put(file, data, size);
    put_number(file, (uint32_t)crc32(0, file->data + begin, (uInt)(file->count - begin)), 4, true);
}

/* A ramp of RGB of 8 or 16 bits, with chunks before its pixels. */
static void write_png(const char *path, uint8_t bits, const bytes *chunks)
{
    bytes file = {.count = 0}, rows = {.count = 0};
    uint8_t packed[1024], head[13] = {0, 0, 0, WIDTH, 0, 0, 0, HEIGHT, bits, 2};
    uLongf size = sizeof packed;
    for (int y = 0; y < HEIGHT; y++) {
        put_number(&rows, 0, 1, true);
        for (int i = 0; i < 3 * WIDTH; i++)
            put_number(&rows, (uint32_t)(5 * i) * (bits == 16 ? 257 : 1), bits / 8, true);
    }
    assert_int_equal(compress(packed, &size, rows.data, rows.count), Z_OK);
    put(&file, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(&file, "IHDR", head, sizeof head);
    if (chunks)
        put(&file, chunks->data, chunks->count);
    put_chunk(&file, "IDAT", packed, size);
    put_chunk(&file, "IEND", "", 0);
    save(&file, path);
}

static void every_png_that_ends_too_early_is_refused(void **state)
{
    (void)state;
    bytes file;
    write_png("a.png", 8, NULL);
    read_bytes("a.png", &file);
    size_t whole = file.count;
    for (file.count = 9; file.count < whole; file.count += 3) {
        save(&file, "a.png");
        assert_refused("a.png", "ends too early");
    }
    save(&(bytes){.count = 0}, "a.png");
    assert_refused("a.png", "empty");
}

static void every_damaged_byte_of_pixels_is_found(void **state)
{
    (void)state;
    bytes file;
    write_png("a.png", 8, NULL);
    read_bytes("a.png", &file);
    for (size_t i = 8 + 25 + 8; i < file.count - 12 - 4; i++) {
        file.data[i] ^= 4;
        save(&file, "a.png");
        assert_refused("a.png", "checksum");
        file.data[i] ^= 4;
    }
}

/* The size alone would cost gigabytes and seconds. */
static void a_picture_larger_than_its_file_can_hold_is_refused(void **state)
{
    (void)state;
    bytes file = {.count = 0};
    const uint8_t head[13] = {0, 0, 0x40, 0, 0, 0, 0x40, 0, 8, 2};
    put(&file, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(&file, "IHDR", head, sizeof head);
    put_chunk(&file, "IDAT", "x", 1);
    put_chunk(&file, "IEND", "", 0);
    save(&file, "a.png");
    assert_refused("a.png", "cannot hold 16384 x 16384 pixels");
}

/* ---- Colours ---- */

static const uint32_t srgb_xy[8] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
static const uint32_t swapped_xy[8] = {31270, 32900, 30000, 60000, 64000, 33000, 15000, 6000};

static void put_primaries(bytes *chunks, const uint32_t xy[8])
{
    bytes data = {.count = 0};
    for (int i = 0; i < 8; i++)
        put_number(&data, xy[i], 4, true);
    put_chunk(chunks, "cHRM", data.data, data.count);
}

static void put_gamma(bytes *chunks, uint32_t gamma)
{
    bytes data = {.count = 0};
    put_number(&data, gamma, 4, true);
    put_chunk(chunks, "gAMA", data.data, data.count);
}

static weft_colour_claim claim_of(const char *path)
{
    weft_colour_claim claim;
    weft_error error = {0};
    if (weft_colour_claim_read(path, NULL, NULL, NULL, &claim, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return claim;
}

static weft_colour_claim png_with(uint8_t bits, const bytes *chunks)
{
    write_png("a.png", bits, chunks);
    return claim_of("a.png");
}

/* PNG, third edition, 4.3: cICP, iCCP, sRGB, then cHRM and gAMA. */
static void colours_of_png_count_in_the_order_of_its_standard(void **state)
{
    (void)state;
    bytes chunks = {.count = 0};
    put_primaries(&chunks, swapped_xy);
    weft_colour_claim claim = png_with(8, &chunks);
    assert_true(claim.kind == WEFT_CLAIM_CLEAR && claim.space.curve[0].kind == WEFT_CURVE_SRGB);
    for (int i = 0; i < 9; i++)
        assert_float_equal(claim.space.matrix[i / 3][i % 3], i == 1 || i == 3 || i == 8, 1e-3);
    put_gamma(&chunks, 100000);
    claim = png_with(8, &chunks);
    assert_float_equal(weft_curve_decode(&claim.space.curve[1], 0.3f), 0.3, 1e-6);
    assert_true(strstr(claim.words, "chromaticities") && strstr(claim.words, "gamma 1"));
    put_chunk(&chunks, "sRGB", "", 1);
    claim = png_with(8, &chunks);
    assert_true(weft_colour_space_is_srgb(&claim.space) && !claim.words[0]);
    put_chunk(&chunks, "cICP", (const uint8_t[]){12, 13, 0, 1}, 4);
    claim = png_with(8, &chunks);
    assert_string_equal(claim.words, "it states Display P3");
    assert_float_equal(claim.space.matrix[0][0], 1.22494, 1e-3);
}

static void primaries_of_srgb_change_nothing(void **state)
{
    (void)state;
    bytes chunks = {.count = 0};
    put_gamma(&chunks, 45455);
    put_primaries(&chunks, srgb_xy);
    weft_colour_claim claim = png_with(8, &chunks);
    assert_true(weft_colour_space_is_srgb(&claim.space) && !claim.words[0]);
}

static void sixteen_bits_of_srgb_have_a_tone_curve(void **state)
{
    (void)state;
    bytes chunks = {.count = 0};
    assert_non_null(strstr(png_with(16, NULL).words, "--linear"));
    put_chunk(&chunks, "sRGB", "", 1);
    weft_colour_claim claim = png_with(16, &chunks);
    assert_true(claim.kind == WEFT_CLAIM_CLEAR && !claim.words[0] && weft_colour_space_is_srgb(&claim.space));
}

/* ITU-R BT.2100 and BT.2408: 203 cd/m^2 is coded as 0.58 by PQ and as 0.75 by HLG. */
static void code_points_name_curves(void **state)
{
    (void)state;
    static const struct {
        uint8_t code[4];
        float encoded;
        double light;
    } row[] = {
        {{1, 13, 0, 1}, 0.5f, 0.21404}, {{1, 8, 0, 1}, 0.5f, 0.5},     {{1, 1, 0, 1}, 0.5f, 0.25963},
        {{9, 16, 0, 1}, 0.5807f, 1},    {{9, 18, 0, 1}, 0.75f, 1},     {{9, 18, 0, 1}, 0.5f, 0.3143},
        {{1, 4, 0, 1}, 0.5f, 0.21764},  {{1, 8, 0, 0}, 16 / 255.f, 0}, {{1, 8, 0, 0}, 235 / 255.f, 1},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        bytes chunks = {.count = 0};
        put_chunk(&chunks, "cICP", row[i].code, 4);
        weft_colour_claim claim = png_with(8, &chunks);
        assert_int_equal(claim.kind, WEFT_CLAIM_CLEAR);
        assert_float_equal(weft_curve_decode(&claim.space.curve[0], row[i].encoded), row[i].light, 2e-3);
    }
    bytes chunks = {.count = 0};
    put_chunk(&chunks, "cICP", (const uint8_t[]){2, 13, 0, 1}, 4);
    weft_colour_claim claim = png_with(8, &chunks);
    assert_true(claim.kind == WEFT_CLAIM_UNCLEAR && strstr(claim.words, "primaries 2"));
}

/* ---- HEIF ---- */

static size_t begin_box(bytes *file, const char *type)
{
    put_number(file, 0, 4, true);
    put(file, type, 4);
    return file->count - 8;
}

static void end_box(bytes *file, size_t begin)
{
    bytes size = {.count = 0};
    put_number(&size, (uint32_t)(file->count - begin), 4, true);
    memcpy(file->data + begin, size.data, 4);
}

static void put_box(bytes *file, const char *type, const void *data, size_t size)
{
    size_t begin = begin_box(file, type);
    put(file, data, size);
    end_box(file, begin);
}

/* Item 2 is the picture. Its properties are 1, 2 and 4; 3 and 5 are another's. */
static void make_heif(bytes *file, bool has_profile)
{
    static const uint8_t nclx[] = {'n', 'c', 'l', 'x', 0, 9, 0, 16, 0, 9, 0x80};
    static const uint8_t other[] = {'n', 'c', 'l', 'x', 0, 1, 0, 1, 0, 1, 0x80};
    static const uint8_t links[] = {0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 2, 3, 5, 0, 2, 3, 0x81, 2, 0x84};
    *file = (bytes){.count = 0};
    put_box(file, "ftyp", "heic\0\0\0\0mif1", 12);
    size_t meta = begin_box(file, "meta");
    put(file, "\0\0\0", 4);
    put_box(file, "pitm", "\0\0\0\0\0\2", 6);
    size_t properties = begin_box(file, "iprp"), list = begin_box(file, "ipco");
    if (has_profile)
        put_box(file, "colr", "profICC", 7);
    else
        put_box(file, "free", "", 0);
    put_box(file, "colr", nclx, sizeof nclx);
    put_box(file, "colr", other, sizeof other);
    put_box(file, "irot", "\3", 1);
    put_box(file, "irot", "\1", 1);
    end_box(file, list);
    put_box(file, "ipma", links, sizeof links);
    end_box(file, properties);
    end_box(file, meta);
    put_box(file, "mdat", "pixels", 6);
}

static void colours_of_heif_are_those_of_its_picture(void **state)
{
    (void)state;
    for (int has_profile = 0; has_profile < 2; has_profile++) {
        bytes file;
        weft_container container;
        weft_colour_tags tags = {0};
        weft_error error = {0};
        make_heif(&file, has_profile);
        save(&file, "a.heic");
        if (weft_container_read("a.heic", &container, &tags, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_int_equal(container, WEFT_CONTAINER_HEIF);
        assert_int_equal(tags.has_cicp, !has_profile);
        assert_int_equal(tags.turned_as, 6);
        assert_int_equal(tags.profile_size, has_profile ? 3 : 0);
        if (has_profile)
            assert_memory_equal(tags.profile, "ICC", 3);
        else
            assert_memory_equal(tags.cicp, ((const uint8_t[]){9, 16, 0, 1}), 4);
        free(tags.profile);
    }
}

static void a_heif_that_ends_too_early_is_refused(void **state)
{
    (void)state;
    bytes file;
    make_heif(&file, true);
    size_t whole = file.count;
    for (file.count = 21; file.count < whole; file.count++) {
        if (file.count == whole - 14) /* before its pixels, where it is whole as a file */
            continue;
        save(&file, "a.heic");
        assert_refused("a.heic", "ends too early");
    }
}

/* ---- TIFF ---- */

typedef struct tiff_kind {
    uint16_t photometric, bits;
    size_t missing; /* bytes at the end */
} tiff_kind;

/* One channel: a ramp of 256 values, black or white first. */
static void write_tiff(const char *path, tiff_kind kind)
{
    enum { ENTRIES = 8, DATA = 8 + 2 + 12 * ENTRIES + 4, ROWS = 8 };
    const uint32_t entry[ENTRIES][2] = {{256, 256},  {257, ROWS}, {258, kind.bits}, {262, kind.photometric},
                                        {273, DATA}, {277, 1},    {278, ROWS},      {279, 256 * ROWS * kind.bits / 8}};
    bytes file = {.count = 0};
    put(&file, "II*\0\10\0\0\0", 8);
    put_number(&file, ENTRIES, 2, false);
    for (int i = 0; i < ENTRIES; i++) {
        put_number(&file, entry[i][0], 2, false);
        put_number(&file, 4, 2, false);
        put_number(&file, 1, 4, false);
        put_number(&file, entry[i][1], 4, false);
    }
    put_number(&file, 0, 4, false);
    for (int i = 0; i < 256 * ROWS; i++) {
        uint32_t value = kind.photometric ? (uint32_t)i % 256 : 255 - (uint32_t)i % 256;
        put_number(&file, kind.bits == 16 ? 257 * value : value, kind.bits / 8, false);
    }
    file.count -= kind.missing;
    save(&file, path);
}

static void white_is_one_whether_it_is_written_as_zero_or_not(void **state)
{
    (void)state;
    for (uint16_t bits = 8; bits <= 16; bits = (uint16_t)(bits + 8)) {
        for (uint16_t photometric = 0; photometric < 2; photometric++) {
            weft_image image;
            weft_error error = {0};
            write_tiff("a.tif", (tiff_kind){photometric, bits, 0});
            if (weft_image_read("a.tif", &image, NULL, &error) != WEFT_OK)
                fail_msg("%s", error.message);
            for (int i = 0; i < 3 * 256; i++)
                assert_float_equal(image.pixels[i], (double)(i / 3) / 255, 1e-6);
            weft_image_free(&image);
        }
    }
}

static void a_tiff_that_ends_too_early_is_refused(void **state)
{
    (void)state;
    for (size_t missing = 1; missing < 256 * 8; missing += 200) {
        write_tiff("a.tif", (tiff_kind){1, 8, missing});
        assert_refused("a.tif", "blocks of its pixels 1 are missing or end too early");
    }
    write_tiff("a.tif", (tiff_kind){1, 8, 256 * 8 + 20});
    assert_refused("a.tif", "ends too early");
}

/* ---- JPEG ---- */

static void a_jpeg_that_is_not_whole_is_refused(void **state)
{
    (void)state;
    const weft_camera_notes notes = {"M", "N", "2026:01:01 00:00:00", 1, 1, 8, 100, 50, 50};
    weft_image image;
    bytes file;
    assert_int_equal(weft_image_create(160, 120, &image, NULL), WEFT_OK);
    for (int i = 0; i < 3 * 160 * 120; i++)
        image.pixels[i] = (float)((i * 7919) % 256) / 255;
    assert_int_equal(weft_snapshot_write("a.jpg", &image, &notes, NULL), WEFT_OK);
    weft_image_free(&image);
    read_bytes("a.jpg", &file);
    size_t whole = file.count;
    for (size_t count = whole - 3; count > 3000; count = count * 3 / 4) {
        file.count = count;
        save(&file, "a.jpg");
        assert_refused("a.jpg", "not whole");
    }
    /* Clusters of a disk that were never written: the decoder does not notice. */
    weft_container container;
    weft_colour_tags tags = {0};
    for (size_t size = 256; size <= 512; size *= 2) {
        bytes zeroed = file;
        zeroed.count = whole;
        memset(zeroed.data + whole / 2, 0, size);
        save(&zeroed, "a.jpg");
        assert_int_equal(weft_container_read("a.jpg", &container, &tags, NULL), WEFT_DAMAGED);
        assert_refused("a.jpg", "replaced by zeros");
    }
    /* Scans that say nothing, each of which a decoder would go through. */
    bytes many = {.count = 0};
    put(&many, "\xff\xd8\xff\xc2\0\13\10\20\0\20\0\1\1\21\0", 15);
    for (int i = 0; i < 500; i++)
        put(&many, "\xff\xda\0\10\1\1\0\1\5\0\x7f", 11);
    put(&many, "\xff\xd9", 2);
    save(&many, "many.jpg");
    assert_refused("many.jpg", "more scans");
    /* The end alone, and the data cut out before it. */
    memcpy(file.data + whole / 2, file.data + whole - 2, 2);
    file.count = whole / 2 + 2;
    save(&file, "a.jpg");
    assert_refused("a.jpg", "not whole");
}

/* Tables that were made for one picture give its commonest symbols codes of zeros: then a flat area is a run of them.
 */
static void a_flat_area_is_no_damage(void **state)
{
    (void)state;
    enum { BLOCKS = 64 * 64 };
    static const uint8_t one[1] = {1}, zeros[2 * BLOCKS / 8];
    bytes file = {.count = 0};
    weft_image image;
    weft_error error = {0};
    put(&file, "\xff\xd8\xff\xdb\0\103\0", 7);
    for (int i = 0; i < 64; i++)
        put(&file, one, 1);
    put(&file, "\xff\xc0\0\13\10\2\0\2\0\1\1\21\0", 13);
    for (int class = 0; class < 2; class ++) {
        const uint8_t table[5 + 16 + 1] = {0xff, 0xc4, 0, 20, (uint8_t)(16 * class), 1};
        put(&file, table, sizeof table);
    }
    put(&file, "\xff\xda\0\10\1\1\0\0\77\0", 10);
    put(&file, zeros, sizeof zeros);
    put(&file, "\xff\xd9", 2);
    save(&file, "flat.jpg");
    if (weft_image_read("flat.jpg", &image, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_true(image.width == 512 && image.height == 512);
    for (int i = 0; i < 3 * 512 * 512; i++)
        assert_float_equal(image.pixels[i], 128 / 255.0, 1e-6);
    weft_image_free(&image);
}

int test_container(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_png_that_ends_too_early_is_refused),
        cmocka_unit_test(every_damaged_byte_of_pixels_is_found),
        cmocka_unit_test(a_picture_larger_than_its_file_can_hold_is_refused),
        cmocka_unit_test(colours_of_png_count_in_the_order_of_its_standard),
        cmocka_unit_test(primaries_of_srgb_change_nothing),
        cmocka_unit_test(sixteen_bits_of_srgb_have_a_tone_curve),
        cmocka_unit_test(code_points_name_curves),
        cmocka_unit_test(colours_of_heif_are_those_of_its_picture),
        cmocka_unit_test(a_heif_that_ends_too_early_is_refused),
        cmocka_unit_test(white_is_one_whether_it_is_written_as_zero_or_not),
        cmocka_unit_test(a_tiff_that_ends_too_early_is_refused),
        cmocka_unit_test(a_jpeg_that_is_not_whole_is_refused),
        cmocka_unit_test(a_flat_area_is_no_damage),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
