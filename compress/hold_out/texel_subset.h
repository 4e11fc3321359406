/* Some texels of a dataset with all of their images, in memory; and some of their images as a dataset of its own. */
#ifndef WEFT_COMPRESS_HOLD_OUT_TEXEL_SUBSET_H
#define WEFT_COMPRESS_HOLD_OUT_TEXEL_SUBSET_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "evaluate/error/predictor.h"

/* ---- Scattered ---- */

/* Places that lie evenly over a material without a period, so that no repeat of the cloth is hit again and again. */

/* Number 1, 2 .. of an additive sequence that fills a square evenly: along `axis` 0 or 1, from 0 to below 1. Pure. */
double weft_scattered_number(int axis, double number);

/* The texel that stands for cell (i, j) of a grid of columns x rows over width x height texels. Pure. */
void weft_scattered_texel(int columns, int rows, int width, int height, int i, int j, int *x, int *y);

/* Which texels. */
typedef enum weft_texel_subset_kind {
    WEFT_TEXEL_SUBSET_SCATTERED, /* one of every cell of a grid, each at another place in it, so that no repeat of the
                               cloth is hit again and again: for fits to which neighbours mean nothing, under far lights
                             */
    WEFT_TEXEL_SUBSET_REGULAR,   /* the same without moving them: near lights need texels at even distances */
    WEFT_TEXEL_SUBSET_BLOCK,     /* neighbours, from the centre: for fits that borrow from them */
    WEFT_TEXEL_SUBSET_PATCHES, /* squares of 16 x 16 neighbours (patches), one of every cell of a grid, where `side` is
                             a multiple of 16: what neighbours have in common stays, and no part stands for all. For far
                             lights */
    WEFT_TEXEL_SUBSET_SMALL_PATCHES /* the same of 4 x 4, where `side` is a multiple of 4 */
} weft_texel_subset_kind;

/* Freed with weft_texel_subset_free. */
typedef struct weft_texel_subset {
    weft_dataset_layout layout;   /* of these texels, its origin moved to their centre, without a plane; every image and
                                     view */
    weft_predicted_window window; /* of a block: where it lies in the dataset */
    weft_dataset_heights surface; /* of a block: that of the whole dataset (weft_dataset_read_surface); else none */
    double whole_mm[2];           /* width and height of the dataset */
    int neighbours;     /* of patches: the texels along their sides; of a block: along its longer side; else 1 */
    weft_half *samples; /* [height][width][image_count][3] */
    uint8_t *mask;      /* [height][width][image_count] */
    float *opacity;     /* [height][width][view_count]; NULL where the dataset has none */
    float *frames;      /* [height][width][2][3]; NULL where the dataset has none */
} weft_texel_subset;

/* A rectangle of texels. */
typedef struct weft_texel_block {
    int x, y, width, height;
} weft_texel_block;

/* At most side x side texels in the middle of the subset. Pure. */
weft_texel_block weft_texel_subset_middle(const weft_texel_subset *subset, int side);

/* Copies some texels of a far subset, without the surface. The caller frees *result. Errors: WEFT_SYSTEM for memory.
 */
weft_code weft_texel_subset_crop(const weft_texel_subset *subset, const weft_texel_block *block,
                                 weft_texel_subset *result, weft_error *error);

/* Whether the subset is seen through heights. Pure. */
bool weft_texel_subset_has_surface(const weft_texel_subset *subset);

/* Whether every sample is masked. Pure. */
bool weft_texel_subset_is_masked(const weft_texel_subset *subset);

/* Gives a material of these texels the heights of the whole dataset, for weft_predictor_of_window. Errors: those of
 * weft_material_heights_create. */
weft_code weft_texel_subset_give_heights(const weft_texel_subset *subset, weft_material *material, weft_error *error);

/* Reads at most `side` x `side` texels. The choice depends on the sizes alone. Errors: those of reading; WEFT_SYSTEM.
 */
weft_code weft_texel_subset_read(weft_dataset *dataset, weft_texel_subset_kind kind, int side,
                                 weft_texel_subset *subset, weft_error *error);
void weft_texel_subset_free(weft_texel_subset *subset);

/* Writes the images with held_out[image] == 0, and the views that still have any, to a dataset in the folder of `path`
 * and opens it, without a surface. It has no name once it is complete, so that nothing is left of it when it is closed,
 * however the program ends; weft_compress takes it without a checkpoint. What is held out is not in it. The caller
 * closes *result. Errors: those of writing and reading. */
weft_code weft_texel_subset_write(const weft_texel_subset *subset, const uint8_t *held_out, const char *path,
                                  weft_dataset **result, weft_error *error);

/* The same with the part of the surface that lies above these texels, unless it is too deep for them. */
weft_code weft_texel_subset_write_with_surface(const weft_texel_subset *subset, const uint8_t *held_out,
                                               const char *path, weft_dataset **result, weft_error *error);

/* ---- Subset layout ---- */

/* The layout of some texels of a dataset. */

/* Of columns x rows texels that lie `stride` apart, as seen from `offset`, mm, from the centre of the source. The
 * caller frees, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_texel_subset_make_layout(const weft_dataset_layout *source, int columns, int rows, int stride,
                                        weft_vec3 offset, weft_dataset_layout *layout, weft_error *error);

/* ---- Subset levels ---- */

/* Texels of several mip levels as texels of one subset: the means of samples that a material's coarser levels are
 * fitted to. */

enum {
    WEFT_TEXEL_SUBSET_LAST_LEVEL = 3,  /* of 8 x 8 texels: more would be read than is fitted */
    WEFT_TEXEL_SUBSET_LEVEL_SIDE = 8,  /* along each side, so many texels of a coarser level at most */
    WEFT_TEXEL_SUBSET_NO_LEVEL = 0xff, /* of a texel that fills up the last row */
};

/* Reads single texels, at most side x side, and then as many as 8 x 8 of each of levels 1, 2 and 3, where there are
 * four or more: each at another place of its cell of a grid over the whole. The first rows are the single texels; with
 * `side` 0 there are none. level [height][width] receives the level of each texel. A texel of a coarser level has the
 * means of those of the samples under it that are not masked. For far lights. The caller frees the subset and *level,
 * also on failure. Errors: those of reading; WEFT_SYSTEM. */
weft_code weft_texel_subset_read_levels(weft_dataset *dataset, int side, weft_texel_subset *subset, uint8_t **level,
                                        weft_error *error);

#endif
