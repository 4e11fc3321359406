/* How far a picture is from a traced one. */
#ifndef WEFT_COMPARE_TRUTH_PICTURE_ERROR_H
#define WEFT_COMPARE_TRUTH_PICTURE_ERROR_H

#include "base/numeric/error_summary.h"
#include "base/picture/image.h"
#include "player/draw/player.h"

/* Pixels along a side of the blocks whose means say how right the tone is, wherever the yarns lie. */
enum { WEFT_TRUTH_BLOCK = 8 };

typedef struct weft_truth_error {
    weft_error_summary error;   /* over the lit pixels of the mesh */
    double block_relative_rmse; /* of means over blocks all of whose pixels are lit; 0 where there is none */
} weft_truth_error;

/* `surface` [height][width] as weft_player_read_surface gives it; both pictures linear. Errors: WEFT_SYSTEM for
 * memory. */
weft_code weft_truth_error_of(const weft_image *truth, const weft_image *picture, const weft_surface_sample *surface,
                              weft_truth_error *result, weft_error *error);

#endif
