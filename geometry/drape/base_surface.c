#include "geometry/drape/draped_cloth.h"

#include <math.h>
#include <stdlib.h>

/* A place this far beside a triangle, in its barycentric coordinates, still lies on it: hems are hit exactly. */
#define TOLERANCE 1e-6

enum { MAX_BUCKETS_ACROSS = 1024 };

static const weft_base_vertex *corner(const weft_base_surface *surface, int triangle, int index)
{
    return &surface->vertex[surface->triangle[triangle][index]];
}

/* Twice the area of a triangle on the flat cloth; positive where it is not mirrored. */
static weft_real flat_area(const weft_base_surface *surface, int triangle)
{
    const weft_base_vertex *a = corner(surface, triangle, 0), *b = corner(surface, triangle, 1);
    const weft_base_vertex *c = corner(surface, triangle, 2);
    return (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
}

static weft_code check_triangles(const weft_base_surface *surface, weft_error *error)
{
    for (int i = 0; i < surface->triangle_count; i++)
        if (!(flat_area(surface, i) > 0))
            return weft_fail(error, WEFT_BAD_INPUT,
                             "triangle %d of the surface has a flat area of %g mm^2: it is mirrored or has none", i + 1,
                             (double)flat_area(surface, i) / 2);
    return WEFT_OK;
}

static void find_bounds(weft_base_map *map)
{
    map->low_x = map->low_y = INFINITY;
    map->high_x = map->high_y = -INFINITY;
    for (int i = 0; i < map->surface->vertex_count; i++) {
        const weft_base_vertex *v = &map->surface->vertex[i];
        map->low_x = fmin(map->low_x, v->x);
        map->low_y = fmin(map->low_y, v->y);
        map->high_x = fmax(map->high_x, v->x);
        map->high_y = fmax(map->high_y, v->y);
    }
}

static int bucket_along(weft_real at, weft_real low, weft_real high, int count)
{
    return (int)weft_clamp(floor((at - low) / (high - low) * (weft_real)count), 0, (weft_real)(count - 1));
}

/* Buckets that a triangle may touch. */
typedef struct bucket_range {
    int left, right, bottom, top;
} bucket_range;

static bucket_range range_of(const weft_base_map *map, int triangle)
{
    const weft_base_vertex *a = corner(map->surface, triangle, 0), *b = corner(map->surface, triangle, 1);
    const weft_base_vertex *c = corner(map->surface, triangle, 2);
    weft_real left = fmin(a->x, fmin(b->x, c->x)), right = fmax(a->x, fmax(b->x, c->x));
    weft_real bottom = fmin(a->y, fmin(b->y, c->y)), top = fmax(a->y, fmax(b->y, c->y));
    return (bucket_range){bucket_along(left, map->low_x, map->high_x, map->columns),
                          bucket_along(right, map->low_x, map->high_x, map->columns),
                          bucket_along(bottom, map->low_y, map->high_y, map->rows),
                          bucket_along(top, map->low_y, map->high_y, map->rows)};
}

static void count_triangles(weft_base_map *map)
{
    for (int i = 0; i < map->surface->triangle_count; i++) {
        bucket_range range = range_of(map, i);
        for (int row = range.bottom; row <= range.top; row++)
            for (int column = range.left; column <= range.right; column++)
                map->start[row * map->columns + column + 1]++;
    }
    for (int i = 0; i < map->columns * map->rows; i++)
        map->start[i + 1] += map->start[i];
}

/* Filling moves every start to the next one; moving them back restores them. */
static void list_triangles(weft_base_map *map)
{
    for (int i = 0; i < map->surface->triangle_count; i++) {
        bucket_range range = range_of(map, i);
        for (int row = range.bottom; row <= range.top; row++)
            for (int column = range.left; column <= range.right; column++)
                map->triangle[map->start[row * map->columns + column]++] = i;
    }
    for (int i = map->columns * map->rows; i > 0; i--)
        map->start[i] = map->start[i - 1];
    map->start[0] = 0;
}

weft_code weft_base_map_create(const weft_base_surface *surface, weft_base_map *map, weft_error *error)
{
    *map = (weft_base_map){.surface = surface};
    WEFT_TRY(check_triangles(surface, error));
    find_bounds(map);
    int across = (int)fmin(ceil(sqrt(surface->triangle_count)), MAX_BUCKETS_ACROSS);
    map->columns = map->rows = across;
    map->start = calloc((size_t)across * (size_t)across + 1, sizeof *map->start);
    if (!map->start)
        return weft_fail_memory(error, "buckets of a surface", (size_t)across * (size_t)across * sizeof *map->start);
    count_triangles(map);
    size_t entries = (size_t)map->start[across * across];
    map->triangle = malloc(entries * sizeof *map->triangle);
    if (!map->triangle) {
        weft_base_map_free(map);
        return weft_fail_memory(error, "buckets of a surface", entries * sizeof *map->triangle);
    }
    list_triangles(map);
    return WEFT_OK;
}

void weft_base_map_free(weft_base_map *map)
{
    free(map->start);
    free(map->triangle);
    *map = (weft_base_map){0};
}

static bool find_weights(const weft_base_surface *surface, int triangle, weft_real x, weft_real y, weft_real weight[3])
{
    const weft_base_vertex *a = corner(surface, triangle, 0), *b = corner(surface, triangle, 1);
    const weft_base_vertex *c = corner(surface, triangle, 2);
    weft_real area = flat_area(surface, triangle);
    weight[1] = ((x - a->x) * (c->y - a->y) - (c->x - a->x) * (y - a->y)) / area;
    weight[2] = ((b->x - a->x) * (y - a->y) - (x - a->x) * (b->y - a->y)) / area;
    weight[0] = 1 - weight[1] - weight[2];
    return fmin(weight[0], fmin(weight[1], weight[2])) >= -(weft_real)TOLERANCE;
}

static weft_vec3 weighted(weft_vec3 a, weft_vec3 b, weft_vec3 c, const weft_real weight[3])
{
    return weft_add(weft_scale(a, weight[0]), weft_add(weft_scale(b, weight[1]), weft_scale(c, weight[2])));
}

static weft_base_place place_on(const weft_base_surface *surface, int triangle, const weft_real weight[3])
{
    const weft_base_vertex *a = corner(surface, triangle, 0), *b = corner(surface, triangle, 1);
    const weft_base_vertex *c = corner(surface, triangle, 2);
    weft_vec3 ab = weft_subtract(b->position, a->position), ac = weft_subtract(c->position, a->position);
    weft_real scale = 1 / flat_area(surface, triangle);
    return (weft_base_place){
        .at = weighted(a->position, b->position, c->position, weight),
        .along_x = weft_subtract(weft_scale(ab, (c->y - a->y) * scale), weft_scale(ac, (b->y - a->y) * scale)),
        .along_y = weft_subtract(weft_scale(ac, (b->x - a->x) * scale), weft_scale(ab, (c->x - a->x) * scale)),
        .normal = weft_unit(weighted(a->normal, b->normal, c->normal, weight))};
}

bool weft_base_map_find(const weft_base_map *map, weft_real x, weft_real y, weft_base_place *place)
{
    int bucket = bucket_along(y, map->low_y, map->high_y, map->rows) * map->columns +
                 bucket_along(x, map->low_x, map->high_x, map->columns);
    for (int i = map->start[bucket]; i < map->start[bucket + 1]; i++) {
        weft_real weight[3];
        if (find_weights(map->surface, map->triangle[i], x, y, weight)) {
            *place = place_on(map->surface, map->triangle[i], weight);
            return true;
        }
    }
    return false;
}
