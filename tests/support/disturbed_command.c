#include "tests/support/disturbed_command.h"

#include "base/atomic_file.h"
#include "tests/support/cmocka_all.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const char *const log_path = "disturbed.log";

off_t size_of(const char *name)
{
    struct stat status;
    return stat(name, &status) == 0 ? status.st_size : -1;
}

/* ---- Running ---- */

static void run_child(const char *const *argument, rlim_t largest_file)
{
    int log = open(log_path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    if (largest_file > 0) {
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){largest_file, largest_file});
    }
    execv(WEFT_PROGRAM, (char *const *)argument);
    _exit(127);
}

static bool has_ended(pid_t child)
{
    siginfo_t info = {0};
    return waitid(P_PID, (id_t)child, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == child;
}

static void wait_and_kill(pid_t child, disturbance how)
{
    while (size_of(how.watched) < how.kill_at && !has_ended(child))
        nanosleep(&(struct timespec){.tv_nsec = 500000}, NULL);
    kill(child, SIGKILL);
}

disturbed run_disturbed(const char *const *argument, disturbance how)
{
    disturbed got = {0};
    struct rusage usage;
    char *text;
    size_t size;
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        run_child(argument, how.largest_file);
    if (how.kill_at > 0)
        wait_and_kill(child, how);
    assert_int_equal(wait4(child, &got.status, 0, &usage), child);
    got.peak_kb = usage.ru_maxrss;
    assert_int_equal(weft_read_file(log_path, 1 << 20, &text, &size, NULL), WEFT_OK);
    snprintf(got.said, sizeof got.said, "%s", text);
    free(text);
    return got;
}

/* ---- Expecting ---- */

void expect_says(const disturbed *got, int code, const char *what)
{
    if (!WIFEXITED(got->status) || WEXITSTATUS(got->status) != code || !strstr(got->said, what))
        fail_msg("status %x, not %d, or no '%s' in: %s", (unsigned)got->status, code, what, got->said);
}

void expect_not_said(const disturbed *got, const char *what)
{
    if (strstr(got->said, what))
        fail_msg("'%s' in: %s", what, got->said);
}

void expect_same_bytes(const char *one, const char *two)
{
    char *bytes[2];
    size_t size[2];
    assert_int_equal(weft_read_file(one, SIZE_MAX / 2, &bytes[0], &size[0], NULL), WEFT_OK);
    assert_int_equal(weft_read_file(two, SIZE_MAX / 2, &bytes[1], &size[1], NULL), WEFT_OK);
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    free(bytes[0]);
    free(bytes[1]);
}
