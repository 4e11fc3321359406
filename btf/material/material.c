#include "btf/material/material.h"

#include "btf/material/format.h"

#include <stdlib.h>
#include <string.h>

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
    WEFT_TRY(check_count("width of the material", width, 1, WEFT_FORMAT_MAX_SIDE, error));
    WEFT_TRY(check_count("height of the material", height, 1, WEFT_FORMAT_MAX_SIDE, error));
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

/* Tables that are stored by components are decoded into arrays all the same. */
static bool has_array(const weft_material *material, weft_section_kind kind)
{
    if (kind == WEFT_SECTION_TABL)
        return material->view_count > 0;
    if (kind == WEFT_SECTION_STAB)
        return material->light_count > 0;
    return weft_section_levels(material, kind) > 0;
}

static weft_code allocate_array(const weft_material *material, weft_section_kind kind, int level, void **array,
                                weft_error *error)
{
    if (!has_array(material, kind))
        return WEFT_OK;
    uint64_t size = weft_section_size(material, kind, level);
    *array = calloc(1, size);
    return *array ? WEFT_OK : weft_fail_memory(error, "material", size);
}

static weft_code allocate_level(weft_material *material, int k, weft_error *error)
{
    weft_material_level *level = &material->level[k];
    void *array[6] = {0};
    weft_code code = WEFT_OK;
    for (int i = 0; i < 6 && code == WEFT_OK; i++)
        code = allocate_array(material, (weft_section_kind)(WEFT_SECTION_FRAM + i), k, &array[i], error);
    level->frame = array[0];
    level->diffuse = array[1];
    level->lobe = array[2];
    level->table = array[3];
    level->light_table = array[4];
    level->model = array[5];
    return code;
}

static weft_code allocate_directions(int count, weft_vec3 **directions, weft_error *error)
{
    if (count == 0)
        return WEFT_OK;
    *directions = calloc((size_t)count, sizeof **directions);
    return *directions ? WEFT_OK : weft_fail_memory(error, "directions", (size_t)count * sizeof **directions);
}

static weft_code allocate_all(weft_material *material, weft_error *error)
{
    material->metadata = strdup("{}");
    if (!material->metadata)
        return weft_fail_memory(error, "material", 3);
    WEFT_TRY(allocate_directions(material->view_count, &material->view, error));
    WEFT_TRY(allocate_directions(material->light_count, &material->light, error));
    for (int k = 0; k < material->level_count; k++)
        WEFT_TRY(allocate_level(material, k, error));
    return WEFT_OK;
}

weft_code weft_material_allocate(weft_material *material, weft_error *error)
{
    weft_code code = allocate_all(material, error);
    if (code != WEFT_OK)
        weft_material_free(material);
    return code;
}

weft_code weft_material_create(int width, int height, int lobe_count, int view_count, int light_count, int with_levels,
                               weft_material *material, weft_error *error)
{
    *material = (weft_material){.texel_pitch_mm = 1};
    WEFT_TRY(weft_material_set_shape(material, width, height, with_levels ? 0 : 1, lobe_count, view_count, light_count,
                                     error));
    return weft_material_allocate(material, error);
}

weft_code weft_material_add_models(weft_material *material, weft_error *error)
{
    material->has_models = true;
    weft_code code = WEFT_OK;
    for (int k = 0; k < material->level_count && code == WEFT_OK; k++) {
        void *model = NULL;
        code = allocate_array(material, WEFT_SECTION_MODL, k, &model, error);
        material->level[k].model = model;
    }
    return code;
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
    free(level->lobe);
    free(level->table);
    free(level->light_table);
    free(level->model);
    weft_table_basis_free(level->table_basis);
    weft_table_basis_free(level->light_table_basis);
}

void weft_material_take_heights(weft_material *material, weft_material_heights *heights)
{
    weft_material_heights_free(material->heights);
    material->heights = heights;
    material->has_heights = heights != NULL;
}

void weft_material_take_seen(weft_material *material, weft_seen *seen)
{
    weft_seen_free(material->seen);
    material->seen = seen;
    material->has_seen = seen != NULL;
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
    if (material->seen)
        weft_seen_drop_finest(material->seen);
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
    weft_seen_free(material->seen);
    free(material->view);
    free(material->light);
    free(material->metadata);
    *material = (weft_material){0};
}

bool weft_material_has_components_alone(const weft_material *material)
{
    const weft_material_level *finest = &material->level[0];
    size_t halves = 4 * (size_t)finest->width * (size_t)finest->height;
    bool is_black = material->components && material->lobe_count == 0;
    for (size_t i = 0; is_black && i < halves; i++)
        is_black = finest->diffuse[i] == 0;
    return is_black;
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
