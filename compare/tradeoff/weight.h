/* The bytes of a material, and of one that has more texels. */
#ifndef WEFT_COMPARE_TRADEOFF_WEIGHT_H
#define WEFT_COMPARE_TRADEOFF_WEIGHT_H

#include "btf/material/material.h"

typedef struct weft_weight {
    double by_texels, shared; /* bytes that grow with the number of texels, and others */
    double texels;            /* of all levels */
} weft_weight;

/* Errors: those of weft_material_weigh. */
weft_code weft_weight_of(const weft_material *material, weft_weight *weight, weft_error *error);

/* Bytes of a file with a finest level of width x height, and levels above it where `levels`. Pure. */
double weft_weight_scaled(const weft_weight *weight, int width, int height, bool levels);

#endif
