/* The opacity of a dataset in the view table of a material. Private to the room. */
#ifndef WEFT_COMPRESS_RUN_OPACITY_H
#define WEFT_COMPRESS_RUN_OPACITY_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"

/* Codes the opacity of every texel and view in level->table; that of a level is the mean over all texels of level 0
 * that its texels cover, as the samples are that they are fitted to, so that colour and opacity of a level belong
 * together. Nothing where the material has no view table. Errors: those of reading; WEFT_SYSTEM. */
weft_code weft_opacity_fill(weft_dataset *dataset, weft_material *material, weft_error *error);

#endif
