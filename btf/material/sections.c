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

weft_code weft_load_metadata(weft_section_reading *r, weft_error *error)
{
    size_t size = r->section->decoded_size;
    char *text = malloc(size + 1);
    if (!text)
        return weft_fail_memory(error, "metadata", size);
    memcpy(text, r->bytes, size);
    text[size] = 0;
    free(r->material->metadata);
    r->material->metadata = text;
    json_error_t where;
    errno = 0;
    json_t *object = json_loadb(text, size, 0, &where);
    bool valid = json_is_object(object) && strlen(text) == size;
    const json_t *certified = json_object_get(object, "certificate");
    weft_certificate certificate;
    r->fault = !valid ? "no JSON object" : certified ? weft_certificate_unpack(certified, &certificate) : NULL;
    json_decref(object);
    if (!valid && errno == ENOMEM) {
        r->fault = NULL;
        return weft_fail_memory(error, "metadata", size);
    }
    return r->fault ? WEFT_BAD_INPUT : WEFT_OK;
}

static void store_metadata(const weft_material *material, int level, uint8_t *bytes)
{
    memcpy(bytes, material->metadata, size_of_metadata(material, level));
}

/* ---- Errors ---- */

/* The last is the PSNR: negative where the fit is poor, infinite where it is perfect. */
const char *weft_fault_of_errors(const weft_material *material, int level, const uint8_t *bytes, size_t size)
{
    (void)material;
    (void)level;
    for (size_t i = 0; i < size / sizeof(double); i++) {
        double value;
        memcpy(&value, bytes + i * sizeof value, sizeof value);
        bool is_psnr = i % WEFT_FORMAT_ERRORS == WEFT_FORMAT_ERRORS - 1;
        if (!(is_psnr ? value > -INFINITY : value >= 0 && value < INFINITY))
            return is_psnr ? "holds a PSNR that is NaN or minus infinity"
                           : "holds an error that is NaN, negative or infinite";
    }
    return NULL;
}

weft_error_summary weft_take_errors(const uint8_t *bytes)
{
    double value[WEFT_FORMAT_ERRORS];
    memcpy(value, bytes, sizeof value);
    return (weft_error_summary){.median_relative = value[0],
                                .percentile80_relative = value[1],
                                .rmse = value[2],
                                .relative_rmse = value[3],
                                .psnr_db = value[4]};
}

static uint64_t size_of_errors(const weft_material *material, int level)
{
    (void)level;
    return (uint64_t)material->level_count * WEFT_FORMAT_ERRORS * sizeof(double);
}

static weft_code load_errors(weft_section_reading *r, weft_error *error)
{
    (void)error;
    for (int k = 0; k < r->material->level_count; k++)
        r->material->level[k].error = weft_take_errors(r->bytes + (size_t)k * WEFT_FORMAT_ERRORS * sizeof(double));
    return WEFT_OK;
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

const char *weft_fault_of_directions(const weft_material *material, int level, const uint8_t *bytes, size_t size)
{
    (void)material;
    (void)level;
    const float *xyz = (const float *)(const void *)bytes;
    for (size_t i = 0; i < size / sizeof *xyz; i += 3) {
        weft_vec3 direction = weft_vec3_of((weft_real)xyz[i], (weft_real)xyz[i + 1], (weft_real)xyz[i + 2]);
        if (!(fabs(weft_length(direction) - 1) < 1e-3) || direction.z < -1e-6)
            return "holds a direction that is no unit vector of the upper hemisphere";
    }
    return NULL;
}

void weft_take_directions(const uint8_t *bytes, int count, weft_vec3 *direction)
{
    const float *xyz = (const float *)(const void *)bytes;
    for (int i = 0; i < count; i++)
        direction[i] =
            weft_unit(weft_vec3_of((weft_real)xyz[3 * i], (weft_real)xyz[3 * i + 1], (weft_real)xyz[3 * i + 2]));
}

uint64_t weft_size_of_views(const weft_material *material, int level)
{
    (void)level;
    return (uint64_t)material->view_count * 3 * sizeof(float);
}

weft_code weft_load_views(weft_section_reading *r, weft_error *error)
{
    (void)error;
    weft_take_directions(r->bytes, r->material->view_count, r->material->view);
    return WEFT_OK;
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

weft_section_array weft_array_of_frames(const weft_material *material, int level)
{
    const size_t bytes = 3 * sizeof(int16_t);
    return (weft_section_array){material->level[level].frame, 0, weft_texel_count(material, level), bytes, bytes};
}

const char *weft_fault_of_halves(const uint8_t *bytes, size_t size, bool all_positive)
{
    const weft_half *half = (const weft_half *)(const void *)bytes, infinite = 0x7c00, minus_zero = 0x8000;
    for (size_t i = 0; i < size / sizeof *half; i++) {
        if ((half[i] & infinite) == infinite)
            return "holds a number that is not finite";
        if (half[i] > minus_zero && (all_positive || i % 4 == 3))
            return "holds a negative diffuse term or exponent";
    }
    return NULL;
}

/* The diffuse term with its ceiling, and behind it the lobes. */
static weft_section_array array_of_lobes(const weft_material *material, int level)
{
    const size_t bytes = 4 * sizeof(weft_half);
    size_t count = (1 + 3 * (size_t)material->lobe_count) * weft_texel_count(material, level);
    return (weft_section_array){material->level[level].diffuse, 0, count, bytes, bytes};
}

static const char *fault_of_lobes(const weft_material *material, int level, const uint8_t *bytes, size_t size)
{
    size_t diffuse = 4 * sizeof(weft_half) * weft_texel_count(material, level);
    const char *fault = weft_fault_of_halves(bytes, diffuse, true);
    return fault ? fault : weft_fault_of_halves(bytes + diffuse, size - diffuse, false);
}

/* ---- View table and opacity: in memory red, green, blue and opacity lie side by side ---- */

static weft_section_array array_of_table(const weft_material *material, int level)
{
    size_t count = (size_t)material->view_count * weft_texel_count(material, level);
    return (weft_section_array){material->level[level].table, 0, count, 3, 4};
}

weft_section_array weft_array_of_opacity(const weft_material *material, int level)
{
    weft_section_array array = array_of_table(material, level);
    array.offset = 3;
    array.bytes = 1;
    return array;
}

/* ---- Components ---- */

static uint64_t size_of_shared(const weft_material *material, int level)
{
    (void)level;
    return weft_components_section_size(material->components, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES);
}

static weft_code load_shared(weft_section_reading *r, weft_error *error)
{
    WEFT_TRY(weft_components_section_read(r->bytes, r->section->decoded_size, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES,
                                          r->material->level[0].width, r->material->level[0].height,
                                          r->material->level_count, &r->material->components, &r->fault, error));
    if (r->material->components->component_count == r->file->component_count)
        return WEFT_OK;
    r->fault = "its components are not as many as the header says";
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

weft_section_array weft_array_of_coefficients(const weft_material *material, int level)
{
    const weft_components *components = material->components;
    size_t count = weft_texel_count(material, level) * (size_t)components->component_count;
    return (weft_section_array){components->level[level].coefficient, 0, count, 1, 1};
}

const char *weft_fault_of_coefficients(const weft_material *material, int level, const uint8_t *bytes, size_t size)
{
    (void)material;
    (void)level;
    return memchr(bytes, 128, size) ? "holds a coefficient of -128" : NULL;
}

/* Floors of red, green and blue, and the ceiling. */
static uint64_t size_of_bounds(const weft_material *material, int level)
{
    return 4 * weft_ceiling_count(material->level[level].width, material->level[level].height);
}

static weft_code load_bounds(weft_section_reading *r, weft_error *error)
{
    (void)error;
    weft_components_level *level = &r->material->components->level[r->section->level];
    for (size_t i = 0; i < r->section->decoded_size / 4; i++) {
        memcpy(level->floor + 3 * i, r->bytes + 4 * i, 3);
        level->ceiling[i] = r->bytes[4 * i + 3];
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

weft_code weft_load_heights(weft_section_reading *r, weft_error *error)
{
    return weft_material_heights_read(r->bytes, r->section->decoded_size, &r->material->heights, &r->fault, error);
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

weft_code weft_load_visibility(weft_section_reading *r, weft_error *error)
{
    return weft_material_visibility_read(r->bytes, r->section->decoded_size, r->material->level_count,
                                         &r->material->visibility, &r->fault, error);
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
    {.type = "ERRO", .size = size_of_errors, .fault = weft_fault_of_errors, .load = load_errors, .store = store_errors},
    {.type = "VIEW",
     .needs = WEFT_FEATURE_VIEWS,
     .size = weft_size_of_views,
     .fault = weft_fault_of_directions,
     .load = weft_load_views,
     .store = store_views},
    {.type = "FRAM", .of_levels = true, .needs = WEFT_FEATURE_LOBES, .array = weft_array_of_frames},
    {.type = "LOBE", .of_levels = true, .needs = WEFT_FEATURE_LOBES, .array = array_of_lobes, .fault = fault_of_lobes},
    {.type = "TABL", .of_levels = true, .needs = WEFT_FEATURE_LOBES | WEFT_FEATURE_VIEWS, .array = array_of_table},
    {.type = "ALPH",
     .of_levels = true,
     .needs = WEFT_FEATURE_VIEWS | WEFT_FEATURE_OPACITY,
     .array = weft_array_of_opacity},
    {.type = "COMP",
     .needs = WEFT_FEATURE_COMPONENTS,
     .is_free = true,
     .size = size_of_shared,
     .load = load_shared,
     .store = store_shared},
    {.type = "COEF",
     .of_levels = true,
     .needs = WEFT_FEATURE_COMPONENTS,
     .array = weft_array_of_coefficients,
     .check = check_coefficients,
     .fault = weft_fault_of_coefficients},
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
