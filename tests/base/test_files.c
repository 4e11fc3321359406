/* Atomic files and the image bridge: what is written is whole or absent. */
#include "base/atomic_file.h"
#include "base/picture/image.h"

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char start[4096];
static char folder[] = "files-XXXXXX";

static int enter_scratch(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    return getcwd(start, sizeof start) && mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int leave_scratch(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return chdir(start) == 0 ? system(command) : -1;
}

static int entries_in_folder(void)
{
    int count = 0;
    DIR *listing = opendir(".");
    for (struct dirent *entry; (entry = readdir(listing));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(listing);
    return count;
}

static weft_code with_file_limit(rlim_t bytes, weft_code (*action)(weft_error *error), weft_error *error)
{
    struct rlimit before, small;
    getrlimit(RLIMIT_FSIZE, &before);
    small = (struct rlimit){bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    weft_code code = action(error);
    setrlimit(RLIMIT_FSIZE, &before);
    return code;
}

static char many_bytes[100000];

static weft_code write_many_bytes(weft_error *error)
{
    return weft_write_file("data.bin", many_bytes, sizeof many_bytes, error);
}

static const char *picture;

static weft_code write_picture(weft_error *error)
{
    weft_image image;
    WEFT_TRY(weft_image_create(200, 200, &image, error));
    for (int i = 0; i < 200 * 200 * 3; i++)
        image.pixels[i] = (float)(rand() % 1000) / 1000;
    weft_code code = weft_image_write(picture, &image, NULL, error);
    weft_image_free(&image);
    return code;
}

static void full_disk_leaves_the_old_file_and_no_other(void **state)
{
    (void)state;
    weft_error error = {0};
    assert_int_equal(weft_write_file("data.bin", "old", 3, &error), WEFT_OK);
    int before = entries_in_folder();
    assert_int_equal(with_file_limit(5000, write_many_bytes, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "data.bin"));
    static const char *pictures[] = {"picture.exr", "picture.png", "picture.tif"};
    for (size_t i = 0; i < sizeof pictures / sizeof pictures[0]; i++) {
        picture = pictures[i];
        assert_int_equal(with_file_limit(5000, write_picture, &error), WEFT_SYSTEM);
        assert_non_null(strstr(error.message, picture));
    }
    assert_int_equal(entries_in_folder(), before);
    char *bytes;
    size_t size;
    assert_int_equal(weft_read_file("data.bin", 100, &bytes, &size, &error), WEFT_OK);
    assert_string_equal(bytes, "old");
    free(bytes);
}

static mode_t mode_of(const char *path)
{
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return status.st_mode & 07777;
}

static void a_replaced_file_keeps_its_permissions(void **state)
{
    (void)state;
    weft_error error = {0};
    mode_t before = umask(027);
    assert_int_equal(weft_write_file("own.bin", "new", 3, &error), WEFT_OK);
    assert_int_equal(mode_of("own.bin"), 0640);
    static const mode_t modes[] = {0600, 0664, 0666, 0444, 0755};
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        assert_int_equal(chmod("own.bin", modes[i]), 0);
        assert_int_equal(weft_write_file("own.bin", "again", 5, &error), WEFT_OK);
        assert_int_equal(mode_of("own.bin"), modes[i]);
    }
    umask(before);
    assert_int_equal(unlink("own.bin"), 0);
}

static void impossible_places_are_named(void **state)
{
    (void)state;
    weft_error error = {0};
    assert_int_equal(weft_write_file("no/such/folder/file", "x", 1, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "no/such/folder"));
    assert_int_equal(weft_write_file(".", "x", 1, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_write_file("", "x", 1, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_write_file("absent/", "x", 1, &error), WEFT_BAD_USAGE);
    char *bytes;
    size_t size;
    assert_int_equal(weft_read_file("absent", 100, &bytes, &size, &error), WEFT_MISSING);
    assert_int_equal(weft_read_file(".", 100, &bytes, &size, &error), WEFT_BAD_INPUT);
    assert_int_equal(weft_write_file("long", many_bytes, 101, &error), WEFT_OK);
    assert_int_equal(weft_read_file("long", 100, &bytes, &size, &error), WEFT_BAD_INPUT);
}

static void a_pipe_or_device_is_not_replaced_by_a_file(void **state)
{
    (void)state;
    weft_error error = {0};
    struct stat status;
    assert_int_equal(mkfifo("pipe", 0600), 0);
    assert_int_equal(symlink("pipe", "link"), 0);
    assert_int_equal(weft_write_file("pipe", "x", 1, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_write_file("link", "x", 1, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "not a regular file"));
    assert_true(stat("link", &status) == 0 && S_ISFIFO(status.st_mode));
}

static void a_link_stays_and_what_it_points_to_is_replaced(void **state)
{
    (void)state;
    char *bytes;
    size_t size;
    struct stat status;
    assert_int_equal(weft_write_file("pointed", "old", 3, NULL), WEFT_OK);
    assert_int_equal(symlink("pointed", "pointing"), 0);
    assert_int_equal(weft_write_file("pointing", "newer", 5, NULL), WEFT_OK);
    assert_true(lstat("pointing", &status) == 0 && S_ISLNK(status.st_mode));
    assert_int_equal(weft_read_file("pointed", 100, &bytes, &size, NULL), WEFT_OK);
    assert_string_equal(bytes, "newer");
    free(bytes);
}

static void folders_are_made_with_their_parents(void **state)
{
    (void)state;
    weft_error error = {0};
    assert_int_equal(weft_make_folder("a/b/c", &error), WEFT_OK);
    assert_int_equal(weft_make_folder("a/b/c", &error), WEFT_OK);
    assert_int_equal(weft_write_file("a/b/c/file", "x", 1, &error), WEFT_OK);
    assert_int_equal(weft_make_folder("a/b/c/file", &error), WEFT_SYSTEM);
}

static void photograph_keeps_every_raw_value_of_every_depth(void **state)
{
    (void)state;
    enum { WIDTH = 67, HEIGHT = 41, COUNT = WIDTH * HEIGHT * 3 };
    static uint16_t written[COUNT], read[COUNT];
    static const int depths[] = {10, 12, 14, 16};
    for (size_t d = 0; d < sizeof depths / sizeof depths[0]; d++) {
        weft_error error = {0};
        for (int i = 0; i < COUNT; i++)
            written[i] = (uint16_t)((unsigned)i * 40503u & ((1u << depths[d]) - 1));
        assert_int_equal(weft_photograph_write("p.tif", WIDTH, HEIGHT, depths[d], written, &error), WEFT_OK);
        assert_int_equal(weft_photograph_read("p.tif", WIDTH, HEIGHT, depths[d], read, &error), WEFT_OK);
        assert_memory_equal(read, written, sizeof read);
    }
}

static void bad_photographs_are_named(void **state)
{
    (void)state;
    static uint16_t samples[64 * 64 * 3];
    weft_error error = {0};
    assert_int_equal(weft_photograph_write("q.tif", 64, 64, 12, samples, &error), WEFT_OK);
    assert_int_equal(weft_photograph_read("q.tif", 64, 63, 12, samples, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "64 x 64"));
    assert_int_equal(weft_photograph_read("absent.tif", 64, 64, 12, samples, &error), WEFT_MISSING);
    assert_non_null(strstr(error.message, "absent.tif"));
    char *bytes;
    size_t size;
    assert_int_equal(weft_read_file("q.tif", 1 << 20, &bytes, &size, &error), WEFT_OK);
    for (size_t length = 0; length < size; length += size / 13) {
        assert_int_equal(weft_write_file("cut.tif", bytes, length, &error), WEFT_OK);
        assert_int_equal(weft_photograph_read("cut.tif", 64, 64, 12, samples, &error), WEFT_DAMAGED);
        assert_non_null(strstr(error.message, "cut.tif"));
    }
    free(bytes);
}

static void images_survive_the_round_trip(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        float tolerance;
        weft_image_kind kind;
    } formats[] = {
        {"i.png", 0.5f / 255, WEFT_IMAGE_INTEGER}, {"i.exr", 5e-4f, WEFT_IMAGE_FLOAT}, {"i.tif", 0, WEFT_IMAGE_FLOAT}};
    weft_error error = {0};
    weft_image written, read;
    assert_int_equal(weft_image_create(17, 9, &written, &error), WEFT_OK);
    for (int i = 0; i < 17 * 9 * 3; i++)
        written.pixels[i] = (float)(i % 101) / 100;
    for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++) {
        weft_image_kind kind;
        assert_int_equal(weft_image_write(formats[f].name, &written, "settings", &error), WEFT_OK);
        assert_int_equal(weft_image_read(formats[f].name, &read, &kind, &error), WEFT_OK);
        assert_int_equal(kind, formats[f].kind);
        assert_true(read.width == 17 && read.height == 9);
        for (int i = 0; i < 17 * 9 * 3; i++)
            assert_true(fabsf(read.pixels[i] - written.pixels[i]) <= formats[f].tolerance * 1.001f);
        weft_image_free(&read);
    }
    weft_image_free(&written);
}

static void a_png_is_rounded_clamped_and_black_where_there_is_no_number(void **state)
{
    (void)state;
    static const float given[] = {NAN,           -INFINITY,     -1, 0.49F / 255, 0.51F / 255,
                                  254.49F / 255, 254.51F / 255, 2,  INFINITY};
    static const float wanted[] = {0, 0, 0, 0, 1, 254, 255, 255, 255};
    weft_image written, read;
    weft_image_kind kind;
    assert_int_equal(weft_image_create(3, 1, &written, NULL), WEFT_OK);
    memcpy(written.pixels, given, sizeof given);
    assert_int_equal(weft_image_write("edges.PNG", &written, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_image_read("edges.PNG", &read, &kind, NULL), WEFT_OK);
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        assert_true(fabsf(255 * read.pixels[i] - wanted[i]) < 1e-3F);
    weft_image_free(&read);
    weft_image_free(&written);
}

/* The reader of the texts is another library. */
static void a_png_keeps_its_text(void **state)
{
    (void)state;
    static const char text[] = "{\n \"version\": 1\n}";
    weft_image written;
    char *settings;
    assert_int_equal(weft_image_create(3, 1, &written, NULL), WEFT_OK);
    assert_int_equal(weft_image_write_settings("text.png", &written, "radiance", text, NULL), WEFT_OK);
    assert_int_equal(weft_image_read_settings("text.png", &settings, NULL), WEFT_OK);
    assert_string_equal(settings, text);
    free(settings);
    weft_image_free(&written);
}

static void the_size_of_a_file_is_0_where_there_is_none(void **state)
{
    (void)state;
    assert_int_equal(weft_write_file("sized", "1234567", 7, NULL), WEFT_OK);
    assert_int_equal(weft_file_bytes("sized"), 7);
    assert_int_equal(weft_file_bytes("unsized"), 0);
}

static void a_file_is_the_same_under_another_name(void **state)
{
    (void)state;
    assert_int_equal(weft_write_file("one", "x", 1, NULL), WEFT_OK);
    assert_int_equal(weft_write_file("other", "x", 1, NULL), WEFT_OK);
    assert_int_equal(symlink("one", "another-name"), 0);
    assert_true(weft_is_same_file("one", "./another-name"));
    assert_false(weft_is_same_file("one", "other"));
    assert_false(weft_is_same_file("missing", "missing"));
}

int test_files(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_disk_leaves_the_old_file_and_no_other),
        cmocka_unit_test(a_replaced_file_keeps_its_permissions),
        cmocka_unit_test(impossible_places_are_named),
        cmocka_unit_test(a_pipe_or_device_is_not_replaced_by_a_file),
        cmocka_unit_test(a_link_stays_and_what_it_points_to_is_replaced),
        cmocka_unit_test(folders_are_made_with_their_parents),
        cmocka_unit_test(photograph_keeps_every_raw_value_of_every_depth),
        cmocka_unit_test(bad_photographs_are_named),
        cmocka_unit_test(images_survive_the_round_trip),
        cmocka_unit_test(a_png_is_rounded_clamped_and_black_where_there_is_no_number),
        cmocka_unit_test(a_png_keeps_its_text),
        cmocka_unit_test(the_size_of_a_file_is_0_where_there_is_none),
        cmocka_unit_test(a_file_is_the_same_under_another_name),
    };
    return cmocka_run_group_tests(tests, enter_scratch, leave_scratch);
}
