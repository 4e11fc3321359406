#include "btf/material/material.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/fuzz.h"

#include <stdlib.h>

enum { COMPONENTS = 2 };

static weft_table_basis *basis_of(int directions, const weft_material_level *level, uint8_t *table)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    weft_table_basis *basis;
    if (weft_table_basis_create(COMPONENTS, directions, texels, &basis, NULL) != WEFT_OK)
        abort();
    for (size_t i = 0; i < basis->size; i++)
        basis->bytes[i] = (uint8_t)(37 * i);
    for (size_t i = 0; i < 3 * COMPONENTS * texels; i++)
        basis->coefficient[i] = (int8_t)(i % 255 - WEFT_BASIS_LARGEST_COEFFICIENT);
    weft_table_basis_decode(basis, table);
    return basis;
}

/* Tables as a mean and components. */
void fuzz_write_seed(const char *path)
{
    weft_material material;
    weft_bytes_write_example(path);
    if (weft_material_read(path, &material, NULL) != WEFT_OK)
        abort();
    for (int k = 0; k < material.level_count; k++) {
        weft_material_level *level = &material.level[k];
        level->table_basis = basis_of(material.view_count, level, level->table);
        level->light_table_basis = basis_of(material.light_count, level, level->light_table);
    }
    material.has_table_bases = true;
    if (weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
