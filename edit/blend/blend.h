/* A material that tiles: its ends are laid over each other and cut where they differ least, as in image quilting (Efros
 * and Freeman 2001), in x and then in y. What they still differ by is spread over the tile, as smoothly as can be
 * (Perez, Gangnet and Blake 2003). What is blended is the codes of the texels, under all lights and views at once, so
 * that any material may be blended, also one of near photographs. */
#ifndef WEFT_EDIT_BLEND_BLEND_H
#define WEFT_EDIT_BLEND_BLEND_H

#include "btf/material/material.h"

/* Pairs of neighbouring texels of which the material knows nothing as neighbours: at the seam. How much they differ, as
 * the root mean square over eight pairs of light and view, is held against all pairs of neighbours in the material. The
 * cut was chosen by eight other pairs of directions. */
typedef struct weft_seam {
    long pair_count;
    double above_99th;      /* share of them above the 99th percentile of the material: 0.01 where none can be seen */
    double strongest;       /* the largest, over the largest of the material */
    double mean_difference; /* relative to the mean of the material: 1 where none can be seen */
} weft_seam;

typedef struct weft_blend_report {
    int width, height;        /* of the tile */
    int overlap_x, overlap_y; /* texels of the material that went into the overlap */
    weft_seam before, after;  /* repeated as it is, and as a tile */
} weft_blend_report;

/* How well the ends of a material meet where it is repeated as it is. Errors: WEFT_BAD_INPUT for a material of fewer
 * than 16 texels a side, WEFT_SYSTEM: it takes 128 bytes a texel. */
weft_code weft_seam_of_material(const weft_material *material, weft_seam *seam, weft_error *error);

/* Makes the tile: at least half as wide and high as the material, of a size at which its ends meet well. Components are
 * blended over three texels beside the cut; lobes and tables are cut. Then components, normals and the brightness of
 * lobes and diffuse term become as alike on both sides of the seam as the material is beside it. Mip levels are those
 * that were fitted (see btf/material/gather.h), changed by as much in the mean. The metadata of the result say what was
 * done in "tile", by which a comparison with the dataset knows that texels lie elsewhere. The caller frees *tile with
 * weft_material_free. Errors: WEFT_BAD_INPUT for a material of fewer than 16 texels a side, WEFT_SYSTEM. */
weft_code weft_blend(const weft_material *material, weft_material *tile, weft_blend_report *report, weft_error *error);

#endif
