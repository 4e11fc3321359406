/* A growing list of lines: names of files, or what the user should know (a library never prints). */
#ifndef WEFT_BASE_TEXT_LINES_H
#define WEFT_BASE_TEXT_LINES_H

#include "base/status.h"
#include "weft/progress.h"

/* Appends a formatted line. Errors: WEFT_SYSTEM for memory. */
weft_code weft_lines_add(weft_lines *lines, weft_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
