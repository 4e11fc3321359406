/* A material as a viewer sees it, from a few directions, for the comparison of texels. Private to the room. */
#ifndef WEFT_EDIT_BLEND_PICTURES_H
#define WEFT_EDIT_BLEND_PICTURES_H

#include "btf/material/material.h"

enum { WEFT_BLEND_PAIRS = 8, WEFT_BLEND_VALUES = 4 * WEFT_BLEND_PAIRS };

/* Owned by the caller, freed with weft_blend_pictures_free. */
typedef struct weft_blend_pictures {
    int width, height;
    float *value; /* [height][width][WEFT_BLEND_VALUES] square roots of reflectance, and opacity */
} weft_blend_pictures;

/* Which pairs of light and view: those by which a cut is chosen, or others between them, by which it is judged. */
typedef enum weft_blend_pairs { WEFT_BLEND_CHOOSES, WEFT_BLEND_JUDGES } weft_blend_pairs;

/* Evaluates level 0 under pairs of light and view spread over the cones that were measured, by components where there
 * are any. A square root is about as bright as it looks. Errors: WEFT_BAD_INPUT for tables that cannot be triangulated,
 * WEFT_SYSTEM. */
weft_code weft_blend_pictures_make(const weft_material *material, weft_blend_pairs which, weft_blend_pictures *pictures,
                                   weft_error *error);
void weft_blend_pictures_free(weft_blend_pictures *pictures);

/* The same with x and y exchanged. Errors: WEFT_SYSTEM. */
weft_code weft_blend_pictures_transpose(const weft_blend_pictures *pictures, weft_blend_pictures *result,
                                        weft_error *error);

/* Means of squares of side x side texels; what is left over at the right and below is dropped. Errors: WEFT_SYSTEM. */
weft_code weft_blend_pictures_reduce(const weft_blend_pictures *pictures, int side, weft_blend_pictures *result,
                                     weft_error *error);

/* The mean squared difference of two texels. */
float weft_blend_difference(const weft_blend_pictures *a, int ax, int ay, const weft_blend_pictures *b, int bx, int by);

/* Room for pictures, zeroed. Errors: WEFT_SYSTEM. */
weft_code weft_blend_pictures_create(int width, int height, weft_blend_pictures *pictures, weft_error *error);

static inline float *weft_blend_texel(const weft_blend_pictures *pictures, int x, int y)
{
    return pictures->value + ((size_t)y * (size_t)pictures->width + (size_t)x) * WEFT_BLEND_VALUES;
}

#endif
