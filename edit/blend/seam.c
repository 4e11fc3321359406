#include "edit/blend/steps.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

static const double seen_as_strong = 0.99;

/* The neighbour of (x, y) to the right or below, in a material that goes round. */
typedef struct neighbour {
    int x, y, right, below;
} neighbour;

static neighbour neighbour_of(const weft_blend_pictures *pictures, int x, int y, int down)
{
    return (neighbour){down ? x : (x + 1) % pictures->width, down ? (y + 1) % pictures->height : y, !down, down};
}

static float edge(const weft_blend_pictures *pictures, int x, int y, neighbour n)
{
    return sqrtf(weft_blend_difference(pictures, x, y, pictures, n.x, n.y));
}

/* Whether two texels of the tile were neighbours in the material as well, each whole. */
static bool were_neighbours(const weft_texel_mix *mix, const weft_blend_pictures *tile, int x, int y, neighbour n)
{
    if (!mix)
        return n.x == x + n.right && n.y == y + n.below;
    const weft_texel_mix *a = &mix[(size_t)y * (size_t)tile->width + (size_t)x];
    const weft_texel_mix *b = &mix[(size_t)n.y * (size_t)tile->width + (size_t)n.x];
    return a->part[0].weight > 0.999f && b->part[0].weight > 0.999f && b->part[0].x == a->part[0].x + n.right &&
           b->part[0].y == a->part[0].y + n.below;
}

/* The differences across edges of `pictures` that are, or are not, of neighbours in the material. Returns their number.
 */
static size_t collect(const weft_blend_pictures *pictures, const weft_texel_mix *mix, bool neighbours, float *found)
{
    size_t count = 0;
    for (int y = 0; y < pictures->height; y++)
        for (int x = 0; x < pictures->width; x++)
            for (int down = 0; down < 2; down++) {
                neighbour n = neighbour_of(pictures, x, y, down);
                if (were_neighbours(mix, pictures, x, y, n) == neighbours)
                    found[count++] = edge(pictures, x, y, n);
            }
    return count;
}

static double mean_of(const float *value, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += value[i];
    return count > 0 ? sum / (double)count : 0;
}

static float largest_of(const float *value, size_t count)
{
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmaxf(largest, value[i]);
    return largest;
}

static size_t edges_of(const weft_blend_pictures *pictures)
{
    return 2 * (size_t)pictures->width * (size_t)pictures->height;
}

static void compare(float *own, size_t own_count, const float *across, size_t across_count, weft_seam *seam)
{
    double mean = mean_of(own, own_count);
    float largest = largest_of(own, own_count);
    float strong = weft_quantile_of_floats(own, own_count, seen_as_strong);
    size_t above = 0;
    for (size_t i = 0; i < across_count; i++)
        above += across[i] > strong;
    *seam = (weft_seam){.pair_count = (long)across_count};
    if (across_count == 0)
        return;
    seam->above_99th = (double)above / (double)across_count;
    seam->strongest = largest > 0 ? largest_of(across, across_count) / largest : 0;
    seam->mean_difference = mean > 0 ? mean_of(across, across_count) / mean : 0;
}

weft_code weft_seam_measure(const weft_blend_pictures *material, const weft_blend_pictures *tile,
                            const weft_texel_mix *mix, weft_seam *seam, weft_error *error)
{
    size_t bytes = (edges_of(material) + edges_of(tile)) * sizeof(float);
    float *own = malloc(bytes), *across = own ? own + edges_of(material) : NULL;
    if (!own)
        return weft_fail_memory(error, "edges of the material", bytes);
    size_t own_count = collect(material, NULL, true, own), across_count = collect(tile, mix, false, across);
    compare(own, own_count, across, across_count, seam);
    free(own);
    return WEFT_OK;
}
