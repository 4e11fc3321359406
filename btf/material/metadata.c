#include "btf/material/metadata.h"

#include "base/text/json_text.h"

#include <stdlib.h>

weft_code weft_material_put_metadata(weft_material *material, const char *name, json_t *value, weft_error *error)
{
    json_t *metadata = json_loads(material->metadata, 0, NULL);
    if (!metadata)
        json_decref(value);
    else
        weft_json_put(&metadata, name, value);
    char *text = metadata ? json_dumps(metadata, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
    json_decref(metadata);
    if (!text)
        return weft_fail_memory(error, "metadata of the material", 0);
    free(material->metadata);
    material->metadata = text;
    return WEFT_OK;
}
