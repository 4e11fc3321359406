/* A JSON object as lines for the user, or as an event. */
#ifndef WEFT_CLI_DESCRIBE_H
#define WEFT_CLI_DESCRIBE_H

#include "cli/command.h"

#include <jansson.h>

/* "name: value" lines, nested objects indented, small arrays on one line; with --json one event {"event":NAME, ...}.
 * Errors: WEFT_SYSTEM where memory is short. */
weft_code describe(const common_options *common, const char *event, json_t *object, weft_error *error);

/* Parses the command line of a command that takes just one file; wrong usage does not return. */
const char *parse_one_file(int argc, char **argv, const char *documentation, common_options *common);

#endif
