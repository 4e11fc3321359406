/* Evaluation of a material: the reference of the player's shader. */
#include "reflectance/lafortune.h"

#include <stdbool.h>

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

static weft_rgba table_value(const weft_material_level *level, size_t texel, int view)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    const uint8_t *code = level->table + 4 * ((size_t)view * texels + texel);
    weft_real r = code[0] / (weft_real)255, g = code[1] / (weft_real)255, b = code[2] / (weft_real)255;
    return (weft_rgba){r * r, g * g, b * b, code[3] / (weft_real)255};
}

/* T and opacity for a view of which the corners are known; 1 without a table. */
static weft_rgba table_at(const weft_material_level *level, size_t texel, const weft_barycentric *corners)
{
    weft_rgba value[3];
    weft_barycentric own = *corners;
    if (!level->table)
        return (weft_rgba){1, 1, 1, 1};
    for (int i = 0; i < 3 && corners->index[i] >= 0; i++) {
        value[i] = table_value(level, texel, corners->index[i]);
        own.index[i] = i;
    }
    return weft_view_table_interpolate(value, &own);
}

static weft_rgba texel_value(const weft_material *material, const weft_material_level *level,
                             const weft_barycentric *corners, size_t texel, weft_vec3 light, weft_vec3 view)
{
    weft_frame frame = weft_frame_decode(level->frame + 3 * texel);
    weft_vec3 l = weft_frame_local(&frame, light), v = weft_frame_local(&frame, view);
    weft_rgba value = table_at(level, texel, corners);
    value.r *= channel_value(material, level, texel, 0, l, v);
    value.g *= channel_value(material, level, texel, 1, l, v);
    value.b *= channel_value(material, level, texel, 2, l, v);
    return value;
}

static weft_barycentric corners_of(const weft_material *material, const weft_triangulation *views, weft_vec3 view)
{
    if (material->view_count == 0)
        return (weft_barycentric){{-1, -1, -1}, {0, 0, 0}};
    return weft_triangulation_lookup(views, view);
}

weft_rgba weft_material_texel(const weft_material *material, const weft_triangulation *views, int level, int x, int y,
                              weft_vec3 light, weft_vec3 view)
{
    const weft_material_level *at = &material->level[level];
    if (!(light.z > 0 && view.z > 0))
        return (weft_rgba){0};
    weft_barycentric corners = corners_of(material, views, view);
    return texel_value(material, at, &corners, (size_t)y * (size_t)at->width + (size_t)x, light, view);
}

static weft_rgba mix(weft_rgba a, weft_rgba b, weft_real share)
{
    return (weft_rgba){a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b),
                       a.a + share * (b.a - a.a)};
}

/* Two neighbouring texels of a repeated row or column, and how far the place between them lies toward the second. */
typedef struct neighbours {
    size_t low, high;
    weft_real share;
} neighbours;

/* `coordinate` in units of the material; texel centres lie at half texels. */
static neighbours neighbours_of(weft_real coordinate, int count)
{
    weft_real position = (coordinate - floor(coordinate)) * (weft_real)count - (weft_real)0.5;
    weft_real cell = floor(position);
    int low = ((int)cell + count) % count;
    return (neighbours){(size_t)low, (size_t)((low + 1) % count), position - cell};
}

static weft_rgba level_value(const weft_material *material, const weft_barycentric *corners, int level, weft_real u,
                             weft_real v, weft_vec3 light, weft_vec3 view)
{
    const weft_material_level *at = &material->level[level];
    neighbours column = neighbours_of(u, at->width), row = neighbours_of(-v, at->height);
    size_t top = row.low * (size_t)at->width, bottom = row.high * (size_t)at->width;
    weft_rgba upper = mix(texel_value(material, at, corners, top + column.low, light, view),
                          texel_value(material, at, corners, top + column.high, light, view), column.share);
    weft_rgba lower = mix(texel_value(material, at, corners, bottom + column.low, light, view),
                          texel_value(material, at, corners, bottom + column.high, light, view), column.share);
    return mix(upper, lower, row.share);
}

weft_rgba weft_material_sample(const weft_material *material, const weft_triangulation *views, weft_real level,
                               weft_real u, weft_real v, weft_vec3 light, weft_vec3 view)
{
    bool finite = isfinite(u) && isfinite(v);
    if (!(light.z > 0 && view.z > 0 && finite))
        return (weft_rgba){0};
    weft_barycentric corners = corners_of(material, views, view);
    weft_real clamped = level > 0 ? fmin(level, (weft_real)(material->level_count - 1)) : 0;
    int fine = (int)clamped;
    weft_rgba value = level_value(material, &corners, fine, u, v, light, view);
    if (clamped > (weft_real)fine)
        value = mix(value, level_value(material, &corners, fine + 1, u, v, light, view), clamped - (weft_real)fine);
    return value;
}
