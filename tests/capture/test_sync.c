/* What a power cut may take. Every call that syncs, renames or appends is noted, and may be made to fail. */
#include "tests/capture/disk_calls.h"
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Events (tests/capture/disk_calls.h) in the order of the calls, of the thread that writes and then of the one that
 * finishes. */
static char noted[4096];
static size_t note_count;
static int photographs_until_failure = -1;

static int note(char event)
{
    if (event == 'P' && photographs_until_failure >= 0 && photographs_until_failure-- == 0)
        return EIO;
    if (event != '-' && note_count + 1 < sizeof noted)
        noted[note_count++] = event;
    return 0;
}

/* Takes a session and returns what was noted from the first photograph on. */
static const char *take_session(weft_code expected)
{
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error = {0};
    note_count = 0;
    disk_call_visit = note;
    assert_int_equal(virtual_session_take(&request, NULL, NULL, &summary, &error), expected);
    noted[note_count] = '\0';
    const char *first = strchr(noted, 'P');
    assert_non_null(first);
    return first;
}

static void remove_session(void)
{
    assert_int_equal(system("rm -rf session session.truth.h5 .session.truth.*"), 0);
}

static void a_line_follows_its_synced_photograph_and_a_viewpoint_ends_synced(void **state)
{
    (void)state;
    char expected[256] = "";
    for (int viewpoint = 0; viewpoint < 5; viewpoint++)
        strcat(expected, "PRLPRLPRLPRLPRLvsJ");
    assert_string_equal(take_session(WEFT_OK), expected);
    small_session_assert_whole("session");
    remove_session();
}

static void a_photograph_that_cannot_be_synced_has_no_line(void **state)
{
    (void)state;
    photographs_until_failure = 7;
    assert_string_equal(take_session(WEFT_SYSTEM), "PRLPRLPRLPRLPRLvsJPRLPRLvsJ");
    assert_int_equal(small_session_journal_lines("session"), 7);
    photographs_until_failure = -1;
    take_session(WEFT_OK);
    small_session_assert_whole("session");
    remove_session();
}

int test_sync(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_follows_its_synced_photograph_and_a_viewpoint_ends_synced),
        cmocka_unit_test(a_photograph_that_cannot_be_synced_has_no_line),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
