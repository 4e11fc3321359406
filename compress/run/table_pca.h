/* Tables of a level by weighted principal components: the small way to store T and S. */
#ifndef WEFT_COMPRESS_RUN_TABLE_PCA_H
#define WEFT_COMPRESS_RUN_TABLE_PCA_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"

/* Replaces the tables T and S of every level of `material` by what a mean and `component_count` components (fewer where
 * there are fewer directions) decode to, and keeps those for the file.
 *
 * A row is the codes x of one channel of one texel. Minimised is sum_row sum_d w_d |x_d - mean_d - sum_k c_k b_kd|^2
 * with w = <f|f>_d x_d^2 over the images that are not held out (of T over lights, of S over views), so that an error of
 * T or S counts as much as what it does to f: principal components of the rows by their mean weights (LAPACK), then
 * alternating weighted least squares for b and c (Gabriel and Zamir 1979) over up to 2^19 codes of texels spread
 * over the level, so that memory does not grow with the material, then c of every row
 * for the b that are stored. Equal input gives an equal result for any number of threads. Errors: WEFT_SYSTEM. */
weft_code weft_material_reduce_tables(const weft_dataset_layout *layout, const uint8_t *held_out,
                                      weft_material *material, int component_count, weft_error *error);

#endif
