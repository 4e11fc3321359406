/* What the files of photographs say of their colours: a phone writes Display P3, a camera can write Adobe RGB. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_FILE_COLOURS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_FILE_COLOURS_H

#include "registration/photographs/photographs.h"

/* Notes what the file at `path` says, and the matrix to linear sRGB that follows. The tone curve is found out in the
 * pictures, whatever is said of it. A file that cannot be read says nothing. Thread-safe. */
void weft_photographs_read_colours(const char *path, weft_photographs_photograph *photograph);

/* A line of the notes for all photographs in use that say the same: turned into sRGB, or not understood. */
weft_code weft_photographs_note_colours(weft_photograph_set *set, weft_error *error);

#endif
