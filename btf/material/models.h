/* Which model each texel of a material has: what it has of lobes, T and S. What it does not have is stored as what
 * changes nothing (docs/reference/weft-format.md, 3.6). All functions are thread-safe. */
#ifndef WEFT_BTF_MATERIAL_MODELS_H
#define WEFT_BTF_MATERIAL_MODELS_H

#include "btf/material/material.h"

typedef struct weft_model_parts {
    int lobe_count;
    int table_bits;       /* of T, per entry: 0 (T = 1), 4, 6 or 8 */
    int light_table_bits; /* of S, alike */
} weft_model_parts;

enum { WEFT_MODEL_CODES = 64, WEFT_MODEL_NAME = 80 };

/* As a byte of MODL. Pure. */
uint8_t weft_model_encode(weft_model_parts parts);
weft_model_parts weft_model_decode(uint8_t code);

/* "diffuse", "2 lobes, T 6 bits". */
void weft_model_print(weft_model_parts parts, char name[WEFT_MODEL_NAME]);

/* The nearest code of a table entry among 2^bits evenly spaced ones: round(255 i / (2^bits - 1)). Pure. */
uint8_t weft_table_code_rounded(uint8_t code, int bits);

/* Adds maps of models and fills them from what is stored: lobes that are not 0, codes of tables that are not 255, and
 * how many bits would hold them. Errors: WEFT_SYSTEM. */
weft_code weft_material_find_models(weft_material *material, weft_error *error);

/* Rounds the codes of T and S to so many bits (4, 6 or 8), and sets the maps of models. Errors: WEFT_SYSTEM. */
weft_code weft_material_round_tables(weft_material *material, int bits, weft_error *error);

/* Number of texels of a level with each model; all 0 without maps. */
void weft_material_count_models(const weft_material *material, int level, long count[WEFT_MODEL_CODES]);

#endif
