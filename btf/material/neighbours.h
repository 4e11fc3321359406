/* The texels of a level around a texture coordinate (docs/reference/weft-format.md, 3.5). */
#ifndef WEFT_BTF_MATERIAL_NEIGHBOURS_H
#define WEFT_BTF_MATERIAL_NEIGHBOURS_H

#include "base/real.h"

#include <tgmath.h>

/* Two neighbouring texels of a repeated row or column, and how far the place between them lies toward the second. */
typedef struct weft_neighbours {
    int low, high;
    weft_real share;
} weft_neighbours;

/* `coordinate` is finite, in units of the material; texel centres lie at half texels of `count`. Pure. */
static inline weft_neighbours weft_neighbours_of(weft_real coordinate, int count)
{
    weft_real position = (coordinate - floor(coordinate)) * (weft_real)count - (weft_real)0.5;
    weft_real cell = floor(position);
    int low = ((int)cell + count) % count;
    weft_neighbours neighbours = {low, (low + 1) % count, position - cell};
    return neighbours;
}

#endif
