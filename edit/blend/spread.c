#include "edit/blend/steps.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nothing becomes brighter by more, nor is a ceiling raised by more. */
static const float most_gain = 4;

/* The sine of no normal of a frame is made larger than this, of 32767. */
static const float steepest = 32000;

/* What is darker than this share of the mean is no brightness to go by. */
static const float darkest = 0.02f;

typedef struct grid {
    int width, height;
} grid;

/* A linear code of all texels: of the material, of the tile as it was mixed, and what is added to it. */
typedef struct plane {
    int from_width, from_height;
    const weft_texel_mix *mix;
    int parts;    /* of a mix that the tile has: all where the code is linear, else the heaviest */
    float *from;  /* [from_height][from_width] */
    float *mixed; /* [height][width] of the tile */
    weft_membrane added;
} plane;

static weft_code open_plane(const weft_material *from, const weft_texel_mix *mix, const weft_material *tile, plane *p,
                            weft_error *error)
{
    const weft_material_level *source = &from->level[0], *target = &tile->level[0];
    size_t texels = (size_t)source->width * (size_t)source->height,
           count = texels + (size_t)target->width * (size_t)target->height;
    *p = (plane){.from_width = source->width, .from_height = source->height, .mix = mix};
    p->from = malloc(count * sizeof *p->from);
    if (!p->from)
        return weft_fail_memory(error, "codes of the tile", count * sizeof *p->from);
    p->mixed = p->from + texels;
    return weft_membrane_create(target->width, target->height, &p->added, error);
}

static void close_plane(plane *p)
{
    weft_membrane_free(&p->added);
    free(p->from);
}

/* ---- Steps ---- */

static const weft_texel_mix *mix_at(const plane *p, int x, int y)
{
    return &p->mix[(size_t)y * (size_t)p->added.width + (size_t)x];
}

static float from_at(const plane *p, int x, int y)
{
    return p->from[(size_t)y * (size_t)p->from_width + (size_t)x];
}

static void mix_plane(plane *p)
{
    for (int y = 0; y < p->added.height; y++)
        for (int x = 0; x < p->added.width; x++) {
            const weft_texel_mix *at = mix_at(p, x, y);
            float sum = 0, weight = 0;
            for (int i = 0; i < p->parts && at->part[i].weight > 0; i++) {
                sum += at->part[i].weight * from_at(p, at->part[i].x, at->part[i].y);
                weight += at->part[i].weight;
            }
            p->mixed[(size_t)y * (size_t)p->added.width + (size_t)x] = sum / weight;
        }
}

/* Adds the steps that the material has from the texels of `at` to their neighbours on the right (below where `down`),
 * or from those on the left (above) where `back`. */
static void add_steps(const plane *p, const weft_texel_mix *at, bool down, bool back, float *sum, float *weight)
{
    for (int i = 0; i < p->parts; i++) {
        int x = at->part[i].x - (back && !down), y = at->part[i].y - (back && down);
        int right = x + !down, below = y + down;
        if (!(at->part[i].weight > 0) || x < 0 || y < 0 || right >= p->from_width || below >= p->from_height)
            continue;
        *sum += at->part[i].weight * (from_at(p, right, below) - from_at(p, x, y));
        *weight += at->part[i].weight;
    }
}

/* What the tile lacks across every edge. It is 0 where neighbours are those of the material. */
static void find_steps(plane *p)
{
    int width = p->added.width, height = p->added.height;
    for (int down = 0; down < 2; down++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                int next_x = down ? x : (x + 1) % width, next_y = down ? (y + 1) % height : y;
                float sum = 0, weight = 0;
                add_steps(p, mix_at(p, x, y), down, false, &sum, &weight);
                add_steps(p, mix_at(p, next_x, next_y), down, true, &sum, &weight);
                size_t here = (size_t)y * (size_t)width + (size_t)x,
                       next = (size_t)next_y * (size_t)width + (size_t)next_x;
                p->added.step[down][here] = weight > 0 ? sum / weight - (p->mixed[next] - p->mixed[here]) : 0;
            }
}

static weft_code solve_plane(plane *p, weft_error *error)
{
    mix_plane(p);
    find_steps(p);
    return weft_membrane_solve(&p->added, error);
}

/* The mean of what is added, and of the code with it where `whole`, over what texel (x, y) of a level covers. */
static float mean_over(const plane *p, bool whole, int level, int x, int y)
{
    double sum = 0, count = 0;
    for (int j = y << level; j < (y + 1) << level && j < p->added.height; j++)
        for (int i = x << level; i < (x + 1) << level && i < p->added.width; i++, count++) {
            size_t at = (size_t)j * (size_t)p->added.width + (size_t)i;
            sum += (double)p->added.value[at] + (whole ? (double)p->mixed[at] : 0);
        }
    return (float)(sum / count);
}

/* ---- Components ---- */

/* The mean reflectance of every texel of the tile, before and after. */
typedef struct brightness {
    float *before, *after; /* [texels][3] */
} brightness;

static int8_t *code_at(const weft_components_level *level, int layer, size_t texel)
{
    size_t texels = (size_t)level->width * (size_t)level->height, group = (size_t)layer / WEFT_COMPONENTS_GROUP;
    return level->coefficient + (group * texels + texel) * WEFT_COMPONENTS_GROUP + layer % WEFT_COMPONENTS_GROUP;
}

static void read_layer(const weft_components *components, int layer, plane *p)
{
    for (size_t i = 0; i < (size_t)p->from_width * (size_t)p->from_height; i++)
        p->from[i] = *code_at(&components->level[0], layer, i);
}

/* A component may have few codes: files were once rounded so. What is added is then a fraction of a code. So the codes
 * become finer by a whole number, as far as the largest remains a code, and by no more than this. */
enum { FINEST_CODES = 16 };

static int finer_codes(const plane *p)
{
    float most = 1;
    for (size_t i = 0; i < (size_t)p->added.width * (size_t)p->added.height; i++)
        most = fmaxf(most, fabsf(p->mixed[i] + p->added.value[i]));
    return (int)fminf(fmaxf(floorf(WEFT_COMPONENTS_LARGEST_CODE / most), 1), FINEST_CODES);
}

static void write_layer(const plane *p, int layer, weft_components *components)
{
    const float most = WEFT_COMPONENTS_LARGEST_CODE;
    const int finer = finer_codes(p);
    components->scale[layer] /= (float)finer;
    for (int k = 0; k < components->level_count; k++) {
        const weft_components_level *level = &components->level[k];
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                float code = roundf((float)finer * mean_over(p, true, k, x, y));
                *code_at(level, layer, (size_t)y * (size_t)level->width + (size_t)x) =
                    (int8_t)fminf(fmaxf(code, -most), most);
            }
    }
}

static void add_brightness(const weft_components *components, int layer, const plane *p, brightness *mean)
{
    double factor[3] = {0};
    for (int i = 0; i < components->image_count; i++)
        for (int c = 0; c < 3; c++) {
            const weft_half *value =
                components->value + 3 * ((size_t)i * (size_t)components->component_count + (size_t)layer);
            factor[c] +=
                (double)weft_float_of_half(value[c]) * (double)components->scale[layer] / components->image_count;
        }
    for (size_t i = 0; i < (size_t)p->added.width * (size_t)p->added.height; i++)
        for (size_t c = 0; c < 3; c++) {
            mean->before[3 * i + c] += (float)factor[c] * p->mixed[i];
            mean->after[3 * i + c] += (float)factor[c] * (p->mixed[i] + p->added.value[i]);
        }
}

/* The least and the largest factor, 1 among them, by which the mean reflectance of the texels changes that square
 * (column, row) of a level covers. */
static void find_gains(const brightness *mean, grid tile, int level, int column, int row, float gain[2])
{
    int left = (column * WEFT_CEILING_SIDE) << level, top = (row * WEFT_CEILING_SIDE) << level,
        side = WEFT_CEILING_SIDE << level;
    gain[0] = gain[1] = 1;
    for (int y = top; y < top + side && y < tile.height; y++)
        for (int x = left; x < left + side && x < tile.width; x++)
            for (size_t c = 0; c < 3; c++) {
                size_t i = 3 * ((size_t)y * (size_t)tile.width + (size_t)x) + c;
                float factor = mean->before[i] > 0 ? fmaxf(mean->after[i], 0) / mean->before[i] : 1;
                gain[0] = fminf(gain[0], factor);
                gain[1] = fmaxf(gain[1], fminf(factor, most_gain));
            }
}

static void widen_bounds(const brightness *mean, grid tile, weft_components *components)
{
    for (int k = 0; k < components->level_count; k++) {
        weft_components_level *level = &components->level[k];
        int columns = (level->width + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
        for (int i = 0; i < (int)weft_ceiling_count(level->width, level->height); i++) {
            float gain[2];
            find_gains(mean, tile, k, i % columns, i / columns, gain);
            if (gain[1] > 1)
                level->ceiling[i] = weft_ceiling_code(gain[1] * weft_ceiling_of_code(level->ceiling[i]));
            for (int c = 0; gain[0] < 1 && c < 3; c++)
                level->floor[3 * i + c] = weft_floor_code(gain[0] * weft_floor_of_code(level->floor[3 * i + c]));
        }
    }
}

static weft_code spread_components(const weft_components *from, plane *p, weft_components *tile, weft_error *error)
{
    grid size = {p->added.width, p->added.height};
    size_t count = 3 * (size_t)size.width * (size_t)size.height;
    brightness mean = {calloc(2 * count, sizeof(float)), NULL};
    if (!mean.before)
        return weft_fail_memory(error, "brightness of the tile", 2 * count * sizeof(float));
    mean.after = mean.before + count;
    weft_code code = WEFT_OK;
    p->parts = WEFT_MIX_TEXELS;
    for (int layer = 0; layer < from->component_count && code == WEFT_OK; layer++) {
        read_layer(from, layer, p);
        code = solve_plane(p, error);
        if (code == WEFT_OK) {
            write_layer(p, layer, tile);
            add_brightness(from, layer, p, &mean);
        }
    }
    if (code == WEFT_OK)
        widen_bounds(&mean, size, tile);
    free(mean.before);
    return code;
}

/* ---- Frames ---- */

/* The normals of the tile, x or y of them, of which `p` is. */
static void tilt(const plane *p, size_t axis, weft_material *tile)
{
    for (int k = 0; k < tile->level_count; k++) {
        const weft_material_level *level = &tile->level[k];
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                int16_t *normal = level->frame + 3 * ((size_t)y * (size_t)level->width + (size_t)x);
                float other = (float)normal[1 - axis], most = sqrtf(fmaxf(steepest * steepest - other * other, 0));
                float value = (float)normal[axis] + mean_over(p, false, k, x, y);
                normal[axis] = (int16_t)lroundf(fminf(fmaxf(value, -most), most));
            }
    }
}

static weft_code spread_normals(const weft_material *from, plane *p, weft_material *tile, weft_error *error)
{
    p->parts = 1;
    for (size_t axis = 0; axis < 2; axis++) {
        for (size_t i = 0; i < (size_t)p->from_width * (size_t)p->from_height; i++)
            p->from[i] = from->level[0].frame[3 * i + axis];
        WEFT_TRY(solve_plane(p, error));
        tilt(p, axis, tile);
    }
    return WEFT_OK;
}

/* ---- Lobes and diffuse terms ---- */

/* How bright every texel is in its lobes and diffuse term: value [3][texels], a mean over the lights and views that
 * choose the cut. */
static weft_code find_brightness(const weft_material *material, float *value, weft_error *error)
{
    weft_material without_components = *material;
    weft_blend_pictures pictures;
    without_components.components = NULL;
    WEFT_TRY(weft_blend_pictures_make(&without_components, WEFT_BLEND_CHOOSES, &pictures, error));
    size_t texels = (size_t)pictures.width * (size_t)pictures.height;
    for (size_t i = 0; i < texels; i++)
        for (size_t c = 0; c < 3; c++) {
            float sum = 0;
            for (size_t pair = 0; pair < WEFT_BLEND_PAIRS; pair++) {
                float root = pictures.value[i * WEFT_BLEND_VALUES + 4 * pair + c];
                sum += root * root;
            }
            value[c * texels + i] = sum / WEFT_BLEND_PAIRS;
        }
    weft_blend_pictures_free(&pictures);
    return WEFT_OK;
}

/* To the logarithms of `count` values, of which none counts as less than `least`. */
static void take_logarithms(float *value, size_t count, float least)
{
    for (size_t i = 0; i < count; i++)
        value[i] = logf(value[i] + least);
}

static float mean_of(const float *value, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)value[i];
    return (float)(sum / (double)count);
}

/* A lobe is as many times as bright where its C are by the root of its exponent. The ceiling goes with green. */
static void scale_texel(const weft_material *tile, const weft_material_level *level, size_t channel, size_t texel,
                        float gain)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    weft_half *rho = level->diffuse + 4 * texel + channel;
    *rho = weft_half_of_float(gain * weft_float_of_half(*rho));
    if (channel == 1)
        rho[2] = weft_half_of_float(gain * weft_float_of_half(rho[2]));
    for (size_t i = 0; i < (size_t)tile->lobe_count; i++) {
        weft_half *lobe = level->lobe + 4 * ((3 * i + channel) * texels + texel);
        float exponent = weft_float_of_half(lobe[3]), factor = exponent > 0 ? powf(gain, 1 / exponent) : 1;
        for (int c = 0; c < 3; c++)
            lobe[c] = weft_half_of_float(factor * weft_float_of_half(lobe[c]));
    }
}

static void scale_channel(const plane *p, size_t channel, weft_material *tile)
{
    for (int k = 0; k < tile->level_count; k++) {
        const weft_material_level *level = &tile->level[k];
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                float added = fminf(mean_over(p, false, k, x, y), logf(most_gain));
                if (added != 0)
                    scale_texel(tile, level, channel, (size_t)y * (size_t)level->width + (size_t)x, expf(added));
            }
    }
}

/* value: of the material, and of the tile with its new normals. */
static weft_code spread_values(plane *p, float *const value[2], weft_material *tile, weft_error *error)
{
    size_t texels = (size_t)p->from_width * (size_t)p->from_height,
           count = (size_t)p->added.width * (size_t)p->added.height;
    float least = fmaxf(darkest * mean_of(value[0], 3 * texels), FLT_MIN);
    take_logarithms(value[0], 3 * texels, least);
    take_logarithms(value[1], 3 * count, least);
    for (size_t channel = 0; channel < 3; channel++) {
        memcpy(p->from, value[0] + channel * texels, texels * sizeof *p->from);
        memcpy(p->mixed, value[1] + channel * count, count * sizeof *p->mixed);
        find_steps(p);
        WEFT_TRY(weft_membrane_solve(&p->added, error));
        scale_channel(p, channel, tile);
    }
    return WEFT_OK;
}

static weft_code spread_brightness(const weft_material *from, plane *p, weft_material *tile, weft_error *error)
{
    size_t texels = (size_t)p->from_width * (size_t)p->from_height,
           count = 3 * (texels + (size_t)p->added.width * (size_t)p->added.height);
    float *room = calloc(count, sizeof *room);
    if (!room)
        return weft_fail_memory(error, "brightness of the tile", count * sizeof *room);
    float *const value[2] = {room, room + 3 * texels};
    weft_code code = find_brightness(from, value[0], error);
    if (code == WEFT_OK)
        code = find_brightness(tile, value[1], error);
    if (code == WEFT_OK)
        code = spread_values(p, value, tile, error);
    free(room);
    return code;
}

weft_code weft_blend_spread(const weft_material *from, const weft_texel_mix *mix, weft_material *tile,
                            weft_error *error)
{
    plane p;
    weft_code code = open_plane(from, mix, tile, &p, error);
    if (code == WEFT_OK && from->components)
        code = spread_components(from->components, &p, tile->components, error);
    if (code == WEFT_OK && from->has_lobes)
        code = spread_normals(from, &p, tile, error);
    if (code == WEFT_OK && from->has_lobes)
        code = spread_brightness(from, &p, tile, error);
    close_plane(&p);
    return code;
}
