#include "btf/material/file.h"

#include "base/atomic_file.h"
#include "base/integers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

const unsigned char weft_format_magic[8] = {0x89, 'W', 'E', 'F', 'T', '\r', '\n', 0x1a};

static const size_t largest_file = (size_t)1 << 40;

enum { KNOWN_FEATURES = WEFT_FEATURE_LOBES | WEFT_FEATURE_COMPONENTS | WEFT_FEATURE_VIEWS | WEFT_FEATURE_OPACITY };

static uint32_t u32_at(const unsigned char *bytes)
{
    uint32_t value;
    memcpy(&value, bytes, sizeof value);
    return value;
}

static uint64_t u64_at(const unsigned char *bytes)
{
    uint64_t value;
    memcpy(&value, bytes, sizeof value);
    return value;
}

weft_code weft_material_file_load(weft_material_file *file, weft_error *error)
{
    return weft_read_file(file->path, largest_file, (char **)&file->bytes, &file->size, error);
}

void weft_material_file_free(weft_material_file *file)
{
    for (int k = 0; k < WEFT_MATERIAL_MAX_LEVELS; k++)
        free(file->model[k]);
    free(file->section);
    free(file->bytes);
}

/* ---- The header ---- */

static weft_code check_header(weft_material_file *file, weft_error *error)
{
    size_t start = file->size < sizeof weft_format_magic ? file->size : sizeof weft_format_magic;
    static const unsigned char hdf5[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
    if (file->size >= sizeof hdf5 && memcmp(file->bytes, hdf5, sizeof hdf5) == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a dataset; a material (NAME.weft) is needed here", file->path);
    if (memcmp(file->bytes, weft_format_magic, start) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is no .weft file", file->path);
    if (file->size < WEFT_FORMAT_HEADER_SIZE)
        return weft_fail(error, WEFT_DAMAGED, "'%s' is cut: %zu bytes, the header alone has %d", file->path, file->size,
                         WEFT_FORMAT_HEADER_SIZE);
    file->version = u32_at(file->bytes + 8);
    uint32_t sections = u32_at(file->bytes + 12);
    uint64_t size = u64_at(file->bytes + 16);
    if (file->version == 0)
        return weft_fail(error, WEFT_DAMAGED, "'%s' is damaged: version 0 of the format", file->path);
    if (file->version > WEFT_FORMAT_VERSION)
        return weft_fail(error, WEFT_NOT_SUPPORTED,
                         "'%s' was written by a newer Weft: version %u of the format, this program reads up to %d",
                         file->path, file->version, WEFT_FORMAT_VERSION);
    if (size != file->size)
        return weft_fail(error, WEFT_DAMAGED, "'%s' is %s: %zu bytes, its header says %llu", file->path,
                         file->size < size ? "cut" : "too long", file->size, (unsigned long long)size);
    if (sections < 1 || sections > WEFT_FORMAT_MAX_SECTIONS)
        return weft_fail(error, WEFT_DAMAGED, "'%s' has %u sections, must be 1 to %d", file->path, sections,
                         WEFT_FORMAT_MAX_SECTIONS);
    size_t table_size = (size_t)sections * WEFT_FORMAT_ENTRY_SIZE;
    if (file->size - WEFT_FORMAT_HEADER_SIZE < table_size)
        return weft_fail(error, WEFT_DAMAGED, "'%s' is cut: no room for its table of %u sections", file->path,
                         sections);
    uLong checksum = crc32_z(0, file->bytes, WEFT_FORMAT_HEADER_SIZE - 4);
    checksum = crc32_z(checksum, file->bytes + WEFT_FORMAT_HEADER_SIZE, table_size);
    if (checksum != u32_at(file->bytes + 60))
        return weft_fail(error, WEFT_DAMAGED, "'%s' is damaged: checksum of the header and section table", file->path);
    return WEFT_OK;
}

static weft_code read_features(weft_material_file *file, weft_error *cause)
{
    if (file->version == 1)
        return weft_read_features_of_version_1(file, cause);
    uint32_t components = u32_at(file->bytes + 56);
    bool has_components = file->features & WEFT_FEATURE_COMPONENTS;
    file->kind = weft_sections_of_version_2;
    file->kind_count = WEFT_FORMAT_KINDS;
    file->component_count = weft_limited_int(components);
    if (!(file->features & (WEFT_FEATURE_LOBES | WEFT_FEATURE_COMPONENTS)))
        return weft_fail(cause, WEFT_DAMAGED, "it has neither lobes nor components");
    if (has_components != (components > 0) || components > WEFT_COMPONENTS_MAX)
        return weft_fail(cause, WEFT_DAMAGED, "number of components is %u", components);
    if (!(file->features & WEFT_FEATURE_LOBES) && u32_at(file->bytes + 36) > 0)
        return weft_fail(cause, WEFT_DAMAGED, "it has a number of lobes without the feature");
    bool has_views = file->features & WEFT_FEATURE_VIEWS;
    if (has_views != (u32_at(file->bytes + 40) > 0) || ((file->features & WEFT_FEATURE_OPACITY) && !has_views))
        return weft_fail(cause, WEFT_DAMAGED, "number of views is %u", u32_at(file->bytes + 40));
    return WEFT_OK;
}

static weft_code read_shape(weft_material_file *file, weft_material *material, weft_error *error)
{
    const unsigned char *b = file->bytes;
    int level_count = weft_limited_int(u32_at(b + 32)),
        lights = file->version == 1 ? weft_limited_int(u32_at(b + 44)) : 0;
    weft_error cause = {0};
    weft_code code = weft_material_set_shape(
        material, weft_limited_int(u32_at(b + 24)), weft_limited_int(u32_at(b + 28)), level_count,
        weft_limited_int(u32_at(b + 36)), weft_limited_int(u32_at(b + 40)), lights, &cause);
    if (code == WEFT_OK && level_count == 0)
        code = weft_fail(&cause, WEFT_DAMAGED, "number of levels is 0, must be at least 1");
    memcpy(&material->texel_pitch_mm, b + 48, sizeof material->texel_pitch_mm);
    if (code == WEFT_OK && !(material->texel_pitch_mm > 0 && isfinite(material->texel_pitch_mm)))
        code = weft_fail(&cause, WEFT_DAMAGED, "texel pitch is %g mm", material->texel_pitch_mm);
    if (code == WEFT_OK)
        code = read_features(file, &cause);
    material->has_lobes = file->version == 1 || file->features & WEFT_FEATURE_LOBES;
    return code == WEFT_OK ? WEFT_OK : weft_fail(error, WEFT_DAMAGED, "'%s' is damaged: %s", file->path, cause.message);
}

/* ---- The table ---- */

static weft_section parse_entry(const unsigned char *entry)
{
    weft_section section = {.level = u32_at(entry + 4),
                            .codec = u32_at(entry + 8),
                            .checksum = u32_at(entry + 12),
                            .offset = u64_at(entry + 16),
                            .stored_size = u64_at(entry + 24),
                            .decoded_size = u64_at(entry + 32)};
    memcpy(section.type, entry, 4);
    return section;
}

weft_code weft_fail_section(const weft_material_file *file, const weft_section *section, weft_error *error,
                            const char *what)
{
    return weft_fail(error, WEFT_DAMAGED, "'%s' is damaged: section %s of level %u: %s", file->path, section->type,
                     section->level, what);
}

/* `end` is where the section before ends; on success where this one does. */
static weft_code check_place(const weft_material_file *file, const weft_section *section, uint64_t *end,
                             weft_error *error)
{
    if (section->offset % WEFT_FORMAT_ALIGNMENT != 0 || section->offset < *end ||
        section->offset - *end >= WEFT_FORMAT_ALIGNMENT)
        return weft_fail_section(file, section, error, "does not follow the one before");
    if (section->offset > file->size || section->stored_size > file->size - section->offset)
        return weft_fail_section(file, section, error, "reaches beyond the end of the file");
    for (uint64_t i = *end; i < section->offset; i++) {
        if (file->bytes[i] != 0)
            return weft_fail_section(file, section, error, "bytes before it are not zero");
    }
    *end = section->offset + section->stored_size;
    return WEFT_OK;
}

static weft_code check_codec(const weft_material_file *file, const weft_section *section, weft_error *error)
{
    if (section->codec == WEFT_CODEC_NONE)
        return section->decoded_size == section->stored_size
                   ? WEFT_OK
                   : weft_fail_section(file, section, error, "stored and decoded size differ without a codec");
    bool has_differences = section->codec == WEFT_CODEC_DIFFERENCES || section->codec == WEFT_CODEC_WEIGHTED;
    bool may_have = file->version == 1 && strcmp(section->type, "LAYR") == 0;
    if (section->codec != WEFT_CODEC_ZSTD && !(has_differences && may_have))
        return weft_fail_section(file, section, error, "unknown codec");
    /* stored_size is at most the size of the file, so the product cannot overflow. */
    if (section->decoded_size > section->stored_size * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        return weft_fail_section(file, section, error, "claims to decode to more than 1024 times its size");
    return WEFT_OK;
}

bool weft_section_is_there(const weft_section_kind *kind, uint32_t features)
{
    return (features & kind->needs) == kind->needs && !(features & kind->bars);
}

int weft_section_levels(const weft_section_kind *kind, const weft_material *material)
{
    return kind->of_levels ? material->level_count : 1;
}

uint64_t weft_section_size(const weft_section_kind *kind, const weft_material *material, int level)
{
    if (!kind->array)
        return kind->size(material, level);
    weft_section_array array = kind->array(material, level);
    return (uint64_t)array.count * array.bytes;
}

static int kind_of(const weft_material_file *file, const char type[5])
{
    int kind = 0;
    while (kind < file->kind_count && strcmp(file->kind[kind].type, type) != 0)
        kind++;
    return kind;
}

/* A section of an unknown kind is skipped. */
static weft_code note_section(weft_material_file *file, int index, const weft_material *material, weft_error *error)
{
    const weft_section *section = &file->section[index];
    int kind = kind_of(file, section->type);
    if (kind == file->kind_count)
        return WEFT_OK;
    if (section->level >= (uint32_t)weft_section_levels(&file->kind[kind], material))
        return weft_fail_section(file, section, error, "the material has no such section");
    if (file->found[kind][section->level])
        return weft_fail_section(file, section, error, "occurs twice");
    file->features |= file->kind[kind].reveals;
    file->found[kind][section->level] = index + 1;
    return WEFT_OK;
}

static weft_code check_size(const weft_material_file *file, const weft_section_kind *kind,
                            const weft_material *material, const weft_section *section, weft_error *error)
{
    const char *fault = NULL;
    if (kind->check)
        fault = kind->check(file, material, section);
    else if (!kind->is_free && section->decoded_size != weft_section_size(kind, material, (int)section->level))
        fault = "its size does not fit the material";
    return fault ? weft_fail_section(file, section, error, fault) : WEFT_OK;
}

static weft_code check_kind(const weft_material_file *file, int index, const weft_material *material, weft_error *error)
{
    const weft_section_kind *kind = &file->kind[index];
    bool is_there = weft_section_is_there(kind, file->features);
    for (int k = 0; k < weft_section_levels(kind, material); k++) {
        bool is_found = file->found[index][k];
        if (is_found && !is_there)
            return weft_fail_section(file, weft_file_section(file, index, k), error,
                                     "the material has no such section");
        if (!is_found && is_there)
            return weft_fail(error, WEFT_DAMAGED, "'%s' is damaged: section %s of level %d is missing", file->path,
                             kind->type, k);
        if (is_found)
            WEFT_TRY(check_size(file, kind, material, weft_file_section(file, index, k), error));
    }
    return WEFT_OK;
}

static weft_code read_table(weft_material_file *file, const weft_material *material, weft_error *error)
{
    file->section_count = (int)u32_at(file->bytes + 12);
    file->section = calloc((size_t)file->section_count, sizeof *file->section);
    if (!file->section)
        return weft_fail_memory(error, "section table", (size_t)file->section_count * sizeof *file->section);
    uint64_t end = WEFT_FORMAT_HEADER_SIZE + (uint64_t)file->section_count * WEFT_FORMAT_ENTRY_SIZE;
    for (int i = 0; i < file->section_count; i++) {
        const unsigned char *entry = file->bytes + WEFT_FORMAT_HEADER_SIZE + (size_t)i * WEFT_FORMAT_ENTRY_SIZE;
        file->section[i] = parse_entry(entry);
        WEFT_TRY(check_place(file, &file->section[i], &end, error));
        WEFT_TRY(check_codec(file, &file->section[i], error));
        WEFT_TRY(note_section(file, i, material, error));
    }
    if (end != file->size)
        return weft_fail(error, WEFT_DAMAGED, "'%s' is damaged: %llu bytes follow its last section", file->path,
                         (unsigned long long)(file->size - end));
    for (int kind = 0; kind < file->kind_count; kind++)
        WEFT_TRY(check_kind(file, kind, material, error));
    return WEFT_OK;
}

static weft_code check_checksums(const weft_material_file *file, weft_error *error)
{
    for (int i = 0; i < file->section_count; i++) {
        const weft_section *section = &file->section[i];
        if (crc32_z(0, file->bytes + section->offset, section->stored_size) != section->checksum)
            return weft_fail_section(file, section, error, "checksum does not match");
    }
    return WEFT_OK;
}

weft_code weft_material_file_open(weft_material_file *file, weft_material *material, weft_error *error)
{
    WEFT_TRY(check_header(file, error));
    uint32_t unknown = 0;
    if (file->version > 1) {
        file->features = u32_at(file->bytes + 44);
        unknown = file->features & (WEFT_FEATURE_OPTIONAL - 1) & ~(uint32_t)KNOWN_FEATURES;
    }
    if (unknown)
        return weft_fail(error, WEFT_NOT_SUPPORTED,
                         "'%s' was written by a newer Weft: it needs features 0x%x, which this program does not know",
                         file->path, unknown);
    WEFT_TRY(read_shape(file, material, error));
    WEFT_TRY(read_table(file, material, error));
    return check_checksums(file, error);
}
