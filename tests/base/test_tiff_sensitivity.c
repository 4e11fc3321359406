/* A TIFF as a camera's own program writes it, with the sensitivity where Exif has it. It is made by hand here, byte by
 * byte. */
#include "base/picture/exif.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { SHORT = 3, LONG = 4, SIDE = 16, PIXELS = SIDE * SIDE * 3, FILE_BYTES = 256 + PIXELS };

typedef struct bytes {
    unsigned char at[FILE_BYTES];
    size_t count;
    bool big_endian;
} bytes;

static void put(bytes *b, unsigned value, int count)
{
    for (int i = 0; i < count; i++)
        b->at[b->count++] = (unsigned char)(value >> 8 * (b->big_endian ? count - 1 - i : i));
}

static void put_entry(bytes *b, unsigned tag, unsigned type, unsigned value)
{
    put(b, tag, 2);
    put(b, type, 2);
    put(b, 1, 4);
    put(b, value, type == SHORT ? 2 : 4);
    if (type == SHORT)
        put(b, 0, 2);
}

static bytes make_tiff(bool big_endian, unsigned exif_at)
{
    enum { ENTRIES = 11, EXIF_AT = 8 + 2 + 12 * ENTRIES + 4, SAMPLES_AT = EXIF_AT + 2 + 12 * 2 + 4 };
    bytes b = {.big_endian = big_endian, .count = 2};
    memcpy(b.at, big_endian ? "MM" : "II", 2);
    put(&b, 42, 2);
    put(&b, 8, 4);
    put(&b, ENTRIES, 2);
    const unsigned entry[ENTRIES][3] = {{256, LONG, SIDE},
                                        {257, LONG, SIDE},
                                        {258, SHORT, 8},
                                        {259, SHORT, 1},
                                        {262, SHORT, 1},
                                        {273, LONG, SAMPLES_AT},
                                        {277, SHORT, 1},
                                        {278, LONG, SIDE},
                                        {279, LONG, SIDE * SIDE},
                                        {284, SHORT, 1},
                                        {34665, LONG, exif_at ? exif_at : EXIF_AT}};
    for (int i = 0; i < ENTRIES; i++)
        put_entry(&b, entry[i][0], entry[i][1], entry[i][2]);
    put(&b, 0, 4);
    put(&b, 2, 2);
    put_entry(&b, 34855, SHORT, 1250);
    put_entry(&b, 41989, SHORT, 39);
    put(&b, 0, 4);
    b.count += SIDE * SIDE;
    return b;
}

static void a_tiff_says_sensitivity_and_angle_of_view_in_either_byte_order(void **state)
{
    (void)state;
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        bytes b = make_tiff(big_endian, 0);
        weft_exif exif;
        scratch_store("picture.tif", b.at, b.count);
        assert_int_equal(weft_exif_read("picture.tif", &exif, NULL), WEFT_OK);
        assert_true(exif.iso == 1250);
        assert_true(exif.focal_length_35mm == 39);
    }
}

static void a_tiff_whose_exif_lies_beyond_its_end_says_none(void **state)
{
    (void)state;
    bytes b = make_tiff(false, 0x7ffffff0);
    weft_exif exif;
    scratch_store("picture.tif", b.at, b.count);
    assert_int_equal(weft_exif_read("picture.tif", &exif, NULL), WEFT_OK);
    assert_true(exif.iso == 0);
}

/* Then the entry holds the place of the values: no sensitivity, however like one it looks. */
static void a_sensitivity_that_lies_elsewhere_is_none(void **state)
{
    (void)state;
    enum { ENTRY_AT = 8 + 2 + 12 * 11 + 4 + 2, RATIONAL = 5 };
    static const struct {
        unsigned char type, count;
        double iso;
    } row[] = {{SHORT, 1, 1250}, {SHORT, 2, 1250}, {SHORT, 3, 0}, {LONG, 1, 1250}, {LONG, 2, 0}, {RATIONAL, 1, 0}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        bytes b = make_tiff(false, 0);
        b.at[ENTRY_AT + 2] = row[i].type;
        b.at[ENTRY_AT + 4] = row[i].count;
        scratch_store("picture.tif", b.at, b.count);
        weft_exif exif;
        assert_int_equal(weft_exif_read("picture.tif", &exif, NULL), WEFT_OK);
        assert_true(exif.iso == row[i].iso);
    }
}

int test_tiff_sensitivity(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tiff_says_sensitivity_and_angle_of_view_in_either_byte_order),
        cmocka_unit_test(a_tiff_whose_exif_lies_beyond_its_end_says_none),
        cmocka_unit_test(a_sensitivity_that_lies_elsewhere_is_none),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
