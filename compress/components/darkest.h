/* How dark the samples of a texel get. */
#ifndef WEFT_COMPRESS_COMPONENTS_DARKEST_H
#define WEFT_COMPRESS_COMPONENTS_DARKEST_H

#include "compress/components/images.h"

/* So many of 1000 valid samples of a texel may be darker than its floor: noise, and what lies in a hard shadow. */
enum { WEFT_DARKER_OF_1000 = 20, WEFT_LEAST_IMAGES_OF_A_FLOOR = 50 };

/* The reflectance in each channel that all but 2 % of the valid samples of a texel reach, rounded down to what
 * weft_floor_of_code gives: floor [3]. `vector` and `valid` are as weft_component_images_gather makes them of `images`.
 * Fewer than WEFT_LEAST_IMAGES_OF_A_FLOOR valid samples say too little: 0. Pure. */
void weft_floor_of_texel(const weft_component_images *images, const float *vector, const uint8_t *valid,
                         float floor[3]);

#endif
