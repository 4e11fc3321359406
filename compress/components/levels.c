#include "compress/components/projection.h"

#include "compress/options/options.h"

#include <math.h>

/* Steps of the finer components in one of the others. */
enum { FINER = 2 * WEFT_COMPONENTS_LARGEST_CODE };

/* The level that is being written, in place over the one below. */
typedef struct pyramid {
    int width, height;
    size_t component_count;
    float *coefficient, *brightest, *floor;
} pyramid;

/* The largest coefficient of level 0 gets the largest code; means are never larger. */
static void find_steps(const pyramid *p, float step[WEFT_COMPONENTS_MAX])
{
    size_t texels = (size_t)p->width * (size_t)p->height;
    for (size_t k = 0; k < p->component_count; k++) {
        float most = 0;
        for (size_t texel = 0; texel < texels; texel++)
            most = fmaxf(most, fabsf(p->coefficient[texel * p->component_count + k]));
        step[k] = most / WEFT_COMPONENTS_LARGEST_CODE;
    }
}

static int8_t *code_of(weft_components_level *level, size_t layer, size_t texel)
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    return level->coefficient + (layer / WEFT_COMPONENTS_GROUP * texels + texel) * WEFT_COMPONENTS_GROUP +
           layer % WEFT_COMPONENTS_GROUP;
}

/* What rounding leaves is at most half a step, which the finer layer, where there is one, has as its largest code. */
static void write_codes(const pyramid *p, const float step[WEFT_COMPONENTS_MAX], bool has_finer,
                        weft_components_level *level)
{
    size_t texels = (size_t)p->width * (size_t)p->height;
    for (size_t k = 0; k < p->component_count; k++)
        for (size_t texel = 0; texel < texels; texel++) {
            float value = step[k] > 0 ? p->coefficient[texel * p->component_count + k] / step[k] : 0;
            float whole = roundf(value);
            *code_of(level, k, texel) = (int8_t)whole;
            if (has_finer)
                *code_of(level, p->component_count + k, texel) = (int8_t)lroundf((value - whole) * FINER);
        }
}

static float brightest_in(const pyramid *p, int x0, int y0)
{
    float most = 0;
    for (int y = y0; y < y0 + WEFT_CEILING_SIDE && y < p->height; y++)
        for (int x = x0; x < x0 + WEFT_CEILING_SIDE && x < p->width; x++)
            most = fmaxf(most, p->brightest[(size_t)y * (size_t)p->width + (size_t)x]);
    return most;
}

static void write_ceilings(const pyramid *p, uint8_t *code)
{
    for (int y = 0; y < p->height; y += WEFT_CEILING_SIDE)
        for (int x = 0; x < p->width; x += WEFT_CEILING_SIDE)
            *code++ = weft_ceiling_code(WEFT_BRIGHTEST_MULTIPLE * brightest_in(p, x, y));
}

static float darkest_in(const pyramid *p, int x0, int y0, size_t channel)
{
    float least = INFINITY;
    for (int y = y0; y < y0 + WEFT_CEILING_SIDE && y < p->height; y++)
        for (int x = x0; x < x0 + WEFT_CEILING_SIDE && x < p->width; x++)
            least = fminf(least, p->floor[3 * ((size_t)y * (size_t)p->width + (size_t)x) + channel]);
    return least;
}

static void write_floors(const pyramid *p, uint8_t *code)
{
    for (int y = 0; y < p->height; y += WEFT_CEILING_SIDE)
        for (int x = 0; x < p->width; x += WEFT_CEILING_SIDE)
            for (size_t c = 0; c < 3; c++)
                *code++ = weft_floor_code(darkest_in(p, x, y, c));
}

/* How many texels of level 0 along a side the texel at `index` of a level covers. */
static int covered(int index, int level, int size)
{
    int first = index << level, last = (index + 1) << level;
    return (last < size ? last : size) - first;
}

/* The mean of up to four texels, by what they cover, goes to texel (x, y) of the next level. */
static void merge(pyramid *p, int level, int width0, int height0, int x, int y, int next_width)
{
    size_t to = (size_t)y * (size_t)next_width + (size_t)x;
    float sum[WEFT_COMPONENTS_MAX] = {0}, dark[3] = {0}, most = 0, total = 0;
    for (int j = 2 * y; j < 2 * y + 2 && j < p->height; j++)
        for (int i = 2 * x; i < 2 * x + 2 && i < p->width; i++) {
            size_t from = (size_t)j * (size_t)p->width + (size_t)i;
            float weight = (float)covered(i, level, width0) * (float)covered(j, level, height0);
            for (size_t k = 0; k < p->component_count; k++)
                sum[k] += weight * p->coefficient[from * p->component_count + k];
            for (size_t c = 0; c < 3; c++)
                dark[c] += weight * p->floor[3 * from + c];
            most = fmaxf(most, p->brightest[from]);
            total += weight;
        }
    for (size_t k = 0; k < p->component_count; k++)
        p->coefficient[to * p->component_count + k] = sum[k] / total;
    for (size_t c = 0; c < 3; c++)
        p->floor[3 * to + c] = dark[c] / total;
    p->brightest[to] = most;
}

/* A texel of the next level lies before those that it is made of, so that nothing is overwritten too early. */
static void next_level(pyramid *p, int level, int width0, int height0)
{
    int width = (p->width + 1) / 2, height = (p->height + 1) / 2;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            merge(p, level, width0, height0, x, y, width);
    p->width = width;
    p->height = height;
}

void weft_components_fill_levels(weft_projection *projection, weft_components *components)
{
    float step[WEFT_COMPONENTS_MAX] = {0};
    pyramid p = {.width = projection->width,
                 .height = projection->height,
                 .component_count = (size_t)projection->component_count,
                 .coefficient = projection->coefficient,
                 .brightest = projection->brightest,
                 .floor = projection->floor};
    bool has_finer = components->component_count > projection->component_count;
    find_steps(&p, step);
    for (int k = 0; k < components->level_count; k++) {
        if (k > 0)
            next_level(&p, k - 1, projection->width, projection->height);
        write_codes(&p, step, has_finer, &components->level[k]);
        write_ceilings(&p, components->level[k].ceiling);
        write_floors(&p, components->level[k].floor);
    }
    for (int k = 0; k < projection->component_count; k++)
        components->scale[k] *= step[k];
    for (int k = projection->component_count; k < components->component_count; k++)
        components->scale[k] *= step[k - projection->component_count] / FINER;
}
