/* The steps of blending: patches spread over a material, cut and joined without a seam. Private to edit/blend. */
#ifndef WEFT_EDIT_BLEND_STEPS_H
#define WEFT_EDIT_BLEND_STEPS_H

#include "base/status.h"
#include "btf/material/gather.h"
#include "btf/material/material.h"
#include "edit/blend/blend.h"

/* ---- Pictures ---- */

/* A material as a viewer sees it, from a few directions, for the comparison of texels. Private to the room. */

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

/* ---- Cut ---- */

/* The cut where two overlapping ends of a material differ least (Efros and Freeman 2001, section 2.1), and the length
 * at which they overlap best. Private to the room. */

/* A material of `size` columns, made of one that has `overlap` more: in row y the columns from at[y] on are the
 * material's own, those before come from `size` further right, where they follow the last column. Freed with
 * weft_cut_free. */
typedef struct weft_cut {
    int size, overlap;
    int *at;     /* [rows] WEFT_CUT_MARGIN .. overlap - WEFT_CUT_MARGIN */
    double cost; /* how much the ends differ along the cut, relative to neighbouring columns: squared differences */
} weft_cut;

enum { WEFT_CUT_MARGIN = 2, WEFT_CUT_LEAST_OVERLAP = 6, WEFT_CUT_LEAST_SIDE = 16 };

/* The cheapest path through cost [rows][columns] that moves by at most one column from row to row, from the last to the
 * first as well where it is `closed`: at [rows] receives its columns, within low .. high. *total receives its cost.
 * Errors: WEFT_SYSTEM. */
weft_code weft_cheapest_path(const float *cost, int rows, int columns, int low, int high, bool closed, int *at,
                             double *total, weft_error *error);

/* Chooses the size, from half the columns to all but WEFT_CUT_LEAST_OVERLAP, and the cut. A longer material is
 * preferred where it is joined almost as well. All columns are kept, with no overlap, where the last goes on in the
 * first as columns do elsewhere. `closed`: the rows go round. The pictures have at least
 * WEFT_CUT_LEAST_SIDE columns. Errors: WEFT_SYSTEM. */
weft_code weft_cut_find(const weft_blend_pictures *pictures, bool closed, weft_cut *cut, weft_error *error);
void weft_cut_free(weft_cut *cut);

/* How much of column x of row y comes from `size` further right: 1 before the cut, 0 after it, between them over three
 * columns. Pure. */
float weft_cut_share(const weft_cut *cut, int x, int y);

/* Pictures of the material that the cut makes, each texel from the side that has more of it. Errors: WEFT_SYSTEM. */
weft_code weft_cut_apply(const weft_blend_pictures *pictures, const weft_cut *cut, weft_blend_pictures *result,
                         weft_error *error);

/* ---- Seam ---- */

/* What can be seen of a seam. Private to the room. */

/* Measures the pictures of a tile, repeated, against those of the material that it is made of. `mix` [height][width] of
 * the tile; NULL for the material as it is. Errors: WEFT_SYSTEM. */
weft_code weft_seam_measure(const weft_blend_pictures *material, const weft_blend_pictures *tile,
                            const weft_texel_mix *mix, weft_seam *seam, weft_error *error);

/* ---- Membrane ---- */

/* A field that is as steep across the edges of a grid as it is asked to be, in the mean of squares. Private to the
 * room. */

/* A grid that goes round in x and in y. Every texel has an edge to the right and one downwards. */
typedef struct weft_membrane {
    int width, height;
    float *step[2]; /* [height][width] what the field should rise by across the edge to the right, and downwards */
    float *value;   /* [height][width] the field */
} weft_membrane;

/* Room for a grid, zeroed. Freed with weft_membrane_free. Errors: WEFT_SYSTEM. */
weft_code weft_membrane_create(int width, int height, weft_membrane *membrane, weft_error *error);
void weft_membrane_free(weft_membrane *membrane);

/* Sets the field, whose mean is 0, to the one that minimises the sum over edges of (rise - step)^2: a discrete Poisson
 * equation (Perez, Gangnet and Blake 2003). Where the steps around are 0 the field is the mean of its neighbours.
 * Conjugate gradients, begun from the solution on a grid half as fine, down to 1e-4 of the steps. Errors: WEFT_SYSTEM.
 */
weft_code weft_membrane_solve(weft_membrane *membrane, weft_error *error);

/* ---- Spread ---- */

/* What the ends of a material differ by, spread over the tile that is made of them. Private to the room. */

/* `tile` is what weft_material_gather made of `from` by `mix`. Adds to a code a field by which the step across the seam
 * becomes what the material has beside it: the mean of the steps of both ends. The field is as smooth as it can be and
 * 0 in the mean, so that edges inside change little. Mip levels get its mean over what they cover.
 *
 * - To each layer, which is linear: that does it under all lights and views at once. Ceilings and floors are widened by
 *   as much as the mean reflectance changes.
 * - To the logarithm of how bright lobes and diffuse term are, by which these are then multiplied.
 *
 * Frames, tables and heights stay. Errors: WEFT_BAD_INPUT for tables that cannot be triangulated, WEFT_SYSTEM. */
weft_code weft_blend_spread(const weft_material *from, const weft_texel_mix *mix, weft_material *tile,
                            weft_error *error);

#endif
