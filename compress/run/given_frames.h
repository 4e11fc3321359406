/* The average frames that a dataset knows of its texels, for all levels of a material. */
#ifndef WEFT_COMPRESS_RUN_GIVEN_FRAMES_H
#define WEFT_COMPRESS_RUN_GIVEN_FRAMES_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"

/* Writes the frames of the dataset into level 0, and into every level above the average over its group of texels
 * (Daubert et al. 2001, section 5.1): where a fit may begin. Errors: those of reading, WEFT_SYSTEM. */
weft_code weft_given_frames_store(weft_dataset *dataset, weft_material *material, weft_error *error);

#endif
