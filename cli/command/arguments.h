/* The command line of a subcommand, by its table of options. */
#ifndef WEFT_CLI_ARGUMENTS_H
#define WEFT_CLI_ARGUMENTS_H

#include "cli/command/command.h"
#include "player/settings/settings.h"

/* Reads the command line into `values` and applies the common options. Wrong usage prints a hint and exits with
 * WEFT_BAD_USAGE; a picture with settings that cannot be read with the code of that. The command frees its
 * weft_settings. */
void weft_arguments_parse(const weft_command *command, int argc, char **argv, void *values);

/* Whether a file is of a kind that the name of an argument allows, as far as both tell: "NAME.weft" is a material,
 * "SESSION" a folder. What is not there, or tells nothing, is left to its reader. Errors: WEFT_BAD_INPUT naming the
 * file, what it is and what belongs in its place. */
weft_code weft_argument_check_type(const char *argument, const char *path, weft_error *error);

/* Visits every option of a command: its own, those of a picture with their setting (else NULL), the common ones.
 * Options without a name are arguments that are known by their place, in the order of the places. */
typedef void weft_arguments_visit(void *context, const weft_option *option, const weft_setting *setting);
void weft_arguments_each(const weft_command *command, weft_arguments_visit *visit, void *context);

/* ---- Completion ---- */

/* What the shells ask when a user presses Tab. */

/* `weft --complete WORD...`: prints what the last word, which may be empty, may become after those before it. A line
 * holds a candidate, a tab and what it means. The line ":file" stands for the names of files, those that end with
 * what follows its tab; the line ":folder" for folders. The shell may cut "--name=value" into three words. Returns the
 * exit code, which is 0. */
int weft_complete(int count, char **word);

#endif
