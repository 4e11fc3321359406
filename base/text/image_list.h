/* The image files of a folder. */
#ifndef WEFT_BASE_TEXT_IMAGE_LIST_H
#define WEFT_BASE_TEXT_IMAGE_LIST_H

#include "base/text/lines.h"

/* Names (relative, sorted) of the image files in a folder and the folders in it. Freed with weft_lines_free. */
weft_code weft_images_list(const char *folder, weft_lines *names, weft_error *error);

#endif
