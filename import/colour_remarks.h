/* What the photographs of a collection say of their colours, gathered for the user. */
#ifndef WEFT_IMPORT_COLOUR_REMARKS_H
#define WEFT_IMPORT_COLOUR_REMARKS_H

#include "import/decode.h"

enum { WEFT_COLOUR_REMARKS = 8 };

/* Of photographs that say the same. */
typedef struct weft_colour_remark {
    weft_claim_kind claim;
    char words[200];
    int count, first; /* the lowest index */
} weft_colour_remark;

/* Starts as {0}. What is said beyond the eighth kind is dropped. */
typedef struct weft_colour_remarks {
    int count;
    weft_colour_remark remark[WEFT_COLOUR_REMARKS];
    int read, unsaid_exr;    /* photographs; and EXR files of them that say nothing */
    int more, first_of_more; /* files of more than one picture, and the lowest index of them */
} weft_colour_remarks;

/* Adds what photograph `index` says; in any order. */
void weft_colour_remarks_add(weft_colour_remarks *remarks, int index, const char *name, const weft_decoded *decoded);

/* A line for files of more than one picture, and one for each kind, that of the lowest index first; and a question
 * where EXR files that are named by their angles say nothing. */
weft_code weft_colour_remarks_note(weft_colour_remarks *remarks, const weft_collection *collection,
                                   weft_import_colours colours, weft_lines *notes, weft_error *error);

#endif
