/* The operator at the terminal, who does by hand whatever the rig has no motor for. */
#ifndef WEFT_CLI_OPERATOR_H
#define WEFT_CLI_OPERATOR_H

#include "capture/motion/stage.h"
#include "cli/command/command.h"

#include <signal.h>

typedef struct weft_terminal_operator {
    const weft_common_options *common;
    const volatile sig_atomic_t *stop;
    int input; /* a descriptor of its own: libgphoto2 closes number 0 when a camera on a network is gone. -1: closed */
} weft_terminal_operator;

/* Takes a copy of the standard input, open until the program ends. */
weft_terminal_operator weft_operator_of(const weft_common_options *common, const volatile sig_atomic_t *stop);

/* Shows the text (an event {"event":"ask","text":...} with --json) and waits for Enter. Errors: WEFT_SYSTEM where the
 * input is closed or at its end, or a stop is asked for. `at` is borrowed. */
weft_operator weft_operator_at_terminal(weft_terminal_operator *at);

#endif
