/* The text format of microcylinder cloth, `.mc` (docs/reference/microcylinder-format.md). */
#ifndef WEFT_REFLECTANCE_MICROCYLINDER_FILE_H
#define WEFT_REFLECTANCE_MICROCYLINDER_FILE_H

#include "base/text/block_parser.h"
#include "reflectance/microcylinder/microcylinder.h"

typedef struct weft_microcylinder_description {
    char name[128];
    weft_microcylinder_cloth cloth; /* admissible */
} weft_microcylinder_description;

/* Reads a cloth. `parameters` [parameter_count] fill in `$name`s as in weaves. Errors: WEFT_BAD_INPUT
 * "FILE:LINE:COLUMN: ..." for what is no cloth, also for numbers that together the model does not have. */
weft_code weft_microcylinder_read(const char *path, const weft_parameter *parameters, int parameter_count,
                                  weft_microcylinder_description *description, weft_error *error);

/* The same from a terminated text; `path` is for messages. */
weft_code weft_microcylinder_parse(const char *text, const char *path, const weft_parameter *parameters,
                                   int parameter_count, weft_microcylinder_description *description, weft_error *error);

#endif
