#include "btf/dataset/derived.h"

#include "base/text/json_text.h"

#include "base/atomic_file.h"

#include <stdlib.h>

weft_code weft_derived_dataset_check(const weft_dataset *dataset, const char *output, const char *loss,
                                     weft_error *error)
{
    if (weft_is_same_file(weft_dataset_path(dataset), output))
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is the dataset itself; %s", output, loss);
    return WEFT_OK;
}

weft_code weft_derived_dataset_finish(weft_dataset_block_writer *writer, const weft_dataset_layout *source,
                                      const char *name, json_t *made, weft_error *error)
{
    char *text = weft_json_with_member(source->provenance, name, made, JSON_COMPACT);
    if (!text) {
        weft_dataset_block_writer_abandon(writer);
        return weft_fail_memory(error, "provenance", 0);
    }
    weft_code code = weft_dataset_block_writer_finish(writer, text, error);
    free(text);
    return code;
}
