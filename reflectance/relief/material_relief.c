#include "reflectance/relief/material_relief.h"

#include <stdlib.h>

static weft_code copy_views(const weft_components *components, weft_vec3 **view, weft_error *error)
{
    size_t bytes = (size_t)components->view_count * sizeof **view;
    *view = malloc(bytes);
    if (!*view)
        return weft_fail_memory(error, "views of components", bytes);
    for (int k = 0; k < components->view_count; k++) {
        const float *xyz = components->view + 3 * k;
        (*view)[k] = weft_unit(weft_vec3_of(xyz[0], xyz[1], xyz[2]));
    }
    return WEFT_OK;
}

static weft_code decode(const weft_material_heights *heights, float **height_mm, weft_error *error)
{
    size_t places = (size_t)heights->width * (size_t)heights->height;
    float *value = malloc(places * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "heights", places * sizeof *value);
    *height_mm = value;
    for (int y = 0; y < heights->height; y++)
        for (int x = 0; x < heights->width; x++)
            *value++ = weft_material_height_mm(heights, x, y);
    return WEFT_OK;
}

static weft_code create(const weft_material_heights *heights, const weft_components *components,
                        weft_material_relief *r, weft_error *error)
{
    WEFT_TRY(copy_views(components, &r->view, error));
    WEFT_TRY(weft_triangulation_build(r->view, components->view_count, &r->views, error));
    WEFT_TRY(decode(heights, &r->height_mm, error));
    weft_height_field field =
        weft_height_field_of(r->height_mm, heights->width, heights->height, heights->size_mm[0], heights->size_mm[1]);
    r->level_count = heights->level_count;
    return weft_relief_create(&field, r->view, components->view_count, &r->relief, error);
}

weft_code weft_material_relief_create(const weft_material *material, weft_material_relief *result, weft_error *error)
{
    *result = (weft_material_relief){0};
    if (!material->heights || !material->components)
        return WEFT_OK;
    weft_code code = create(material->heights, material->components, result, error);
    if (code != WEFT_OK)
        weft_material_relief_free(result);
    return code;
}

void weft_material_relief_free(weft_material_relief *relief)
{
    weft_relief_free(&relief->relief);
    weft_triangulation_free(relief->views);
    free(relief->height_mm);
    free(relief->view);
    *relief = (weft_material_relief){0};
}

weft_real weft_material_relief_share(const weft_material_relief *relief, weft_real level)
{
    if (relief->relief.view_count == 0)
        return 0;
    return weft_clamp(relief->level_count - level, 0, 1);
}

void weft_material_relief_taps(const weft_material_relief *relief, weft_real u, weft_real v, weft_vec3 view,
                               int index[3], weft_relief_tap tap[3])
{
    weft_barycentric around = weft_triangulation_lookup(relief->views, view);
    for (int i = 0; i < 3; i++)
        index[i] = around.index[i];
    weft_relief_taps(&relief->relief, 1, u, v, view, around.index, around.weight, tap);
}
