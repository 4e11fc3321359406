/* Evaluation of a material: the reference of the player's shader. */
#include "reflectance/lafortune/lafortune.h"

#include "btf/material/neighbours.h"

#include <stdbool.h>

static weft_real ceiling_of(const weft_material_level *level, size_t texel)
{
    return weft_float_of_half(level->diffuse[4 * texel + 3]);
}

static weft_real rho_of(const weft_material_level *level, size_t texel, int channel)
{
    return weft_float_of_half(level->diffuse[4 * texel + (size_t)channel]);
}

/* Lobe `index` of a channel; lobes are stored as one plane after another. */
static weft_lobe lobe_of(const weft_material_level *level, size_t texel, int index, int channel)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    const weft_half *code = level->lobe + 4 * ((size_t)(3 * index + channel) * texels + texel);
    return (weft_lobe){weft_float_of_half(code[0]), weft_float_of_half(code[1]), weft_float_of_half(code[2]),
                       weft_float_of_half(code[3])};
}

static weft_real channel_value(const weft_material *material, const weft_material_level *level, size_t texel,
                               int channel, weft_vec3 light, weft_vec3 view)
{
    weft_lobe lobes[WEFT_MATERIAL_MAX_LOBES];
    for (int i = 0; i < material->lobe_count; i++)
        lobes[i] = lobe_of(level, texel, i, channel);
    return weft_lafortune(rho_of(level, texel, channel), lobes, material->lobe_count, light, view);
}

static weft_rgba table_value(const uint8_t *table, const weft_material_level *level, size_t texel, int direction)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    const uint8_t *code = table + 4 * ((size_t)direction * texels + texel);
    weft_real r = code[0] / (weft_real)255, g = code[1] / (weft_real)255, b = code[2] / (weft_real)255;
    return (weft_rgba){r * r, g * g, b * b, code[3] / (weft_real)255};
}

/* T and opacity, or S, for a direction of which the corners are known; 1 without a table. */
static weft_rgba table_at(const uint8_t *table, const weft_material_level *level, size_t texel,
                          const weft_barycentric *corners)
{
    weft_rgba value[3];
    weft_barycentric own = *corners;
    if (!table)
        return (weft_rgba){1, 1, 1, 1};
    for (int i = 0; i < 3 && corners->index[i] >= 0; i++) {
        value[i] = table_value(table, level, texel, corners->index[i]);
        own.index[i] = i;
    }
    return weft_view_table_interpolate(value, &own);
}

/* What is the same for all texels under one light and view. */
typedef struct table_corners {
    weft_barycentric view, light;
} table_corners;

static weft_rgba texel_value(const weft_material *material, const weft_material_level *level,
                             const table_corners *corners, size_t texel, weft_vec3 light, weft_vec3 view)
{
    weft_rgba lit = table_at(level->light_table, level, texel, &corners->light);
    weft_rgba value = table_at(level->table, level, texel, &corners->view);
    if (!material->has_lobes)
        return (weft_rgba){0, 0, 0, value.a};
    weft_frame frame = weft_frame_decode(level->frame + 3 * texel);
    weft_vec3 l = weft_frame_local(&frame, light), v = weft_frame_local(&frame, view);
    value.r *= lit.r * channel_value(material, level, texel, 0, l, v);
    value.g *= lit.g * channel_value(material, level, texel, 1, l, v);
    value.b *= lit.b * channel_value(material, level, texel, 2, l, v);
    return weft_under_ceiling(value, ceiling_of(level, texel));
}

static table_corners corners_of(const weft_material *material, const weft_table_directions *directions, weft_vec3 light,
                                weft_vec3 view)
{
    table_corners corners = {{{-1, -1, -1}, {0, 0, 0}}, {{-1, -1, -1}, {0, 0, 0}}};
    if (material->view_count > 0)
        corners.view = weft_triangulation_lookup(directions->views, view);
    if (material->light_count > 0)
        corners.light = weft_triangulation_lookup(directions->lights, light);
    return corners;
}

weft_code weft_table_directions_create(const weft_material *material, weft_table_directions *directions,
                                       weft_error *error)
{
    *directions = (weft_table_directions){0};
    weft_code code = WEFT_OK;
    if (material->view_count > 0)
        code = weft_triangulation_build(material->view, material->view_count, &directions->views, error);
    if (code == WEFT_OK && material->light_count > 0)
        code = weft_triangulation_build(material->light, material->light_count, &directions->lights, error);
    if (code != WEFT_OK)
        weft_table_directions_free(directions);
    return code;
}

void weft_table_directions_free(weft_table_directions *directions)
{
    weft_triangulation_free(directions->views);
    weft_triangulation_free(directions->lights);
    *directions = (weft_table_directions){0};
}

/* Any direction from which the opacity can be found. */
static weft_vec3 above_horizon(weft_vec3 light)
{
    return light.z > 0 ? light : weft_vec3_of(0, 0, 1);
}

/* What no light reaches hides what is behind it all the same. */
static weft_rgba lit_from(weft_vec3 light, weft_rgba value)
{
    return light.z > 0 ? value : (weft_rgba){0, 0, 0, value.a};
}

weft_rgba weft_material_texel(const weft_material *material, const weft_table_directions *directions, int level, int x,
                              int y, weft_vec3 light, weft_vec3 view)
{
    const weft_material_level *at = &material->level[level];
    if (!(view.z > 0))
        return (weft_rgba){0};
    weft_vec3 above = above_horizon(light);
    table_corners corners = corners_of(material, directions, above, view);
    return lit_from(light, texel_value(material, at, &corners, (size_t)y * (size_t)at->width + (size_t)x, above, view));
}

static weft_rgba mix(weft_rgba a, weft_rgba b, weft_real share)
{
    return (weft_rgba){a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b),
                       a.a + share * (b.a - a.a)};
}

static weft_rgba level_value(const weft_material *material, const table_corners *corners, int level, weft_real u,
                             weft_real v, weft_vec3 light, weft_vec3 view)
{
    const weft_material_level *at = &material->level[level];
    weft_neighbours column = weft_neighbours_of(u, at->width), row = weft_neighbours_of(-v, at->height);
    size_t top = (size_t)row.low * (size_t)at->width, bottom = (size_t)row.high * (size_t)at->width;
    size_t left = (size_t)column.low, right = (size_t)column.high;
    weft_rgba upper = mix(texel_value(material, at, corners, top + left, light, view),
                          texel_value(material, at, corners, top + right, light, view), column.share);
    weft_rgba lower = mix(texel_value(material, at, corners, bottom + left, light, view),
                          texel_value(material, at, corners, bottom + right, light, view), column.share);
    return mix(upper, lower, row.share);
}

weft_rgba weft_material_sample(const weft_material *material, const weft_table_directions *directions, weft_real level,
                               weft_real u, weft_real v, weft_vec3 light, weft_vec3 view)
{
    bool finite = isfinite(u) && isfinite(v);
    if (!(view.z > 0 && finite))
        return (weft_rgba){0};
    weft_vec3 above = above_horizon(light);
    table_corners corners = corners_of(material, directions, above, view);
    weft_real clamped = level > 0 ? fmin(level, (weft_real)(material->level_count - 1)) : 0;
    int fine = (int)clamped;
    weft_rgba value = level_value(material, &corners, fine, u, v, above, view);
    if (clamped > (weft_real)fine)
        value = mix(value, level_value(material, &corners, fine + 1, u, v, above, view), clamped - (weft_real)fine);
    return lit_from(light, value);
}
