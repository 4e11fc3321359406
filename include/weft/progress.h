/* How a long computation reports to its caller: how far it is, and messages that are no errors. */
#ifndef WEFT_PROGRESS_H
#define WEFT_PROGRESS_H

#include "weft/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* `report` may be NULL. It is called from one thread at a time, with 0 <= done <= total; `stage` is a present
 * participle in lower case ("registering views") that stays the same for the whole of a stage; it may be read during
 * the call alone. */
typedef struct weft_progress {
    void (*report)(void *context, const char *stage, long done, long total);
    void *context;
} weft_progress;

/* Messages that cannot wait for the end. `line` may be NULL; `text` is one line without a newline, to be read during
 * the call alone. */
typedef struct weft_log {
    void (*line)(void *context, const char *text);
    void *context;
} weft_log;

/* Messages that can: a list of lines, freed with weft_lines_free. */
typedef struct weft_lines {
    int count;
    char **line; /* [count] */
} weft_lines;

/* Leaves an empty list. */
WEFT_API void weft_lines_free(weft_lines *lines);

#ifdef __cplusplus
}
#endif
#endif
