/* Camera raw comes as the sensor counted. A DNG is made by hand here, byte by byte: no program of this house writes
 * one. */
#include "base/picture/exif.h"
#include "base/picture/image.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 64, HEIGHT = 48, BLACK = 256, WHITE = 16383 };

/* Tags of TIFF (6.0) and DNG (1.4). */
enum { BYTE = 1, ASCII, SHORT, LONG, RATIONAL, SRATIONAL = 10 };
typedef struct tag {
    unsigned number, type, count;
    const void *value;
    size_t size;
} tag;

#define TAG(number, type, unit, ...)                                                                                   \
    {                                                                                                                  \
        number, type, sizeof((unit[]){__VA_ARGS__}) / (type == RATIONAL || type == SRATIONAL ? 8 : sizeof(unit)),      \
            (unit[]){__VA_ARGS__}, sizeof((unit[]){__VA_ARGS__})                                                       \
    }

static void put(FILE *file, unsigned value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        fputc((int)(value >> 8 * i & 255), file);
}

/* The ramp that the sensor saw, in counts above black. */
static double ramp(int x, int y)
{
    return 40 * x + 20 * y + 100;
}

static void write_dng(const char *path, double brightness)
{
    /* Neutral is (1/2, 1, 2/3): whoever balances the white shows it. */
    enum { EXIF_IFD = 34665, STRIP = 273 };
    const tag tags[] = {TAG(254, LONG, uint32_t, 0),
                        TAG(256, LONG, uint32_t, WIDTH),
                        TAG(257, LONG, uint32_t, HEIGHT),
                        TAG(258, SHORT, uint16_t, 16),
                        TAG(259, SHORT, uint16_t, 1),
                        TAG(262, SHORT, uint16_t, 32803),
                        TAG(271, ASCII, char, 'W', 'e', 'f', 't', 'y', 0),
                        TAG(272, ASCII, char, 'T', 'e', 's', 't', 'y', 0),
                        TAG(STRIP, LONG, uint32_t, 0),
                        TAG(274, SHORT, uint16_t, 1),
                        TAG(277, SHORT, uint16_t, 1),
                        TAG(278, LONG, uint32_t, HEIGHT),
                        TAG(279, LONG, uint32_t, WIDTH * HEIGHT * 2),
                        TAG(284, SHORT, uint16_t, 1),
                        TAG(33421, SHORT, uint16_t, 2, 2),
                        TAG(33422, BYTE, uint8_t, 0, 1, 1, 2),
                        TAG(EXIF_IFD, LONG, uint32_t, 0),
                        TAG(50706, BYTE, uint8_t, 1, 4, 0, 0),
                        TAG(50707, BYTE, uint8_t, 1, 1, 0, 0),
                        TAG(50708, ASCII, char, 'W', 'e', 'f', 't', 'y', 0),
                        TAG(50714, SHORT, uint16_t, BLACK),
                        TAG(50717, SHORT, uint16_t, WHITE),
                        TAG(50721, SRATIONAL, int32_t, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1),
                        TAG(50728, RATIONAL, uint32_t, 1, 2, 1, 1, 2, 3),
                        TAG(50778, SHORT, uint16_t, 21)};
    const unsigned count = sizeof tags / sizeof *tags;
    unsigned data = 8 + 2 + 12 * count + 4, exif = data;
    for (unsigned i = 0; i < count; i++)
        exif += tags[i].size > 4 ? (unsigned)tags[i].size : 0;
    unsigned strip = exif + 2 + 12 + 4 + 8;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fwrite("II*\0\10\0\0\0", 1, 8, file);
    put(file, count, 2);
    for (unsigned i = 0; i < count; i++) {
        put(file, tags[i].number, 2);
        put(file, tags[i].type, 2);
        put(file, tags[i].count, 4);
        unsigned char inside[4] = {0};
        if (tags[i].number == STRIP || tags[i].number == EXIF_IFD) {
            put(file, tags[i].number == STRIP ? strip : exif, 4);
        } else if (tags[i].size > 4) {
            put(file, data, 4);
            data += (unsigned)tags[i].size;
        } else {
            memcpy(inside, tags[i].value, tags[i].size);
            fwrite(inside, 1, 4, file);
        }
    }
    put(file, 0, 4);
    for (unsigned i = 0; i < count; i++)
        fwrite(tags[i].value, 1, tags[i].size > 4 ? tags[i].size : 0, file);
    put(file, 1, 2);
    put(file, 33434, 2); /* exposure: 1/8 s */
    put(file, RATIONAL, 2);
    put(file, 1, 4);
    put(file, exif + 18, 4);
    put(file, 0, 4);
    put(file, 125, 4);
    put(file, 1000, 4);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double counts = BLACK + brightness * ramp(i % WIDTH, i / WIDTH);
        put(file, (unsigned)(counts < WHITE ? counts : WHITE), 2);
    }
    fclose(file);
}

static void raw_values_are_linear_and_as_the_sensor_counted(void **state)
{
    (void)state;
    for (double brightness = 1; brightness < 5; brightness *= 2) {
        weft_image image;
        weft_image_kind kind;
        weft_error error = {0};
        write_dng("picture.dng", brightness);
        if (weft_image_read("picture.dng", &image, &kind, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_int_equal(kind, WEFT_IMAGE_FLOAT);
        assert_true(image.width == WIDTH && image.height == HEIGHT);
        for (int y = 8; y < HEIGHT - 8; y++) {
            for (int x = 8; x < WIDTH - 8; x++) {
                double counts = fmin(brightness * ramp(x, y) / (WHITE - BLACK), 1);
                for (int k = 0; k < 3; k++)
                    assert_float_equal(image.pixels[3 * (y * WIDTH + x) + k], counts, 2e-3);
            }
        }
        weft_image_free(&image);
    }
}

static void a_raw_file_says_how_long_it_was_exposed(void **state)
{
    (void)state;
    weft_exif exif;
    write_dng("picture.dng", 1);
    assert_int_equal(weft_exif_read("picture.dng", &exif, NULL), WEFT_OK);
    assert_float_equal(exif.exposure_s, 0.125, 1e-6);
    assert_true(exif.is_linear && !exif.is_float);
}

static void assert_refused(const char *path, const char *reason)
{
    weft_image image;
    weft_error error = {0};
    assert_int_equal(weft_image_read(path, &image, NULL, &error), WEFT_DAMAGED);
    if (!strstr(error.message, reason))
        fail_msg("'%s' does not say '%s'", error.message, reason);
}

/* Programs that share the notes of a camera keep the file and drop what the sensor counted. */
static void raw_files_without_their_pixels_are_no_photographs(void **state)
{
    (void)state;
    write_dng("picture.dng", 1);
    assert_int_equal(truncate("picture.dng", 600), 0);
    assert_refused("picture.dng", "of 1 blocks of its pixels 1 are missing or end too early");
    write_dng("picture.dng", 1);
    assert_int_equal(truncate("picture.dng", WIDTH * HEIGHT * 2), 0);
    assert_refused("picture.dng", "end too early");
    write_dng("picture.dng", 1);
    FILE *file = fopen("picture.dng", "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, -WIDTH * HEIGHT * 2, SEEK_END), 0);
    for (int i = 0; i < WIDTH * HEIGHT * 2; i++)
        fputc(0, file);
    fclose(file);
    assert_refused("picture.dng", "holds no values of a sensor");
    write_dng("picture.dng", 0);
    assert_refused("picture.dng", "of its 48 rows hold nothing");
    write_dng("picture.dng", 1e4);
    assert_refused("picture.dng", "the same value everywhere");
}

/* The reader of TIFF would show the values of the filters as grey. */
static void a_raw_file_is_one_whatever_its_name(void **state)
{
    (void)state;
    weft_exif exif;
    write_dng("picture.tif", 1);
    assert_int_equal(weft_exif_read("picture.tif", &exif, NULL), WEFT_OK);
    assert_true(exif.is_linear && !exif.is_float);
}

static void a_jpeg_is_one_whatever_its_name(void **state)
{
    (void)state;
    static const char *const name[] = {"picture.nef", "picture.dng", "picture.cr2"};
    const weft_camera_notes notes = {"M", "N", "2026:01:01 00:00:00", 1, 1, 8, 100, 50, 50};
    weft_image image;
    assert_int_equal(weft_image_create(64, 48, &image, NULL), WEFT_OK);
    for (int i = 0; i < 3 * 64 * 48; i++)
        image.pixels[i] = (float)(i % 97) / 97;
    for (int i = 0; i < 3; i++) {
        weft_image read;
        weft_image_kind kind;
        weft_exif exif;
        assert_int_equal(weft_snapshot_write("picture.jpg", &image, &notes, NULL), WEFT_OK);
        assert_int_equal(rename("picture.jpg", name[i]), 0);
        assert_int_equal(weft_image_read(name[i], &read, &kind, NULL), WEFT_OK);
        assert_int_equal(kind, WEFT_IMAGE_INTEGER);
        assert_int_equal(weft_exif_read(name[i], &exif, NULL), WEFT_OK);
        assert_false(exif.is_linear);
        weft_image_free(&read);
    }
    weft_image_free(&image);
}

int test_camera_raw(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(raw_values_are_linear_and_as_the_sensor_counted),
        cmocka_unit_test(a_raw_file_says_how_long_it_was_exposed),
        cmocka_unit_test(raw_files_without_their_pixels_are_no_photographs),
        cmocka_unit_test(a_raw_file_is_one_whatever_its_name),
        cmocka_unit_test(a_jpeg_is_one_whatever_its_name),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
