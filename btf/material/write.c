#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "btf/material/file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include <zstd.h>

/* Higher levels gain under 1 % on half floats and cost several times as long. */
static const int zstd_level = 6;
/* Of whole numbers and of what was pruned they gain a fifth. */
static const int high_level = 19;

/* The file as it grows in memory. */
typedef struct file_image {
    const char *path;
    unsigned char *bytes; /* zeroed beyond size */
    size_t size, capacity;
    weft_section section[WEFT_FORMAT_KINDS * WEFT_MATERIAL_MAX_LEVELS];
    int section_count;
    uint64_t by_texels; /* stored bytes of what grows with the number of texels */
} file_image;

static size_t aligned(size_t size)
{
    return (size + WEFT_FORMAT_ALIGNMENT - 1) / WEFT_FORMAT_ALIGNMENT * WEFT_FORMAT_ALIGNMENT;
}

static size_t table_end(int section_count)
{
    return WEFT_FORMAT_HEADER_SIZE + (size_t)section_count * WEFT_FORMAT_ENTRY_SIZE;
}

static void put(unsigned char **at, const void *value, size_t size)
{
    memcpy(*at, value, size);
    *at += size;
}

static void put_u32(unsigned char **at, uint32_t value)
{
    put(at, &value, sizeof value);
}

static void put_u64(unsigned char **at, uint64_t value)
{
    put(at, &value, sizeof value);
}

static void put_table(const file_image *file)
{
    unsigned char *at = file->bytes + WEFT_FORMAT_HEADER_SIZE;
    for (int i = 0; i < file->section_count; i++) {
        const weft_section *section = &file->section[i];
        put(&at, section->type, 4);
        put_u32(&at, section->level);
        put_u32(&at, section->codec);
        put_u32(&at, section->checksum);
        put_u64(&at, section->offset);
        put_u64(&at, section->stored_size);
        put_u64(&at, section->decoded_size);
    }
}

static void put_header(const file_image *file, const weft_material *material, uint32_t features)
{
    unsigned char *at = file->bytes;
    put(&at, weft_format_magic, sizeof weft_format_magic);
    put_u32(&at, WEFT_FORMAT_VERSION);
    put_u32(&at, (uint32_t)file->section_count);
    put_u64(&at, file->size);
    put_u32(&at, (uint32_t)material->level[0].width);
    put_u32(&at, (uint32_t)material->level[0].height);
    put_u32(&at, (uint32_t)material->level_count);
    put_u32(&at, material->has_lobes ? (uint32_t)material->lobe_count : 0);
    put_u32(&at, features & WEFT_FEATURE_VIEWS ? (uint32_t)material->view_count : 0);
    put_u32(&at, features);
    put(&at, &material->texel_pitch_mm, sizeof material->texel_pitch_mm);
    put_u32(&at, material->components ? (uint32_t)material->components->component_count : 0);
    size_t before = (size_t)(at - file->bytes);
    uLong checksum = crc32_z(0, file->bytes, before);
    checksum = crc32_z(checksum, file->bytes + WEFT_FORMAT_HEADER_SIZE,
                       table_end(file->section_count) - WEFT_FORMAT_HEADER_SIZE);
    put_u32(&at, (uint32_t)checksum);
}

/* Lengthens a Zstandard frame of `packed` bytes by a skippable one (RFC 8878, 3.1.2), so that a reader accepts that it
 * decodes to `size`. */
static size_t lengthen(unsigned char *stored, size_t packed, size_t size)
{
    enum { SKIPPABLE_HEADER = 8 };
    const uint32_t magic = 0x184d2a50;
    size_t least = size > WEFT_FORMAT_FREE_RATIO ? (size - WEFT_FORMAT_FREE_RATIO - 1) / WEFT_FORMAT_MAX_RATIO + 1 : 0;
    if (packed >= least)
        return packed;
    size_t missing = least - packed;
    uint32_t padding = missing > SKIPPABLE_HEADER ? (uint32_t)(missing - SKIPPABLE_HEADER) : 0;
    unsigned char *at = stored + packed;
    put_u32(&at, magic);
    put_u32(&at, padding);
    memset(at, 0, padding);
    return packed + SKIPPABLE_HEADER + padding;
}

/* Compresses into `stored`; 0 where the section had better be stored as it is. */
static size_t compress_section(unsigned char *stored, size_t capacity, const void *bytes, size_t size, int level)
{
    size_t packed = ZSTD_compress(stored, capacity, bytes, size, level);
    if (ZSTD_isError(packed) || packed >= size - size / 32)
        return 0;
    return lengthen(stored, packed, size);
}

static bool is_kind(const weft_section_kind *kind, const char *type)
{
    return strcmp(kind->type, type) == 0;
}

/* Views, errors and short metadata are left to readers without a Zstandard decoder. */
static bool may_be_packed(const weft_section_kind *kind, size_t size)
{
    if (is_kind(kind, "META"))
        return size > WEFT_FORMAT_PLAIN_METADATA;
    return !is_kind(kind, "ERRO") && !is_kind(kind, "VIEW");
}

static void add_section(file_image *file, const weft_material *material, const weft_section_kind *kind, int k,
                        const void *bytes, size_t size)
{
    size_t offset = aligned(file->size), bound = ZSTD_compressBound(size);
    unsigned char *stored = file->bytes + offset;
    int level = material->visibility || is_kind(kind, "COMP") ? high_level : zstd_level;
    size_t packed = may_be_packed(kind, size) ? compress_section(stored, bound, bytes, size, level) : 0;
    size_t stored_size = packed > 0 ? packed : size;
    if (packed == 0)
        memcpy(stored, bytes, size);
    /* The compressor may have touched more than it returned. */
    memset(stored + stored_size, 0, bound - stored_size);
    weft_section *section = &file->section[file->section_count++];
    *section = (weft_section){.level = (uint32_t)k,
                              .codec = packed > 0 ? WEFT_CODEC_ZSTD : WEFT_CODEC_NONE,
                              .checksum = (uint32_t)crc32_z(0, stored, stored_size),
                              .offset = offset,
                              .stored_size = stored_size,
                              .decoded_size = size};
    memcpy(section->type, kind->type, sizeof section->type);
    file->size = offset + stored_size;
    file->by_texels += kind->of_levels || is_kind(kind, "HGHT") ? stored_size : 0;
}

static void take_array(weft_section_array array, uint8_t *bytes)
{
    const uint8_t *from = (const uint8_t *)array.base + array.offset;
    for (size_t i = 0; i < array.count; i++)
        memcpy(bytes + i * array.bytes, from + i * array.stride, array.bytes);
}

static weft_code store_section(file_image *file, const weft_material *material, const weft_section_kind *kind, int k,
                               weft_error *error)
{
    size_t size = weft_section_size(kind, material, k);
    uint8_t *bytes = calloc(1, size + 1);
    if (!bytes)
        return weft_fail_memory(error, "section of the material", size + 1);
    if (kind->array)
        take_array(kind->array(material, k), bytes);
    else
        kind->store(material, k, bytes);
    const char *fault = kind->fault ? kind->fault(material, k, bytes, size) : NULL;
    if (!fault)
        add_section(file, material, kind, k, bytes, size);
    free(bytes);
    return fault ? weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': the material %s", file->path, fault) : WEFT_OK;
}

static int count_sections(const weft_material *material, uint32_t features)
{
    int count = 0;
    for (int i = 0; i < WEFT_FORMAT_KINDS; i++) {
        const weft_section_kind *kind = &weft_sections_of_version_2[i];
        count += weft_section_is_there(kind, features) ? weft_section_levels(kind, material) : 0;
    }
    return count;
}

/* Room for every section, each by itself at the worst that Zstandard does to it. */
static size_t largest_file(const weft_material *material, uint32_t features)
{
    size_t size = aligned(table_end(count_sections(material, features)));
    for (int i = 0; i < WEFT_FORMAT_KINDS; i++) {
        const weft_section_kind *kind = &weft_sections_of_version_2[i];
        for (int k = 0; weft_section_is_there(kind, features) && k < weft_section_levels(kind, material); k++)
            size += aligned(ZSTD_compressBound(weft_section_size(kind, material, k)));
    }
    return size;
}

static weft_code fill(file_image *file, const weft_material *material, weft_error *error)
{
    uint32_t features = weft_material_features(material);
    file->capacity = largest_file(material, features);
    file->bytes = calloc(1, file->capacity);
    if (!file->bytes)
        return weft_fail_memory(error, "material file", file->capacity);
    file->size = table_end(count_sections(material, features));
    for (int i = 0; i < WEFT_FORMAT_KINDS; i++) {
        const weft_section_kind *kind = &weft_sections_of_version_2[i];
        for (int k = 0; weft_section_is_there(kind, features) && k < weft_section_levels(kind, material); k++)
            WEFT_TRY(store_section(file, material, kind, k, error));
    }
    put_table(file);
    put_header(file, material, features);
    return WEFT_OK;
}

/* ---- What could not be read back ---- */

static weft_code check_metadata(const char *path, const char *metadata, weft_error *error)
{
    if (strlen(metadata) > WEFT_FORMAT_MAX_METADATA)
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': metadata has %zu bytes, at most %d are allowed",
                         path, strlen(metadata), WEFT_FORMAT_MAX_METADATA);
    json_error_t where;
    errno = 0;
    json_t *object = json_loads(metadata, 0, &where);
    bool valid = json_is_object(object);
    json_decref(object);
    return valid ? WEFT_OK
                 : weft_json_fail(error, WEFT_BAD_USAGE, "cannot write '%s': metadata is no JSON object", path);
}

weft_code weft_material_check_writable(const weft_material *material, weft_error *error)
{
    if (material->light_count > 0)
        return weft_fail(
            error, WEFT_BAD_USAGE,
            "the material has a light table, which files have not had since 0.2: compress its dataset again");
    if (!material->has_lobes && !material->components)
        return weft_fail(error, WEFT_BAD_USAGE, "the material has neither lobes nor components");
    return WEFT_OK;
}

static weft_code check_contents(const char *path, const weft_material *material, weft_error *error)
{
    if (!(material->texel_pitch_mm > 0) || !isfinite(material->texel_pitch_mm))
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': texel pitch is %g mm", path,
                         material->texel_pitch_mm);
    WEFT_TRY(check_metadata(path, material->metadata, error));
    weft_error cause = {0};
    if (weft_material_check_writable(material, &cause) != WEFT_OK)
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': %s", path, cause.message);
    return WEFT_OK;
}

/* ---- Writing ---- */

weft_code weft_material_write(const char *path, const weft_material *material, weft_error *error)
{
    WEFT_TRY(check_contents(path, material, error));
    file_image file = {.path = path};
    weft_code code = fill(&file, material, error);
    if (code == WEFT_OK)
        code = weft_write_file(path, file.bytes, file.size, error);
    free(file.bytes);
    return code;
}

weft_code weft_material_weigh(const weft_material *material, uint64_t *by_texels, uint64_t *shared, weft_error *error)
{
    file_image file = {.path = "the material"};
    weft_code code = check_contents(file.path, material, error);
    if (code == WEFT_OK)
        code = fill(&file, material, error);
    *by_texels = file.by_texels;
    *shared = file.size - file.by_texels;
    free(file.bytes);
    return code;
}

weft_code weft_material_size(const weft_material *material, uint64_t *size, weft_error *error)
{
    uint64_t by_texels, shared;
    weft_code code = weft_material_weigh(material, &by_texels, &shared, error);
    *size = by_texels + shared;
    return code;
}
