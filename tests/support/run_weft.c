#include "tests/support/run_weft.h"

#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

int run_weft(const char *before, const char *arguments, char said[RUN_WEFT_SAID])
{
    char command[1024];
    snprintf(command, sizeof command, "%s " WEFT_PROGRAM " %s 2>&1", before, arguments);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    said[fread(said, 1, RUN_WEFT_SAID - 1, pipe)] = 0;
    int status = pclose(pipe);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

void expect_weft_after(const char *before, const char *arguments, int code, const char *what)
{
    char said[RUN_WEFT_SAID];
    int got = run_weft(before, arguments, said);
    if (got != code || !strstr(said, what))
        fail_msg("weft %s exited with %d, not %d, and said '%s', not '%s'", arguments, got, code, said, what);
}

void expect_weft(const char *arguments, int code, const char *what)
{
    expect_weft_after("", arguments, code, what);
}
