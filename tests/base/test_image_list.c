/* Which files of a folder are photographs, and what is said where none is. */
#include "base/text/image_list.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void touch(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
}

static void images_are_listed_by_name_one_folder_deep(void **state)
{
    (void)state;
    assert_int_equal(mkdir("deep", 0755) + mkdir("deep/below", 0755) + mkdir("deep/below/lower", 0755), 0);
    const char *const file[] = {"b.JPG",       "e.HDR",    "f.HEIC", "d.bmp",       "a.nef",
                                ".hidden.jpg", "note.txt", "jpg",    "below/c.tif", "below/lower/d.jpg"};
    char path[64];
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        snprintf(path, sizeof path, "deep/%s", file[i]);
        touch(path);
    }
    weft_lines names;
    weft_error error = {0};
    expect_ok(weft_images_list("deep//", &names, &error), &error);
    static const char *const expected[] = {"a.nef", "b.JPG", "below/c.tif", "d.bmp", "e.HDR", "f.HEIC"};
    assert_int_equal(names.count, 6);
    for (int i = 0; i < names.count; i++)
        assert_string_equal(names.line[i], expected[i]);
    weft_lines_free(&names);
}

static void what_systems_leave_behind_is_no_photograph(void **state)
{
    (void)state;
    static const char *const folder[] = {"left",          "left/@eaDir",   "left/.thumbnails", "left/__MACOSX",
                                         "left/#recycle", "left/view@eaD", "left/$Recycle.bin"};
    static const char *const file[] = {"a.jpg",          "._a.jpg",           "Thumbs.db",      ".DS_Store",
                                       "@eaDir/a.jpg",   ".thumbnails/a.jpg", "__MACOSX/a.jpg", "#recycle/a.jpg",
                                       "view@eaD/b.jpg", "$Recycle.bin/a.jpg"};
    char path[64];
    for (size_t i = 0; i < sizeof folder / sizeof *folder; i++)
        assert_int_equal(mkdir(folder[i], 0755), 0);
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        snprintf(path, sizeof path, "left/%s", file[i]);
        touch(path);
    }
    /* A link that is broken is a photograph that was meant to be there. */
    assert_int_equal(symlink("nowhere", "left/to-nowhere.png"), 0);
    weft_lines names;
    weft_error error = {0};
    expect_ok(weft_images_list("left", &names, &error), &error);
    assert_int_equal(names.count, 3);
    assert_string_equal(names.line[0], "a.jpg");
    assert_string_equal(names.line[1], "to-nowhere.png");
    assert_string_equal(names.line[2], "view@eaD/b.jpg");
    weft_lines_free(&names);
}

static void assert_refused(weft_code code, const weft_error *error, const char *words)
{
    assert_int_equal(code, WEFT_BAD_INPUT);
    if (!strstr(error->message, words))
        fail_msg("'%s' does not say '%s'", error->message, words);
}

static void what_is_no_folder_is_refused(void **state)
{
    (void)state;
    weft_lines names;
    weft_error error = {0};
    touch("one.jpg");
    assert_refused(weft_images_list("one.jpg", &names, &error), &error, "'one.jpg' is a file, not a folder");
    assert_refused(weft_images_list("nowhere", &names, &error), &error, "cannot list 'nowhere'");
}

static void a_folder_without_images_is_described(void **state)
{
    (void)state;
    weft_error error = {0};
    assert_int_equal(mkdir("none", 0755), 0);
    assert_refused(weft_images_missing("none", &error), &error, "it is empty");
    touch("none/a.txt");
    assert_refused(weft_images_missing("none", &error), &error, "none of its 1 files has the name");
    touch("none/MVI_1.MOV");
    assert_refused(weft_images_missing("none", &error), &error, "1 of its 2 files are films");
}

int test_image_list(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_listed_by_name_one_folder_deep),
        cmocka_unit_test(what_systems_leave_behind_is_no_photograph),
        cmocka_unit_test(what_is_no_folder_is_refused),
        cmocka_unit_test(a_folder_without_images_is_described),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
