#include "base/atomic_file.h"
#include "btf/material/certificate.h"
#include "btf/material/compact.h"
#include "btf/material/table.h"

#include <errno.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zstd.h>

static const size_t largest_file = (size_t)1 << 40;

static weft_code unpack(const weft_file_image *file, const weft_section *section, void *bytes, weft_error *error)
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

/* `bytes` holds decoded_size bytes. */
static weft_code decode(const weft_file_image *file, const weft_section *section, void *bytes, weft_error *error)
{
    WEFT_TRY(unpack(file, section, bytes, error));
    const char *fault = weft_section_fault(weft_section_kind_of(section->type), bytes, section->decoded_size);
    return fault ? weft_fail_section(file, section, error, fault) : WEFT_OK;
}

static weft_code read_metadata(const weft_file_image *file, const weft_section *section, weft_material *material,
                               weft_error *error)
{
    char *text = calloc(1, section->decoded_size + 1);
    if (!text)
        return weft_fail_memory(error, "metadata", section->decoded_size);
    free(material->metadata);
    material->metadata = text;
    WEFT_TRY(decode(file, section, text, error));
    json_error_t where;
    errno = 0;
    json_t *object = json_loadb(text, section->decoded_size, 0, &where);
    bool valid = json_is_object(object) && strlen(text) == section->decoded_size;
    const json_t *certified = json_object_get(object, "certificate");
    weft_certificate certificate;
    const char *fault = !valid ? "no JSON object" : certified ? weft_certificate_unpack(certified, &certificate) : NULL;
    json_decref(object);
    if (!valid && errno == ENOMEM)
        return weft_fail_memory(error, "metadata", section->decoded_size);
    return fault ? weft_fail_section(file, section, error, fault) : WEFT_OK;
}

static weft_code read_directions(const weft_file_image *file, const weft_section *section, int count,
                                 weft_vec3 *direction, weft_error *error)
{
    float *xyz = malloc(section->decoded_size);
    if (!xyz)
        return weft_fail_memory(error, "directions", section->decoded_size);
    weft_code code = decode(file, section, xyz, error);
    for (int i = 0; i < count && code == WEFT_OK; i++)
        direction[i] = weft_unit(weft_vec3_of(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]));
    free(xyz);
    return code;
}

static weft_code read_error(const weft_file_image *file, const weft_section *section, weft_error_summary *measured,
                            weft_error *error)
{
    double value[WEFT_FORMAT_ERRORS];
    WEFT_TRY(decode(file, section, value, error));
    *measured = (weft_error_summary){.median_relative = value[0],
                                     .percentile80_relative = value[1],
                                     .rmse = value[2],
                                     .relative_rmse = value[3],
                                     .psnr_db = value[4]};
    return WEFT_OK;
}

static weft_code read_compact(const weft_file_image *file, const weft_section *section, const weft_material *material,
                              weft_section_kind kind, int k, weft_error *error)
{
    if (section->decoded_size != weft_section_compact_size(material, kind, k))
        return weft_fail_section(file, section, error, "its size does not fit the models of its level");
    uint8_t *bytes = malloc(section->decoded_size + 1);
    if (!bytes)
        return weft_fail_memory(error, "compact section", section->decoded_size + 1);
    weft_code code = decode(file, section, bytes, error);
    if (code == WEFT_OK)
        weft_section_expand(material, kind, k, bytes);
    free(bytes);
    return code;
}

static weft_code read_basis(const weft_file_image *file, const weft_section *section, weft_material *material,
                            weft_section_kind kind, int k, weft_error *error)
{
    weft_material_level *level = &material->level[k];
    weft_table_basis **basis = kind == WEFT_SECTION_TPCA ? &level->table_basis : &level->light_table_basis;
    uint8_t *table = kind == WEFT_SECTION_TPCA ? level->table : level->light_table;
    int directions = weft_section_directions(material, kind);
    size_t texels = (size_t)material->level[k].width * (size_t)material->level[k].height;
    WEFT_TRY(weft_table_basis_create(weft_table_basis_components(section->decoded_size, directions, texels), directions,
                                     texels, basis, error));
    WEFT_TRY(decode(file, section, (*basis)->bytes, error));
    memset(table, 255, 4 * (size_t)directions * texels);
    weft_table_basis_decode(*basis, table);
    return WEFT_OK;
}

/* After TPCA. */
static weft_code read_opacity(const weft_file_image *file, const weft_section *section, const weft_material *material,
                              int k, weft_error *error)
{
    uint8_t *alpha = malloc(section->decoded_size), *table = material->level[k].table;
    if (!alpha)
        return weft_fail_memory(error, "opacity", section->decoded_size);
    weft_code code = decode(file, section, alpha, error);
    for (size_t i = 0; code == WEFT_OK && i < section->decoded_size; i++)
        table[4 * i + 3] = alpha[i];
    free(alpha);
    return code;
}

static weft_components_coding coding_of(const weft_section *section)
{
    return section->codec == WEFT_CODEC_DIFFERENCES ? WEFT_COMPONENTS_BY_DIFFERENCES
           : section->codec == WEFT_CODEC_WEIGHTED  ? WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES
                                                    : WEFT_COMPONENTS_AS_THEY_ARE;
}

/* Before LCOE, whose sizes show that the file is as large as the components it claims. */
static weft_code read_components(const weft_file_image *file, const weft_section *section, weft_material *material,
                                 weft_error *error)
{
    const weft_material_level *level = material->level;
    uint8_t *bytes = malloc(section->decoded_size + 1);
    if (!bytes)
        return weft_fail_memory(error, "components", section->decoded_size + 1);
    weft_code code = decode(file, section, bytes, error);
    const char *fault = NULL;
    uint32_t components = 0;
    if (code == WEFT_OK && section->decoded_size >= 8)
        memcpy(&components, bytes + 4, sizeof components);
    for (int k = 0; k < material->level_count && code == WEFT_OK; k++) {
        if (weft_file_section(file, WEFT_SECTION_LCOE, k)->decoded_size !=
            (uint64_t)components * (uint64_t)level[k].width * (uint64_t)level[k].height)
            code = weft_fail_section(file, section, error, "its components are not those of the coefficients");
    }
    if (code == WEFT_OK)
        code =
            weft_components_header_read(bytes, section->decoded_size, coding_of(section), level[0].width,
                                        level[0].height, material->level_count, &material->components, &fault, error);
    free(bytes);
    return fault ? weft_fail_section(file, section, error, fault) : code;
}

static weft_code read_heights(const weft_file_image *file, const weft_section *section, weft_material *material,
                              weft_error *error)
{
    uint8_t *bytes = malloc(section->decoded_size + 1);
    const char *fault = NULL;
    if (!bytes)
        return weft_fail_memory(error, "heights", section->decoded_size + 1);
    weft_code code = decode(file, section, bytes, error);
    if (code == WEFT_OK)
        code = weft_material_heights_read(bytes, section->decoded_size, &material->heights, &fault, error);
    free(bytes);
    return fault ? weft_fail_section(file, section, error, fault) : code;
}

static weft_code read_seen(const weft_file_image *file, const weft_section *section, weft_material *material,
                           weft_error *error)
{
    uint8_t *bytes = malloc(section->decoded_size + 1);
    const char *fault = NULL;
    if (!bytes)
        return weft_fail_memory(error, "maps of what is seen", section->decoded_size + 1);
    weft_code code = decode(file, section, bytes, error);
    if (code == WEFT_OK)
        code = weft_seen_read(bytes, section->decoded_size, material->level_count, &material->seen, &fault, error);
    free(bytes);
    return fault ? weft_fail_section(file, section, error, fault) : code;
}

static weft_code read_section(const weft_file_image *file, weft_material *material, weft_section_kind kind, int k,
                              weft_error *error)
{
    const weft_section *section = weft_file_section(file, kind, k);
    switch (kind) {
    case WEFT_SECTION_META:
        return read_metadata(file, section, material, error);
    case WEFT_SECTION_VIEW:
        return read_directions(file, section, material->view_count, material->view, error);
    case WEFT_SECTION_LITE:
        return read_directions(file, section, material->light_count, material->light, error);
    case WEFT_SECTION_ERRO:
        return read_error(file, section, &material->level[k].error, error);
    case WEFT_SECTION_TPCA:
    case WEFT_SECTION_SPCA:
        return read_basis(file, section, material, kind, k, error);
    case WEFT_SECTION_ALPH:
        return read_opacity(file, section, material, k, error);
    case WEFT_SECTION_LAYR:
        return read_components(file, section, material, error);
    case WEFT_SECTION_HGHT:
        return read_heights(file, section, material, error);
    case WEFT_SECTION_SEEN:
        return read_seen(file, section, material, error);
    default:
        if (section->decoded_size < weft_section_size(material, kind, k))
            return read_compact(file, section, material, kind, k, error);
        return decode(file, section, weft_section_texels(material, kind, k), error);
    }
}

static weft_code read_kind(const weft_file_image *file, weft_material *material, weft_section_kind kind,
                           weft_error *error)
{
    for (int k = 0; k < weft_section_levels(material, kind); k++)
        WEFT_TRY(read_section(file, material, kind, k, error));
    return WEFT_OK;
}

/* The maps of models come first: they say what compact sections hold. */
static weft_code read_sections(const weft_file_image *file, weft_material *material, weft_error *error)
{
    WEFT_TRY(read_kind(file, material, WEFT_SECTION_MODL, error));
    for (int kind = 0; kind < WEFT_SECTION_KINDS; kind++) {
        if (kind != WEFT_SECTION_MODL)
            WEFT_TRY(read_kind(file, material, (weft_section_kind)kind, error));
    }
    return WEFT_OK;
}

static weft_code read_image(weft_file_image *file, weft_material *material, weft_error *error)
{
    WEFT_TRY(weft_file_image_open(file, material, error));
    WEFT_TRY(weft_material_allocate(material, error));
    return read_sections(file, material, error);
}

weft_code weft_material_read(const char *path, weft_material *material, weft_error *error)
{
    *material = (weft_material){0};
    weft_file_image file = {.path = path};
    WEFT_TRY(weft_read_file(path, largest_file, (char **)&file.bytes, &file.size, error));
    weft_code code = read_image(&file, material, error);
    if (code != WEFT_OK)
        weft_material_free(material);
    free(file.section);
    free(file.bytes);
    return code;
}

weft_code weft_material_read_metadata(const char *path, char **metadata, weft_error *error)
{
    weft_material material = {0};
    weft_file_image file = {.path = path};
    *metadata = NULL;
    WEFT_TRY(weft_read_file(path, largest_file, (char **)&file.bytes, &file.size, error));
    weft_code code = weft_file_image_open(&file, &material, error);
    if (code == WEFT_OK)
        code = read_kind(&file, &material, WEFT_SECTION_META, error);
    if (code == WEFT_OK)
        *metadata = material.metadata;
    else
        free(material.metadata);
    free(file.section);
    free(file.bytes);
    return code;
}
