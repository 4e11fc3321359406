#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void blank_control_characters(char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text < 0x20 || *text == 0x7f)
            *text = '?';
    }
}

void weft_error_set(weft_error *error, weft_code code, const char *format, ...)
{
    if (!error)
        return;
    error->code = code;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    blank_control_characters(error->message);
}

void weft_error_set_errno(weft_error *error, const char *action, const char *path)
{
    weft_error_set(error, weft_code_of_errno(), "cannot %s '%s': %s", action, path, strerror(errno));
}
