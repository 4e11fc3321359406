/* ICC profiles of curves and colorants (ICC.1:2010, the model of three components): what cameras, phones and converters
 * of raw files write. The one door to Little CMS. */
#ifndef WEFT_BASE_PICTURE_ICC_PROFILE_H
#define WEFT_BASE_PICTURE_ICC_PROFILE_H

#include "base/picture/colour_space.h"

#include <stdint.h>

/* The space that a profile describes, with its name. Within rounding of sRGB it is sRGB. A profile of grey has one
 * curve for all. False for a profile of tables, of other colours than RGB and grey, or a damaged one; then only the
 * name is set, "" where there is none. Reads nothing outside of bytes [size]. Thread-safe. */
bool weft_icc_profile_read(const uint8_t *bytes, size_t size, weft_colour_space *space);

#endif
