#include "tests/capture/disk_calls.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/suite.h"

#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Calls of the system before the process dies; negative: it lives. */
static int calls_left;

static int die_in_time(char event)
{
    (void)event;
    if (calls_left-- == 0)
        raise(SIGKILL);
    return 0;
}

/* Runs in a process of its own that is killed before its call `last_call` that changes the disk; -1: it is not. What
 * the kill leaves behind is then all that the next run knows. (The parent starts no OpenMP thread, for those would not
 * survive fork.) Returns whether it was killed. */
static bool run(int last_call)
{
    int status;
    virtual_session request = small_session_request();
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        calls_left = last_call;
        disk_call_visit = die_in_time;
        weft_capture_summary summary;
        weft_error error = {0};
        weft_code code = virtual_session_take(&request, NULL, NULL, &summary, &error);
        if (code != WEFT_OK)
            fprintf(stderr, "%s\n", error.message);
        _exit((int)code);
    }
    assert_true(waitpid(child, &status, 0) > 0);
    bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    assert_true(killed || (WIFEXITED(status) && WEXITSTATUS(status) == 0));
    return killed;
}

static void complete_run(void)
{
    assert_false(run(-1));
}

static void remove_session(void)
{
    assert_int_equal(system("rm -rf session session.truth.h5 .session.truth.*"), 0);
}

static void a_session_killed_at_any_moment_loses_and_repeats_nothing(void **state)
{
    (void)state;
    for (int step = suite_argument ? 5 : 7; step <= 7; step += 2) {
        int kills = 0, before = 0;
        while (run(kills * step % 23)) {
            int lines = small_session_journal_lines("session");
            assert_true(lines >= before);
            before = lines;
            kills++;
        }
        small_session_assert_whole("session");
        assert_true(kills >= 9);
        remove_session();
    }
}

static void a_run_killed_before_its_first_photograph_starts_again(void **state)
{
    (void)state;
    assert_true(run(0));
    complete_run();
    small_session_assert_whole("session");
    remove_session();
}

static void a_journal_line_cut_in_the_middle_is_written_again(void **state)
{
    (void)state;
    complete_run();
    size_t size;
    char *journal = (char *)scratch_load("session/journal.jsonl", &size);
    scratch_store("session/journal.jsonl", journal, size - 20);
    free(journal);
    complete_run();
    small_session_assert_whole("session");
    remove_session();
}

/* Applies a disturbance to the photograph of shot 12, runs again, and checks that its photograph is whole. */
static void assert_retaken(void (*disturb)(const char *path))
{
    complete_run();
    weft_session session;
    char path[PATH_MAX];
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    weft_session_photograph_path(&session, 12, path, sizeof path);
    disturb(path);
    uint32_t untouched = session.record[11].crc32;
    int viewpoint = session.record[12].viewpoint;
    weft_session_free(&session);
    complete_run();
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    assert_int_equal(session.record[11].crc32, untouched);
    /* The axes were homed again, so the photograph is of a new viewpoint. */
    assert_int_not_equal(session.record[12].viewpoint, viewpoint);
    assert_int_equal(small_session_journal_lines("session"), SMALL_SHOTS + 1);
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    assert_int_equal(size, session.record[12].bytes);
    free(bytes);
    weft_session_free(&session);
    remove_session();
}

static void delete_photograph(const char *path)
{
    assert_int_equal(unlink(path), 0);
}

static void truncate_photograph(const char *path)
{
    assert_int_equal(truncate(path, 1000), 0);
}

static void change_a_byte(const char *path)
{
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    bytes[size / 2] ^= 0x10;
    scratch_store(path, bytes, size);
    free(bytes);
}

static void photographs_that_do_not_match_the_journal_are_taken_again(void **state)
{
    (void)state;
    assert_retaken(delete_photograph);
    assert_retaken(truncate_photograph);
    assert_retaken(change_a_byte);
}

/* Names as a process leaves them that dies before it renames its file; and names that are somebody else's. */
static void what_a_dead_process_left_is_swept_away_and_nothing_else(void **state)
{
    (void)state;
    static const char *const left[] = {"session/.session.12345.json", "session/.photograph.tif",
                                       ".session.truth.12345.h5"};
    static const char *const others[] = {"session/.session.notes.json", "session/.session.json",
                                         "session/.session.7.json.bak"};
    complete_run();
    for (int i = 0; i < 3; i++)
        scratch_store(left[i], "{", 1);
    for (int i = 0; i < 3; i++)
        scratch_store(others[i], "{", 1);
    complete_run();
    for (int i = 0; i < 3; i++)
        assert_int_not_equal(access(left[i], F_OK), 0);
    for (int i = 0; i < 3; i++)
        assert_int_equal(remove(others[i]), 0);
    small_session_assert_whole("session");
    remove_session();
}

int test_resume(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_session_killed_at_any_moment_loses_and_repeats_nothing),
        cmocka_unit_test(what_a_dead_process_left_is_swept_away_and_nothing_else),
        cmocka_unit_test(a_run_killed_before_its_first_photograph_starts_again),
        cmocka_unit_test(a_journal_line_cut_in_the_middle_is_written_again),
        cmocka_unit_test(photographs_that_do_not_match_the_journal_are_taken_again),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
