/* The inner loop of player/raw/bc6h.h, compiled once for every instruction set. */
#ifndef WEFT_PLAYER_RAW_BC6H_KERNEL_H
#define WEFT_PLAYER_RAW_BC6H_KERNEL_H

#include "base/processor.h"
#include "player/raw/bc6h.h"

enum { WEFT_BC6H_BATCH = 16 }; /* blocks; a multiple of the lanes of every instruction set */

typedef struct weft_bc6h_batch {
    _Alignas(64) float value[WEFT_BC6H_TEXELS][3][WEFT_BC6H_BATCH];
    /* The results: bits that an end has less than 16, the ends in what is left, and the place of each texel, 0 to 15,
     * of the first texel at most 7 */
    _Alignas(64) int32_t shift[WEFT_BC6H_BATCH];
    int32_t end[2][3][WEFT_BC6H_BATCH];
    int32_t place[WEFT_BC6H_TEXELS][WEFT_BC6H_BATCH];
} weft_bc6h_batch;

/* Modes by the bits that their ends lack, and the largest difference of their ends in units of what is left. */
enum { WEFT_BC6H_MODES = 4 };
static const int32_t weft_bc6h_shift[WEFT_BC6H_MODES] = {6, 5, 4, 0};
static const int32_t weft_bc6h_reach[WEFT_BC6H_MODES] = {1023, 255, 127, 7};

#define WEFT_DECLARE_BC6H_KERNEL(set) void weft_bc6h_fit_##set(weft_bc6h_batch *batch)

WEFT_FOR_EACH_SET(WEFT_DECLARE_BC6H_KERNEL);

#endif
