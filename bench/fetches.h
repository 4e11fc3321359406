/* What a pixel fetches from a material, under one light and with neighbouring texels, levels and directions all
 * evaluated (WEFT_FILTER_EXACT). */
#ifndef WEFT_BENCH_FETCHES_H
#define WEFT_BENCH_FETCHES_H

#include "btf/material/material.h"

/* Reads of textures, as the shader has them, and the bytes of all texels that the hardware then interpolates. */
typedef struct weft_fetches {
    int reads, bytes;
} weft_fetches;

/* Of a material: of its components where it has some, through its heights where it has those, else of lobes and tables.
 * Pure. */
weft_fetches weft_fetches_of_material(const weft_material *material);

#endif
