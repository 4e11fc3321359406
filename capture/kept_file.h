/* Files of a camera that a session keeps as they are. */
#ifndef WEFT_CAPTURE_KEPT_FILE_H
#define WEFT_CAPTURE_KEPT_FILE_H

#include "base/status.h"

/* Puts the file of a camera where the session keeps it: moved, or copied and then removed where it lies on another
 * disk. Makes the folder. Errors: WEFT_SYSTEM; what was there is there still. */
weft_code weft_keep_file(const char *from, const char *to, weft_error *error);

#endif
