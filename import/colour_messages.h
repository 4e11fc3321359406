/* What the photographs of a collection say of their colours, gathered for the user. */
#ifndef WEFT_IMPORT_COLOUR_MESSAGES_H
#define WEFT_IMPORT_COLOUR_MESSAGES_H

#include "import/decode.h"

enum { WEFT_COLOUR_MESSAGES = 8 };

/* Of photographs that say the same. */
typedef struct weft_colour_message {
    weft_claim_kind claim;
    char words[200];
    int count, first; /* the lowest index */
} weft_colour_message;

/* Starts as {0}. What is said beyond the eighth kind is dropped. */
typedef struct weft_colour_messages {
    int count;
    weft_colour_message message[WEFT_COLOUR_MESSAGES];
    int read, unsaid_exr;    /* photographs; and EXR files of them that say nothing */
    int more, first_of_more; /* files of more than one picture, and the lowest index of them */
} weft_colour_messages;

/* Adds what photograph `index` says; in any order. */
void weft_colour_messages_add(weft_colour_messages *messages, int index, const char *name, const weft_decoded *decoded);

/* A line for files of more than one picture, and one for each kind, that of the lowest index first; and a question
 * where EXR files that are named by their angles say nothing. */
weft_code weft_colour_messages_note(weft_colour_messages *messages, const weft_collection *collection,
                                    weft_import_colours colours, weft_lines *notes, weft_error *error);

#endif
