#include "btf/material/table_basis.h"

#include <stdlib.h>

uint64_t weft_table_basis_size(int component_count, int direction_count, size_t texel_count)
{
    uint64_t components = (uint64_t)component_count, directions = (uint64_t)direction_count;
    return 2 * directions * (1 + components) + 3 * components * (uint64_t)texel_count;
}

int weft_table_basis_components(uint64_t size, int direction_count, size_t texel_count)
{
    uint64_t mean = 2 * (uint64_t)direction_count, each = mean + 3 * (uint64_t)texel_count;
    if (size <= mean || (size - mean) % each != 0 || (size - mean) / each > WEFT_BASIS_MAX_COMPONENTS)
        return 0;
    return (int)((size - mean) / each);
}

weft_code weft_table_basis_create(int component_count, int direction_count, size_t texel_count,
                                  weft_table_basis **result, weft_error *error)
{
    weft_table_basis *basis = calloc(1, sizeof *basis);
    uint64_t size = weft_table_basis_size(component_count, direction_count, texel_count);
    *result = basis;
    if (!basis)
        return weft_fail_memory(error, "components of tables", sizeof *basis);
    *basis = (weft_table_basis){component_count, direction_count, texel_count, size, calloc(1, size), NULL, NULL, NULL};
    if (!basis->bytes) {
        weft_table_basis_free(basis);
        *result = NULL;
        return weft_fail_memory(error, "components of tables", size);
    }
    basis->mean = (int16_t *)(void *)basis->bytes;
    basis->component = basis->mean + direction_count;
    basis->coefficient = (int8_t *)(basis->component + (size_t)component_count * (size_t)direction_count);
    return WEFT_OK;
}

void weft_table_basis_free(weft_table_basis *basis)
{
    if (basis)
        free(basis->bytes);
    free(basis);
}

static uint8_t decode_code(const weft_table_basis *basis, int direction, const int8_t *coefficient)
{
    int32_t sum = basis->mean[direction] * (WEFT_BASIS_COMPONENT_UNIT / WEFT_BASIS_MEAN_UNIT);
    for (int k = 0; k < basis->component_count; k++)
        sum += coefficient[(size_t)k * 3 * basis->texel_count] *
               basis->component[(size_t)k * (size_t)basis->direction_count + (size_t)direction];
    sum = (sum + WEFT_BASIS_COMPONENT_UNIT / 2) >> 11;
    return (uint8_t)(sum < 0 ? 0 : sum > 255 ? 255 : sum);
}

void weft_table_basis_decode(const weft_table_basis *basis, uint8_t *table)
{
    for (int direction = 0; direction < basis->direction_count; direction++) {
        uint8_t *plane = table + (size_t)direction * basis->texel_count * 4;
        for (size_t channel = 0; channel < 3; channel++) {
            const int8_t *coefficient = basis->coefficient + channel * basis->texel_count;
            for (size_t texel = 0; texel < basis->texel_count; texel++)
                plane[4 * texel + channel] = decode_code(basis, direction, coefficient + texel);
        }
    }
}
