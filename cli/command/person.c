#include "cli/command/person.h"

#include "base/text/json_text.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

weft_terminal_person weft_person_of(const weft_common_options *common, const volatile sig_atomic_t *stop)
{
    const int first_free = 3;
    return (weft_terminal_person){common, stop, fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, first_free)};
}

static void say(const weft_terminal_person *person, const char *text)
{
    if (!person->common->json) {
        fprintf(stderr, "%s Then press Enter. ", text);
        fflush(stderr);
        return;
    }
    json_t *event = json_pack("{s:s, s:s}", "event", "ask", "text", text);
    char *line = event ? json_dumps(event, JSON_COMPACT) : NULL;
    if (line)
        weft_command_event(person->common, line);
    free(line);
    json_decref(event);
}

/* Waits in short steps, to hear a stop. */
static weft_code wait_for_enter(const weft_terminal_person *person, weft_error *error)
{
    enum { STEP_MS = 100 };
    for (;;) {
        struct pollfd input = {person->input, POLLIN, 0};
        char letter;
        if (*person->stop)
            return weft_fail(error, WEFT_SYSTEM, "stopped while somebody was asked for");
        if (poll(&input, 1, STEP_MS) <= 0)
            continue;
        if (read(person->input, &letter, 1) != 1)
            return weft_fail(error, WEFT_SYSTEM, "nobody is there to be asked: the input is at its end");
        if (letter == '\n')
            return WEFT_OK;
    }
}

static weft_code ask(void *context, const char *text, weft_error *error)
{
    say(context, text);
    return wait_for_enter(context, error);
}

weft_person weft_person_at_terminal(weft_terminal_person *person)
{
    return (weft_person){person, ask};
}
