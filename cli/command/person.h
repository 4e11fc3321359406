/* Whoever sits at the terminal, asked to do by hand what the rig has no motor for. */
#ifndef WEFT_CLI_PERSON_H
#define WEFT_CLI_PERSON_H

#include "capture/motion/stage.h"
#include "cli/command/command.h"

#include <signal.h>

typedef struct weft_terminal_person {
    const weft_common_options *common;
    const volatile sig_atomic_t *stop;
    int input; /* a descriptor of its own: libgphoto2 closes number 0 when a camera on a network is gone */
} weft_terminal_person;

/* Takes a copy of the standard input, open until the program ends. */
weft_terminal_person weft_person_of(const weft_common_options *common, const volatile sig_atomic_t *stop);

/* Says the text (an event {"event":"ask","text":...} with --json) and waits for Enter. Errors: WEFT_SYSTEM where the
 * input is at its end, or a stop is asked for. `person` is borrowed. */
weft_person weft_person_at_terminal(weft_terminal_person *person);

#endif
