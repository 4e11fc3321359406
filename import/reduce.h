/* Pictures become texels: reduced by averaging exact areas, in linear light. */
#ifndef WEFT_IMPORT_REDUCE_H
#define WEFT_IMPORT_REDUCE_H

#include "base/half.h"
#include "base/picture/image.h"

#include <stdbool.h>
#include <stddef.h>

/* Texels of the dataset when pictures of source_width x source_height are to be `asked` texels wide; 0: as they are.
 * Texels are square. Where the height does not come out whole, it is rounded down: less than half a texel is left out
 * above the picture, and as much below. Errors: WEFT_BAD_USAGE for more than there are, or less than one row. */
weft_code weft_reduced_size(int source_width, int source_height, int asked, int *width, int *height, weft_error *error);

/* Makes what is `white` 1, before it is stored as half floats. */
void weft_divide_by_white(double white, weft_image *image);

/* The first number of a picture that a half float cannot hold: its index, false where there is none. Pure. */
bool weft_find_unstorable(const weft_image *image, size_t *index);

/* Every texel becomes the mean of `image` over the area it covers; pixels that are covered in part count by that part.
 * The size is that of weft_reduced_size. samples [height][width][3]. touched [height][width]: all bits of flagged
 * [image height][width] of the pixels that took part; both NULL where none is. Thread-safe. Errors: WEFT_SYSTEM. */
weft_code weft_reduce(const weft_image *image, const uint8_t *flagged, int width, int height, weft_half *samples,
                      uint8_t *touched, weft_error *error);

#endif
