/* LOBE, TABL and STAB without the texels that have no such part (docs/reference/weft-format.md, 3.6): the map of models
 * of the level says which these are. Private to btf/. */
#ifndef WEFT_BTF_MATERIAL_COMPACT_H
#define WEFT_BTF_MATERIAL_COMPACT_H

#include "btf/material/format.h"

#include <stdbool.h>

/* True for the sections that may be compact: LOBE, TABL and STAB of a material with maps of models. Pure. */
bool weft_section_may_be_compact(const weft_material *material, weft_section_kind kind);

/* Bytes of such a section when compact; needs the map of the level. */
uint64_t weft_section_compact_size(const weft_material *material, weft_section_kind kind, int level);

/* Copies the texels that have the part into `bytes` [weft_section_compact_size], plane by plane. False where one that
 * is left out holds something all the same: then nothing but the whole section says it. */
bool weft_section_compact(const weft_material *material, weft_section_kind kind, int level, uint8_t *bytes);

/* The way back: all other texels get what changes nothing, a lobe of C = 0 and N = 1 or codes of 255. */
void weft_section_expand(const weft_material *material, weft_section_kind kind, int level, const uint8_t *bytes);

#endif
