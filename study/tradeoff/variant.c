#include "study/tradeoff/variant.h"

#include "btf/material/models.h"

#include <unistd.h>

weft_code weft_variant_make(const weft_material *fitted, const weft_priced_model *model, const char *path,
                            weft_material *result, weft_error *error)
{
    WEFT_TRY(weft_material_write(path, fitted, error));
    weft_code code = weft_material_read(path, result, error);
    unlink(path);
    WEFT_TRY(code);
    if (!model->options.heights)
        weft_material_take_heights(result, NULL);
    if (model->fewer_texels)
        weft_material_drop_finest(result);
    if (model->table_bits > 0)
        code = weft_material_round_tables(result, model->table_bits, error);
    if (code != WEFT_OK)
        weft_material_free(result);
    return code;
}
