/* A JSON object as lines for the user, or as an event; and what a capture would do, or its check found. */
#ifndef WEFT_CLI_DESCRIBE_H
#define WEFT_CLI_DESCRIBE_H

#include "capture/capture.h"
#include "cli/command.h"
#include "study/preflight/preflight.h"

#include <jansson.h>

/* "name: value" lines, nested objects indented, small arrays on one line; with --json one event {"event":NAME, ...}.
 * Errors: WEFT_SYSTEM where memory is short. */
weft_code weft_command_describe(const weft_common_options *common, const char *event, json_t *object,
                                weft_error *error);

/* ---- What `weft capture` says of a rehearsal and of a check ---- */

/* `in_order`: the stage chose an order, and knows how long it takes. */
void weft_say_rehearsal(const weft_common_options *common, const weft_capture_rehearsal *rehearsal, bool in_order);

/* A line for each check, or an event. Errors: WEFT_SYSTEM for memory. */
weft_code weft_say_checks(const weft_common_options *common, const weft_preflight *result, weft_error *error);

#endif
