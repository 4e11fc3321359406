#include "btf/lines.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

weft_code weft_lines_add(weft_lines *notes, weft_error *error, const char *format, ...)
{
    char **line = realloc(notes->line, ((size_t)notes->count + 1) * sizeof *line);
    if (!line)
        return weft_fail_memory(error, "notes", ((unsigned long long)notes->count + 1) * sizeof *line);
    notes->line = line;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&notes->line[notes->count], format, arguments);
    va_end(arguments);
    if (length < 0)
        return weft_fail_memory(error, "note", 0);
    notes->count++;
    return WEFT_OK;
}

void weft_lines_free(weft_lines *notes)
{
    for (int i = 0; i < notes->count; i++)
        free(notes->line[i]);
    free(notes->line);
    *notes = (weft_lines){0};
}
