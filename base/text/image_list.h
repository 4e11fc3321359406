/* The image files of a folder. */
#ifndef WEFT_BASE_TEXT_IMAGE_LIST_H
#define WEFT_BASE_TEXT_IMAGE_LIST_H

#include "base/text/lines.h"

/* Names (relative, sorted) of the image files in a folder and the folders in it. Hidden ones are passed over, and
 * folders that systems make for themselves: macOS writes ._IMG.jpg beside IMG.jpg, a Synology @eaDir. Freed with
 * weft_lines_free. Errors: WEFT_BAD_INPUT for what is no folder, or cannot be listed; WEFT_SYSTEM. */
weft_code weft_images_list(const char *folder, weft_lines *names, weft_error *error);

/* Says what a folder without images holds instead, and what to do. Errors: always; WEFT_BAD_INPUT, or as of
 * weft_images_list. */
weft_code weft_images_missing(const char *folder, weft_error *error);

#endif
