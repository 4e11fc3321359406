/* The sections of version 1 that version 2 has not, or has otherwise (docs/reference/weft-format.md, "Reading version
 * 1"): expanded to the material of today. */
#include "btf/material/component_section.h"
#include "btf/material/file.h"

#include <stdlib.h>
#include <string.h>

/* What a file of version 1 holds: the first three stand in its header, sections reveal the others. */
enum {
    LOBES = 1 << 0,
    VIEWS = 1 << 1,
    LIGHTS = 1 << 2,
    MODELS = 1 << 3,
    BASES = 1 << 4, /* tables by components */
    OPACITY = 1 << 5,
    COMPONENTS = 1 << 6,
    FLOORS = 1 << 7,
    HEIGHTS = 1 << 8,
    VISIBILITY = 1 << 9
};

/* ---- Sizes ---- */

static uint64_t size_of_models(const weft_material *material, int level)
{
    return weft_texel_count(material, level);
}

static uint64_t size_of_lights(const weft_material *material, int level)
{
    (void)level;
    return (uint64_t)material->light_count * 3 * sizeof(float);
}

static uint64_t size_of_diffuse(const weft_material *material, int level)
{
    return weft_texel_count(material, level) * 4 * sizeof(weft_half);
}

static uint64_t size_of_lobes(const weft_material *material, int level)
{
    return 3 * (uint64_t)material->lobe_count * size_of_diffuse(material, level);
}

static uint64_t size_of_table(const weft_material *material, int level)
{
    return 4 * (uint64_t)material->view_count * weft_texel_count(material, level);
}

static uint64_t size_of_light_table(const weft_material *material, int level)
{
    return 4 * (uint64_t)material->light_count * weft_texel_count(material, level);
}

static uint64_t size_of_errors(const weft_material *material, int level)
{
    (void)material;
    (void)level;
    return WEFT_FORMAT_ERRORS * sizeof(double);
}

/* Before components are allocated they have sizes alone. */
static weft_section_array array_of_ceilings(const weft_material *material, int level)
{
    const weft_components *components = material->components;
    size_t count = weft_ceiling_count(material->level[level].width, material->level[level].height);
    return (weft_section_array){components ? components->level[level].ceiling : NULL, 0, count, 1, 1};
}

static weft_section_array array_of_floors(const weft_material *material, int level)
{
    const weft_components *components = material->components;
    weft_section_array array = array_of_ceilings(material, level);
    return (weft_section_array){components ? components->level[level].floor : NULL, 0, array.count, 3, 3};
}

/* ---- Which parts a texel has ---- */

enum { MODEL_CODES = 64 };

static weft_code load_models(weft_section_reading *r, weft_error *error)
{
    for (size_t i = 0; i < r->section->decoded_size; i++) {
        if (r->bytes[i] >= MODEL_CODES)
            r->fault = "holds an unknown model";
    }
    if (r->fault)
        return WEFT_BAD_INPUT;
    r->file->model[r->section->level] = malloc(r->section->decoded_size);
    if (!r->file->model[r->section->level])
        return weft_fail_memory(error, "models of texels", r->section->decoded_size);
    memcpy(r->file->model[r->section->level], r->bytes, r->section->decoded_size);
    return WEFT_OK;
}

/* Planes of texels, of which those without the part may have been left out. */
typedef struct planes {
    uint8_t *texels;
    size_t plane_count, texel_bytes;
    bool (*has_part)(uint8_t model, size_t plane);
    const void *neutral; /* what changes nothing */
} planes;

static bool has_lobe(uint8_t model, size_t plane)
{
    return (size_t)(model & 3) > plane / 3;
}

static bool has_table(uint8_t model, size_t plane)
{
    (void)plane;
    return model >> 2 & 3;
}

static bool has_light_table(uint8_t model, size_t plane)
{
    (void)plane;
    return model >> 4 & 3;
}

static planes planes_of(const weft_material *material, const weft_section *section)
{
    static const weft_half no_lobe[4] = {0, 0, 0, 0x3c00};
    static const uint8_t white[4] = {255, 255, 255, 255};
    const weft_material_level *level = &material->level[section->level];
    if (strcmp(section->type, "LOBE") == 0)
        return (planes){(uint8_t *)level->lobe, 3 * (size_t)material->lobe_count, 4 * sizeof(weft_half), has_lobe,
                        no_lobe};
    if (strcmp(section->type, "TABL") == 0)
        return (planes){level->table, (size_t)material->view_count, 4, has_table, white};
    return (planes){level->light_table, (size_t)material->light_count, 4, has_light_table, white};
}

static uint64_t compact_size(const planes *p, const uint8_t *model, size_t texels)
{
    uint64_t size = 0;
    for (size_t plane = 0; plane < p->plane_count; plane++) {
        for (size_t texel = 0; texel < texels; texel++)
            size += p->has_part(model[texel], plane) ? p->texel_bytes : 0;
    }
    return size;
}

static void expand(const planes *p, const uint8_t *model, size_t texels, const uint8_t *bytes)
{
    uint8_t *to = p->texels;
    for (size_t plane = 0; plane < p->plane_count; plane++) {
        for (size_t texel = 0; texel < texels; texel++, to += p->texel_bytes) {
            bool has = p->has_part(model[texel], plane);
            memcpy(to, has ? bytes : p->neutral, p->texel_bytes);
            bytes += has ? p->texel_bytes : 0;
        }
    }
}

/* The exact size is known only once the models of the level are; until then that it is smaller, and that a small file
 * does not claim a large material. */
static const char *check_compact(const weft_material_file *file, const weft_section *section, uint64_t whole)
{
    bool is_compact = (file->features & MODELS) && section->decoded_size < whole;
    if (section->decoded_size != whole && !is_compact)
        return "its size does not fit the material";
    if (is_compact && whole > file->size * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        return "claims to expand to more than 1024 times the size of the file";
    return NULL;
}

static const char *check_lobes(const weft_material_file *file, const weft_material *material,
                               const weft_section *section)
{
    return check_compact(file, section, size_of_lobes(material, (int)section->level));
}

static const char *check_table(const weft_material_file *file, const weft_material *material,
                               const weft_section *section)
{
    return check_compact(file, section, size_of_table(material, (int)section->level));
}

static const char *check_light_table(const weft_material_file *file, const weft_material *material,
                                     const weft_section *section)
{
    return check_compact(file, section, size_of_light_table(material, (int)section->level));
}

static weft_code load_planes(weft_section_reading *r, weft_error *error)
{
    (void)error;
    planes p = planes_of(r->material, r->section);
    const uint8_t *model = r->file->model[r->section->level];
    size_t texels = weft_texel_count(r->material, (int)r->section->level);
    if (r->section->decoded_size == p.plane_count * p.texel_bytes * texels)
        memcpy(p.texels, r->bytes, r->section->decoded_size);
    else if (r->section->decoded_size == compact_size(&p, model, texels))
        expand(&p, model, texels, r->bytes);
    else
        r->fault = "its size does not fit the models of its level";
    return r->fault ? WEFT_BAD_INPUT : WEFT_OK;
}

/* ---- Lobes ---- */

static const char *fault_of_diffuse(const weft_material *material, int level, const uint8_t *bytes, size_t size)
{
    (void)material;
    (void)level;
    return weft_fault_of_halves(bytes, size, true);
}

/* The fourth number was unused. */
static weft_code load_diffuse(weft_section_reading *r, weft_error *error)
{
    (void)error;
    weft_half *diffuse = r->material->level[r->section->level].diffuse;
    memcpy(diffuse, r->bytes, r->section->decoded_size);
    for (size_t i = 3; i < r->section->decoded_size / sizeof *diffuse; i += 4)
        diffuse[i] = 0;
    return WEFT_OK;
}

static const char *fault_of_lobes(const weft_material *material, int level, const uint8_t *bytes, size_t size)
{
    (void)material;
    (void)level;
    return weft_fault_of_halves(bytes, size, false);
}

static weft_code load_lights(weft_section_reading *r, weft_error *error)
{
    (void)error;
    weft_take_directions(r->bytes, r->material->light_count, r->material->light);
    return WEFT_OK;
}

static weft_code load_errors(weft_section_reading *r, weft_error *error)
{
    (void)error;
    r->material->level[r->section->level].error = weft_take_errors(r->bytes);
    return WEFT_OK;
}

/* ---- Tables by components ---- */

enum { BASIS_SHIFT = 11, MOST_OF_BASIS = 64, MEAN_FACTOR = 16 };

static size_t directions_of(const weft_material *material, const weft_section *section)
{
    return (size_t)(section->type[0] == 'T' ? material->view_count : material->light_count);
}

/* How many components a basis of so many bytes has; 0 where there is none of that size. */
static size_t components_of_basis(uint64_t size, size_t directions, size_t texels)
{
    uint64_t mean = 2 * directions, each = mean + 3 * texels;
    if (size <= mean || (size - mean) % each != 0 || (size - mean) / each > MOST_OF_BASIS)
        return 0;
    return (size - mean) / each;
}

/* A small file does not claim large tables. */
static const char *check_basis(const weft_material_file *file, const weft_material *material,
                               const weft_section *section)
{
    size_t directions = directions_of(material, section), texels = weft_texel_count(material, (int)section->level);
    if (components_of_basis(section->decoded_size, directions, texels) == 0)
        return "its size does not fit the material";
    if (4 * (uint64_t)directions * texels > file->size * WEFT_FORMAT_MAX_RATIO + WEFT_FORMAT_FREE_RATIO)
        return "claims to expand to more than 1024 times the size of the file";
    return NULL;
}

static uint8_t code_of_basis(int32_t sum)
{
    sum = (sum + (1 << (BASIS_SHIFT - 1))) >> BASIS_SHIFT;
    return (uint8_t)(sum < 0 ? 0 : sum > 255 ? 255 : sum);
}

static weft_code load_basis(weft_section_reading *r, weft_error *error)
{
    (void)error;
    const weft_material_level *level = &r->material->level[r->section->level];
    size_t directions = directions_of(r->material, r->section),
           texels = weft_texel_count(r->material, (int)r->section->level);
    size_t count = components_of_basis(r->section->decoded_size, directions, texels);
    const int16_t *mean = (const int16_t *)(const void *)r->bytes, *component = mean + directions;
    const int8_t *coefficient = (const int8_t *)(component + count * directions);
    uint8_t *table = r->section->type[0] == 'T' ? level->table : level->light_table;
    memset(table, 255, 4 * directions * texels);
    for (size_t d = 0; d < directions; d++)
        for (size_t i = 0; i < 3 * texels; i++) {
            int32_t sum = MEAN_FACTOR * mean[d];
            for (size_t k = 0; k < count; k++)
                sum += coefficient[3 * k * texels + i] * component[k * directions + d];
            table[4 * (d * texels + i % texels) + i / texels] = code_of_basis(sum);
        }
    return WEFT_OK;
}

/* ---- Components ---- */

static const char *check_coefficients(const weft_material_file *file, const weft_material *material,
                                      const weft_section *section)
{
    (void)file;
    uint64_t texels = weft_texel_count(material, (int)section->level);
    return section->decoded_size % texels != 0 || section->decoded_size / texels > WEFT_COMPONENTS_MAX
               ? "its size does not fit the material"
               : NULL;
}

/* Whether the coefficients of every level are of so many components: their sizes show that the file is as large as the
 * components that it claims. */
static bool fit_coefficients(const weft_material_file *file, const weft_material *material, uint32_t components)
{
    bool fit = true;
    for (int i = 0; i < file->kind_count; i++)
        for (int k = 0; k < material->level_count && strcmp(file->kind[i].type, "LCOE") == 0; k++)
            fit = fit &&
                  weft_file_section(file, i, k)->decoded_size == components * (uint64_t)weft_texel_count(material, k);
    return fit;
}

static weft_code load_shared(weft_section_reading *r, weft_error *error)
{
    weft_value_coding coding = r->section->codec == WEFT_CODEC_DIFFERENCES ? WEFT_VALUES_BY_DIFFERENCES
                               : r->section->codec == WEFT_CODEC_WEIGHTED  ? WEFT_VALUES_BY_WEIGHTED_DIFFERENCES
                                                                           : WEFT_VALUES_AS_HALVES;
    uint32_t components = 0;
    if (r->section->decoded_size >= 8)
        memcpy(&components, r->bytes + 4, sizeof components);
    if (!fit_coefficients(r->file, r->material, components)) {
        r->fault = "its components are not those of the coefficients";
        return WEFT_BAD_INPUT;
    }
    return weft_components_section_read(r->bytes, r->section->decoded_size, coding, r->material->level[0].width,
                                        r->material->level[0].height, r->material->level_count,
                                        &r->material->components, &r->fault, error);
}

/* ---- The list ---- */

/* The models come first: they say what compact sections hold. */
static const weft_section_kind sections_of_version_1[] = {
    {.type = "MODL",
     .of_levels = true,
     .needs = MODELS,
     .reveals = MODELS,
     .size = size_of_models,
     .load = load_models},
    {.type = "META", .check = weft_check_metadata, .load = weft_load_metadata},
    {.type = "VIEW",
     .needs = VIEWS,
     .size = weft_size_of_views,
     .fault = weft_fault_of_directions,
     .load = weft_load_views},
    {.type = "LITE", .needs = LIGHTS, .size = size_of_lights, .fault = weft_fault_of_directions, .load = load_lights},
    {.type = "FRAM", .of_levels = true, .array = weft_array_of_frames},
    {.type = "RHO ", .of_levels = true, .size = size_of_diffuse, .fault = fault_of_diffuse, .load = load_diffuse},
    {.type = "LOBE",
     .of_levels = true,
     .needs = LOBES,
     .check = check_lobes,
     .fault = fault_of_lobes,
     .load = load_planes},
    {.type = "TABL", .of_levels = true, .needs = VIEWS, .bars = BASES, .check = check_table, .load = load_planes},
    {.type = "STAB",
     .of_levels = true,
     .needs = LIGHTS,
     .bars = BASES,
     .check = check_light_table,
     .load = load_planes},
    {.type = "TPCA",
     .of_levels = true,
     .needs = VIEWS | BASES,
     .reveals = BASES,
     .check = check_basis,
     .load = load_basis},
    {.type = "SPCA",
     .of_levels = true,
     .needs = LIGHTS | BASES,
     .reveals = BASES,
     .check = check_basis,
     .load = load_basis},
    {.type = "ALPH", .of_levels = true, .needs = OPACITY | BASES, .reveals = OPACITY, .array = weft_array_of_opacity},
    {.type = "ERRO", .of_levels = true, .size = size_of_errors, .fault = weft_fault_of_errors, .load = load_errors},
    {.type = "LAYR", .needs = COMPONENTS, .reveals = COMPONENTS, .is_free = true, .load = load_shared},
    {.type = "LCOE",
     .of_levels = true,
     .needs = COMPONENTS,
     .array = weft_array_of_coefficients,
     .check = check_coefficients,
     .fault = weft_fault_of_coefficients},
    {.type = "CEIL", .of_levels = true, .needs = COMPONENTS, .array = array_of_ceilings},
    {.type = "FLOR", .of_levels = true, .needs = COMPONENTS | FLOORS, .reveals = FLOORS, .array = array_of_floors},
    {.type = "HGHT", .needs = HEIGHTS, .reveals = HEIGHTS, .is_free = true, .load = weft_load_heights},
    {.type = "SEEN", .needs = VISIBILITY, .reveals = VISIBILITY, .is_free = true, .load = weft_load_visibility},
};

static bool is_above_0(const uint8_t *word)
{
    return (word[0] | word[1] | word[2] | word[3]) != 0;
}

weft_code weft_read_features_of_version_1(weft_material_file *file, weft_error *error)
{
    const uint8_t *header = file->bytes;
    file->kind = sections_of_version_1;
    file->kind_count = (int)(sizeof sections_of_version_1 / sizeof *sections_of_version_1);
    file->features = 0;
    if (is_above_0(header + 36))
        file->features |= LOBES;
    if (is_above_0(header + 40))
        file->features |= VIEWS;
    if (is_above_0(header + 44))
        file->features |= LIGHTS;
    return is_above_0(header + 56) ? weft_fail(error, WEFT_BAD_INPUT, "the reserved field is not zero") : WEFT_OK;
}
