#include "edit/prune/steps.h"

#include "btf/direction/square_map.h"
#include "btf/direction/triangulation.h"

#include <stdlib.h>
#include <string.h>

enum { PROBES = 3 }; /* along a side of a cell, to compare triangulations */

/* ---- Cells ---- */

/* The direction at a place of the square; below the horizon in its corners. */
static weft_vec3 direction_at(double x, double y)
{
    double a = 2 * (x - 0.5), b = 2 * (y - 0.5), square = a * a + b * b, scale = 1 / (1 + square);
    return weft_vec3_of(2 * a * scale, 2 * b * scale, (1 - square) * scale);
}

static weft_vec3 direction_in_cell(int cell, double x, double y)
{
    int column = cell % WEFT_VISIBILITY_SIDE, row = cell / WEFT_VISIBILITY_SIDE;
    weft_vec3 direction = direction_at((column + x) / WEFT_VISIBILITY_SIDE, (row + y) / WEFT_VISIBILITY_SIDE);
    direction.z = fmax(direction.z, 0);
    return weft_unit(direction);
}

/* A cell lies within this of its middle: half its diagonal, where the map shrinks most, to a quarter. */
static const double cell_radius = 4 * 0.7071067811865476 / WEFT_VISIBILITY_SIDE;

/* ---- Which entries ---- */

static double angle_between(weft_vec3 a, weft_vec3 b)
{
    return atan2(weft_length(weft_cross(a, b)), weft_dot(a, b));
}

/* From a direction to the arc between two others. */
static double angle_to_arc(weft_vec3 q, weft_vec3 a, weft_vec3 b)
{
    weft_vec3 pole = weft_unit(weft_cross(a, b));
    bool beside = weft_dot(weft_cross(pole, a), q) < 0 || weft_dot(weft_cross(b, pole), q) < 0;
    return beside ? fmin(angle_between(q, a), angle_between(q, b)) : fabs(asin(weft_clamp(weft_dot(q, pole), -1, 1)));
}

static double angle_to_triangle(weft_vec3 q, const weft_vec3 c[3])
{
    double least = WEFT_PI;
    bool inside = true;
    for (int i = 0; i < 3; i++) {
        weft_vec3 a = c[i], b = c[(i + 1) % 3], across = weft_cross(a, b);
        inside = inside && weft_dot(across, q) * weft_dot(across, c[(i + 2) % 3]) >= 0;
        least = fmin(least, angle_to_arc(q, a, b));
    }
    return inside ? 0 : least;
}

/* How far the point that a direction is looked up at lies from it: beyond the triangles, at their border. */
static double angle_to_all(const weft_triangulation *t, const weft_vec3 *direction, weft_vec3 q)
{
    weft_barycentric at = weft_triangulation_lookup(t, q);
    weft_vec3 point = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        if (at.index[i] >= 0)
            point = weft_add(point, weft_scale(direction[at.index[i]], at.weight[i]));
    return angle_between(point, q);
}

/* All corners of triangles that a direction of the cell may be looked up in: the point where it is lies no further from
 * it than that of the middle does, and twice the radius. */
static void keep_for_cell(const weft_triangulation *t, const weft_vec3 *direction, int cell, bool *kept)
{
    weft_vec3 middle = direction_in_cell(cell, 0.5, 0.5);
    const int(*corner)[3] = weft_triangulation_triangles(t);
    double visibility = angle_to_all(t, direction, middle) + 2 * cell_radius;
    for (int i = 0; i < weft_triangulation_triangle_count(t); i++) {
        const weft_vec3 at[3] = {direction[corner[i][0]], direction[corner[i][1]], direction[corner[i][2]]};
        if (angle_to_triangle(middle, at) <= visibility)
            kept[corner[i][0]] = kept[corner[i][1]] = kept[corner[i][2]] = true;
    }
}

static int keep(const weft_triangulation *t, const weft_vec3 *direction, int count, const uint8_t *cells, bool *kept)
{
    int kept_count = 0;
    for (int cell = 0; cell < WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE; cell++)
        if (cells[cell])
            keep_for_cell(t, direction, cell, kept);
    for (int i = 0; i < count; i++)
        kept_count += kept[i];
    return kept_count;
}

/* ---- Whether it is still the same ---- */

static void spread_weights(const weft_barycentric *at, const int *number, double *weight, double sign)
{
    for (int i = 0; i < 3; i++)
        if (at->index[i] >= 0)
            weight[number ? number[at->index[i]] : at->index[i]] += sign * at->weight[i];
}

static bool same_weights(const weft_triangulation *all, const weft_triangulation *few, const int *number, int count,
                         weft_vec3 q, double *weight)
{
    double difference = 0;
    weft_barycentric a = weft_triangulation_lookup(all, q), b = weft_triangulation_lookup(few, q);
    memset(weight, 0, (size_t)count * sizeof *weight);
    spread_weights(&a, NULL, weight, 1);
    spread_weights(&b, number, weight, -1);
    for (int i = 0; i < count; i++)
        difference = fmax(difference, fabs(weight[i]));
    return difference < 1e-5;
}

/* number [entries of few] is what each was called before. */
static bool is_still_the_same(const weft_triangulation *all, const weft_triangulation *few, const int *number,
                              int count, const uint8_t *cells, double *weight)
{
    for (int cell = 0; cell < WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE; cell++)
        for (int i = 0; cells[cell] && i < PROBES * PROBES; i++) {
            weft_vec3 q = direction_in_cell(cell, i % PROBES / (PROBES - 1.0), (int)(i / PROBES) / (PROBES - 1.0));
            if (!same_weights(all, few, number, count, q, weight))
                return false;
        }
    return true;
}

/* ---- Leaving out ---- */

static void pack_planes(uint8_t *table, const int *number, int count, size_t plane)
{
    for (int i = 0; i < count; i++)
        memmove(table + (size_t)i * plane, table + (size_t)number[i] * plane, plane);
}

/* number: of the entries that stay, ascending. */
static void leave_out(weft_material *material, const int *number, int count)
{
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        pack_planes(level->table, number, count, 4 * (size_t)level->width * (size_t)level->height);
    }
    for (int i = 0; i < count; i++)
        material->view[i] = material->view[number[i]];
    material->view_count = count;
}

/* kept, number and weight are of `count` entries, zeroed. */
static weft_code prune(weft_material *material, const uint8_t *cells, bool *kept, int *number, double *weight,
                       weft_vec3 *few_directions, const weft_triangulation *all, weft_error *error)
{
    int count = material->view_count, kept_count = 0;
    int wanted = keep(all, material->view, count, cells, kept);
    if (wanted < 3 || wanted == count || weft_triangulation_triangle_count(all) == 0)
        return WEFT_OK;
    for (int i = 0; i < count; i++)
        if (kept[i]) {
            few_directions[kept_count] = material->view[i];
            number[kept_count++] = i;
        }
    weft_triangulation *few;
    WEFT_TRY(weft_triangulation_build(few_directions, kept_count, &few, error));
    bool same = is_still_the_same(all, few, number, count, cells, weight);
    weft_triangulation_free(few);
    if (same)
        leave_out(material, number, kept_count);
    return WEFT_OK;
}

weft_code weft_prune_tables(const weft_visibility *visibility, weft_material *material, weft_error *error)
{
    size_t count = (size_t)material->view_count;
    weft_triangulation *all = NULL;
    if (count == 0)
        return WEFT_OK;
    bool *kept = calloc(count, sizeof *kept);
    int *number = calloc(count, sizeof *number);
    double *weight = calloc(count, sizeof *weight);
    weft_vec3 *few = calloc(count, sizeof *few);
    weft_code code =
        kept && number && weight && few ? WEFT_OK : weft_fail_memory(error, "directions", count * sizeof *few);
    if (code == WEFT_OK)
        code = weft_triangulation_build(material->view, (int)count, &all, error);
    if (code == WEFT_OK)
        code = prune(material, visibility->view, kept, number, weight, few, all, error);
    weft_triangulation_free(all);
    free(kept);
    free(number);
    free(weight);
    free(few);
    return code;
}
