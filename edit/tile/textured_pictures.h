/* The photographs of a dataset in which a tile is looked for. Private to the room. */
#ifndef WEFT_EDIT_TILE_TEXTURED_PICTURES_H
#define WEFT_EDIT_TILE_TEXTURED_PICTURES_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"

enum { WEFT_TILE_PICTURES = 24 };

/* Owned by the caller, freed with weft_tile_pictures_free. */
typedef struct weft_tile_pictures {
    int width, height, count;
    int image[WEFT_TILE_PICTURES];
    float *value; /* [count][height][width] mean of the channels relative to that of the image, less 1; masked: the mean
                     of its valid neighbours, or 0 */
    uint8_t *mask; /* [count][height][width] 0: valid */
} weft_tile_pictures;

/* The photographs with the largest covariance of neighbouring texels relative to their mean, which noise does not
 * raise; none steeper than 65 degrees or less than half valid. Fewer than WEFT_TILE_PICTURES where the material is
 * large. Errors: WEFT_BAD_INPUT where there is none; those of reading; WEFT_SYSTEM. */
weft_code weft_tile_pictures_read(weft_dataset *dataset, const weft_progress *progress, weft_tile_pictures *pictures,
                                  weft_error *error);
void weft_tile_pictures_free(weft_tile_pictures *pictures);

#endif
