#include "capture/camera/camera.h"

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Digits, with a point or, as some cameras have it, a comma; NULL where there are none. */
static const char *read_number(const char *at, double *number)
{
    double unit = 1;
    const char *start = at;
    *number = 0;
    for (; isdigit((unsigned char)*at); at++)
        *number = 10 * *number + (*at - '0');
    if (at > start && (*at == '.' || *at == ',')) {
        for (at++; isdigit((unsigned char)*at); at++)
            *number += (unit /= 10) * (*at - '0');
    }
    return at > start ? at : NULL;
}

double weft_shutter_seconds(const char *choice)
{
    double above, below = 1;
    const char *at = read_number(choice, &above);
    if (at && *at == '/')
        at = read_number(at + 1, &below);
    if (!at || !(below > 0))
        return 0;
    /* Seconds, if anything. */
    bool is_time = *at == 0 || strcmp(at, "s") == 0 || strcmp(at, "\"") == 0 || strcmp(at, " sec.") == 0;
    return is_time ? above / below : 0;
}
