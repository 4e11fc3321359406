/* Every problem that a session may have is found, told once, and mended by the next capture. */
#include "base/atomic_file.h"
#include "capture/session_check.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int brackets; /* of the captures */

static int capture(void)
{
    virtual_session request = small_session_request();
    request.capture.brackets = brackets;
    weft_capture_summary summary;
    weft_error error = {0};
    expect_ok(virtual_session_take(&request, NULL, NULL, &summary, &error), &error);
    return summary.taken;
}

static weft_session_problems check(void)
{
    weft_session session;
    weft_session_problems problems;
    weft_error error = {0};
    expect_ok(weft_session_open("session", &session, &error), &error);
    expect_ok(weft_session_check(&session, NULL, &problems, &error), &error);
    weft_session_free(&session);
    return problems;
}

static void path_of(int shot, char path[PATH_MAX])
{
    weft_session session;
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    weft_session_photograph_path(&session, shot, path, PATH_MAX);
    weft_session_free(&session);
}

static void change_a_byte(int shot)
{
    char path[PATH_MAX];
    size_t size;
    path_of(shot, path);
    unsigned char *bytes = scratch_load(path, &size);
    bytes[size / 2] ^= 1;
    scratch_store(path, bytes, size);
    free(bytes);
}

/* As a camera does it that hands over a photograph of before. */
static void repeat_photograph(int shot, int instead)
{
    char from[PATH_MAX], to[PATH_MAX];
    size_t size;
    weft_session session;
    path_of(shot, from);
    path_of(instead, to);
    unsigned char *bytes = scratch_load(from, &size);
    scratch_store(to, bytes, size);
    free(bytes);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    weft_shot_record record = session.record[shot];
    assert_int_equal(weft_session_append(&session, instead, &record, NULL), WEFT_OK);
    weft_session_free(&session);
}

static void expect_problem(const weft_session_problems *problems, int index, weft_session_problem_kind kind, int shot,
                           const char *says)
{
    assert_in_range(index, 0, problems->count - 1);
    const weft_session_problem *problem = &problems->problem[index];
    assert_int_equal(problem->kind, kind);
    assert_int_equal(problem->shot, shot);
    if (!strstr(problem->text, says))
        fail_msg("%s", problem->text);
}

static void remove_session(void)
{
    assert_int_equal(system("rm -rf session session.truth.h5"), 0);
}

static void a_session_as_it_was_taken_is_sound(void **state)
{
    (void)state;
    capture();
    weft_session_problems problems = check();
    assert_int_equal(problems.count, 0);
    weft_session_problems_free(&problems);
    remove_session();
}

static void every_problem_is_found_and_the_next_capture_takes_those_shots_alone(void **state)
{
    (void)state;
    char path[PATH_MAX];
    capture();
    /* The line of the last shot is lost: it was never taken, whatever lies there. */
    assert_int_equal(system("sed -i '$d' session/journal.jsonl"), 0);
    path_of(3, path);
    assert_int_equal(unlink(path), 0);
    change_a_byte(7);
    repeat_photograph(14, 9);
    weft_session_problems problems = check();
    assert_int_equal(problems.count, 3);
    expect_problem(&problems, 0, WEFT_PROBLEM_MISSING, 3, "No such file");
    expect_problem(&problems, 1, WEFT_PROBLEM_DAMAGED, 7, "has the checksum");
    /* Shot 14 comes later in the plan, but earlier in the journal. */
    expect_problem(&problems, 2, WEFT_PROBLEM_DUPLICATE, 9, "has the bytes of shot 14");
    weft_session_problems_free(&problems);
    assert_int_equal(capture(), 4);
    problems = check();
    assert_int_equal(problems.count, 0);
    weft_session_problems_free(&problems);
    remove_session();
}

/* A photograph of another camera under the checksum that the journal has. */
static void a_photograph_that_the_journal_knows_but_nobody_can_read_is_damaged(void **state)
{
    (void)state;
    capture();
    char path[PATH_MAX];
    path_of(5, path);
    scratch_store(path, "no picture", 10);
    weft_session session;
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    weft_shot_record record = session.record[5];
    record.bytes = 10;
    record.crc32 = 0xddbfe061;
    assert_int_equal(weft_session_append(&session, 5, &record, NULL), WEFT_OK);
    weft_session_free(&session);
    weft_session_problems problems = check();
    assert_int_equal(problems.count, 1);
    expect_problem(&problems, 0, WEFT_PROBLEM_DAMAGED, 5, "tl000_pl000_tv030_pv000.tif");
    weft_session_problems_free(&problems);
    remove_session();
}

static void photographs_of_a_bracket_are_checked_like_any(void **state)
{
    (void)state;
    brackets = 2;
    capture();
    weft_session session;
    char path[PATH_MAX];
    int bracketed = 0, shot = -1;
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    for (int i = 0; i < session.shot_count; i++) {
        bracketed += session.record[i].bracket_count;
        shot = session.record[i].bracket_count > 0 ? i : shot;
        for (int b = 0; b < session.record[i].bracket_count; b++) {
            weft_session_bracket_path(&session, i, b, path, sizeof path);
            assert_int_equal(weft_file_bytes(path), session.record[i].bracket[b].bytes);
            assert_true(session.record[i].bracket[b].exposure_s != session.record[i].exposure_s);
        }
    }
    weft_session_free(&session);
    assert_true(bracketed > 0);
    assert_int_equal(unlink(path), 0);
    weft_session_problems problems = check();
    assert_int_equal(problems.count, 1);
    expect_problem(&problems, 0, WEFT_PROBLEM_MISSING, shot, ".bracket");
    weft_session_problems_free(&problems);
    assert_int_equal(capture(), 1);
    problems = check();
    assert_int_equal(problems.count, 0);
    weft_session_problems_free(&problems);
    brackets = 0;
    remove_session();
}

/* A shot that is taken again with fewer exposures leaves none of the old ones; one that nobody took is unexpected. */
static void a_bracket_that_the_journal_does_not_have_is_foreign(void **state)
{
    (void)state;
    weft_session session;
    char path[PATH_MAX];
    int shot = 0;
    brackets = 2;
    capture();
    brackets = 0;
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    while (session.record[shot].bracket_count == 0)
        shot++;
    weft_session_free(&session);
    change_a_byte(shot);
    assert_int_equal(capture(), 1);
    weft_session_problems problems = check();
    assert_int_equal(problems.count, 0);
    weft_session_problems_free(&problems);
    assert_int_equal(weft_session_open("session", &session, NULL), WEFT_OK);
    weft_session_bracket_path(&session, shot, 0, path, sizeof path);
    weft_session_free(&session);
    assert_int_equal(access(path, F_OK), -1);
    scratch_store(path, "x", 1);
    problems = check();
    assert_int_equal(problems.count, 1);
    expect_problem(&problems, 0, WEFT_PROBLEM_UNEXPECTED, -1, ".bracket1.tif");
    weft_session_problems_free(&problems);
    remove_session();
}

static bool lists(const weft_session_problems *problems, const char *file)
{
    for (int i = 0; i < problems->count; i++) {
        if (problems->problem[i].kind == WEFT_PROBLEM_UNEXPECTED && problems->problem[i].shot == -1 &&
            strstr(problems->problem[i].text, file))
            return true;
    }
    return false;
}

static void files_of_others_are_foreign_and_those_of_the_camera_are_not(void **state)
{
    (void)state;
    static const char *const unexpected[] = {"session/notes.txt", "session/tv000_pv000/tl031_pl000_tv000_pv000.tif",
                                             "session/tv000_pv000/tl000_pl000_tv000_pv000.jpg",
                                             "session/.session.4711.json", "session/.photograph.tif"};
    static const char *const known[] = {"session/tv000_pv000/tl000_pl000_tv000_pv000.original.nef",
                                        "session/.directory"};
    enum { UNEXPECTED = sizeof unexpected / sizeof *unexpected };
    capture();
    for (int i = 0; i < UNEXPECTED; i++)
        scratch_store(unexpected[i], "x", 1);
    for (int i = 0; i < 2; i++)
        scratch_store(known[i], "x", 1);
    weft_session_problems problems = check();
    assert_int_equal(problems.count, UNEXPECTED);
    for (int i = 0; i < UNEXPECTED; i++) {
        if (!lists(&problems, unexpected[i]))
            fail_msg("%s", unexpected[i]);
    }
    weft_session_problems_free(&problems);
    assert_int_equal(capture(), 0);
    remove_session();
}

static void a_list_that_names_no_folder_is_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {"{\"weft_cameras\":1,\"cameras\":[\"..\"]}",
                                      "{\"weft_cameras\":1,\"cameras\":[\"a/b\"]}",
                                      "{\"weft_cameras\":1,\"cameras\":[\"a\",\"a\"]}",
                                      "{\"weft_cameras\":1,\"cameras\":[\"a\",\"A\"]}",
                                      "{\"weft_cameras\":1,\"cameras\":[]}",
                                      "{\"weft_cameras\":2,\"cameras\":[\"a\"]}",
                                      "{\"weft_cameras\":1,\"cameras\":[7]}"};
    weft_camera_list list;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        scratch_store("cameras.json", bad[i], strlen(bad[i]));
        assert_int_equal(weft_camera_list_read(".", &list, NULL), WEFT_BAD_INPUT);
    }
    unlink("cameras.json");
    assert_int_equal(weft_camera_list_read(".", &list, NULL), WEFT_OK);
    assert_int_equal(list.count, 0);
}

int test_session_check(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_that_names_no_folder_is_refused),
        cmocka_unit_test(a_session_as_it_was_taken_is_sound),
        cmocka_unit_test(every_problem_is_found_and_the_next_capture_takes_those_shots_alone),
        cmocka_unit_test(a_photograph_that_the_journal_knows_but_nobody_can_read_is_damaged),
        cmocka_unit_test(photographs_of_a_bracket_are_checked_like_any),
        cmocka_unit_test(a_bracket_that_the_journal_does_not_have_is_foreign),
        cmocka_unit_test(files_of_others_are_foreign_and_those_of_the_camera_are_not),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
