/* EXR files of other programs: components, channels of other names, and a stored rectangle that is not the shown one.
 * Their bytes are written here, after the description of the format, not by the library that reads them. */
#include "base/atomic_file.h"
#include "base/picture/image.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char path[] = "test_exr.exr";

typedef struct bytes {
    uint8_t data[4096];
    size_t count;
} bytes;

static void put(bytes *file, const void *data, size_t count)
{
    assert_true(file->count + count <= sizeof file->data);
    memcpy(file->data + file->count, data, count);
    file->count += count;
}

static void put_text(bytes *file, const char *text)
{
    put(file, text, strlen(text) + 1);
}

static void put_whole(bytes *file, int32_t value)
{
    put(file, &value, sizeof value);
}

/* Name, type and size of an attribute; its value follows. */
static void put_attribute(bytes *file, const char *name, const char *type, int size)
{
    put_text(file, name);
    put_text(file, type);
    put_whole(file, size);
}

/* Columns and rows from the first to the last. */
typedef struct window {
    int left, top, right, bottom;
} window;

static void put_window(bytes *file, const char *name, window w)
{
    put_attribute(file, name, "box2i", 16);
    const int side[] = {w.left, w.top, w.right, w.bottom};
    for (int i = 0; i < 4; i++)
        put_whole(file, side[i]);
}

static void put_channels(bytes *file, int count, const char *const names[])
{
    int size = 1;
    for (int i = 0; i < count; i++)
        size += (int)strlen(names[i]) + 1 + 16;
    put_attribute(file, "channels", "chlist", size);
    for (int i = 0; i < count; i++) {
        put_text(file, names[i]);
        put_whole(file, 2); /* 32-bit floats */
        put_whole(file, 0);
        put_whole(file, 1);
        put_whole(file, 1);
    }
    put(file, "", 1);
}

static void put_byte_attribute(bytes *file, const char *name, const char *type)
{
    put_attribute(file, name, type, 1);
    put(file, "", 1);
}

static void put_header(bytes *file, int count, const char *const names[], window stored, window shown)
{
    const float one = 1, centre[2] = {0, 0};
    put_whole(file, 20000630);
    put_whole(file, 2);
    put_channels(file, count, names);
    put_byte_attribute(file, "compression", "compression");
    put_window(file, "dataWindow", stored);
    put_window(file, "displayWindow", shown);
    put_byte_attribute(file, "lineOrder", "lineOrder");
    put_attribute(file, "pixelAspectRatio", "float", 4);
    put(file, &one, 4);
    put_attribute(file, "screenWindowCenter", "v2f", 8);
    put(file, centre, 8);
    put_attribute(file, "screenWindowWidth", "float", 4);
    put(file, &one, 4);
    put(file, "", 1);
}

/* What the channel of that index holds at a pixel, in the coordinates of both windows. */
static float value_at(int channel, int x, int y)
{
    return (float)(100 * channel + 10 * (y + 5) + (x + 5));
}

/* Channels have to be in the order of the alphabet. */
static void write_exr(int count, const char *const names[], window stored, window shown)
{
    bytes file = {.count = 0};
    put_header(&file, count, names, stored, shown);
    int width = stored.right - stored.left + 1, rows = stored.bottom - stored.top + 1;
    int64_t row_bytes = 8 + 4 * (int64_t)count * width;
    for (int row = 0; row < rows; row++) {
        int64_t offset = (int64_t)file.count + 8 * (rows - row) + row * row_bytes;
        put(&file, &offset, sizeof offset);
    }
    for (int y = stored.top; y <= stored.bottom; y++) {
        put_whole(&file, y);
        put_whole(&file, 4 * count * width);
        for (int channel = 0; channel < count; channel++) {
            for (int x = stored.left; x <= stored.right; x++) {
                float value = value_at(channel, x, y);
                put(&file, &value, sizeof value);
            }
        }
    }
    assert_int_equal(weft_write_file(path, file.data, file.count, NULL), WEFT_OK);
}

static const window small = {0, 0, 2, 1};

static weft_image read_exr(void)
{
    weft_image image;
    weft_image_kind kind;
    weft_error error = {0};
    if (weft_image_read(path, &image, &kind, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(kind, WEFT_IMAGE_FLOAT);
    unlink(path);
    return image;
}

/* That red, green and blue are these channels. */
static void assert_colour(int red, int green, int blue)
{
    const int channel[3] = {red, green, blue};
    weft_image image = read_exr();
    assert_int_equal(image.width, 3);
    assert_int_equal(image.height, 2);
    for (int i = 0; i < 3 * 3 * 2; i++)
        assert_float_equal(image.pixels[i], value_at(channel[i % 3], i / 3 % 3, i / 9), 0);
    weft_image_free(&image);
}

static void assert_refused(const char *reason)
{
    weft_image image;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_image_read(path, &image, NULL, &error)), WEFT_BAD_INPUT);
    if (!strstr(error.message, reason) || !strstr(error.message, path))
        fail_msg("'%s' does not say '%s' or not of which file", error.message, reason);
    unlink(path);
}

static void colours_are_found_by_their_names(void **state)
{
    (void)state;
    write_exr(4, (const char *const[]){"A", "B", "G", "R"}, small, small);
    assert_colour(3, 2, 1);
    write_exr(3, (const char *const[]){"blue", "green", "red"}, small, small);
    assert_colour(2, 1, 0);
    write_exr(1, (const char *const[]){"Y"}, small, small);
    assert_colour(0, 0, 0);
    write_exr(2, (const char *const[]){"A", "Y"}, small, small);
    assert_colour(1, 1, 1);
    write_exr(2, (const char *const[]){"left.Y", "left.Z"}, small, small);
    assert_colour(0, 0, 0);
}

static void the_picture_is_what_no_layer_holds(void **state)
{
    (void)state;
    write_exr(6, (const char *const[]){"B", "G", "R", "albedo.B", "albedo.G", "albedo.R"}, small, small);
    assert_colour(2, 1, 0);
    write_exr(7, (const char *const[]){"Aux.B", "Aux.G", "Aux.R", "B", "G", "R", "Z"}, small, small);
    assert_colour(5, 4, 3);
}

static void the_only_layer_is_the_picture(void **state)
{
    (void)state;
    write_exr(4, (const char *const[]){"beauty.B", "beauty.G", "beauty.R", "depth.Z"}, small, small);
    assert_colour(2, 1, 0);
}

static void what_is_no_picture_is_refused_and_named(void **state)
{
    (void)state;
    write_exr(6, (const char *const[]){"diffuse.B", "diffuse.G", "diffuse.R", "gloss.B", "gloss.G", "gloss.R"}, small,
              small);
    assert_refused("gloss.R");
    write_exr(3, (const char *const[]){"N.X", "N.Y", "N.Z"}, small, small);
    assert_refused("N.X, N.Y, N.Z");
    write_exr(3, (const char *const[]){"B", "G", "Z"}, small, small);
    assert_refused("no channels R, G, B");
    write_exr(1, (const char *const[]){"Z"}, small, small);
    assert_refused("nor a grey one: Z");
    write_exr(2, (const char *const[]){"N.X", "N.Y"}, small, small);
    assert_refused("nor a grey one: N.X, N.Y");
}

static void what_is_shown_counts_not_what_is_stored(void **state)
{
    (void)state;
    static const char *const names[] = {"B", "G", "R"};
    const window shown = {-2, -1, 3, 2};
    const window stored[] = {{-1, 0, 1, 1}, {-4, -3, 5, 4}, {-4, 0, 0, 4}, {-2, -1, 3, 2}};
    for (int i = 0; i < 4; i++) {
        window s = stored[i];
        write_exr(3, names, s, shown);
        weft_image image = read_exr();
        assert_int_equal(image.width, 6);
        assert_int_equal(image.height, 4);
        for (int at = 0; at < 6 * 4; at++) {
            int x = at % 6 + shown.left, y = at / 6 + shown.top;
            bool is_stored = x >= s.left && x <= s.right && y >= s.top && y <= s.bottom;
            for (int c = 0; c < 3; c++) {
                if (is_stored)
                    assert_float_equal(image.pixels[3 * at + c], value_at(2 - c, x, y), 0);
                else
                    assert_true(isnan(image.pixels[3 * at + c]));
            }
        }
        assert_int_equal(image.is_partial, i == 0 || i == 2);
        weft_image_free(&image);
    }
    write_exr(3, names, small, (window){0, 0, 1 << 20, 1 << 20});
    assert_refused("display window");
}

/* As far apart as the library lets them be: nothing of what is stored is shown. */
static void windows_that_do_not_overlap_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"B", "G", "R"};
    const int far = 1073741815;
    write_exr(3, names, (window){far, 0, far + 5, 1}, (window){-far, 0, -far + 2, 1});
    assert_refused("do not overlap");
    write_exr(3, names, (window){4, 3, 6, 6}, (window){-2, -1, 3, 2});
    assert_refused("do not overlap");
}

/* A size that runs beyond the file is not believed, whatever else the header says. */
static void a_header_that_ends_too_early_is_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"B", "G", "R"};
    bytes file = {.count = 0};
    put_header(&file, 3, names, small, small);
    for (size_t count = 9; count < file.count; count += 7) {
        assert_int_equal(weft_write_file(path, file.data, count, NULL), WEFT_OK);
        assert_refused("ends too early");
    }
    /* Of many parts: the second header counts, too. */
    bytes parts = file;
    parts.data[5] |= 16;
    put_attribute(&parts, "comments", "string", 0x7fffffff);
    assert_int_equal(weft_write_file(path, parts.data, parts.count, NULL), WEFT_OK);
    assert_refused("header ends too early");
    const uint32_t large = 0x7fffffff;
    memcpy(file.data + 8 + strlen("channels") + 1 + strlen("chlist") + 1, &large, 4);
    assert_int_equal(weft_write_file(path, file.data, file.count, NULL), WEFT_OK);
    assert_refused("header ends too early");
}

static void deep_images_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"B", "G", "R"};
    bytes file = {.count = 0};
    put_header(&file, 3, names, small, small);
    file.data[5] |= 8;
    assert_int_equal(weft_write_file(path, file.data, file.count, NULL), WEFT_OK);
    assert_refused("deep OpenEXR");
}

int test_exr(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_are_found_by_their_names),
        cmocka_unit_test(the_picture_is_what_no_layer_holds),
        cmocka_unit_test(the_only_layer_is_the_picture),
        cmocka_unit_test(what_is_no_picture_is_refused_and_named),
        cmocka_unit_test(what_is_shown_counts_not_what_is_stored),
        cmocka_unit_test(windows_that_do_not_overlap_are_refused),
        cmocka_unit_test(a_header_that_ends_too_early_is_refused),
        cmocka_unit_test(deep_images_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
