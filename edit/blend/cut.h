/* The cut where two overlapping ends of a material differ least (Efros and Freeman 2001, section 2.1), and the length
 * at which they overlap best. Private to the room. */
#ifndef WEFT_EDIT_BLEND_CUT_H
#define WEFT_EDIT_BLEND_CUT_H

#include "edit/blend/pictures.h"

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

#endif
