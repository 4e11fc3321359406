/* What the subcommands of `weft` share: their table, common options, and how they speak to the user. */
#ifndef WEFT_CLI_COMMAND_H
#define WEFT_CLI_COMMAND_H

#include "base/progress.h"
#include "base/status.h"
#include "base/text/lines.h"
#include "base/text/option.h"

#include <jansson.h>

typedef struct weft_common_options {
    bool quiet, json;
    int threads; /* 0 = all cores */
} weft_common_options;

/* A subcommand: what it is called and says of itself, what it is given, and what it does. Its file is cli/NAME.c. The
 * values that its options set begin with a weft_common_options. */
typedef struct weft_command {
    const char *name, *summary; /* as `weft --help` lists them */
    const char *former_name;    /* accepted for one version, with a note; NULL: none */
    const char *usage;          /* what follows the name */
    const char *documentation;  /* begins with an example */
    const weft_option *options; /* end with {0}; arguments that are known by their place come in their order */
    size_t settings_offset;     /* of a weft_settings in the values, which the options of a picture set; 0: none */
    const char *needs;          /* said where a required one is missing */
    const char *surplus;        /* said of one argument too many */
    weft_code (*check)(void *values, weft_error *error); /* of all values together, or NULL. Errors: WEFT_BAD_USAGE */
    int (*run)(int argc, char **argv);                   /* argv[0] is "weft NAME"; returns the exit code */
} weft_command;

extern const weft_command weft_command_capture, weft_command_synthetic, weft_command_simulate, weft_command_register,
    weft_command_photographs, weft_command_import;
extern const weft_command weft_command_tile, weft_command_relief, weft_command_bard, weft_command_compress,
    weft_command_fit_weave, weft_command_prune;
extern const weft_command weft_command_render, weft_command_play, weft_command_compare, weft_command_tradeoff,
    weft_command_truth, weft_command_eval;
extern const weft_command weft_command_info, weft_command_verify, weft_command_target, weft_command_lens,
    weft_command_colour, weft_command_calibrate;

/* All of them, in the order of `weft --help`; the last has no command. */
typedef struct weft_command_entry {
    const char *heading; /* before it, or NULL */
    const weft_command *command;
} weft_command_entry;
extern const weft_command_entry weft_commands[];

/* The command of that name or former name, or NULL. */
const weft_command *weft_command_named(const char *name);

/* The progress reporter of the command line: a line with an ETA that rewrites itself on a terminal, a plain line every
 * few seconds otherwise, a JSON event with --json, nothing with --quiet. */
weft_progress weft_command_progress(const weft_common_options *common);

/* A result for the user, on stdout (nothing with --quiet; an event {"event":"note","text":...} with --json). */
void weft_command_say(const weft_common_options *common, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Where the page is that was written: "NAME: FOLDER/index.html". */
void weft_command_say_page(const weft_common_options *common, const char *name, const char *folder);

/* One machine-readable event with --json, nothing otherwise. `json_object` is the text of a JSON object. */
void weft_command_event(const weft_common_options *common, const char *json_object);

/* A result for the user for each of several lines, with `before` in front of it. */
void weft_command_say_lines(const weft_common_options *common, const char *before, const weft_lines *lines);

enum { WEFT_NUMBER_SIZE = 24 };

/* A number of such an event, to six digits; "null" where it is not finite, because JSON has no infinity. Returns text.
 */
const char *weft_command_number(double value, char text[WEFT_NUMBER_SIZE]);

/* Prints "weft COMMAND: MESSAGE" on stderr when code is not WEFT_OK, and returns it as the exit code. */
int weft_command_exit(const char *command, const weft_common_options *common, weft_code code, const weft_error *error);

/* Tells the user, for computations that report. */
weft_log weft_command_log(const weft_common_options *common);

#endif
