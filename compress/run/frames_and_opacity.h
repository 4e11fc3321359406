/* What a dataset keeps of its texels beside samples, frames and opacity, for all levels of a material. */
#ifndef WEFT_COMPRESS_RUN_FRAMES_AND_OPACITY_H
#define WEFT_COMPRESS_RUN_FRAMES_AND_OPACITY_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"

/* Writes the frames of the dataset into level 0, and into every level above the average over its group of texels
 * (Daubert et al. 2001, section 5.1): where a fit may begin. Errors: those of reading, WEFT_SYSTEM. */
weft_code weft_given_frames_store(weft_dataset *dataset, weft_material *material, weft_error *error);

/* ---- Opacity ---- */

/* Codes the opacity of every texel and view in level->table; that of a level is the mean over all texels of level 0
 * that its texels cover, as the samples are that they are fitted to, so that colour and opacity of a level belong
 * together. Nothing where the material has no view table. Errors: those of reading; WEFT_SYSTEM. */
weft_code weft_opacity_fill(weft_dataset *dataset, weft_material *material, weft_error *error);

#endif
