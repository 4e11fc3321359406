/* PNG by libpng alone, which every desktop has loaded: OpenImageIO brings two hundred libraries, and a picture of a
 * material would wait for them longer than for its pixels. */
#ifndef WEFT_BASE_PICTURE_PNG_H
#define WEFT_BASE_PICTURE_PNG_H

#include "base/picture/image.h"

#include <stdbool.h>

/* The key of the tEXt chunk for Weft's own text. */
#define WEFT_PNG_SETTINGS "weft:settings"

/* Whether a path ends in .png, in any case. */
bool weft_png_is_named(const char *path);

/* Writes 8-bit sRGB atomically: values are clamped to 0..1 and rounded, what is no number is 0. The texts (ASCII, may
 * be NULL) go into tEXt chunks "Description" and "weft:settings". The same arguments give the same bytes. Thread-safe.
 * Errors: WEFT_SYSTEM. */
weft_code weft_png_write(const char *path, const weft_image *image, const char *description, const char *settings,
                         weft_error *error);

#endif
