/* The list of what a folder holds for a window: its order, what is left out, and the way up and down. */
#include "tests/support/cmocka_all.h"

#include "player/window/files.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *name_of(const weft_folder_files *files, int place)
{
    assert_true(place < files->count);
    return strrchr(files->path[place], '/') + 1;
}

static void read_list(weft_folder_files *files, const char *folder)
{
    weft_error error = {0};
    expect_ok(weft_folder_files_read(files, folder, &error), &error);
}

static void folders_come_first_and_only_what_can_be_opened_is_listed(void **state)
{
    (void)state;
    weft_folder_files files = {0};
    mkdir("beta", 0700), mkdir("alpha.weft", 0700), mkdir(".hidden", 0700);
    const char *const names[] = {"z.weft", "a.btf.h5", "m.wv", "notes.txt", ".b.weft", ".weft", "c.h5"};
    for (int i = 0; i < 7; i++)
        scratch_store(names[i], "x", 1);
    read_list(&files, ".");
    assert_int_equal(files.folder_count, 3);
    assert_string_equal(name_of(&files, 1), "alpha.weft");
    assert_string_equal(name_of(&files, 2), "beta");
    assert_int_equal(files.count, 6);
    assert_string_equal(name_of(&files, 3), "a.btf.h5");
    assert_string_equal(name_of(&files, 4), "m.wv");
    assert_string_equal(name_of(&files, 5), "z.weft");
    weft_folder_files_free(&files);
}

static void one_can_go_down_and_up_again(void **state)
{
    (void)state;
    weft_folder_files files = {0};
    char here[PATH_MAX];
    mkdir("down", 0700);
    assert_non_null(getcwd(here, sizeof here));
    read_list(&files, "down");
    assert_int_equal(files.count, 1);
    assert_string_equal(files.path[0], here);
    read_list(&files, files.path[0]);
    assert_string_equal(files.folder, here);
    read_list(&files, "/");
    assert_string_equal(files.path[0], "/");
    assert_true(files.count > 1 && files.path[1][0] == '/' && files.path[1][1] != '/');
    read_list(&files, "absent");
    assert_int_equal(files.count, 0);
    weft_folder_files_free(&files);
}

static void a_crowded_folder_is_cut(void **state)
{
    (void)state;
    weft_folder_files files = {0};
    char name[32];
    mkdir("crowd", 0700);
    for (int i = 0; i < WEFT_FOLDER_FILES_MOST + 5; i++) {
        snprintf(name, sizeof name, "crowd/%04d.weft", i);
        scratch_store(name, "x", 1);
    }
    read_list(&files, "crowd");
    assert_int_equal(files.count, WEFT_FOLDER_FILES_MOST);
    assert_true(files.has_more);
    weft_folder_files_free(&files);
}

int test_folder_files(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folders_come_first_and_only_what_can_be_opened_is_listed),
        cmocka_unit_test(one_can_go_down_and_up_again),
        cmocka_unit_test(a_crowded_folder_is_cut),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
