#include "btf/material/material.h"

#include "btf/material/file.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_TEXELS = 16384 /* along a side */ };

static weft_code check_count(const char *what, int count, int least, int most, weft_error *error)
{
    if (count < least || count > most)
        return weft_fail(error, WEFT_BAD_USAGE, "%s is %d, must be %d to %d", what, count, least, most);
    return WEFT_OK;
}

static int chain_length(int width, int height)
{
    int levels = 1;
    for (int side = width > height ? width : height; side > 1; side = (side + 1) / 2)
        levels++;
    return levels;
}

weft_code weft_material_set_shape(weft_material *material, int width, int height, int level_count, int lobe_count,
                                  int view_count, int light_count, weft_error *error)
{
    WEFT_TRY(check_count("width of the material", width, 1, MOST_TEXELS, error));
    WEFT_TRY(check_count("height of the material", height, 1, MOST_TEXELS, error));
    WEFT_TRY(check_count("number of lobes", lobe_count, 0, WEFT_MATERIAL_MAX_LOBES, error));
    WEFT_TRY(check_count("number of views", view_count, 0, WEFT_MATERIAL_MAX_VIEWS, error));
    WEFT_TRY(check_count("number of lights", light_count, 0, WEFT_MATERIAL_MAX_LIGHTS, error));
    int chain = chain_length(width, height);
    WEFT_TRY(check_count("number of levels", level_count, 0, chain, error));
    material->lobe_count = lobe_count;
    material->view_count = view_count;
    material->light_count = light_count;
    material->level_count = level_count > 0 ? level_count : chain;
    for (int k = 0; k < material->level_count; k++) {
        material->level[k].width = width;
        material->level[k].height = height;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return WEFT_OK;
}

static weft_code allocate_array(uint64_t size, void *array, weft_error *error)
{
    void *bytes = NULL;
    if (size > 0) {
        bytes = calloc(1, size);
        if (!bytes)
            return weft_fail_memory(error, "material", size);
    }
    memcpy(array, &bytes, sizeof bytes);
    return WEFT_OK;
}

/* The lobes of a level lie behind its diffuse term, as they do in the file. */
static weft_code allocate_lobes(const weft_material *material, weft_material_level *level, weft_error *error)
{
    size_t texels = (size_t)level->width * (size_t)level->height, plane = 4 * texels;
    WEFT_TRY(allocate_array(texels * 3 * sizeof *level->frame, &level->frame, error));
    WEFT_TRY(allocate_array((1 + 3 * (size_t)material->lobe_count) * plane * sizeof *level->diffuse, &level->diffuse,
                            error));
    level->lobe = material->lobe_count > 0 ? level->diffuse + plane : NULL;
    return WEFT_OK;
}

static weft_code allocate_level(const weft_material *material, weft_material_level *level, weft_error *error)
{
    uint64_t codes = 4 * (uint64_t)level->width * (uint64_t)level->height;
    if (material->has_lobes)
        WEFT_TRY(allocate_lobes(material, level, error));
    WEFT_TRY(allocate_array(codes * (uint64_t)material->view_count, &level->table, error));
    return allocate_array(codes * (uint64_t)material->light_count, &level->light_table, error);
}

static weft_code allocate_all(weft_material *material, weft_error *error)
{
    material->metadata = strdup("{}");
    if (!material->metadata)
        return weft_fail_memory(error, "material", 3);
    WEFT_TRY(allocate_array((uint64_t)material->view_count * sizeof *material->view, &material->view, error));
    WEFT_TRY(allocate_array((uint64_t)material->light_count * sizeof *material->light, &material->light, error));
    for (int k = 0; k < material->level_count; k++)
        WEFT_TRY(allocate_level(material, &material->level[k], error));
    return WEFT_OK;
}

weft_code weft_material_allocate(weft_material *material, weft_error *error)
{
    weft_code code = allocate_all(material, error);
    if (code != WEFT_OK)
        weft_material_free(material);
    return code;
}

static weft_code create(bool has_lobes, int width, int height, int lobe_count, int view_count, int light_count,
                        int with_levels, weft_material *material, weft_error *error)
{
    *material = (weft_material){.texel_pitch_mm = 1, .has_lobes = has_lobes};
    WEFT_TRY(weft_material_set_shape(material, width, height, with_levels ? 0 : 1, lobe_count, view_count, light_count,
                                     error));
    return weft_material_allocate(material, error);
}

weft_code weft_material_create(int width, int height, int lobe_count, int view_count, int light_count, int with_levels,
                               weft_material *material, weft_error *error)
{
    return create(true, width, height, lobe_count, view_count, light_count, with_levels, material, error);
}

weft_code weft_material_create_without_lobes(int width, int height, int view_count, int with_levels,
                                             weft_material *material, weft_error *error)
{
    return create(false, width, height, 0, view_count, 0, with_levels, material, error);
}

void weft_material_set_ceiling(weft_material_level *level, size_t texel, float value)
{
    const weft_half largest = 0x7bff;
    weft_half ceiling = value > 0 ? weft_half_of_float(value) : 0;
    if (value > 0 && weft_float_of_half(ceiling) < value)
        ceiling++;
    level->diffuse[4 * texel + 3] = ceiling < largest ? ceiling : largest;
}

static void free_level(weft_material_level *level)
{
    free(level->frame);
    free(level->diffuse);
    free(level->table);
    free(level->light_table);
}

void weft_material_take_heights(weft_material *material, weft_material_heights *heights)
{
    weft_material_heights_free(material->heights);
    material->heights = heights;
}

void weft_material_take_visibility(weft_material *material, weft_material_visibility *visibility)
{
    weft_material_visibility_free(material->visibility);
    material->visibility = visibility;
}

void weft_material_drop_finest(weft_material *material)
{
    if (material->level_count < 2)
        return;
    free_level(&material->level[0]);
    memmove(material->level, material->level + 1, (size_t)--material->level_count * sizeof *material->level);
    material->texel_pitch_mm *= 2;
    if (material->components)
        weft_components_drop_finest(material->components);
    if (material->heights && --material->heights->level_count == 0)
        weft_material_take_heights(material, NULL);
    if (material->visibility)
        weft_material_visibility_drop_finest(material->visibility);
}

void weft_material_drop_coarsest(weft_material *material)
{
    if (material->level_count < 2)
        return;
    weft_material_level *last = &material->level[--material->level_count];
    free_level(last);
    *last = (weft_material_level){0};
    if (material->components)
        weft_components_drop_coarsest(material->components);
}

void weft_material_free(weft_material *material)
{
    for (int k = 0; k < material->level_count; k++)
        free_level(&material->level[k]);
    weft_components_free(material->components);
    weft_material_heights_free(material->heights);
    weft_material_visibility_free(material->visibility);
    free(material->view);
    free(material->light);
    free(material->metadata);
    *material = (weft_material){0};
}

bool weft_material_has_components_alone(const weft_material *material)
{
    return material->components && !material->has_lobes;
}

const char *weft_material_errors_of(const weft_material *material)
{
    if (!material->components)
        return NULL;
    if (weft_material_has_components_alone(material))
        return "components";
    return material->lobe_count > 0 ? "lobes beside the components" : "diffuse term beside the components";
}

bool weft_material_has_holes(const weft_material *material)
{
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        size_t codes = (size_t)material->view_count * (size_t)level->width * (size_t)level->height;
        for (size_t i = 0; level->table && i < codes; i++) {
            if (level->table[4 * i + 3] != 255)
                return true;
        }
    }
    return false;
}

/* ---- For other programs ---- */

void weft_material_close(weft_material *material)
{
    if (material)
        weft_material_free(material);
    free(material);
}

int weft_material_level_count(const weft_material *material)
{
    return material->level_count;
}

int weft_material_width(const weft_material *material, int level)
{
    return material->level[level].width;
}

int weft_material_height(const weft_material *material, int level)
{
    return material->level[level].height;
}

double weft_material_texel_pitch_mm(const weft_material *material)
{
    return material->texel_pitch_mm;
}

int weft_material_component_count(const weft_material *material)
{
    return material->components ? material->components->component_count : 0;
}

int weft_material_lobe_count(const weft_material *material)
{
    return material->lobe_count;
}

const char *weft_material_metadata(const weft_material *material)
{
    return material->metadata;
}
