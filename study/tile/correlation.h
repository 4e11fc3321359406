/* How a material correlates with itself. Private to study/. */
#ifndef WEFT_STUDY_TILE_CORRELATION_H
#define WEFT_STUDY_TILE_CORRELATION_H

#include "study/tile/pictures.h"

/* Along one axis: lag 0, 1, .. of an even lag along the other of 0. Owned by the caller. */
typedef struct weft_tile_correlation {
    int columns, rows;
    double *along_x, *along_y; /* [columns], [rows] 1 at lag 0; lags whose overlap is more than a quarter, else 0 */
} weft_tile_correlation;

/* Sum over all pictures, each sum divided by the number of valid pairs. Errors: WEFT_SYSTEM. */
weft_code weft_tile_correlate(const weft_tile_pictures *pictures, weft_tile_correlation *correlation,
                              weft_error *error);
void weft_tile_correlation_free(weft_tile_correlation *correlation);

#endif
