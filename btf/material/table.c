#include "btf/material/table.h"

#include "btf/material/compact.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

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

static weft_code check_header(const weft_file_image *file, weft_error *error)
{
    size_t start = file->size < sizeof weft_format_magic ? file->size : sizeof weft_format_magic;
    static const unsigned char hdf5[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
    if (file->size >= sizeof hdf5 && memcmp(file->bytes, hdf5, sizeof hdf5) == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a dataset: a material (NAME.weft) belongs in its place",
                         file->path);
    if (memcmp(file->bytes, weft_format_magic, start) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is no .weft file", file->path);
    if (file->size < WEFT_FORMAT_HEADER_SIZE)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is cut: %zu bytes, the header alone has %d", file->path,
                         file->size, WEFT_FORMAT_HEADER_SIZE);
    uint32_t version = u32_at(file->bytes + 8), sections = u32_at(file->bytes + 12);
    uint64_t size = u64_at(file->bytes + 16);
    if (version != WEFT_FORMAT_VERSION)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has version %u of the format, this program reads version %d",
                         file->path, version, WEFT_FORMAT_VERSION);
    if (size != file->size)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is %s: %zu bytes, its header says %llu", file->path,
                         file->size < size ? "cut" : "too long", file->size, (unsigned long long)size);
    if (sections < 1 || sections > WEFT_FORMAT_MAX_SECTIONS)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %u sections, must be 1 to %d", file->path, sections,
                         WEFT_FORMAT_MAX_SECTIONS);
    size_t table_size = (size_t)sections * WEFT_FORMAT_ENTRY_SIZE;
    if (file->size - WEFT_FORMAT_HEADER_SIZE < table_size)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is cut: no room for its table of %u sections", file->path,
                         sections);
    uLong checksum = crc32_z(0, file->bytes, WEFT_FORMAT_HEADER_SIZE - 4);
    checksum = crc32_z(checksum, file->bytes + WEFT_FORMAT_HEADER_SIZE, table_size);
    if (checksum != u32_at(file->bytes + 60))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is damaged: checksum of the header and section table",
                         file->path);
    return WEFT_OK;
}

static int limited_int(uint32_t value)
{
    return value > INT32_MAX ? INT32_MAX : (int)value;
}

static weft_code read_shape(const weft_file_image *file, weft_material *material, weft_error *error)
{
    const unsigned char *b = file->bytes;
    int level_count = limited_int(u32_at(b + 32));
    weft_error cause = {0};
    weft_code code = weft_material_set_shape(material, limited_int(u32_at(b + 24)), limited_int(u32_at(b + 28)),
                                             level_count, limited_int(u32_at(b + 36)), limited_int(u32_at(b + 40)),
                                             limited_int(u32_at(b + 44)), &cause);
    if (code == WEFT_OK && level_count == 0)
        code = weft_fail(&cause, WEFT_BAD_INPUT, "number of levels is 0, must be at least 1");
    memcpy(&material->texel_pitch_mm, b + 48, sizeof material->texel_pitch_mm);
    if (code == WEFT_OK && !(material->texel_pitch_mm > 0 && isfinite(material->texel_pitch_mm)))
        code = weft_fail(&cause, WEFT_BAD_INPUT, "texel pitch is %g mm", material->texel_pitch_mm);
    if (code == WEFT_OK && u32_at(b + 56) != 0)
        code = weft_fail(&cause, WEFT_BAD_INPUT, "the reserved field is not zero");
    return code == WEFT_OK ? WEFT_OK
                           : weft_fail(error, WEFT_BAD_INPUT, "'%s' is damaged: %s", file->path, cause.message);
}

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

const weft_section *weft_file_section(const weft_file_image *file, weft_section_kind kind, int level)
{
    return &file->section[file->found[kind][level] - 1];
}

weft_code weft_fail_section(const weft_file_image *file, const weft_section *section, weft_error *error,
                            const char *what)
{
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' is damaged: section %s of level %u: %s", file->path, section->type,
                     section->level, what);
}

/* `end` is where the section before ends; on success where this one does. */
static weft_code check_place(const weft_file_image *file, const weft_section *section, uint64_t *end, weft_error *error)
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

static weft_code check_codec(const weft_file_image *file, const weft_section *section, weft_error *error)
{
    if (section->codec == WEFT_CODEC_NONE)
        return section->decoded_size == section->stored_size
                   ? WEFT_OK
                   : weft_fail_section(file, section, error, "stored and decoded size differ without a codec");
    bool is_components = weft_section_kind_of(section->type) == WEFT_SECTION_LAYR;
    bool has_differences = section->codec == WEFT_CODEC_DIFFERENCES || section->codec == WEFT_CODEC_WEIGHTED;
    if (section->codec != WEFT_CODEC_ZSTD && !(has_differences && is_components))
        return weft_fail_section(file, section, error, "unknown codec");
    /* stored_size is at most the size of the file, so the product cannot overflow. */
    if (section->decoded_size > section->stored_size * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        return weft_fail_section(file, section, error, "claims to decode to more than 1024 times its size");
    return WEFT_OK;
}

/* And of a size of its own, which its reader checks. */
static bool is_of_all_levels(weft_section_kind kind)
{
    return kind == WEFT_SECTION_LAYR || kind == WEFT_SECTION_HGHT || kind == WEFT_SECTION_SEEN;
}

/* One map of models announces those of all levels. */
static weft_code note_section(weft_file_image *file, int index, weft_material *material, weft_error *error)
{
    const weft_section *section = &file->section[index];
    weft_section_kind kind = weft_section_kind_of(section->type);
    if (kind == WEFT_SECTION_KINDS)
        return WEFT_OK;
    material->has_models = material->has_models || kind == WEFT_SECTION_MODL;
    material->has_components = material->has_components || kind == WEFT_SECTION_LAYR;
    material->has_floors = material->has_floors || kind == WEFT_SECTION_FLOR;
    material->has_heights = material->has_heights || kind == WEFT_SECTION_HGHT;
    material->has_seen = material->has_seen || kind == WEFT_SECTION_SEEN;
    material->has_opacity = material->has_opacity || kind == WEFT_SECTION_ALPH;
    material->has_table_bases = material->has_table_bases || kind == WEFT_SECTION_TPCA || kind == WEFT_SECTION_SPCA;
    /* Whether there are TABL or TPCA is known at the end of the table alone. */
    if (section->level >= (uint32_t)material->level_count || (is_of_all_levels(kind) && section->level > 0) ||
        (kind <= WEFT_SECTION_LITE && section->level >= (uint32_t)weft_section_levels(material, kind)))
        return weft_fail_section(file, section, error, "the material has no such section");
    if (file->found[kind][section->level])
        return weft_fail_section(file, section, error, "occurs twice");
    if (kind == WEFT_SECTION_META && section->decoded_size > WEFT_FORMAT_MAX_METADATA)
        return weft_fail_section(file, section, error, "its size does not fit the material");
    file->found[kind][section->level] = index + 1;
    return WEFT_OK;
}

int weft_section_directions(const weft_material *material, weft_section_kind kind)
{
    return kind == WEFT_SECTION_TPCA ? material->view_count : material->light_count;
}

static size_t texels_of(const weft_material *material, int k)
{
    return (size_t)material->level[k].width * (size_t)material->level[k].height;
}

/* Its size says how many components there are; a small file does not claim large tables. */
static weft_code check_basis(const weft_file_image *file, const weft_material *material, weft_section_kind kind, int k,
                             weft_error *error)
{
    const weft_section *section = weft_file_section(file, kind, k);
    int directions = weft_section_directions(material, kind);
    uint64_t decoded = 4 * (uint64_t)directions * texels_of(material, k);
    if (!weft_table_basis_components(section->decoded_size, directions, texels_of(material, k)))
        return weft_fail_section(file, section, error, "its size does not fit the material");
    if (decoded > file->size * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        return weft_fail_section(file, section, error, "claims to expand to more than 1024 times the size of the file");
    return WEFT_OK;
}

/* Coefficients are four to a texel and group; how many groups, LAYR says, which a reader holds against it. */
static weft_code check_coefficients(const weft_file_image *file, const weft_material *material, int k,
                                    weft_error *error)
{
    const weft_section *section = weft_file_section(file, WEFT_SECTION_LCOE, k);
    uint64_t texels = texels_of(material, k);
    if (section->decoded_size % texels != 0 || section->decoded_size / texels > WEFT_COMPONENTS_MAX)
        return weft_fail_section(file, section, error, "its size does not fit the material");
    return WEFT_OK;
}

/* Of a compact section the exact size is known only once the map of its level is; until then that it is smaller, and
 * that a small file does not claim a large material. */
static weft_code check_size(const weft_file_image *file, const weft_material *material, weft_section_kind kind, int k,
                            weft_error *error)
{
    const weft_section *section = weft_file_section(file, kind, k);
    uint64_t whole = weft_section_size(material, kind, k);
    if (kind == WEFT_SECTION_TPCA || kind == WEFT_SECTION_SPCA)
        return check_basis(file, material, kind, k, error);
    if (kind == WEFT_SECTION_LCOE)
        return check_coefficients(file, material, k, error);
    if (is_of_all_levels(kind))
        return WEFT_OK;
    bool compact = weft_section_may_be_compact(material, kind) && section->decoded_size < whole;
    if (kind != WEFT_SECTION_META && section->decoded_size != whole && !compact)
        return weft_fail_section(file, section, error, "its size does not fit the material");
    if (compact && whole > file->size * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        return weft_fail_section(file, section, error, "claims to expand to more than 1024 times the size of the file");
    return WEFT_OK;
}

static weft_code check_complete(const weft_file_image *file, const weft_material *material, weft_error *error)
{
    for (int kind = 0; kind < WEFT_SECTION_KINDS; kind++) {
        int levels = weft_section_levels(material, (weft_section_kind)kind);
        if (levels == 0 && file->found[kind][0])
            return weft_fail_section(file, weft_file_section(file, kind, 0), error, "the material has no such section");
        for (int k = 0; k < levels; k++) {
            if (!file->found[kind][k])
                return weft_fail(error, WEFT_BAD_INPUT, "'%s' is damaged: section %s of level %d is missing",
                                 file->path, weft_section_type[kind], k);
            WEFT_TRY(check_size(file, material, (weft_section_kind)kind, k, error));
        }
    }
    return WEFT_OK;
}

static weft_code read_table(weft_file_image *file, weft_material *material, weft_error *error)
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
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is damaged: %llu bytes follow its last section", file->path,
                         (unsigned long long)(file->size - end));
    return check_complete(file, material, error);
}

static weft_code check_checksums(const weft_file_image *file, weft_error *error)
{
    for (int i = 0; i < file->section_count; i++) {
        const weft_section *section = &file->section[i];
        if (crc32_z(0, file->bytes + section->offset, section->stored_size) != section->checksum)
            return weft_fail_section(file, section, error, "checksum does not match");
    }
    return WEFT_OK;
}

weft_code weft_file_image_open(weft_file_image *file, weft_material *material, weft_error *error)
{
    WEFT_TRY(check_header(file, error));
    WEFT_TRY(read_shape(file, material, error));
    WEFT_TRY(read_table(file, material, error));
    return check_checksums(file, error);
}
