/* The folder of photographs: which there are, and which have the size that most have. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_FOLDER_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_FOLDER_H

#include "registration/photographs/photographs.h"

/* Fewer photographs than this make no material. */
enum { WEFT_PHOTOGRAPHS_FEWEST = 3 };

/* Fills an empty `set` with the photographs of a folder, their names and what the camera wrote of them. One that
 * cannot be read, or has another size than most, gets a remark. The caller frees `set` with weft_photographs_free,
 * also after an error. Errors: WEFT_BAD_INPUT where there are too few, or none can be read; WEFT_SYSTEM. Uses OpenMP.
 */
weft_code weft_photographs_list(const char *folder, weft_photograph_set *set, weft_error *error);

/* Of a photograph of the size that most of those in use have; NULL where none is in use. Pure. */
const weft_exif *weft_photographs_common_size(const weft_photograph_set *set);

#endif
