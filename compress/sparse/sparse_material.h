/* The sparse model as a material. */
#ifndef WEFT_COMPRESS_SPARSE_SPARSE_MATERIAL_H
#define WEFT_COMPRESS_SPARSE_SPARSE_MATERIAL_H

#include "base/progress.h"
#include "compress/sparse/sparse.h"
#include "compress/texel/texel.h"

/* Fits and measures all levels of `material`, whose shape is set: no table, at most one lobe. `setting` receives what
 * cross-validation chose. Errors: those of reading, WEFT_SYSTEM for memory. */
weft_code weft_sparse_material_fit(weft_dataset *dataset, const uint8_t *held_out, const weft_progress *progress,
                                   weft_material *material, weft_sparse_setting *setting, weft_texel_counts *counts,
                                   long *masked_count, weft_error *error);

#endif
