/* The settings of a picture as one table: each with its name in the JSON text and, where the command line can change
 * it, with its option. Text, pictures, parser and help are made of it. */
#ifndef WEFT_PLAYER_SETTINGS_SCHEMA_H
#define WEFT_PLAYER_SETTINGS_SCHEMA_H

#include "base/text/option.h"

/* A table ends with {0}. */
typedef struct weft_setting {
    const char *key; /* "camera.distance" lies in the object "camera"; NULL: not a value, but an option for several */
    weft_option option; /* kind, place and range; also name and help where there is such an option */
    int count;          /* elements of an array, which its JSON holds in a list; 0: one value */
    /* A list of structures */
    const struct weft_setting *part; /* one of them */
    int most;
    size_t stride, count_offset; /* count_offset: of the int that counts them */
} weft_setting;

/* The groups of the help are numbered from 1; offsets are those in weft_settings (player/settings/settings.h). At
 * most 64. Static storage. */
const weft_setting *weft_settings_schema(void);

/* The title of a group; NULL beyond the last. */
const char *weft_settings_group(int group);

#endif
