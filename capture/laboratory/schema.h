/* The keys of a rig file: what each section may hold, and where it goes. */
#ifndef WEFT_CAPTURE_LABORATORY_SCHEMA_H
#define WEFT_CAPTURE_LABORATORY_SCHEMA_H

#include "capture/laboratory/rig_file.h"

#include <stddef.h>

typedef enum weft_key_kind {
    WEFT_KEY_NUMBER, /* double from low to high */
    WEFT_KEY_WHOLE,  /* the same, a whole number */
    WEFT_KEY_INT,    /* int from low to high */
    WEFT_KEY_TEXT,   /* char[WEFT_RIG_TEXT_SIZE] */
    WEFT_KEY_WORD,   /* an enum that counts from 0: one of `words` */
    WEFT_KEY_FLAG    /* bool: "yes" or "no" */
} weft_key_kind;

typedef struct weft_rig_key {
    const char *name;
    weft_key_kind kind;
    size_t offset; /* in the section's structure */
    bool required;
    double value, low, high; /* default and bounds */
    const char *text;        /* default of texts and words */
    const char *const *words;
} weft_rig_key;

typedef struct weft_rig_section {
    const char *name; /* "" for the file itself */
    size_t offset;    /* of its structure in weft_rig_file; of an axis: in weft_axis; of a camera:
                         in weft_camera_description */
    const weft_rig_key *key;
    int key_count;
} weft_rig_section;

enum { WEFT_RIG_SECTION_COUNT = 5, WEFT_RIG_KEYS_MAX = 32 };

/* The file itself, axis, stage, light, camera. */
extern const weft_rig_section weft_rig_schema[WEFT_RIG_SECTION_COUNT];

/* The key of that name in the section of that name, or NULL. */
const weft_rig_key *weft_rig_key_find(const char *section, const char *name);

#endif
