/* The list of files that windows showed last: its order, its length, and lists that are not one. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "player/window/recent_files.h"
#include "tests/support/scratch_folder.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char here[PATH_MAX];

static int enter(void **state)
{
    return scratch_folder_enter(state) || !getcwd(here, sizeof here) || setenv("XDG_STATE_HOME", here, 1);
}

static int forget(void **state)
{
    (void)state;
    unlink("weft/recent-files");
    return 0;
}

static void make_file(int number, char name[16])
{
    snprintf(name, 16, "file%d.weft", number);
    scratch_store(name, "x", 1);
}

static void add(weft_recent_files *recent, const char *path)
{
    weft_error error = {0};
    if (weft_recent_files_add(recent, path, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

static void expect_name(const weft_recent_files *recent, int place, const char *name)
{
    char path[PATH_MAX + 32];
    snprintf(path, sizeof path, "%s/%s", here, name);
    assert_true(place < recent->count);
    assert_string_equal(recent->path[place], path);
}

static void the_next_window_has_the_newest_first_and_each_once(void **state)
{
    (void)state;
    weft_recent_files recent;
    char name[16];
    weft_recent_files_read(&recent);
    assert_int_equal(recent.count, 0);
    for (int i = 0; i < 3; i++) {
        make_file(i, name);
        add(&recent, name);
    }
    add(&recent, "./file0.weft");
    weft_recent_files_free(&recent);
    weft_recent_files_read(&recent);
    assert_int_equal(recent.count, 3);
    expect_name(&recent, 0, "file0.weft");
    expect_name(&recent, 1, "file2.weft");
    expect_name(&recent, 2, "file1.weft");
    weft_recent_files_free(&recent);
}

/* Each has read the list before the other stored its file. */
static void windows_beside_each_other_keep_the_files_of_both(void **state)
{
    (void)state;
    weft_recent_files one, other;
    char name[16];
    weft_recent_files_read(&one);
    weft_recent_files_read(&other);
    for (int i = 0; i < 2; i++) {
        make_file(i, name);
        add(i ? &other : &one, name);
    }
    make_file(2, name);
    add(&one, name);
    assert_int_equal(one.count, 3);
    expect_name(&one, 1, "file1.weft");
    weft_recent_files_free(&one);
    weft_recent_files_free(&other);
}

static void a_folder_is_no_file(void **state)
{
    (void)state;
    weft_recent_files recent;
    assert_int_equal(weft_make_folder("drape", NULL), WEFT_OK);
    weft_recent_files_read(&recent);
    add(&recent, "drape");
    assert_int_equal(recent.count, 0);
    weft_recent_files_free(&recent);
}

static void the_oldest_falls_off_a_full_list(void **state)
{
    (void)state;
    weft_recent_files recent;
    char name[16];
    weft_recent_files_read(&recent);
    for (int i = 0; i < WEFT_RECENT_FILES_MOST + 2; i++) {
        make_file(i, name);
        add(&recent, name);
    }
    assert_int_equal(recent.count, WEFT_RECENT_FILES_MOST);
    expect_name(&recent, WEFT_RECENT_FILES_MOST - 1, "file2.weft");
    weft_recent_files_free(&recent);
}

static void what_is_gone_and_what_is_no_path_is_not_offered(void **state)
{
    (void)state;
    weft_recent_files recent;
    char name[16], list[PATH_MAX + 200];
    make_file(1, name);
    assert_int_equal(weft_make_folder("weft", NULL), WEFT_OK);
    int size = snprintf(list, sizeof list, "\n\nfile1.weft\n/no/such/file\n%s/file1.weft\n\xff\xfe\n%s/file1.weft",
                        here, here);
    scratch_store("weft/recent-files", list, (size_t)size);
    weft_recent_files_read(&recent);
    assert_int_equal(recent.count, 1);
    expect_name(&recent, 0, "file1.weft");
    add(&recent, "no-such-file");
    add(&recent, "drape");
    assert_int_equal(recent.count, 1);
    weft_recent_files_free(&recent);
}

static void a_list_that_is_no_list_is_empty(void **state)
{
    (void)state;
    weft_recent_files recent;
    char *bytes = calloc(1, 1 << 20);
    assert_non_null(bytes);
    assert_int_equal(weft_make_folder("weft", NULL), WEFT_OK);
    scratch_store("weft/recent-files", bytes, 100);
    weft_recent_files_read(&recent);
    assert_int_equal(recent.count, 0);
    weft_recent_files_free(&recent);
    memset(bytes, '/', 1 << 20);
    scratch_store("weft/recent-files", bytes, 1 << 20);
    weft_recent_files_read(&recent);
    assert_int_equal(recent.count, 0);
    weft_recent_files_free(&recent);
    free(bytes);
}

/* A name with a line break would be two lines. */
static void a_name_of_two_lines_is_not_taken(void **state)
{
    (void)state;
    weft_recent_files recent;
    scratch_store("two\nlines", "x", 1);
    weft_recent_files_read(&recent);
    add(&recent, "two\nlines");
    assert_int_equal(recent.count, 0);
    weft_recent_files_free(&recent);
}

static void what_cannot_be_stored_is_said_and_kept_for_this_window(void **state)
{
    (void)state;
    weft_recent_files recent;
    weft_error error = {0};
    char name[16];
    make_file(1, name);
    scratch_store("nowhere", "x", 1);
    char nowhere[PATH_MAX + 16];
    snprintf(nowhere, sizeof nowhere, "%s/nowhere", here);
    setenv("XDG_STATE_HOME", nowhere, 1);
    weft_recent_files_read(&recent);
    assert_int_equal(weft_recent_files_add(&recent, name, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "nowhere"));
    expect_name(&recent, 0, name);
    weft_recent_files_free(&recent);
    setenv("XDG_STATE_HOME", here, 1);
}

int test_recent_files(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(the_next_window_has_the_newest_first_and_each_once, forget),
        cmocka_unit_test_teardown(windows_beside_each_other_keep_the_files_of_both, forget),
        cmocka_unit_test_teardown(a_folder_is_no_file, forget),
        cmocka_unit_test_teardown(the_oldest_falls_off_a_full_list, forget),
        cmocka_unit_test_teardown(what_is_gone_and_what_is_no_path_is_not_offered, forget),
        cmocka_unit_test_teardown(a_list_that_is_no_list_is_empty, forget),
        cmocka_unit_test_teardown(a_name_of_two_lines_is_not_taken, forget),
        cmocka_unit_test_teardown(what_cannot_be_stored_is_said_and_kept_for_this_window, forget),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}
