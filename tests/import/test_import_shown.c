/* Photographs are taken as a viewer shows them: turned by their Exif orientation, and as bright under alpha. */
#include "folder.h"

#include "base/atomic_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 3, HEIGHT = 2 };

/* What everybody sees: each pixel has a value of its own. */
static float shown(int x, int y, int channel)
{
    return 0.1f * (float)(1 + x + WIDTH * y) + 0.02f * (float)channel;
}

/* Exif 2.3, tag 274: the side of the picture that the first row of the file is, and that its first column is. */
typedef enum side { TOP, RIGHT, BOTTOM, LEFT } side;

static const side first_row[] = {TOP, TOP, BOTTOM, BOTTOM, LEFT, RIGHT, RIGHT, LEFT};
static const side first_column[] = {LEFT, RIGHT, RIGHT, LEFT, TOP, TOP, BOTTOM, BOTTOM};

/* Goes `distance` pixels inward from a side. */
static void go_in(side from, int distance, int *x, int *y)
{
    if (from == LEFT || from == RIGHT)
        *x = from == LEFT ? distance : WIDTH - 1 - distance;
    else
        *y = from == TOP ? distance : HEIGHT - 1 - distance;
}

static void put_turned(const test_folder *folder, const char *name, int orientation)
{
    side rows = first_row[orientation - 1], columns = first_column[orientation - 1];
    int width = rows == TOP || rows == BOTTOM ? WIDTH : HEIGHT;
    weft_image image;
    assert_int_equal(weft_image_create(width, WIDTH * HEIGHT / width, &image, NULL), WEFT_OK);
    for (int row = 0; row < image.height; row++) {
        for (int column = 0; column < image.width; column++) {
            int x = 0, y = 0;
            go_in(rows, row, &x, &y);
            go_in(columns, column, &x, &y);
            for (int c = 0; c < 3; c++)
                image.pixels[3 * (row * image.width + column) + c] = shown(x, y, c);
        }
    }
    const weft_camera_notes notes = {.make = "M",
                                     .model = "N",
                                     .date = "2026:01:01 00:00:00",
                                     .orientation = orientation,
                                     .exposure_s = 1,
                                     .f_number = 8,
                                     .iso = 100,
                                     .focal_length_mm = 50};
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    assert_int_equal(weft_snapshot_write(path, &image, &notes, NULL), WEFT_OK);
    weft_image_free(&image);
}

static void photographs_are_turned_as_they_are_shown(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    for (int orientation = 1; orientation <= 8; orientation++) {
        char name[64];
        snprintf(name, sizeof name, "tl%03d_pl000_tv000_pv000.tif", 5 * orientation);
        put_turned(&folder, name, orientation);
    }
    weft_import_options options = weft_import_defaults();
    options.linear = true;
    weft_error error = {0};
    if (folder_import(&folder, &options, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    imported import = folder_open(&folder);
    assert_int_equal(import.layout->width, WIDTH);
    assert_int_equal(import.layout->height, HEIGHT);
    for (int orientation = 1; orientation <= 8; orientation++) {
        int image = imported_image(&import, 5 * orientation, 0, 0, 0);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
            int x = i / 3 % WIDTH, y = i / 3 / WIDTH;
            assert_float_equal(imported_sample(&import, x, y, image, i % 3), shown(x, y, i % 3), 0.001);
        }
    }
    imported_close(&import);
    folder_remove(&folder);
}

/* A PNG of one pixel: 200, 100, 50 with alpha 51. */
static const uint8_t transparent_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0x1f, 0x15, 0xc4, 0x89, 0x00, 0x00, 0x00,
    0x0d, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x38, 0x91, 0x62, 0x64, 0x0c, 0x00, 0x04, 0xe8, 0x01, 0x92,
    0x11, 0x55, 0x90, 0x2b, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static void alpha_darkens_nothing(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    char path[128];
    snprintf(path, sizeof path, "%s/tl000_pl000_tv000_pv000.png", folder.path);
    assert_int_equal(weft_write_file(path, transparent_png, sizeof transparent_png, NULL), WEFT_OK);
    weft_import_options options = weft_import_defaults();
    options.linear = true;
    assert_int_equal(folder_import(&folder, &options, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    for (int c = 0; c < 3; c++)
        assert_float_equal(imported_sample(&import, 0, 0, 0, c), (200 >> c) / 255.0, 0.002);
    imported_close(&import);
    folder_remove(&folder);
}

/* Else the message would be that there is no list. */
static void a_list_of_what_is_not_there_is_named(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_text(&folder, "stones.lp", "2\na.psd 0 0 1\nb.psd 0.5 0 0.866\n");
    folder_put_text(&folder, "a.psd", "8BPS");
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "none of the 2 listed photographs"));
    assert_non_null(strstr(error.message, "'a.psd'"));
    assert_null(strstr(error.message, "nor an .lp file"));
    folder_remove(&folder);
}

int test_import_shown(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photographs_are_turned_as_they_are_shown),
        cmocka_unit_test(alpha_darkens_nothing),
        cmocka_unit_test(a_list_of_what_is_not_there_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
