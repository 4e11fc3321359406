#include "cli/command/operator.h"

#include "base/text/json_text.h"
#include "cli/command/describe.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

weft_terminal_operator weft_operator_of(const weft_common_options *common, const volatile sig_atomic_t *stop)
{
    const int first_free = 3;
    return (weft_terminal_operator){common, stop, fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, first_free)};
}

static void say(const weft_terminal_operator *at, const char *text)
{
    if (!at->common->json) {
        fprintf(stderr, "%s Then press Enter. ", text);
        fflush(stderr);
        return;
    }
    weft_command_report(at->common, "ask", json_pack("{s:s}", "text", text), NULL);
}

/* Waits in short steps, to hear a stop. */
static weft_code wait_for_enter(const weft_terminal_operator *at, weft_error *error)
{
    enum { STEP_MS = 100 };
    char letter = 0;
    while (letter != '\n') {
        struct pollfd input = {at->input, POLLIN, 0};
        if (*at->stop)
            return weft_fail(error, WEFT_SYSTEM, "stopped while waiting for Enter");
        /* poll ignores a descriptor below 0. */
        if (at->input < 0 || (poll(&input, 1, STEP_MS) > 0 && read(at->input, &letter, 1) != 1))
            return weft_fail(error, WEFT_SYSTEM, "Standard input is closed, so nobody can press Enter.");
    }
    return WEFT_OK;
}

static weft_code ask(void *context, const char *text, weft_error *error)
{
    say(context, text);
    return wait_for_enter(context, error);
}

weft_operator weft_operator_at_terminal(weft_terminal_operator *at)
{
    return (weft_operator){at, ask};
}
