/* A structure of plain values as a JSON object, by one table of its fields that is both written and read: nothing is
 * written that is not read back. */
#ifndef WEFT_PLAYER_SETTINGS_JSON_FIELDS_H
#define WEFT_PLAYER_SETTINGS_JSON_FIELDS_H

#include "base/status.h"

#include <jansson.h>
#include <stddef.h>

typedef enum weft_json_kind {
    WEFT_JSON_NUMBER, /* double, from low to high */
    WEFT_JSON_ANGLE,  /* double in radians; in the file degrees, from low to high */
    WEFT_JSON_WHOLE,  /* int, from low to high */
    WEFT_JSON_SWITCH, /* bool */
    WEFT_JSON_CHOICE, /* an enum of the size of int that counts from 0; in the file one of the names in `choice` */
    WEFT_JSON_TEXT,   /* char *, owned, or NULL; in the file a string or null */
    WEFT_JSON_PART,   /* a structure by the table `part` */
    WEFT_JSON_LIST    /* an array of what `part` says, by one field without a name */
} weft_json_kind;

/* A table ends with a field of no kind and no name: {0}. */
typedef struct weft_json_field {
    const char *name;
    weft_json_kind kind;
    size_t offset; /* in the structure; of a list's element: 0 */
    double low, high;
    const char *const *choice; /* ends with NULL */
    const struct weft_json_field *part;
    int least, most;     /* elements of a list */
    size_t stride;       /* bytes from one element to the next */
    size_t count_offset; /* of the int that counts a list's elements; ignored where least = most */
} weft_json_field;

/* The caller owns *object. Errors: WEFT_BAD_USAGE for a number that is not finite; WEFT_SYSTEM. */
weft_code weft_json_write_fields(const weft_json_field *table, const void *structure, json_t **object,
                                 weft_error *error);

/* Fields that the object lacks stay as they are. `where` names the object in messages ("settings of 'a.png'"). Errors:
 * WEFT_BAD_INPUT with the path to the key that is unknown, of another type or out of range; what was read before it is
 * then set. */
weft_code weft_json_read_fields(const weft_json_field *table, const json_t *object, const char *where, void *structure,
                                weft_error *error);

#endif
