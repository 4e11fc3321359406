/* Reduction of an image by exact area averaging. */
#ifndef WEFT_IMPORT_AREA_AVERAGE_H
#define WEFT_IMPORT_AREA_AVERAGE_H

#include "base/image.h"

/* Every pixel of `result` (allocated, no larger than `image`) becomes the mean of `image` over the area it covers;
 * pixels that are covered in part count by that part. touched [result height][width] = whether any pixel with flagged
 * [image height][width] != 0 took part. Errors: WEFT_SYSTEM for memory. */
weft_code weft_area_average(const weft_image *image, const uint8_t *flagged, weft_image *result, uint8_t *touched,
                            weft_error *error);

#endif
