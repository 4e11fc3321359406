#include "btf/material/models.h"

#include <stdio.h>

/* ---- Codes ---- */

static const int bits_of_code[4] = {0, 4, 6, 8};

static unsigned code_of_bits(int bits)
{
    unsigned code = 0;
    while (code < 3 && bits_of_code[code] < bits)
        code++;
    return code;
}

uint8_t weft_model_encode(weft_model_parts parts)
{
    unsigned table = code_of_bits(parts.table_bits), light_table = code_of_bits(parts.light_table_bits);
    return (uint8_t)((unsigned)parts.lobe_count | table << 2 | light_table << 4);
}

weft_model_parts weft_model_decode(uint8_t code)
{
    return (weft_model_parts){code & 3, bits_of_code[code >> 2 & 3], bits_of_code[code >> 4 & 3]};
}

void weft_model_print(weft_model_parts parts, char name[WEFT_MODEL_NAME])
{
    char table[32] = "", light_table[32] = "";
    if (parts.table_bits > 0)
        snprintf(table, sizeof table, ", T %d bits", parts.table_bits);
    if (parts.light_table_bits > 0)
        snprintf(light_table, sizeof light_table, ", S %d bits", parts.light_table_bits);
    if (parts.lobe_count == 0)
        snprintf(name, WEFT_MODEL_NAME, "diffuse%s%s", table, light_table);
    else
        snprintf(name, WEFT_MODEL_NAME, "%d lobe%s%s%s", parts.lobe_count, parts.lobe_count > 1 ? "s" : "", table,
                 light_table);
}

uint8_t weft_table_code_rounded(uint8_t code, int bits)
{
    int steps = (1 << bits) - 1, step = (code * steps * 2 + 255) / 510;
    return (uint8_t)((step * 255 * 2 + steps) / (2 * steps));
}

/* ---- Maps ---- */

/* Highest lobe that has a direction in any channel. */
static int lobes_of(const weft_material *material, const weft_material_level *level, size_t texel)
{
    const unsigned sign = 0x8000;
    size_t texels = (size_t)level->width * (size_t)level->height;
    for (int lobe = material->lobe_count - 1; lobe >= 0; lobe--) {
        for (size_t channel = 0; channel < 3; channel++) {
            const weft_half *c = level->lobe + 4 * ((3 * (size_t)lobe + channel) * texels + texel);
            if ((c[0] | c[1] | c[2]) & ~sign)
                return lobe + 1;
        }
    }
    return 0;
}

/* The fewest bits that hold all codes of a texel; 0 where all are 255. */
static int bits_of_table(const uint8_t *table, size_t texels, size_t texel, int count)
{
    int needed = 0;
    for (int i = 0; i < 3 * count && needed < 3; i++) {
        uint8_t code = table[4 * ((size_t)(i / 3) * texels + texel) + (size_t)(i % 3)];
        if (code != 255 && needed == 0)
            needed = 1;
        while (needed > 0 && needed < 3 && weft_table_code_rounded(code, bits_of_code[needed]) != code)
            needed++;
    }
    return bits_of_code[needed];
}

static weft_model_parts parts_of(const weft_material *material, const weft_material_level *level, size_t texel)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    weft_model_parts parts = {.lobe_count = lobes_of(material, level, texel)};
    if (level->table)
        parts.table_bits = bits_of_table(level->table, texels, texel, material->view_count);
    if (level->light_table)
        parts.light_table_bits = bits_of_table(level->light_table, texels, texel, material->light_count);
    return parts;
}

weft_code weft_material_find_models(weft_material *material, weft_error *error)
{
    if (!material->has_models)
        WEFT_TRY(weft_material_add_models(material, error));
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        for (size_t texel = 0; texel < (size_t)level->width * (size_t)level->height; texel++)
            level->model[texel] = weft_model_encode(parts_of(material, level, texel));
    }
    return WEFT_OK;
}

static void round_codes(uint8_t *table, size_t texels, int count, int bits)
{
    for (size_t i = 0; table && i < 4 * texels * (size_t)count; i++)
        table[i] = i % 4 == 3 ? table[i] : weft_table_code_rounded(table[i], bits);
}

weft_code weft_material_round_tables(weft_material *material, int bits, weft_error *error)
{
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        size_t texels = (size_t)level->width * (size_t)level->height;
        round_codes(level->table, texels, material->view_count, bits);
        round_codes(level->light_table, texels, material->light_count, bits);
    }
    return weft_material_find_models(material, error);
}

void weft_material_count_models(const weft_material *material, int level, long count[WEFT_MODEL_CODES])
{
    const weft_material_level *at = &material->level[level];
    for (int code = 0; code < WEFT_MODEL_CODES; code++)
        count[code] = 0;
    for (size_t texel = 0; at->model && texel < (size_t)at->width * (size_t)at->height; texel++)
        count[at->model[texel]]++;
}
