/* View or light tables of a level as a mean and a few components: the contents of TPCA and SPCA
 * (docs/reference/weft-format.md). Integers throughout, so that every reader decodes the same codes:
 *     code(d) = (16 mean(d) + sum_k coefficient_k component_k(d) + 1024) >> 11, clamped to 0 .. 255 */
#ifndef WEFT_BTF_MATERIAL_TABLE_BASIS_H
#define WEFT_BTF_MATERIAL_TABLE_BASIS_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

enum {
    WEFT_BASIS_MEAN_UNIT = 128,       /* of a code */
    WEFT_BASIS_COMPONENT_UNIT = 2048, /* of a code, for a coefficient of 1 */
    WEFT_BASIS_LARGEST_COEFFICIENT = 127,
    WEFT_BASIS_MAX_COMPONENTS = 64
};

/* `bytes` is what is stored; the other pointers lead into it. */
typedef struct weft_table_basis {
    int component_count, direction_count;
    size_t texel_count, size;
    uint8_t *bytes;
    int16_t *mean;       /* [direction] */
    int16_t *component;  /* [component][direction] */
    int8_t *coefficient; /* [component][channel 3][texel] */
} weft_table_basis;

/* Bytes of a basis. Pure. */
uint64_t weft_table_basis_size(int component_count, int direction_count, size_t texel_count);

/* The number of components of a basis of so many bytes; 0 where there is none of that size. Pure. */
int weft_table_basis_components(uint64_t size, int direction_count, size_t texel_count);

/* Zeroed. Errors: WEFT_SYSTEM. The caller frees with weft_table_basis_free. */
weft_code weft_table_basis_create(int component_count, int direction_count, size_t texel_count,
                                  weft_table_basis **result, weft_error *error);
void weft_table_basis_free(weft_table_basis *basis);

/* Sets red, green and blue of table [direction][texel][4], and leaves the fourth byte as it is. Thread-safe. */
void weft_table_basis_decode(const weft_table_basis *basis, uint8_t *table);

#endif
