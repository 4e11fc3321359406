/* What a power cut may take. Every call that syncs, renames or appends is noted, and may be made to fail. */
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int __real_fdatasync(int descriptor);
int __real_fsync(int descriptor);
int __real_rename(const char *from, const char *to);
ssize_t __real_pwrite(int descriptor, const void *bytes, size_t size, off_t at);
int __wrap_fdatasync(int descriptor);
int __wrap_fsync(int descriptor);
int __wrap_rename(const char *from, const char *to);
ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t size, off_t at);

/* In the order of the calls, of the thread that writes and then of the one that finishes: P the photograph synced, R
 * renamed, L its journal line appended; v the folder of a view, s that of the session, J the journal synced. */
static char noted[4096];
static size_t note_count;
static int photographs_until_failure = -1;

static void note(char event)
{
    if (note_count + 1 < sizeof noted)
        noted[note_count++] = event;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

static void path_of(int descriptor, char path[PATH_MAX])
{
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    ssize_t length = readlink(link, path, PATH_MAX - 1);
    path[length < 0 ? 0 : length] = '\0';
}

int __wrap_fdatasync(int descriptor)
{
    char path[PATH_MAX];
    path_of(descriptor, path);
    if (ends_with(path, "/session/.photograph.tif")) {
        if (photographs_until_failure >= 0 && photographs_until_failure-- == 0) {
            errno = EIO;
            return -1;
        }
        note('P');
    } else if (ends_with(path, "/session/journal.jsonl")) {
        note('J');
    }
    return __real_fdatasync(descriptor);
}

int __wrap_fsync(int descriptor)
{
    char path[PATH_MAX];
    struct stat status;
    path_of(descriptor, path);
    if (fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode) && strstr(path, "/session"))
        note(ends_with(path, "/session") ? 's' : 'v');
    return __real_fsync(descriptor);
}

int __wrap_rename(const char *from, const char *to)
{
    if (ends_with(from, "/.photograph.tif"))
        note('R');
    return __real_rename(from, to);
}

ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t size, off_t at)
{
    char path[PATH_MAX];
    path_of(descriptor, path);
    if (ends_with(path, "/session/journal.jsonl"))
        note('L');
    return __real_pwrite(descriptor, bytes, size, at);
}

/* Takes a session and returns what was noted from the first photograph on. */
static const char *take_session(weft_code expected)
{
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error = {0};
    note_count = 0;
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
