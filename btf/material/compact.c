#include "btf/material/compact.h"

#include "btf/material/models.h"

#include <string.h>

/* How a section is laid out: planes of texels. */
typedef struct planes {
    uint8_t *texels;
    const uint8_t *model; /* [texel_count] */
    weft_section_kind kind;
    size_t plane_count, texel_count, texel_bytes;
} planes;

static planes planes_of(const weft_material *material, weft_section_kind kind, int k)
{
    const weft_material_level *level = &material->level[k];
    size_t count = (size_t)level->width * (size_t)level->height;
    planes p = {weft_section_texels(material, kind, k), level->model, kind, 0, count, 4};
    if (kind == WEFT_SECTION_LOBE) {
        p.plane_count = 3 * (size_t)material->lobe_count;
        p.texel_bytes = 4 * sizeof(weft_half);
    } else {
        p.plane_count = (size_t)(kind == WEFT_SECTION_TABL ? material->view_count : material->light_count);
    }
    return p;
}

static bool has_part(const planes *p, size_t plane, size_t texel)
{
    weft_model_parts parts = weft_model_decode(p->model[texel]);
    if (p->kind == WEFT_SECTION_LOBE)
        return (size_t)parts.lobe_count > plane / 3;
    return (p->kind == WEFT_SECTION_TABL ? parts.table_bits : parts.light_table_bits) > 0;
}

/* What changes nothing. */
static const void *neutral_texel(weft_section_kind kind)
{
    static const weft_half lobe[4] = {0, 0, 0, 0x3c00};
    static const uint8_t codes[4] = {255, 255, 255, 255};
    return kind == WEFT_SECTION_LOBE ? (const void *)lobe : codes;
}

bool weft_section_may_be_compact(const weft_material *material, weft_section_kind kind)
{
    return material->has_models &&
           (kind == WEFT_SECTION_LOBE || kind == WEFT_SECTION_TABL || kind == WEFT_SECTION_STAB);
}

uint64_t weft_section_compact_size(const weft_material *material, weft_section_kind kind, int level)
{
    planes p = planes_of(material, kind, level);
    uint64_t size = 0;
    for (size_t plane = 0; plane < p.plane_count; plane++) {
        for (size_t texel = 0; texel < p.texel_count; texel++)
            size += has_part(&p, plane, texel) ? p.texel_bytes : 0;
    }
    return size;
}

bool weft_section_compact(const weft_material *material, weft_section_kind kind, int level, uint8_t *bytes)
{
    planes p = planes_of(material, kind, level);
    const uint8_t *from = p.texels;
    for (size_t plane = 0; plane < p.plane_count; plane++) {
        for (size_t texel = 0; texel < p.texel_count; texel++, from += p.texel_bytes) {
            if (has_part(&p, plane, texel)) {
                memcpy(bytes, from, p.texel_bytes);
                bytes += p.texel_bytes;
            } else if (memcmp(from, neutral_texel(kind), p.texel_bytes) != 0) {
                return false;
            }
        }
    }
    return true;
}

void weft_section_expand(const weft_material *material, weft_section_kind kind, int level, const uint8_t *bytes)
{
    planes p = planes_of(material, kind, level);
    uint8_t *to = p.texels;
    for (size_t plane = 0; plane < p.plane_count; plane++) {
        for (size_t texel = 0; texel < p.texel_count; texel++, to += p.texel_bytes) {
            bool has = has_part(&p, plane, texel);
            memcpy(to, has ? bytes : neutral_texel(kind), p.texel_bytes);
            bytes += has ? p.texel_bytes : 0;
        }
    }
}
