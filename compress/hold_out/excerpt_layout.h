/* The layout of some texels of a dataset. */
#ifndef WEFT_COMPRESS_HOLD_OUT_EXCERPT_LAYOUT_H
#define WEFT_COMPRESS_HOLD_OUT_EXCERPT_LAYOUT_H

#include "btf/dataset/dataset.h"

/* Of columns x rows texels that lie `stride` apart, as seen from `offset`, mm, from the centre of the source. The
 * caller frees, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_excerpt_make_layout(const weft_dataset_layout *source, int columns, int rows, int stride,
                                   weft_vec3 offset, weft_dataset_layout *layout, weft_error *error);

#endif
