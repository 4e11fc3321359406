/* A JSON object as lines for the user, or as an event. */
#ifndef WEFT_CLI_DESCRIBE_H
#define WEFT_CLI_DESCRIBE_H

#include "cli/command/command.h"

#include <jansson.h>

/* "name: value" lines, nested objects indented, small arrays on one line; with --json one event {"event":NAME, ...}.
 * Errors: WEFT_SYSTEM where memory is short. */
weft_code weft_command_describe(const weft_common_options *common, const char *event, json_t *object,
                                weft_error *error);

/* With --json one event {"event":NAME, ...}, else nothing. Frees the object; NULL: memory was short. Errors:
 * WEFT_SYSTEM where memory is short. */
weft_code weft_command_report(const weft_common_options *common, const char *event, json_t *object, weft_error *error);

#endif
