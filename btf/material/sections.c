/* The sections of version 2 (docs/reference/weft-format.md, 2). */
#include "btf/material/certificate.h"
#include "btf/material/component_section.h"
#include "btf/material/file.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t weft_texel_count(const weft_material *material, int level)
{
    return (size_t)material->level[level].width * (size_t)material->level[level].height;
}

uint32_t weft_material_features(const weft_material *material)
{
    uint32_t features = 0;
    bool has_holes = weft_material_has_holes(material);
    if (material->has_lobes)
        features |= WEFT_FEATURE_LOBES;
    if (material->components)
        features |= WEFT_FEATURE_COMPONENTS;
    if (material->view_count > 0 && (material->has_lobes || has_holes))
        features |= WEFT_FEATURE_VIEWS;
    if (has_holes)
        features |= WEFT_FEATURE_OPACITY;
    if (material->heights)
        features |= WEFT_FEATURE_HEIGHTS;
    if (material->visibility)
        features |= WEFT_FEATURE_VISIBILITY;
    return features;
}

/* ---- Metadata ---- */

static uint64_t size_of_metadata(const weft_material *material, int level)
{
    (void)level;
    return strlen(material->metadata);
}

const char *weft_check_metadata(const weft_material_file *file, const weft_material *material,
                                const weft_section *section)
{
    (void)file;
    (void)material;
    return section->decoded_size > WEFT_FORMAT_MAX_METADATA ? "its size does not fit the material" : NULL;
}

weft_code weft_load_metadata(weft_material_file *file, weft_material *material, const weft_section *section,
                             const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    size_t size = section->decoded_size;
    char *text = malloc(size + 1);
    if (!text)
        return weft_fail_memory(error, "metadata", size);
    memcpy(text, bytes, size);
    text[size] = 0;
    free(material->metadata);
    material->metadata = text;
    json_error_t where;
    errno = 0;
    json_t *object = json_loadb(text, size, 0, &where);
    bool valid = json_is_object(object) && strlen(text) == size;
    const json_t *certified = json_object_get(object, "certificate");
    weft_certificate certificate;
    *fault = !valid ? "no JSON object" : certified ? weft_certificate_unpack(certified, &certificate) : NULL;
    json_decref(object);
    if (!valid && errno == ENOMEM) {
        *fault = NULL;
        return weft_fail_memory(error, "metadata", size);
    }
    return *fault ? WEFT_BAD_INPUT : WEFT_OK;
}

static void store_metadata(const weft_material *material, int level, uint8_t *bytes)
{
    memcpy(bytes, material->metadata, size_of_metadata(material, level));
}

/* ---- Errors ---- */

/* The last is the PSNR: negative where the fit is poor, infinite where it is perfect. */
const char *weft_take_errors(const double *value, weft_error_summary *error)
{
    for (int i = 0; i < WEFT_FORMAT_ERRORS; i++) {
        bool is_psnr = i + 1 == WEFT_FORMAT_ERRORS;
        if (!(is_psnr ? value[i] > -INFINITY : value[i] >= 0 && value[i] < INFINITY))
            return is_psnr ? "holds a PSNR that is NaN or minus infinity"
                           : "holds an error that is NaN, negative or infinite";
    }
    *error = (weft_error_summary){.median_relative = value[0],
                                  .percentile80_relative = value[1],
                                  .rmse = value[2],
                                  .relative_rmse = value[3],
                                  .psnr_db = value[4]};
    return NULL;
}

static uint64_t size_of_errors(const weft_material *material, int level)
{
    (void)level;
    return (uint64_t)material->level_count * WEFT_FORMAT_ERRORS * sizeof(double);
}

static weft_code load_errors(weft_material_file *file, weft_material *material, const weft_section *section,
                             const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)section;
    (void)error;
    double value[WEFT_FORMAT_ERRORS];
    for (int k = 0; k < material->level_count && !*fault; k++) {
        memcpy(value, bytes + (size_t)k * sizeof value, sizeof value);
        *fault = weft_take_errors(value, &material->level[k].error);
    }
    return *fault ? WEFT_BAD_INPUT : WEFT_OK;
}

static void store_errors(const weft_material *material, int level, uint8_t *bytes)
{
    (void)level;
    for (int k = 0; k < material->level_count; k++) {
        const weft_error_summary *error = &material->level[k].error;
        const double value[WEFT_FORMAT_ERRORS] = {error->median_relative, error->percentile80_relative, error->rmse,
                                                  error->relative_rmse, error->psnr_db};
        memcpy(bytes + (size_t)k * sizeof value, value, sizeof value);
    }
}

/* ---- Views ---- */

const char *weft_take_directions(const float *xyz, int count, weft_vec3 *direction)
{
    for (int i = 0; i < count; i++) {
        direction[i] = weft_vec3_of((weft_real)xyz[3 * i], (weft_real)xyz[3 * i + 1], (weft_real)xyz[3 * i + 2]);
        if (!(fabs(weft_length(direction[i]) - 1) < 1e-3) || direction[i].z < -1e-6)
            return "holds a direction that is no unit vector of the upper hemisphere";
        direction[i] = weft_unit(direction[i]);
    }
    return NULL;
}

uint64_t weft_size_of_views(const weft_material *material, int level)
{
    (void)level;
    return (uint64_t)material->view_count * 3 * sizeof(float);
}

weft_code weft_load_views(weft_material_file *file, weft_material *material, const weft_section *section,
                          const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)section;
    (void)error;
    *fault = weft_take_directions((const float *)(const void *)bytes, material->view_count, material->view);
    return *fault ? WEFT_BAD_INPUT : WEFT_OK;
}

static void store_views(const weft_material *material, int level, uint8_t *bytes)
{
    (void)level;
    float *xyz = (float *)(void *)bytes;
    for (int i = 0; i < material->view_count; i++) {
        xyz[3 * i] = (float)material->view[i].x;
        xyz[3 * i + 1] = (float)material->view[i].y;
        xyz[3 * i + 2] = (float)material->view[i].z;
    }
}

/* ---- Frames and lobes ---- */

uint64_t weft_size_of_frames(const weft_material *material, int level)
{
    return weft_texel_count(material, level) * 3 * sizeof(int16_t);
}

weft_code weft_load_frames(weft_material_file *file, weft_material *material, const weft_section *section,
                           const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)fault;
    (void)error;
    memcpy(material->level[section->level].frame, bytes, section->decoded_size);
    return WEFT_OK;
}

static void store_frames(const weft_material *material, int level, uint8_t *bytes)
{
    memcpy(bytes, material->level[level].frame, weft_size_of_frames(material, level));
}

const char *weft_fault_of_halves(const weft_half *half, size_t count, bool all_positive)
{
    const weft_half infinite = 0x7c00, minus_zero = 0x8000;
    for (size_t i = 0; i < count; i++) {
        if ((half[i] & infinite) == infinite)
            return "holds a number that is not finite";
        if (half[i] > minus_zero && (all_positive || i % 4 == 3))
            return "holds a negative diffuse term or exponent";
    }
    return NULL;
}

/* The diffuse term with its ceiling, and behind it the lobes. */
static uint64_t size_of_lobes(const weft_material *material, int level)
{
    return (1 + 3 * (uint64_t)material->lobe_count) * weft_texel_count(material, level) * 4 * sizeof(weft_half);
}

static weft_code load_lobes(weft_material_file *file, weft_material *material, const weft_section *section,
                            const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)error;
    const weft_half *half = (const weft_half *)(const void *)bytes;
    size_t diffuse = 4 * weft_texel_count(material, (int)section->level),
           all = section->decoded_size / sizeof(weft_half);
    *fault = weft_fault_of_halves(half, diffuse, true);
    if (!*fault)
        *fault = weft_fault_of_halves(half + diffuse, all - diffuse, false);
    if (!*fault)
        memcpy(material->level[section->level].diffuse, bytes, section->decoded_size);
    return *fault ? WEFT_BAD_INPUT : WEFT_OK;
}

static void store_lobes(const weft_material *material, int level, uint8_t *bytes)
{
    memcpy(bytes, material->level[level].diffuse, size_of_lobes(material, level));
}

/* ---- View table and opacity ---- */

static uint64_t size_of_table(const weft_material *material, int level)
{
    return 3 * weft_size_of_opacity(material, level);
}

static weft_code load_table(weft_material_file *file, weft_material *material, const weft_section *section,
                            const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)fault;
    (void)error;
    uint8_t *table = material->level[section->level].table;
    for (size_t i = 0; i < section->decoded_size / 3; i++)
        memcpy(table + 4 * i, bytes + 3 * i, 3);
    return WEFT_OK;
}

static void store_table(const weft_material *material, int level, uint8_t *bytes)
{
    const uint8_t *table = material->level[level].table;
    for (size_t i = 0; i < weft_size_of_opacity(material, level); i++)
        memcpy(bytes + 3 * i, table + 4 * i, 3);
}

uint64_t weft_size_of_opacity(const weft_material *material, int level)
{
    return (uint64_t)material->view_count * weft_texel_count(material, level);
}

weft_code weft_load_opacity(weft_material_file *file, weft_material *material, const weft_section *section,
                            const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)fault;
    (void)error;
    uint8_t *table = material->level[section->level].table;
    for (size_t i = 0; i < section->decoded_size; i++)
        table[4 * i + 3] = bytes[i];
    return WEFT_OK;
}

static void store_opacity(const weft_material *material, int level, uint8_t *bytes)
{
    const uint8_t *table = material->level[level].table;
    for (size_t i = 0; i < weft_size_of_opacity(material, level); i++)
        bytes[i] = table[4 * i + 3];
}

/* ---- Components ---- */

static uint64_t size_of_shared(const weft_material *material, int level)
{
    (void)level;
    return weft_components_section_size(material->components, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES);
}

static weft_code load_shared(weft_material_file *file, weft_material *material, const weft_section *section,
                             const uint8_t *bytes, const char **fault, weft_error *error)
{
    WEFT_TRY(weft_components_section_read(bytes, section->decoded_size, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES,
                                          material->level[0].width, material->level[0].height, material->level_count,
                                          &material->components, fault, error));
    if (material->components->component_count == file->component_count)
        return WEFT_OK;
    *fault = "its components are not as many as the header says";
    return WEFT_BAD_INPUT;
}

static void store_shared(const weft_material *material, int level, uint8_t *bytes)
{
    (void)level;
    weft_components_section_write(material->components, bytes);
}

/* How many components there are, the header says before they are read. */
static const char *check_coefficients(const weft_material_file *file, const weft_material *material,
                                      const weft_section *section)
{
    uint64_t texels = weft_texel_count(material, (int)section->level);
    return section->decoded_size == texels * (uint64_t)file->component_count ? NULL
                                                                             : "its size does not fit the material";
}

static uint64_t size_of_coefficients(const weft_material *material, int level)
{
    return weft_texel_count(material, level) * (uint64_t)material->components->component_count;
}

weft_code weft_load_coefficients(weft_material_file *file, weft_material *material, const weft_section *section,
                                 const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)error;
    for (size_t i = 0; i < section->decoded_size; i++) {
        if (bytes[i] == 128)
            *fault = "holds a coefficient of -128";
    }
    if (!*fault)
        memcpy(material->components->level[section->level].coefficient, bytes, section->decoded_size);
    return *fault ? WEFT_BAD_INPUT : WEFT_OK;
}

static void store_coefficients(const weft_material *material, int level, uint8_t *bytes)
{
    memcpy(bytes, material->components->level[level].coefficient, size_of_coefficients(material, level));
}

/* Floors of red, green and blue, and the ceiling. */
static uint64_t size_of_bounds(const weft_material *material, int level)
{
    return 4 * weft_ceiling_count(material->level[level].width, material->level[level].height);
}

static weft_code load_bounds(weft_material_file *file, weft_material *material, const weft_section *section,
                             const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    (void)fault;
    (void)error;
    weft_components_level *level = &material->components->level[section->level];
    for (size_t i = 0; i < section->decoded_size / 4; i++) {
        memcpy(level->floor + 3 * i, bytes + 4 * i, 3);
        level->ceiling[i] = bytes[4 * i + 3];
    }
    return WEFT_OK;
}

static void store_bounds(const weft_material *material, int k, uint8_t *bytes)
{
    const weft_components_level *level = &material->components->level[k];
    for (size_t i = 0; i < size_of_bounds(material, k) / 4; i++) {
        memcpy(bytes + 4 * i, level->floor + 3 * i, 3);
        bytes[4 * i + 3] = level->ceiling[i];
    }
}

/* ---- Heights and visibility ---- */

static uint64_t size_of_heights(const weft_material *material, int level)
{
    (void)level;
    return weft_material_heights_size(material->heights);
}

weft_code weft_load_heights(weft_material_file *file, weft_material *material, const weft_section *section,
                            const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    return weft_material_heights_read(bytes, section->decoded_size, &material->heights, fault, error);
}

static void store_heights(const weft_material *material, int level, uint8_t *bytes)
{
    (void)level;
    weft_material_heights_write(material->heights, bytes);
}

static uint64_t size_of_visibility(const weft_material *material, int level)
{
    (void)level;
    return weft_material_visibility_size(material->visibility);
}

weft_code weft_load_visibility(weft_material_file *file, weft_material *material, const weft_section *section,
                               const uint8_t *bytes, const char **fault, weft_error *error)
{
    (void)file;
    return weft_material_visibility_read(bytes, section->decoded_size, material->level_count, &material->visibility,
                                         fault, error);
}

static void store_visibility(const weft_material *material, int level, uint8_t *bytes)
{
    (void)level;
    weft_material_visibility_write(material->visibility, bytes);
}

/* ---- The list ---- */

const weft_section_kind weft_sections_of_version_2[WEFT_FORMAT_KINDS] = {
    {.type = "META",
     .is_free = true,
     .size = size_of_metadata,
     .check = weft_check_metadata,
     .load = weft_load_metadata,
     .store = store_metadata},
    {.type = "ERRO", .size = size_of_errors, .load = load_errors, .store = store_errors},
    {.type = "VIEW",
     .needs = WEFT_FEATURE_VIEWS,
     .size = weft_size_of_views,
     .load = weft_load_views,
     .store = store_views},
    {.type = "FRAM",
     .of_levels = true,
     .needs = WEFT_FEATURE_LOBES,
     .size = weft_size_of_frames,
     .load = weft_load_frames,
     .store = store_frames},
    {.type = "LOBE",
     .of_levels = true,
     .needs = WEFT_FEATURE_LOBES,
     .size = size_of_lobes,
     .load = load_lobes,
     .store = store_lobes},
    {.type = "TABL",
     .of_levels = true,
     .needs = WEFT_FEATURE_LOBES | WEFT_FEATURE_VIEWS,
     .size = size_of_table,
     .load = load_table,
     .store = store_table},
    {.type = "ALPH",
     .of_levels = true,
     .needs = WEFT_FEATURE_VIEWS | WEFT_FEATURE_OPACITY,
     .size = weft_size_of_opacity,
     .load = weft_load_opacity,
     .store = store_opacity},
    {.type = "COMP",
     .needs = WEFT_FEATURE_COMPONENTS,
     .is_free = true,
     .size = size_of_shared,
     .load = load_shared,
     .store = store_shared},
    {.type = "COEF",
     .of_levels = true,
     .needs = WEFT_FEATURE_COMPONENTS,
     .size = size_of_coefficients,
     .check = check_coefficients,
     .load = weft_load_coefficients,
     .store = store_coefficients},
    {.type = "BNDS",
     .of_levels = true,
     .needs = WEFT_FEATURE_COMPONENTS,
     .size = size_of_bounds,
     .load = load_bounds,
     .store = store_bounds},
    {.type = "HGHT",
     .needs = WEFT_FEATURE_HEIGHTS,
     .is_free = true,
     .size = size_of_heights,
     .load = weft_load_heights,
     .store = store_heights},
    {.type = "VISI",
     .needs = WEFT_FEATURE_VISIBILITY,
     .is_free = true,
     .size = size_of_visibility,
     .load = weft_load_visibility,
     .store = store_visibility},
};
