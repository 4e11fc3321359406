/* What a material says of itself, as JSON. */
#ifndef WEFT_BTF_MATERIAL_METADATA_H
#define WEFT_BTF_MATERIAL_METADATA_H

#include "btf/material/material.h"

#include <jansson.h>

/* Puts `value` into the metadata under `name`, where it takes the place of what was there. `value` is given away, also
 * on failure; NULL, which jansson returns where memory is short, is such a failure. Errors: WEFT_SYSTEM for memory. */
weft_code weft_material_put_metadata(weft_material *material, const char *name, json_t *value, weft_error *error);

#endif
