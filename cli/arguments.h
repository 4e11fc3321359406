/* The command line of a subcommand, by its table of options. */
#ifndef WEFT_CLI_ARGUMENTS_H
#define WEFT_CLI_ARGUMENTS_H

#include "cli/command.h"
#include "player/settings/scene_options.h"

/* What the values of a command begin with that shows a scene. */
typedef struct weft_scene_values {
    weft_common_options common;
    weft_scene_request scene; /* the command frees it */
} weft_scene_values;

/* Reads the command line into `values` and applies the common options. Wrong usage prints a hint and exits with
 * WEFT_BAD_USAGE; a picture with settings that cannot be read with the code of that. */
void weft_arguments_parse(const weft_command *command, int argc, char **argv, void *values);

#endif
