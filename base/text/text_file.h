/* Text files that describe something: weaves, stitches, microcylinder cloth. */
#ifndef WEFT_BASE_TEXT_TEXT_FILE_H
#define WEFT_BASE_TEXT_TEXT_FILE_H

#include "base/status.h"

enum { WEFT_TEXT_FILE_MAX_BYTES = 10 << 20 };

/* Reads a whole file, which may be a pipe, into a terminated text; the caller frees it. Thread-safe. Errors:
 * WEFT_BAD_INPUT for a file that cannot be opened, is a folder, has more than WEFT_TEXT_FILE_MAX_BYTES or holds a byte
 * 0; WEFT_SYSTEM where reading fails or memory runs out. */
weft_code weft_text_file_read(const char *path, char **text, weft_error *error);

#endif
