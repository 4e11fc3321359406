/* The corners of the target's markers in a photograph of unknown pose. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_CORNERS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_CORNERS_H

#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"

/* Fills marker_count, corner_count, plate and seen with corners that one plane explains, and the remark where there are
 * too few. Errors: WEFT_SYSTEM. */
weft_code weft_corners_find(const weft_target *target, const weft_light_values *values,
                            weft_photographs_photograph *photograph, weft_error *error);

#endif
