/* The unit tile of a dataset that repeats: its size and place, found from the photographs, and a dataset of one tile,
 * the mean of all of them (Irawan and Marschner 2012, section 4.2). */
#ifndef WEFT_EDIT_TILE_TILE_H
#define WEFT_EDIT_TILE_TILE_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "reflectance/weave/weave.h"

/* A rectangle along the axes of the material that repeats over it. Texels, x to the right, y down, from the upper left
 * corner of the material: the tile covers [left + i width, left + (i + 1) width) x [top + j height, ..). */
typedef struct weft_tile {
    double width, height;
    double left, top; /* 0 <= left < width, 0 <= top < height; with a weave the corner of its tile, else 0 */
} weft_tile;

typedef struct weft_tile_report {
    weft_tile tile;
    double width_mm, height_mm;
    double tiles_x, tiles_y;   /* how many lie side by side in the material */
    int picture_count;         /* photographs it was found in: those with the strongest texture */
    double repeat_x, repeat_y; /* correlation of these with themselves one tile aside; 1 for a perfect repeat */
    double likeness; /* correlation of their mean tile with the weave under the same lights and views; 0 without */
    int texels_x, texels_y;   /* of the tile that was written */
    double residual_share;    /* of the variance of the texels that the mean tile does not explain, images alike */
    double residual_relative; /* its square root, relative to the mean of each image */
    long empty_count;         /* samples of the mean tile that no valid sample reached: written as missing */
} weft_tile_report;

/* Finds the tile from the autocorrelation of the photographs whose texture stands out most, to a fraction of a texel by
 * making the mean tile as contrasty as it gets. `weave` (may be NULL) tells which multiple of the shortest repeat is
 * its tile, and where that begins, by its texture under the same lights and views. Fills the report up to `likeness`.
 * Errors: WEFT_BAD_INPUT for a near dataset, too few texels, no repeat, or a repeat that does not look like the weave;
 * those of reading; WEFT_SYSTEM. */
weft_code weft_tile_find(weft_dataset *dataset, const weft_weave *weave, const weft_progress *progress,
                         weft_tile_report *report, weft_error *error);

/* How the tiles of a weave lie on the material if `tile` is one of them. A number of tiles within a hundredth of a
 * whole one is that: such a material was cut to repeat. Pure. */
weft_weave_layout weft_tile_layout(const weft_tile *tile, const weft_dataset_layout *material);

/* Averages all tiles, of all images, into one of texels_x x texels_y texels, about the size of those of the dataset,
 * and writes it as a dataset of the same images. Every valid sample counts, shared between the four texels of the tile
 * nearest to it. Reads the dataset once, or once for every gigabyte of the tile. Fills the rest of the report. Errors:
 * WEFT_BAD_USAGE where `output` is the dataset itself; those of reading and writing. */
weft_code weft_tile_write(weft_dataset *dataset, const char *output, const weft_progress *progress,
                          weft_tile_report *report, weft_error *error);

#endif
