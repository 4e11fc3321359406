#include "btf/material/file.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

static weft_code decode(const weft_material_file *file, const weft_section *section, uint8_t *bytes, weft_error *error)
{
    const unsigned char *stored = file->bytes + section->offset;
    if (section->codec == WEFT_CODEC_NONE) {
        memcpy(bytes, stored, section->decoded_size);
        return WEFT_OK;
    }
    size_t size = ZSTD_decompress(bytes, section->decoded_size, stored, section->stored_size);
    if (ZSTD_isError(size) || size != section->decoded_size)
        return weft_fail_section(file, section, error, "cannot be decoded to the size it claims");
    return WEFT_OK;
}

static void fill_array(weft_section_array array, const uint8_t *bytes)
{
    uint8_t *to = (uint8_t *)array.base + array.offset;
    for (size_t i = 0; i < array.count; i++)
        memcpy(to + i * array.stride, bytes + i * array.bytes, array.bytes);
}

static weft_code take(const weft_section_kind *kind, weft_section_reading *r, weft_error *error)
{
    int level = (int)r->section->level;
    if (kind->fault)
        r->fault = kind->fault(r->material, level, r->bytes, r->section->decoded_size);
    if (r->fault)
        return WEFT_BAD_INPUT;
    if (!kind->array)
        return kind->load(r, error);
    fill_array(kind->array(r->material, level), r->bytes);
    return WEFT_OK;
}

static weft_code read_section(weft_material_file *file, weft_material *material, const weft_section_kind *kind,
                              const weft_section *section, weft_error *error)
{
    uint8_t *bytes = malloc(section->decoded_size + 1);
    weft_section_reading reading = {file, material, section, bytes, NULL};
    if (!bytes)
        return weft_fail_memory(error, "section of the material", section->decoded_size + 1);
    weft_code code = decode(file, section, bytes, error);
    if (code == WEFT_OK)
        code = take(kind, &reading, error);
    free(bytes);
    return reading.fault ? weft_fail_section(file, section, error, reading.fault) : code;
}

static weft_code read_kind(weft_material_file *file, weft_material *material, int index, weft_error *error)
{
    const weft_section_kind *kind = &file->kind[index];
    for (int k = 0; weft_section_is_there(kind, file->features) && k < weft_section_levels(kind, material); k++)
        WEFT_TRY(read_section(file, material, kind, weft_file_section(file, index, k), error));
    return WEFT_OK;
}

/* A table without colours or without opacity is 1. */
static void fill_tables(const weft_material *material)
{
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        if (level->table)
            memset(level->table, 255, 4 * (size_t)material->view_count * weft_texel_count(material, k));
    }
}

static weft_code read_image(weft_material_file *file, weft_material *material, weft_error *error)
{
    WEFT_TRY(weft_material_file_open(file, material, error));
    WEFT_TRY(weft_material_allocate(material, error));
    fill_tables(material);
    for (int kind = 0; kind < file->kind_count; kind++)
        WEFT_TRY(read_kind(file, material, kind, error));
    return WEFT_OK;
}

weft_code weft_material_read(const char *path, weft_material *material, weft_error *error)
{
    *material = (weft_material){0};
    weft_material_file file = {.path = path};
    WEFT_TRY(weft_material_file_load(&file, error));
    weft_code code = read_image(&file, material, error);
    if (code != WEFT_OK)
        weft_material_free(material);
    weft_material_file_free(&file);
    return code;
}

weft_code weft_material_open(const char *path, weft_material **result, weft_error *error)
{
    weft_material *material = malloc(sizeof *material);
    if (!material)
        return weft_fail_memory(error, "material", sizeof *material);
    weft_code code = weft_material_read(path, material, error);
    if (code == WEFT_OK)
        *result = material;
    else
        free(material);
    return code;
}

weft_code weft_material_read_metadata(const char *path, char **metadata, weft_error *error)
{
    weft_material material = {0};
    weft_material_file file = {.path = path};
    *metadata = NULL;
    WEFT_TRY(weft_material_file_load(&file, error));
    weft_code code = weft_material_file_open(&file, &material, error);
    for (int kind = 0; kind < file.kind_count && code == WEFT_OK; kind++)
        if (strcmp(file.kind[kind].type, "META") == 0)
            code = read_kind(&file, &material, kind, error);
    if (code == WEFT_OK)
        *metadata = material.metadata;
    else
        free(material.metadata);
    weft_material_file_free(&file);
    return code;
}
