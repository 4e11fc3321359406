/* The layout of NAME.weft (docs/reference/weft-format.md), shared by its reader and writer. Private to btf/. */
#ifndef WEFT_BTF_MATERIAL_FORMAT_H
#define WEFT_BTF_MATERIAL_FORMAT_H

#include "btf/material/material.h"

#include <stdbool.h>
#include <stdint.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "arrays are stored as they lie in memory");

enum {
    WEFT_FORMAT_VERSION = 1,
    WEFT_FORMAT_HEADER_SIZE = 64,
    WEFT_FORMAT_ENTRY_SIZE = 40,
    WEFT_FORMAT_ALIGNMENT = 64,
    WEFT_FORMAT_MAX_SECTIONS = 4096,
    WEFT_FORMAT_MAX_SIDE = 16384,
    WEFT_FORMAT_MAX_METADATA = 1 << 24,
    WEFT_FORMAT_PLAIN_METADATA = 4096, /* bytes that are never compressed */
    WEFT_FORMAT_MAX_RATIO = 1024,      /* a zstd section decodes to at most MAX_RATIO x stored + FREE_RATIO bytes */
    WEFT_FORMAT_FREE_RATIO = 1 << 16,  /* and a compact one expands to MAX_RATIO x the whole file + FREE_RATIO */
    WEFT_FORMAT_ERRORS = 5             /* numbers in an ERRO section */
};

extern const unsigned char weft_format_magic[8];

typedef enum weft_codec {
    WEFT_CODEC_NONE = 0,
    WEFT_CODEC_ZSTD = 1,
    WEFT_CODEC_DIFFERENCES = 2, /* of LAYR alone: Zstandard, with its values by differences; read, not written */
    WEFT_CODEC_WEIGHTED = 3     /* the same with the weights of what they are told from */
} weft_codec;

typedef enum weft_section_kind {
    WEFT_SECTION_META,
    WEFT_SECTION_VIEW,
    WEFT_SECTION_LITE,
    WEFT_SECTION_FRAM,
    WEFT_SECTION_RHO,
    WEFT_SECTION_LOBE,
    WEFT_SECTION_TABL,
    WEFT_SECTION_STAB,
    WEFT_SECTION_MODL,
    WEFT_SECTION_TPCA,
    WEFT_SECTION_SPCA,
    WEFT_SECTION_ALPH,
    WEFT_SECTION_ERRO,
    WEFT_SECTION_LAYR,
    WEFT_SECTION_LCOE,
    WEFT_SECTION_CEIL,
    WEFT_SECTION_FLOR,
    WEFT_SECTION_HGHT,
    WEFT_SECTION_SEEN,
    WEFT_SECTION_KINDS /* their number; stands for an unknown type */
} weft_section_kind;

/* One entry of the section table. */
typedef struct weft_section {
    char type[5]; /* NUL-terminated */
    uint32_t level, codec, checksum;
    uint64_t offset, stored_size, decoded_size;
} weft_section;

extern const char weft_section_type[WEFT_SECTION_KINDS][5];

/* The kind of a section type; WEFT_SECTION_KINDS for an unknown one. Pure. */
weft_section_kind weft_section_kind_of(const char type[5]);

/* Number of levels that hold a section of this kind: 0 where the material has none. Uses the counts only. Pure. */
int weft_section_levels(const weft_material *material, weft_section_kind kind);

/* Decoded bytes of a section, from the counts and level sizes only; 0 for META, TPCA and SPCA, whose sizes are free,
 * and for LAYR, LCOE, HGHT and SEEN while the components, heights or maps are not read. Pure. */
uint64_t weft_section_size(const weft_material *material, weft_section_kind kind, int level);

/* The texels of FRAM, RHO, LOBE, TABL, STAB, MODL, LCOE, CEIL and FLOR in memory; NULL for the other kinds. */
void *weft_section_texels(const weft_material *material, weft_section_kind kind, int level);

/* What is wrong with decoded contents ("holds ..."), NULL where they are fine: numbers that are not finite, negative
 * diffuse terms or exponents, directions that are no unit vectors of the upper hemisphere. Pure. */
const char *weft_section_fault(weft_section_kind kind, const void *bytes, size_t size);

/* Checks the counts and sets the sizes of all levels; allocates nothing. level_count 0 asks for the full chain.
 * Errors: WEFT_BAD_USAGE naming the number out of range. */
weft_code weft_material_set_shape(weft_material *material, int width, int height, int level_count, int lobe_count,
                                  int view_count, int light_count, weft_error *error);

/* Allocates the arrays of a material whose shape is set. On failure everything is freed. Errors: WEFT_SYSTEM. */
weft_code weft_material_allocate(weft_material *material, weft_error *error);

#endif
