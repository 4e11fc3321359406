/* Small pictures for the report. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_THUMBNAIL_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_THUMBNAIL_H

#include "base/half.h"
#include "base/picture/image.h"
#include "registration/lamp/read.h"

/* The photograph reduced to about 260 pixels across, sRGB. The caller frees it with weft_image_free. Errors:
 * WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_thumbnail_of_photograph(const weft_light_values *values, weft_image *thumbnail, weft_error *error);

/* Reflectance times cosine [height][width][3] reduced to at most 160 texels across, sRGB: 1 is white. As above. */
weft_code weft_thumbnail_of_texels(const weft_half *texel, int width, int height, weft_image *thumbnail,
                                   weft_error *error);

#endif
