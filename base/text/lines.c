#include "base/text/lines.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

weft_code weft_lines_add(weft_lines *lines, weft_error *error, const char *format, ...)
{
    char **line = realloc(lines->line, ((size_t)lines->count + 1) * sizeof *line);
    if (!line)
        return weft_fail_memory(error, "lines", ((unsigned long long)lines->count + 1) * sizeof *line);
    lines->line = line;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&lines->line[lines->count], format, arguments);
    va_end(arguments);
    if (length < 0)
        return weft_fail_memory(error, "line", 0);
    lines->count++;
    return WEFT_OK;
}

void weft_lines_free(weft_lines *lines)
{
    for (int i = 0; i < lines->count; i++)
        free(lines->line[i]);
    free(lines->line);
    *lines = (weft_lines){0};
}
