/* What the subcommands of `weft` share: their table, common options, and how they speak to the user. */
#ifndef WEFT_CLI_COMMAND_H
#define WEFT_CLI_COMMAND_H

#include "base/progress.h"
#include "base/status.h"

#include <argp.h>
#include <stdbool.h>

/* --quiet, --json and --threads, as an argp child: { &common_argp, 0, "Common options:", 9 }. The child's input must be
 * a common_options; commands pass it in ARGP_KEY_INIT: state->child_inputs[0] = &options.common. */
typedef struct common_options {
    bool quiet, json;
    int threads; /* 0 = all cores; applied to OpenMP by common_start */
} common_options;

extern const struct argp common_argp;

/* Most commands make one file of another: what they are given alike. */
typedef struct conversion {
    common_options common;
    const char *input, *output; /* the one argument, and -o */
    const char *noun;           /* what the input is called */
    const char *needed;         /* said where either is missing; NULL: the command sees to that itself */
} conversion;

/* What is left over by the parser of such a command, whose option table has its own words for 'o': -o, the one
 * argument, the common options as its only child, and in the end that input and output are there, and not the same
 * file. */
error_t parse_conversion(int key, char *argument, struct argp_state *state, conversion *files);

/* Parses a command line with argp; wrong usage prints a hint and exits with WEFT_BAD_USAGE. Then applies the common
 * options. */
void command_parse(const struct argp *parser, int argc, char **argv, void *input, common_options *common);

/* The progress reporter of the command line: a line with an ETA that rewrites itself on a terminal, a plain line every
 * few seconds otherwise, a JSON event with --json, nothing with --quiet. */
weft_progress command_progress(const common_options *common);

/* A result for the user, on stdout (nothing with --quiet; an event {"event":"note","text":...} with --json). */
void command_say(const common_options *common, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* One machine-readable event with --json, nothing otherwise. `json_object` is the text of a JSON object. */
void command_event(const common_options *common, const char *json_object);

/* Prints "weft COMMAND: MESSAGE" on stderr when code is not WEFT_OK, and returns it as the exit code. */
int command_exit(const char *command, const common_options *common, weft_code code, const weft_error *error);

/* Every subcommand: its file is cli/NAME.c. argv[0] is "weft NAME". */
int command_capture(int argc, char **argv);
int command_simulate(int argc, char **argv);
int command_register(int argc, char **argv);
int command_import(int argc, char **argv);
int command_compress(int argc, char **argv);
int command_bard(int argc, char **argv);
int command_tile(int argc, char **argv);
int command_fit_weave(int argc, char **argv);
int command_render(int argc, char **argv);
int command_play(int argc, char **argv);
int command_compare(int argc, char **argv);
int command_eval(int argc, char **argv);
int command_info(int argc, char **argv);
int command_verify(int argc, char **argv);

#endif
