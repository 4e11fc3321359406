/* The two matrices whose product is a channel of a file of Bonn, in the order in which images are made of them. */
#ifndef WEFT_IMPORT_BONN_MATRIX_H
#define WEFT_IMPORT_BONN_MATRIX_H

#include "base/half.h"
#include "import/bonn/reader.h"

#include <stddef.h>

enum { WEFT_BONN_CHANNELS = 3 };

/* Texels that are multiplied at once. */
enum { WEFT_BONN_BLOCK = 64 };

/* What a channel needs of every image: value [image][stride], of which the first component_count count. Not owned. */
typedef struct weft_bonn_weights {
    const float *value;
    size_t stride;
} weft_bonn_weights;

/* What a channel needs of every texel: [block of texels][component][WEFT_BONN_BLOCK], 0 beyond the last texel. As
 * narrow as the file has it: one of the two is NULL. Not owned. */
typedef struct weft_bonn_textures {
    const weft_half *half;
    const float *single;
} weft_bonn_textures;

typedef struct weft_bonn_channel {
    int component_count;
    weft_bonn_weights weights;
    weft_bonn_textures textures;
} weft_bonn_channel;

typedef struct weft_bonn_matrices {
    size_t image_count, texel_count;
    weft_bonn_channel channel[WEFT_BONN_CHANNELS];
    void *owned[2 * WEFT_BONN_CHANNELS]; /* what the channels point to */
} weft_bonn_matrices;

/* The matrices of one channel; image_count and texel_count are set. Errors: WEFT_BAD_INPUT for sizes that do not belong
 * to the images and texels, more components than images, a number that is none, or a file that ends before;
 * WEFT_SYSTEM. The caller frees with weft_bonn_matrices_free, also after an error. */
weft_code weft_bonn_matrices_read_channel(weft_bonn_matrices *matrices, int channel, weft_bonn_reader *reader,
                                          weft_error *error);

/* The same of all channels in one pair of matrices: those of an image (or of a texel, where the matrix is transposed)
 * follow one another. */
weft_code weft_bonn_matrices_read_joint(weft_bonn_matrices *matrices, weft_bonn_reader *reader, weft_error *error);

void weft_bonn_matrices_free(weft_bonn_matrices *matrices);

#endif
