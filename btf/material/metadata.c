#include "btf/material/metadata.h"

#include "base/text/json_text.h"

#include <stdlib.h>

weft_code weft_material_put_metadata(weft_material *material, const char *name, json_t *value, weft_error *error)
{
    char *text = weft_json_with_member(material->metadata, name, value, JSON_COMPACT | JSON_SORT_KEYS);
    if (!text)
        return weft_fail_memory(error, "metadata of the material", 0);
    free(material->metadata);
    material->metadata = text;
    return WEFT_OK;
}
