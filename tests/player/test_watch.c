/* Files that change while they are watched. */
#include "player/window/files.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int set_up(void **state)
{
    weft_watch *watch = NULL;
    weft_error error;
    if (weft_watch_create(&watch, &error) != WEFT_OK)
        return -1;
    mkdir("watched", 0755);
    write_file("watched/a.weft", "1");
    write_file("watched/b.wv", "1");
    assert_int_equal(weft_watch_set(watch, 0, "watched/a.weft", &error), WEFT_OK);
    assert_int_equal(weft_watch_set(watch, 3, "watched/b.wv", &error), WEFT_OK);
    *state = watch;
    return 0;
}

static int tear_down(void **state)
{
    weft_watch_free(*state);
    return 0;
}

static void nothing_changed_at_first(void **state)
{
    assert_int_equal(weft_watch_poll(*state, 0), -1);
    assert_int_equal(weft_watch_poll(*state, 10), -1);
}

static void a_file_written_in_place_is_told_once_after_a_pause(void **state)
{
    write_file("watched/a.weft", "2");
    assert_int_equal(weft_watch_poll(*state, 1), -1);
    assert_int_equal(weft_watch_poll(*state, 1.2), -1);
    assert_int_equal(weft_watch_poll(*state, 1.31), 0);
    assert_int_equal(weft_watch_poll(*state, 5), -1);
}

static void a_file_renamed_into_place_counts(void **state)
{
    write_file("watched/.b.wv.tmp", "2");
    assert_int_equal(weft_watch_poll(*state, 1), -1);
    assert_int_equal(rename("watched/.b.wv.tmp", "watched/b.wv"), 0);
    assert_int_equal(weft_watch_poll(*state, 2), -1);
    assert_int_equal(weft_watch_poll(*state, 2.5), 3);
    assert_int_equal(weft_watch_poll(*state, 9), -1);
}

/* vim renames the old file away before it writes the new one. */
static void a_file_that_is_gone_for_a_while_is_told_when_it_is_back(void **state)
{
    assert_int_equal(rename("watched/b.wv", "watched/b.wv~"), 0);
    assert_int_equal(weft_watch_poll(*state, 1), -1);
    assert_int_equal(weft_watch_poll(*state, 2), -1);
    write_file("watched/b.wv", "3");
    weft_watch_poll(*state, 3);
    assert_int_equal(weft_watch_poll(*state, 3.5), 3);
}

static void a_file_half_written_is_not_told(void **state)
{
    FILE *file = fopen("watched/a.weft", "w");
    fputs("half", file);
    fflush(file);
    assert_int_equal(weft_watch_poll(*state, 1), -1);
    assert_int_equal(weft_watch_poll(*state, 9), -1);
    fclose(file);
    weft_watch_poll(*state, 10);
    assert_int_equal(weft_watch_poll(*state, 10.5), 0);
}

static void writing_again_prolongs_the_pause(void **state)
{
    for (int k = 0; k < 5; k++) {
        write_file("watched/a.weft", "4");
        assert_int_equal(weft_watch_poll(*state, 1 + 0.2 * k), -1);
    }
    assert_int_equal(weft_watch_poll(*state, 2.2), 0);
    assert_int_equal(weft_watch_poll(*state, 9), -1);
}

static void other_files_of_the_folder_are_not_told(void **state)
{
    write_file("watched/c.weft", "1");
    write_file("watched/a.weft2", "1");
    weft_watch_poll(*state, 1);
    assert_int_equal(weft_watch_poll(*state, 9), -1);
}

static void a_slot_that_watches_something_else_forgets(void **state)
{
    weft_error error;
    write_file("watched/a.weft", "5");
    assert_int_equal(weft_watch_set(*state, 0, NULL, &error), WEFT_OK);
    weft_watch_poll(*state, 1);
    assert_int_equal(weft_watch_poll(*state, 9), -1);
    write_file("watched/b.wv", "5"); /* in the same folder */
    weft_watch_poll(*state, 10);
    assert_int_equal(weft_watch_poll(*state, 11), 3);
}

static void a_folder_that_is_not_there_is_an_error(void **state)
{
    weft_error error;
    assert_int_equal(weft_watch_set(*state, 1, "no/such/folder/a.weft", &error), WEFT_SYSTEM);
    assert_int_equal(weft_watch_poll(*state, 1), -1);
}

int test_watch(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(nothing_changed_at_first, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_written_in_place_is_told_once_after_a_pause, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_renamed_into_place_counts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_that_is_gone_for_a_while_is_told_when_it_is_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_half_written_is_not_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(writing_again_prolongs_the_pause, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_files_of_the_folder_are_not_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_slot_that_watches_something_else_forgets, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_folder_that_is_not_there_is_an_error, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
