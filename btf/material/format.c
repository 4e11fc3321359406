#include "btf/material/format.h"

#include "btf/material/models.h"

#include <string.h>

const unsigned char weft_format_magic[8] = {0x89, 'W', 'E', 'F', 'T', '\r', '\n', 0x1a};

const char weft_section_type[WEFT_SECTION_KINDS][5] = {"META", "VIEW", "LITE", "FRAM", "RHO ", "LOBE", "TABL",
                                                       "STAB", "MODL", "TPCA", "SPCA", "ALPH", "ERRO", "LAYR",
                                                       "LCOE", "CEIL", "FLOR", "HGHT", "SEEN"};

weft_section_kind weft_section_kind_of(const char type[5])
{
    int kind = 0;
    while (kind < WEFT_SECTION_KINDS && strcmp(weft_section_type[kind], type) != 0)
        kind++;
    return (weft_section_kind)kind;
}

int weft_section_levels(const weft_material *material, weft_section_kind kind)
{
    switch (kind) {
    case WEFT_SECTION_META:
        return 1;
    case WEFT_SECTION_VIEW:
        return material->view_count > 0;
    case WEFT_SECTION_LITE:
        return material->light_count > 0;
    case WEFT_SECTION_LOBE:
        return material->lobe_count > 0 ? material->level_count : 0;
    case WEFT_SECTION_TABL:
        return material->view_count > 0 && !material->has_table_bases ? material->level_count : 0;
    case WEFT_SECTION_STAB:
        return material->light_count > 0 && !material->has_table_bases ? material->level_count : 0;
    case WEFT_SECTION_TPCA:
        return material->view_count > 0 && material->has_table_bases ? material->level_count : 0;
    case WEFT_SECTION_SPCA:
        return material->light_count > 0 && material->has_table_bases ? material->level_count : 0;
    case WEFT_SECTION_ALPH:
        return material->has_opacity && material->has_table_bases ? material->level_count : 0;
    case WEFT_SECTION_MODL:
        return material->has_models ? material->level_count : 0;
    case WEFT_SECTION_LAYR:
        return material->has_components;
    case WEFT_SECTION_LCOE:
    case WEFT_SECTION_CEIL:
        return material->has_components ? material->level_count : 0;
    case WEFT_SECTION_FLOR:
        return material->has_components && material->has_floors ? material->level_count : 0;
    case WEFT_SECTION_HGHT:
        return material->has_heights;
    case WEFT_SECTION_SEEN:
        return material->has_seen;
    default:
        return material->level_count;
    }
}

uint64_t weft_section_size(const weft_material *material, weft_section_kind kind, int level)
{
    uint64_t texels = (uint64_t)material->level[level].width * (uint64_t)material->level[level].height;
    switch (kind) {
    case WEFT_SECTION_VIEW:
        return (uint64_t)material->view_count * 3 * sizeof(float);
    case WEFT_SECTION_LITE:
        return (uint64_t)material->light_count * 3 * sizeof(float);
    case WEFT_SECTION_FRAM:
        return texels * 3 * sizeof(int16_t);
    case WEFT_SECTION_RHO:
        return texels * 4 * sizeof(weft_half);
    case WEFT_SECTION_LOBE:
        return (uint64_t)material->lobe_count * 3 * texels * 4 * sizeof(weft_half);
    case WEFT_SECTION_TABL:
        return (uint64_t)material->view_count * texels * 4;
    case WEFT_SECTION_STAB:
        return (uint64_t)material->light_count * texels * 4;
    case WEFT_SECTION_ALPH:
        return (uint64_t)material->view_count * texels;
    case WEFT_SECTION_MODL:
        return texels;
    case WEFT_SECTION_ERRO:
        return WEFT_FORMAT_ERRORS * sizeof(double);
    case WEFT_SECTION_LAYR:
        return material->components
                   ? weft_components_header_size(material->components, WEFT_COMPONENTS_BY_WEIGHTED_DIFFERENCES)
                   : 0;
    case WEFT_SECTION_LCOE:
        return material->components ? texels * (uint64_t)material->components->component_count : 0;
    case WEFT_SECTION_HGHT:
        return material->heights ? weft_material_heights_size(material->heights) : 0;
    case WEFT_SECTION_SEEN:
        return material->seen ? weft_seen_size(material->seen) : 0;
    case WEFT_SECTION_CEIL:
        return weft_ceiling_count(material->level[level].width, material->level[level].height);
    case WEFT_SECTION_FLOR:
        return 3 * weft_ceiling_count(material->level[level].width, material->level[level].height);
    default:
        return 0;
    }
}

void *weft_section_texels(const weft_material *material, weft_section_kind kind, int level)
{
    const weft_material_level *at = &material->level[level];
    switch (kind) {
    case WEFT_SECTION_FRAM:
        return at->frame;
    case WEFT_SECTION_RHO:
        return at->diffuse;
    case WEFT_SECTION_LOBE:
        return at->lobe;
    case WEFT_SECTION_TABL:
        return at->table;
    case WEFT_SECTION_STAB:
        return at->light_table;
    case WEFT_SECTION_MODL:
        return at->model;
    case WEFT_SECTION_LCOE:
        return material->components->level[level].coefficient;
    case WEFT_SECTION_CEIL:
        return material->components->level[level].ceiling;
    case WEFT_SECTION_FLOR:
        return material->components->level[level].floor;
    default:
        return NULL;
    }
}

/* rho and N, but not Cx, Cy, Cz, must not be negative. */
static const char *fault_of_halves(weft_section_kind kind, const weft_half *half, size_t count)
{
    const weft_half infinite = 0x7c00, minus_zero = 0x8000;
    for (size_t i = 0; i < count; i++) {
        if ((half[i] & infinite) == infinite)
            return "holds a number that is not finite";
        if (half[i] > minus_zero && (kind == WEFT_SECTION_RHO || i % 4 == 3))
            return "holds a negative diffuse term or exponent";
    }
    return NULL;
}

static const char *fault_of_directions(const float *xyz, size_t count)
{
    for (size_t i = 0; i + 2 < count; i += 3) {
        weft_vec3 direction = {xyz[i], xyz[i + 1], xyz[i + 2]};
        if (!(fabs(weft_length(direction) - 1) < 1e-3) || direction.z < -1e-6)
            return "holds a direction that is no unit vector of the upper hemisphere";
    }
    return NULL;
}

/* The last is the PSNR: negative where the fit is poor, infinite where it is perfect. */
static const char *fault_of_errors(const double *value, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        bool is_psnr = i + 1 == count;
        if (!(is_psnr ? value[i] > -INFINITY : value[i] >= 0 && value[i] < INFINITY))
            return is_psnr ? "holds a PSNR that is NaN or minus infinity"
                           : "holds an error that is NaN, negative or infinite";
    }
    return NULL;
}

static const char *fault_of_coefficients(const int8_t *coefficient, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (coefficient[i] < -WEFT_COMPONENTS_LARGEST_CODE)
            return "holds a coefficient of -128";
    }
    return NULL;
}

static const char *fault_of_models(const uint8_t *model, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (model[i] >= WEFT_MODEL_CODES)
            return "holds an unknown model";
    }
    return NULL;
}

const char *weft_section_fault(weft_section_kind kind, const void *bytes, size_t size)
{
    switch (kind) {
    case WEFT_SECTION_VIEW:
    case WEFT_SECTION_LITE:
        return fault_of_directions(bytes, size / sizeof(float));
    case WEFT_SECTION_RHO:
    case WEFT_SECTION_LOBE:
        return fault_of_halves(kind, bytes, size / sizeof(weft_half));
    case WEFT_SECTION_MODL:
        return fault_of_models(bytes, size);
    case WEFT_SECTION_ERRO:
        return fault_of_errors(bytes, size / sizeof(double));
    case WEFT_SECTION_LCOE:
        return fault_of_coefficients(bytes, size);
    default:
        return NULL;
    }
}
