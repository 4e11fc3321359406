/* The used photographs as images of a dataset. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_MATERIAL_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_MATERIAL_H

#include "registration/photographs/photographs.h"

/* Resamples the photographs under their poses, divides by what a perfect white diffuser would show at every texel, and
 * writes the dataset. Errors: WEFT_BAD_INPUT where a file has gone since; WEFT_SYSTEM. Uses OpenMP. */
weft_code weft_photographs_write_dataset(const char *folder, const char *output,
                                         const weft_photographs_settings *settings, const weft_progress *progress,
                                         weft_photograph_set *set, weft_error *error);

#endif
