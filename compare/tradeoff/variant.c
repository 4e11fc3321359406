#include "compare/tradeoff/variant.h"

#include "btf/material/component_rounding.h"
#include "btf/material/models.h"

#include <string.h>
#include <unistd.h>

/* The others add nothing, and take next to no room in a file. */
static void keep_first_components(weft_components *components, int kept)
{
    for (size_t image = 0; image < (size_t)components->image_count; image++) {
        weft_half *value = components->value + 3 * image * (size_t)components->component_count;
        memset(value + 3 * kept, 0, 3 * (size_t)(components->component_count - kept) * sizeof *value);
    }
    for (int k = 0; k < components->level_count; k++) {
        const weft_components_level *level = &components->level[k];
        size_t texels = (size_t)level->width * (size_t)level->height;
        for (size_t i = 0; i < texels * (size_t)components->component_count; i++) {
            size_t layer = i / (WEFT_COMPONENTS_GROUP * texels) * WEFT_COMPONENTS_GROUP + i % WEFT_COMPONENTS_GROUP;
            if (layer >= (size_t)kept)
                level->coefficient[i] = 0;
        }
    }
}

weft_code weft_variant_make(const weft_material *fitted, const weft_priced_model *model, double rounding_step,
                            const char *path, weft_material *result, weft_error *error)
{
    WEFT_TRY(weft_material_write(path, fitted, error));
    weft_code code = weft_material_read(path, result, error);
    unlink(path);
    WEFT_TRY(code);
    if (!model->options.heights)
        weft_material_take_heights(result, NULL);
    if (model->first_components > 0 && result->components)
        keep_first_components(result->components, model->first_components);
    if (model->options.rounded && result->components && rounding_step > 0)
        weft_components_round(rounding_step, result->components);
    if (model->fewer_texels)
        weft_material_drop_finest(result);
    if (model->table_bits > 0)
        code = weft_material_round_tables(result, model->table_bits, error);
    if (code != WEFT_OK)
        weft_material_free(result);
    return code;
}
