/* The two halves of reading a stitch. Private to the room. */
#ifndef WEFT_GEOMETRY_STITCH_SYNTAX_H
#define WEFT_GEOMETRY_STITCH_SYNTAX_H

#include "geometry/stitch/stitch.h"

/* What the text says, every number in its range and every yarn periodic. Frees what it allocated on failure. */
weft_code weft_stitch_parse_text(const char *text, const char *path, weft_stitch *stitch, weft_error *error);

/* Whether the yarns are solids: none bends tighter than its radius, stands upright or runs through another. */
weft_code weft_stitch_check(const weft_stitch *stitch, const char *path, weft_error *error);

#endif
