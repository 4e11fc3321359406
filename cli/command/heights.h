/* The search for heights that ends every command which writes a dataset. */
#ifndef WEFT_CLI_HEIGHTS_H
#define WEFT_CLI_HEIGHTS_H

#include "cli/command/command.h"
#include "relief/relief.h"

/* The option of such a command; its values begin with weft_common_options and hold the switch in `member`. */
#define WEFT_HEIGHTS_OPTION(values, member)                                                                            \
    {                                                                                                                  \
        "heights",                                                                                                     \
            .argument = "on|off",                                                                                      \
            .help = "Look for heights in the parallax, as weft relief does, and keep what is found (default: on)",     \
            .kind = WEFT_OPTION_SWITCH, .offset = offsetof(values, member)                                             \
    }

/* Says what was decided, in a line and as an event "relief". */
void weft_heights_say(const weft_common_options *common, const weft_relief_report *report);

/* What there is to find in the closed dataset `path`. Errors: those of weft_relief_estimate and of reading. The caller
 * frees the report. */
weft_code weft_heights_estimate(const weft_common_options *common, const char *path, weft_relief_report *report,
                                weft_error *error);

/* Looks for heights in the closed dataset `path`, which was written just now, and keeps what was decided. The file
 * stays as it is where that is nothing, where its photographs can show no parallax, and where memory or disk do not
 * suffice, for the file is written anew; then the reason is said. */
void weft_heights_look(const weft_common_options *common, const char *path);

#endif
