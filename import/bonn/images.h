/* Images of a file of Bonn: products of its matrices, in linear RGB. */
#ifndef WEFT_IMPORT_BONN_IMAGES_H
#define WEFT_IMPORT_BONN_IMAGES_H

#include "base/picture/image.h"
#include "import/bonn/file.h"

/* Images that are made together: what is unpacked of the texels serves all of them. */
enum { WEFT_BONN_GROUP = 16 };

/* How many images to make at a time so that they take no more than some 64 MB: 1 to WEFT_BONN_GROUP. Pure. */
int weft_bonn_group_size(const weft_bonn_file *file);

/* Makes images number[count] (view * light_count + light), count at most WEFT_BONN_GROUP; `image` [count] are of the
 * size of the file. Values may be above 1, below 0 and, where the file is odd, infinite. Thread-safe. Errors:
 * WEFT_SYSTEM. */
weft_code weft_bonn_images_make(const weft_bonn_file *file, const int *number, int count, weft_image *image,
                                weft_error *error);

/* ---- Frames of the texels ---- */

/* frames [height][width][2][3], unit normal and tangent: the means over the texels of the file whose centres lie in
 * each. False where one of the file is no frame above the surface, or a mean has no direction. Pure. */
bool weft_bonn_frames_average(const weft_bonn_file *file, int width, int height, float *frames);

#endif
