#include "tests/btf/material/weft_bytes.h"

#include "btf/direction/direction.h"
#include "btf/material/material.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

uint32_t weft_bytes_u32(const unsigned char *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

uint64_t weft_bytes_u64(const unsigned char *at)
{
    return weft_bytes_u32(at) | (uint64_t)weft_bytes_u32(at + 4) << 32;
}

void weft_bytes_put_u32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

void weft_bytes_put_u64(unsigned char *at, uint64_t value)
{
    weft_bytes_put_u32(at, (uint32_t)value);
    weft_bytes_put_u32(at + 4, (uint32_t)(value >> 32));
}

unsigned char *weft_bytes_entry(unsigned char *file, int index)
{
    return file + WEFT_BYTES_HEADER + WEFT_BYTES_ENTRY * index;
}

int weft_bytes_find(unsigned char *file, const char type[4], uint32_t level)
{
    int count = (int)weft_bytes_u32(file + 12);
    for (int i = 0; i < count; i++) {
        unsigned char *entry = weft_bytes_entry(file, i);
        if (memcmp(entry, type, 4) == 0 && weft_bytes_u32(entry + ENTRY_LEVEL) == level)
            return i;
    }
    return -1;
}

void weft_bytes_repair(unsigned char *file, size_t size, bool sections)
{
    size_t count = size < WEFT_BYTES_HEADER ? 0 : weft_bytes_u32(file + 12);
    if (count == 0 || count > (size - WEFT_BYTES_HEADER) / WEFT_BYTES_ENTRY)
        return;
    for (size_t i = 0; sections && i < count; i++) {
        unsigned char *entry = weft_bytes_entry(file, (int)i);
        uint64_t offset = weft_bytes_u64(entry + ENTRY_OFFSET), stored = weft_bytes_u64(entry + ENTRY_STORED);
        if (offset <= size && stored <= size - offset)
            weft_bytes_put_u32(entry + ENTRY_CHECKSUM, (uint32_t)crc32_z(0, file + offset, stored));
    }
    uLong checksum = crc32_z(0, file, 60);
    checksum = crc32_z(checksum, file + WEFT_BYTES_HEADER, count * WEFT_BYTES_ENTRY);
    weft_bytes_put_u32(file + 60, (uint32_t)checksum);
}

static void fill_level(weft_material *material, int k)
{
    weft_material_level *level = &material->level[k];
    int texels = level->width * level->height;
    for (int i = 0; i < 3 * texels; i++)
        level->frame[i] = (int16_t)(1000 * (k + 1) + 37 * i);
    for (int i = 0; i < 4 * texels; i++)
        level->diffuse[i] = weft_half_of_float((float)(k + i + 1) / 64);
    for (int i = 0; i < material->lobe_count * 12 * texels; i++)
        level->lobe[i] = weft_half_of_float((float)(i % 4 == 3 ? 1 + i % 60 : i % 11 - 5) / 4);
    for (int i = 0; i < material->view_count * 4 * texels; i++)
        level->table[i] = (uint8_t)(i * 7 + k);
    level->error = (weft_error_summary){0.01 + k, 0.02 + k, 0.03 + k, 0.04 + k, 50.0 + k, 0};
}

void weft_bytes_write_example(const char *path)
{
    weft_material material;
    if (weft_material_create(5, 3, 2, 4, 0, 1, &material, NULL) != WEFT_OK)
        abort();
    material.texel_pitch_mm = 0.125;
    for (int i = 0; i < material.view_count; i++)
        material.view[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    for (int k = 0; k < material.level_count; k++)
        fill_level(&material, k);
    free(material.metadata);
    material.metadata = strdup("{\"provenance\": \"made by a test\"}");
    if (!material.metadata || weft_material_write(path, &material, NULL) != WEFT_OK)
        abort();
    weft_material_free(&material);
}
