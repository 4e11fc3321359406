#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "btf/material/compact.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include <zstd.h>

/* Higher levels gain under 1 % on half floats and cost several times as long. */
static const int zstd_level = 6;
/* Of what is rounded they gain a fifth. */
static const int rounded_level = 19;

/* The file as it grows in memory. */
typedef struct file_image {
    const char *path;
    unsigned char *bytes; /* zeroed beyond size */
    size_t size, capacity;
    weft_section section[WEFT_SECTION_KINDS * WEFT_MATERIAL_MAX_LEVELS];
    int section_count;
    int level; /* of Zstandard */
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

static void put_header(const file_image *file, const weft_material *material)
{
    unsigned char *at = file->bytes;
    put(&at, weft_format_magic, sizeof weft_format_magic);
    put_u32(&at, WEFT_FORMAT_VERSION);
    put_u32(&at, (uint32_t)file->section_count);
    put_u64(&at, file->size);
    put_u32(&at, (uint32_t)material->level[0].width);
    put_u32(&at, (uint32_t)material->level[0].height);
    put_u32(&at, (uint32_t)material->level_count);
    put_u32(&at, (uint32_t)material->lobe_count);
    put_u32(&at, (uint32_t)material->view_count);
    put_u32(&at, (uint32_t)material->light_count);
    put(&at, &material->texel_pitch_mm, sizeof material->texel_pitch_mm);
    put_u32(&at, 0);
    size_t before = (size_t)(at - file->bytes);
    uLong checksum = crc32_z(0, file->bytes, before);
    checksum = crc32_z(checksum, file->bytes + WEFT_FORMAT_HEADER_SIZE,
                       table_end(file->section_count) - WEFT_FORMAT_HEADER_SIZE);
    put_u32(&at, (uint32_t)checksum);
}

/* Compresses into `stored`; 0 where the section had better be stored as it is. */
static size_t compress_section(void *stored, size_t capacity, const void *bytes, size_t size, int level)
{
    size_t packed = ZSTD_compress(stored, capacity, bytes, size, level);
    if (ZSTD_isError(packed) || packed >= size - size / 32)
        return 0;
    return size <= (uint64_t)packed * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO ? packed : 0;
}

/* Directions, errors and short metadata are left to readers without a Zstandard decoder. */
static bool may_be_packed(weft_section_kind kind, size_t size)
{
    if (kind == WEFT_SECTION_META)
        return size > WEFT_FORMAT_PLAIN_METADATA;
    return kind >= WEFT_SECTION_FRAM && kind != WEFT_SECTION_ERRO;
}

static weft_code add_section(file_image *file, weft_section_kind kind, int level, const void *bytes, size_t size,
                             weft_error *error)
{
    const char *fault = weft_section_fault(kind, bytes, size);
    if (fault)
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': section %s of level %d %s", file->path,
                         weft_section_type[kind], level, fault);
    size_t offset = aligned(file->size), bound = ZSTD_compressBound(size);
    unsigned char *stored = file->bytes + offset;
    size_t packed = may_be_packed(kind, size) ? compress_section(stored, bound, bytes, size, file->level) : 0;
    size_t stored_size = packed > 0 ? packed : size;
    if (packed == 0)
        memcpy(stored, bytes, size);
    /* The compressor may have touched more than it returned. */
    memset(stored + stored_size, 0, bound - stored_size);
    weft_section *section = &file->section[file->section_count++];
    *section = (weft_section){.level = (uint32_t)level,
                              .codec = packed > 0 ? WEFT_CODEC_ZSTD : WEFT_CODEC_NONE,
                              .checksum = (uint32_t)crc32_z(0, stored, stored_size),
                              .offset = offset,
                              .stored_size = stored_size,
                              .decoded_size = size};
    memcpy(section->type, weft_section_type[kind], sizeof section->type);
    file->size = offset + stored_size;
    return WEFT_OK;
}

static weft_code add_directions(file_image *file, weft_section_kind kind, const weft_vec3 *direction, int count,
                                weft_error *error)
{
    size_t size = (size_t)count * 3 * sizeof(float);
    float *xyz = malloc(size);
    if (!xyz)
        return weft_fail_memory(error, "directions", size);
    for (int i = 0; i < count; i++) {
        xyz[3 * i] = (float)direction[i].x;
        xyz[3 * i + 1] = (float)direction[i].y;
        xyz[3 * i + 2] = (float)direction[i].z;
    }
    weft_code code = add_section(file, kind, 0, xyz, size, error);
    free(xyz);
    return code;
}

/* Compact where that is smaller and says all there is, and where a reader will believe it. */
static weft_code add_texels(file_image *file, const weft_material *material, weft_section_kind kind, int k,
                            weft_error *error)
{
    const void *texels = weft_section_texels(material, kind, k);
    uint64_t whole = weft_section_size(material, kind, k), size = whole;
    if (weft_section_may_be_compact(material, kind) &&
        whole <= file->size * (uint64_t)WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        size = weft_section_compact_size(material, kind, k);
    if (size == whole)
        return add_section(file, kind, k, texels, whole, error);
    uint8_t *bytes = malloc(size + 1);
    if (!bytes)
        return weft_fail_memory(error, "compact section", size + 1);
    weft_code code = weft_section_compact(material, kind, k, bytes) ? add_section(file, kind, k, bytes, size, error)
                                                                    : add_section(file, kind, k, texels, whole, error);
    free(bytes);
    return code;
}

static const weft_table_basis *basis_of(const weft_material *material, weft_section_kind kind, int k)
{
    const weft_material_level *level = &material->level[k];
    return kind == WEFT_SECTION_TPCA ? level->table_basis : level->light_table_basis;
}

static weft_code add_opacity(file_image *file, const weft_material *material, int k, weft_error *error)
{
    size_t size = weft_section_size(material, WEFT_SECTION_ALPH, k);
    uint8_t *alpha = malloc(size);
    if (!alpha)
        return weft_fail_memory(error, "opacity", size);
    for (size_t i = 0; i < size; i++)
        alpha[i] = material->level[k].table[4 * i + 3];
    weft_code code = add_section(file, WEFT_SECTION_ALPH, k, alpha, size, error);
    free(alpha);
    return code;
}

/* Bytes that the next section would take in the file, in whose free room it is tried. */
static size_t packed_size(const file_image *file, const void *bytes, size_t size)
{
    size_t packed =
        compress_section(file->bytes + aligned(file->size), ZSTD_compressBound(size), bytes, size, file->level);
    return packed > 0 ? packed : size;
}

/* The smaller one. Copies, as of images that a scene never reaches, are smaller as they are. They are compared at the
 * lower level, where a try of 1.3 MB takes 0.03 s: at the level that is written it takes 0.6 s, which would triple the
 * time that a price list or a pruning spends on each file. Only near a tie may that choose the larger one. */
static weft_components_coding choose_coding(const file_image *file, const weft_components *components, uint8_t *bytes)
{
    size_t packed[] = {0, 0};
    const weft_components_coding coding[] = {WEFT_COMPONENTS_AS_THEY_ARE, WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES};
    if (!weft_components_have_differences(components))
        return WEFT_COMPONENTS_AS_THEY_ARE;
    for (int i = 0; i < 2; i++) {
        weft_components_header_write(components, coding[i], bytes);
        packed[i] = packed_size(file, bytes, weft_components_header_size(components, coding[i]));
    }
    return coding[packed[1] < packed[0]];
}

static weft_code add_components(file_image *file, const weft_material *material, weft_error *error)
{
    size_t most = weft_components_header_size(material->components, WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES);
    uint8_t *bytes = malloc(most);
    if (!bytes)
        return weft_fail_memory(error, "components", most);
    weft_components_coding coding = choose_coding(file, material->components, bytes);
    weft_components_header_write(material->components, coding, bytes);
    int level = file->level;
    file->level = weft_components_have_differences(material->components) ? rounded_level : level;
    weft_code code = add_section(file, WEFT_SECTION_LAYR, 0, bytes,
                                 weft_components_header_size(material->components, coding), error);
    file->level = level;
    if (code == WEFT_OK && coding == WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES)
        file->section[file->section_count - 1].codec = WEFT_CODEC_WEIGHTED;
    free(bytes);
    return code;
}

static weft_code add_heights(file_image *file, const weft_material *material, weft_error *error)
{
    size_t size = weft_material_heights_size(material->heights);
    uint8_t *bytes = malloc(size);
    if (!bytes)
        return weft_fail_memory(error, "heights", size);
    weft_material_heights_write(material->heights, bytes);
    weft_code code = add_section(file, WEFT_SECTION_HGHT, 0, bytes, size, error);
    free(bytes);
    return code;
}

static weft_code add_seen(file_image *file, const weft_material *material, weft_error *error)
{
    size_t size = weft_seen_size(material->seen);
    uint8_t *bytes = calloc(1, size);
    if (!bytes)
        return weft_fail_memory(error, "maps of what is seen", size);
    weft_seen_write(material->seen, bytes);
    weft_code code = add_section(file, WEFT_SECTION_SEEN, 0, bytes, size, error);
    free(bytes);
    return code;
}

static weft_code add_level_section(file_image *file, const weft_material *material, weft_section_kind kind, int k,
                                   weft_error *error)
{
    const weft_error_summary *measured = &material->level[k].error;
    const double errors[WEFT_FORMAT_ERRORS] = {measured->median_relative, measured->percentile80_relative,
                                               measured->rmse, measured->relative_rmse, measured->psnr_db};
    switch (kind) {
    case WEFT_SECTION_META:
        return add_section(file, kind, 0, material->metadata, strlen(material->metadata), error);
    case WEFT_SECTION_VIEW:
        return add_directions(file, kind, material->view, material->view_count, error);
    case WEFT_SECTION_LITE:
        return add_directions(file, kind, material->light, material->light_count, error);
    case WEFT_SECTION_ERRO:
        return add_section(file, kind, k, errors, sizeof errors, error);
    case WEFT_SECTION_TPCA:
    case WEFT_SECTION_SPCA: {
        const weft_table_basis *basis = basis_of(material, kind, k);
        return add_section(file, kind, k, basis->bytes, basis->size, error);
    }
    case WEFT_SECTION_ALPH:
        return add_opacity(file, material, k, error);
    case WEFT_SECTION_LAYR:
        return add_components(file, material, error);
    case WEFT_SECTION_HGHT:
        return add_heights(file, material, error);
    case WEFT_SECTION_SEEN:
        return add_seen(file, material, error);
    default:
        return add_texels(file, material, kind, k, error);
    }
}

static int count_sections(const weft_material *material)
{
    int count = 0;
    for (int kind = 0; kind < WEFT_SECTION_KINDS; kind++)
        count += weft_section_levels(material, (weft_section_kind)kind);
    return count;
}

static size_t section_bytes(const weft_material *material, weft_section_kind kind, int k)
{
    if (kind == WEFT_SECTION_TPCA || kind == WEFT_SECTION_SPCA)
        return basis_of(material, kind, k)->size;
    return weft_section_size(material, kind, k);
}

/* Room for every section, each by itself at the worst that zstd does to it. */
static size_t largest_file(const weft_material *material)
{
    size_t size =
        aligned(table_end(count_sections(material))) + aligned(ZSTD_compressBound(strlen(material->metadata)));
    for (int kind = 0; kind < WEFT_SECTION_KINDS; kind++) {
        for (int k = 0; k < weft_section_levels(material, (weft_section_kind)kind); k++)
            size += aligned(ZSTD_compressBound(section_bytes(material, (weft_section_kind)kind, k)));
    }
    return size;
}

static weft_code fill(file_image *file, const weft_material *material, weft_error *error)
{
    file->level = material->seen ? rounded_level : zstd_level;
    file->capacity = largest_file(material);
    file->bytes = calloc(1, file->capacity);
    if (!file->bytes)
        return weft_fail_memory(error, "material file", file->capacity);
    file->size = table_end(count_sections(material));
    for (int kind = 0; kind < WEFT_SECTION_KINDS; kind++) {
        for (int k = 0; k < weft_section_levels(material, (weft_section_kind)kind); k++)
            WEFT_TRY(add_level_section(file, material, (weft_section_kind)kind, k, error));
    }
    put_table(file);
    put_header(file, material);
    return WEFT_OK;
}

static weft_code check_header(const char *path, const weft_material *material, weft_error *error)
{
    if (!(material->texel_pitch_mm > 0) || !isfinite(material->texel_pitch_mm))
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': texel pitch is %g mm", path,
                         material->texel_pitch_mm);
    if (strlen(material->metadata) > WEFT_FORMAT_MAX_METADATA)
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write '%s': metadata has %zu bytes, at most %d are allowed",
                         path, strlen(material->metadata), WEFT_FORMAT_MAX_METADATA);
    json_error_t where;
    errno = 0;
    json_t *object = json_loads(material->metadata, 0, &where);
    bool valid = json_is_object(object);
    json_decref(object);
    return valid ? WEFT_OK
                 : weft_json_fail(error, WEFT_BAD_USAGE, "cannot write '%s': metadata is no JSON object", path);
}

weft_code weft_material_write(const char *path, const weft_material *material, weft_error *error)
{
    WEFT_TRY(check_header(path, material, error));
    file_image file = {.path = path};
    weft_code code = fill(&file, material, error);
    if (code == WEFT_OK)
        code = weft_write_file(path, file.bytes, file.size, error);
    free(file.bytes);
    return code;
}

/* Of a section as it is stored, what grows with the number of texels: of a basis all but its mean and components. */
static uint64_t bytes_by_texels(const weft_material *material, const weft_section *section)
{
    weft_section_kind kind = weft_section_kind_of(section->type);
    if (kind == WEFT_SECTION_TPCA || kind == WEFT_SECTION_SPCA) {
        const weft_table_basis *basis = basis_of(material, kind, (int)section->level);
        uint64_t shared = weft_table_basis_size(basis->component_count, basis->direction_count, 0);
        return section->stored_size - section->stored_size * shared / basis->size;
    }
    bool is_texels = kind == WEFT_SECTION_ALPH || kind == WEFT_SECTION_HGHT ||
                     weft_section_texels(material, kind, (int)section->level);
    return is_texels ? section->stored_size : 0;
}

weft_code weft_material_weigh(const weft_material *material, uint64_t *by_texels, uint64_t *shared, weft_error *error)
{
    file_image file = {.path = "the material"};
    weft_code code = check_header(file.path, material, error);
    if (code == WEFT_OK)
        code = fill(&file, material, error);
    *by_texels = 0;
    for (int i = 0; i < file.section_count; i++)
        *by_texels += bytes_by_texels(material, &file.section[i]);
    *shared = file.size - *by_texels;
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
