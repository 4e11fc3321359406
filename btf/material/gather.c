#include "btf/material/gather.h"

#include "btf/material/file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Texels that are moved as they are ---- */

static int held_within(int value, int size)
{
    return value < 0 ? 0 : value >= size ? size - 1 : value;
}

/* A coordinate of a level, moved as the texel of level 0 at its centre is. */
static int moved(int at, int level, int centre, int source, int size)
{
    return held_within(at + (int)lround((source - centre) / exp2(level)), size);
}

static int centre_of(int at, int level, int size)
{
    return held_within((at << level) + ((1 << level) - 1) / 2, size);
}

/* The texel of `from` that each of a level of `to` is: place [height][width]. */
static void find_places(const weft_material *from, const weft_material *to, int level, const weft_texel_mix *mix,
                        size_t *place)
{
    const weft_material_level *source = &from->level[level], *target = &to->level[level];
    for (int y = 0; y < target->height; y++) {
        int centre_y = centre_of(y, level, to->level[0].height);
        for (int x = 0; x < target->width; x++) {
            int centre_x = centre_of(x, level, to->level[0].width);
            const weft_texel_mix *at = &mix[(size_t)centre_y * (size_t)to->level[0].width + (size_t)centre_x];
            int from_x = moved(x, level, centre_x, at->part[0].x, source->width);
            int from_y = moved(y, level, centre_y, at->part[0].y, source->height);
            *place++ = (size_t)from_y * (size_t)source->width + (size_t)from_x;
        }
    }
}

static void copy_plane(const char *from, char *to, size_t texel_bytes, const size_t *place, size_t texels)
{
    for (size_t i = 0; i < texels; i++)
        memcpy(to + i * texel_bytes, from + place[i] * texel_bytes, texel_bytes);
}

/* Planes of texels of `texel_bytes`. */
static void copy_planes(const void *from, void *to, size_t count, size_t texel_bytes, size_t from_texels,
                        const size_t *place, size_t texels)
{
    for (size_t p = 0; from && p < count; p++)
        copy_plane((const char *)from + p * from_texels * texel_bytes, (char *)to + p * texels * texel_bytes,
                   texel_bytes, place, texels);
}

static weft_code gather_level(const weft_material *from, const weft_texel_mix *mix, int k, weft_material *to,
                              weft_error *error)
{
    const weft_material_level *source = &from->level[k];
    weft_material_level *target = &to->level[k];
    size_t all = weft_texel_count(from, k), texels = weft_texel_count(to, k), *place = calloc(texels, sizeof *place);
    if (!place)
        return weft_fail_memory(error, "places of texels", texels * sizeof *place);
    find_places(from, to, k, mix, place);
    copy_planes(source->frame, target->frame, 1, 3 * sizeof *source->frame, all, place, texels);
    copy_planes(source->diffuse, target->diffuse, 1 + 3 * (size_t)from->lobe_count, 4 * sizeof *source->diffuse, all,
                place, texels);
    copy_planes(source->table, target->table, (size_t)from->view_count, 4, all, place, texels);
    target->error = source->error;
    free(place);
    return WEFT_OK;
}

/* ---- Components ---- */

static const int8_t *coefficients(const weft_components_level *level, int group, int x, int y)
{
    size_t texel = ((size_t)group * (size_t)level->height + (size_t)y) * (size_t)level->width + (size_t)x;
    return level->coefficient + WEFT_COMPONENTS_GROUP * texel;
}

/* The sum over the texels of level 0 that a texel of level k covers, of one group. */
static double add_covered(const weft_components_level *from, const weft_components_level *to, const weft_texel_mix *mix,
                          int level, int group, int x, int y, double sum[WEFT_COMPONENTS_GROUP])
{
    double covered = 0;
    for (int j = y << level; j < (y + 1) << level && j < to->height; j++)
        for (int i = x << level; i < (x + 1) << level && i < to->width; i++) {
            const weft_texel_mix *at = &mix[(size_t)j * (size_t)to->width + (size_t)i];
            for (int p = 0; p < WEFT_MIX_TEXELS; p++) {
                if (!(at->part[p].weight > 0))
                    continue;
                const int8_t *c = coefficients(from, group, at->part[p].x, at->part[p].y);
                for (int k = 0; k < WEFT_COMPONENTS_GROUP; k++)
                    sum[k] += (double)at->part[p].weight * c[k];
            }
            covered++;
        }
    return covered;
}

static void mix_level(const weft_components *from, const weft_texel_mix *mix, int k, weft_components *to)
{
    weft_components_level *level = &to->level[k];
#pragma omp parallel for collapse(2)
    for (int group = 0; group < to->component_count / WEFT_COMPONENTS_GROUP; group++)
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                double sum[WEFT_COMPONENTS_GROUP] = {0};
                double covered = add_covered(&from->level[0], &to->level[0], mix, k, group, x, y, sum);
                int8_t *code = (int8_t *)coefficients(level, group, x, y);
                for (int c = 0; c < WEFT_COMPONENTS_GROUP; c++)
                    code[c] = (int8_t)lround(sum[c] / covered);
            }
}

static int squares_of(int side)
{
    return (side + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
}

static size_t square_at(const weft_components_level *level, int x, int y)
{
    return (size_t)(y / WEFT_CEILING_SIDE) * (size_t)squares_of(level->width) + (size_t)(x / WEFT_CEILING_SIDE);
}

/* The square of `from` is under that of `to`. */
static void widen_bounds(const weft_components_level *from, size_t square, weft_components_level *to, size_t mixed)
{
    if (to->ceiling[mixed] < from->ceiling[square])
        to->ceiling[mixed] = from->ceiling[square];
    for (size_t c = 0; c < 3; c++)
        if (to->floor[3 * mixed + c] > from->floor[3 * square + c])
            to->floor[3 * mixed + c] = from->floor[3 * square + c];
}

/* Of each level from level 0: a square of level k lies over 2^k x 2^k of those of level 0 at most. */
static void mix_bounds(const weft_components *from, const weft_texel_mix *mix, int k, weft_components *to)
{
    int width = to->level[0].width, height = to->level[0].height;
    weft_components_level *level = &to->level[k];
    memset(level->floor, UINT8_MAX, 3 * weft_ceiling_count(level->width, level->height));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const weft_texel_mix *at = &mix[(size_t)y * (size_t)width + (size_t)x];
            for (int p = 0; p < WEFT_MIX_TEXELS; p++)
                if (at->part[p].weight > 0)
                    widen_bounds(&from->level[0], square_at(&from->level[0], at->part[p].x, at->part[p].y), level,
                                 square_at(level, x >> k, y >> k));
        }
}

static void copy_shared(const weft_components *from, weft_components *to)
{
    size_t views = (size_t)from->view_count, images = (size_t)from->image_count, count = (size_t)from->component_count;
    memcpy(to->view, from->view, 3 * views * sizeof *from->view);
    memcpy(to->light, from->light, 3 * images * sizeof *from->light);
    memcpy(to->first, from->first, (views + 1) * sizeof *from->first);
    memcpy(to->scale, from->scale, count * sizeof *from->scale);
    memcpy(to->length, from->length, count * sizeof *from->length);
    memcpy(to->nugget, from->nugget, count * sizeof *from->nugget);
    memcpy(to->value, from->value, 3 * images * count * sizeof *from->value);
}

static weft_code gather_components(const weft_components *from, const weft_texel_mix *mix, weft_material *to,
                                   weft_error *error)
{
    WEFT_TRY(
        weft_components_create(from, to->level[0].width, to->level[0].height, to->level_count, &to->components, error));
    copy_shared(from, to->components);
    for (int k = 0; k < to->level_count; k++) {
        mix_level(from, mix, k, to->components);
        mix_bounds(from, mix, k, to->components);
    }
    return WEFT_OK;
}

/* ---- Heights ---- */

/* Places along a side of a texel. */
static int places_of(int places, int texels)
{
    int whole = (int)lround((double)places / texels);
    return whole > 1 ? whole : 1;
}

/* Place `i` of `count` of texel `at`, of the heights of a material of `texels`. */
static int place_in(int at, int i, int count, int texels, int places)
{
    return (int)(((long)at * count + i) * places / ((long)texels * count));
}

static float mixed_height(const weft_material *from, const weft_texel_mix *at, int i, int j, int across, int down)
{
    const weft_material_heights *heights = from->heights;
    float sum = 0;
    for (int p = 0; p < WEFT_MIX_TEXELS; p++) {
        if (!(at->part[p].weight > 0))
            continue;
        int x = place_in(at->part[p].x, i, across, from->level[0].width, heights->width);
        int y = place_in(at->part[p].y, j, down, from->level[0].height, heights->height);
        sum += at->part[p].weight * weft_material_height_mm(heights, x, y);
    }
    return sum;
}

/* A texel takes its heights with it. A plane stays one. */
static weft_code gather_heights(const weft_material *from, const weft_texel_mix *mix, weft_material *to,
                                weft_error *error)
{
    const weft_material_heights *heights = from->heights;
    int columns = to->level[0].width, rows = to->level[0].height;
    bool is_plane = heights->width == 1 && heights->height == 1;
    int across = places_of(heights->width, from->level[0].width),
        down = places_of(heights->height, from->level[0].height);
    int width = is_plane ? 1 : columns * across, height = is_plane ? 1 : rows * down;
    const double size_mm[2] = {heights->size_mm[0] * columns / from->level[0].width,
                               heights->size_mm[1] * rows / from->level[0].height};
    weft_material_heights *result;
    float *value = malloc((size_t)width * (size_t)height * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "heights", (size_t)width * (size_t)height * sizeof *value);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            value[(size_t)y * (size_t)width + (size_t)x] =
                mixed_height(from, &mix[(size_t)(y / down) * (size_t)columns + (size_t)(x / across)], x % across,
                             y % down, across, down);
    weft_code code = weft_material_heights_create(value, width, height, heights->level_count, size_mm, &result, error);
    free(value);
    if (code == WEFT_OK)
        weft_material_take_heights(to, result);
    return code;
}

/* ---- The material ---- */

static weft_code allocate_like(const weft_material *from, int width, int height, weft_material *to, weft_error *error)
{
    WEFT_TRY(weft_material_check_writable(from, error));
    *to = (weft_material){.has_lobes = from->has_lobes, .texel_pitch_mm = from->texel_pitch_mm};
    WEFT_TRY(weft_material_set_shape(to, width, height, from->level_count > 1 ? 0 : 1, from->lobe_count,
                                     from->view_count, 0, error));
    if (to->level_count > from->level_count)
        return weft_fail(error, WEFT_BAD_USAGE, "%d x %d texels are more than the material has", width, height);
    return weft_material_allocate(to, error);
}

static weft_code describe_like(const weft_material *from, weft_material *to, weft_error *error)
{
    if (from->view_count > 0)
        memcpy(to->view, from->view, (size_t)from->view_count * sizeof *from->view);
    char *metadata = strdup(from->metadata);
    if (!metadata)
        return weft_fail_memory(error, "metadata of the material", strlen(from->metadata));
    free(to->metadata);
    to->metadata = metadata;
    return WEFT_OK;
}

weft_code weft_material_gather(const weft_material *from, int width, int height, const weft_texel_mix *mix,
                               weft_material *result, weft_error *error)
{
    WEFT_TRY(allocate_like(from, width, height, result, error));
    weft_code code = describe_like(from, result, error);
    for (int k = 0; k < result->level_count && code == WEFT_OK; k++)
        code = gather_level(from, mix, k, result, error);
    if (code == WEFT_OK && from->components)
        code = gather_components(from->components, mix, result, error);
    if (code == WEFT_OK && from->heights)
        code = gather_heights(from, mix, result, error);
    if (code != WEFT_OK)
        weft_material_free(result);
    return code;
}
