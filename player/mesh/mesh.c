#include "player/mesh/mesh.h"

#include "base/vector.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

weft_code weft_mesh_allocate(int vertex_count, int triangle_count, weft_mesh *mesh, weft_error *error)
{
    *mesh = (weft_mesh){0};
    if (vertex_count < 3 || vertex_count > WEFT_MESH_MAX_VERTICES || triangle_count < 1 ||
        triangle_count > WEFT_MESH_MAX_TRIANGLES)
        return weft_fail(error, WEFT_BAD_USAGE, "a mesh of %d vertices and %d triangles cannot be made", vertex_count,
                         triangle_count);
    mesh->vertex_count = vertex_count;
    mesh->triangle_count = triangle_count;
    mesh->size = mesh->coordinate_length = 1;
    mesh->vertex = calloc((size_t)vertex_count, sizeof *mesh->vertex);
    mesh->index = calloc((size_t)triangle_count + (size_t)triangle_count / 4, sizeof *mesh->index);
    if (mesh->vertex && mesh->index)
        return WEFT_OK;
    weft_mesh_free(mesh);
    return weft_fail_memory(error, "mesh", (unsigned long long)vertex_count * sizeof *mesh->vertex);
}

void weft_mesh_free(weft_mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->index);
    *mesh = (weft_mesh){0};
}

static void find_box(const weft_mesh *mesh, float low[3], float high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = INFINITY;
        high[axis] = -INFINITY;
        for (int i = 0; i < mesh->vertex_count; i++) {
            low[axis] = fminf(low[axis], mesh->vertex[i].position[axis]);
            high[axis] = fmaxf(high[axis], mesh->vertex[i].position[axis]);
        }
    }
}

void weft_mesh_bounds(const weft_mesh *mesh, float centre[3], float *radius)
{
    float low[3], high[3];
    find_box(mesh, low, high);
    for (int axis = 0; axis < 3; axis++)
        centre[axis] = low[axis] + (high[axis] - low[axis]) / 2;
    *radius = 0;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->vertex[i].position;
        *radius = fmaxf(*radius, hypotf(hypotf(p[0] - centre[0], p[1] - centre[1]), p[2] - centre[2]));
    }
}

/* ---- Normals and tangents. Sums are kept in double: a mesh may have slivers beside large faces. ---- */

static weft_vec3 load(const float a[3])
{
    return weft_vec3_of(a[0], a[1], a[2]);
}

static weft_vec3 difference(const float a[3], const float b[3])
{
    return weft_subtract(load(a), load(b));
}

static void add_scaled(weft_vec3 *sum, weft_vec3 a, double scale)
{
    *sum = weft_add(*sum, weft_scale(a, scale));
}

/* False, and `a` unchanged, where it has no direction. */
static bool make_unit(weft_vec3 *a)
{
    double length = weft_length(*a);
    if (!(length > 0) || !isfinite(length))
        return false;
    *a = weft_vec3_of(a->x / length, a->y / length, a->z / length);
    return true;
}

static void store(weft_vec3 a, float result[3])
{
    result[0] = (float)a.x;
    result[1] = (float)a.y;
    result[2] = (float)a.z;
}

weft_code weft_mesh_compute_normals(weft_mesh *mesh, const uint32_t *group, weft_error *error)
{
    size_t count = (size_t)mesh->vertex_count;
    weft_vec3 *sum = calloc(count, sizeof *sum);
    if (!sum)
        return weft_fail_memory(error, "normals", count * sizeof *sum);
    for (int t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->index[t];
        const float *p = mesh->vertex[corner[0]].position;
        weft_vec3 area = weft_cross(difference(mesh->vertex[corner[1]].position, p),
                                    difference(mesh->vertex[corner[2]].position, p));
        for (int i = 0; i < 3; i++)
            add_scaled(&sum[group ? group[corner[i]] : corner[i]], area, 1);
    }
    for (size_t i = 0; i < count; i++) {
        weft_vec3 normal = sum[group ? group[i] : i];
        store(make_unit(&normal) ? normal : weft_vec3_of(0, 0, 1), mesh->vertex[i].normal);
    }
    free(sum);
    return WEFT_OK;
}

/* dp/du and dp/dv of a triangle, times its area in texture space. */
static bool texture_gradients(const weft_mesh *mesh, const uint32_t corner[3], weft_vec3 *along_u, weft_vec3 *along_v)
{
    const weft_vertex *a = &mesh->vertex[corner[0]], *b = &mesh->vertex[corner[1]], *c = &mesh->vertex[corner[2]];
    weft_vec3 ab = difference(b->position, a->position), ac = difference(c->position, a->position);
    double ab_u = (double)b->coordinate[0] - a->coordinate[0], ab_v = (double)b->coordinate[1] - a->coordinate[1];
    double ac_u = (double)c->coordinate[0] - a->coordinate[0], ac_v = (double)c->coordinate[1] - a->coordinate[1];
    double sign = ab_u * ac_v - ac_u * ab_v < 0 ? -1 : 1;
    *along_u = *along_v = weft_vec3_of(0, 0, 0);
    add_scaled(along_u, ab, sign * ac_v);
    add_scaled(along_u, ac, -sign * ab_v);
    add_scaled(along_v, ac, sign * ab_u);
    add_scaled(along_v, ab, -sign * ac_u);
    return ab_u * ac_v != ac_u * ab_v;
}

static weft_vec3 any_perpendicular(weft_vec3 normal)
{
    weft_vec3 axis = weft_vec3_of(fabs(normal.x) < 0.9, fabs(normal.x) >= 0.9, 0);
    add_scaled(&axis, normal, -weft_dot(axis, normal));
    make_unit(&axis);
    return axis;
}

static void set_tangent(weft_vertex *vertex, weft_vec3 along_u, weft_vec3 along_v)
{
    weft_vec3 normal = load(vertex->normal);
    add_scaled(&along_u, normal, -weft_dot(along_u, normal));
    if (!make_unit(&along_u))
        along_u = any_perpendicular(normal);
    store(along_u, vertex->tangent);
    vertex->tangent[3] = weft_dot(weft_cross(normal, along_u), along_v) < 0 ? -1 : 1;
}

weft_code weft_mesh_compute_tangents(weft_mesh *mesh, weft_error *error)
{
    size_t count = (size_t)mesh->vertex_count;
    weft_vec3(*sum)[2] = calloc(count, sizeof *sum);
    if (!sum)
        return weft_fail_memory(error, "tangents", count * sizeof *sum);
    for (int t = 0; t < mesh->triangle_count; t++) {
        weft_vec3 along_u, along_v;
        if (!texture_gradients(mesh, mesh->index[t], &along_u, &along_v))
            continue;
        for (int i = 0; i < 3; i++) {
            add_scaled(&sum[mesh->index[t][i]][0], along_u, 1);
            add_scaled(&sum[mesh->index[t][i]][1], along_v, 1);
        }
    }
    for (size_t i = 0; i < count; i++)
        set_tangent(&mesh->vertex[i], sum[i][0], sum[i][1]);
    free(sum);
    return WEFT_OK;
}

/* Twice the signed area of a triangle of the texture. */
static double coordinate_area(const float a[2], const float b[2], const float c[2])
{
    double ab_u = (double)b[0] - a[0], ab_v = (double)b[1] - a[1];
    double ac_u = (double)c[0] - a[0], ac_v = (double)c[1] - a[1];
    return ab_u * ac_v - ac_u * ab_v;
}

void weft_mesh_measure(weft_mesh *mesh)
{
    double on_mesh = 0, on_texture = 0;
    for (int t = 0; t < mesh->triangle_count; t++) {
        const weft_vertex *a = &mesh->vertex[mesh->index[t][0]], *b = &mesh->vertex[mesh->index[t][1]];
        const weft_vertex *c = &mesh->vertex[mesh->index[t][2]];
        weft_vec3 area = weft_cross(difference(b->position, a->position), difference(c->position, a->position));
        on_mesh += sqrt(weft_dot(area, area));
        on_texture += fabs(coordinate_area(a->coordinate, b->coordinate, c->coordinate));
    }
    mesh->coordinate_length = on_texture > 0 ? sqrt(on_mesh / on_texture) : 0;
    float low[3], high[3];
    find_box(mesh, low, high);
    mesh->size = 0;
    for (int axis = 0; axis < 3; axis++)
        mesh->size = fmax(mesh->size, (double)high[axis] - low[axis]);
}

/* ---- Triangles of a grid ---- */

/* Two triangles for each square of stride x stride cells. Returns the end of them. */
static uint32_t (*index_squares(uint32_t (*index)[3], int columns, int rows, int stride))[3]
{
    for (int row = 0; row + stride < rows; row += stride) {
        for (int column = 0; column + stride < columns; column += stride) {
            uint32_t a = (uint32_t)(row * columns + column), b = a + (uint32_t)stride;
            uint32_t c = a + (uint32_t)(stride * columns), d = c + (uint32_t)stride;
            memcpy(*index++, (uint32_t[3]){a, b, d}, sizeof *index);
            memcpy(*index++, (uint32_t[3]){a, d, c}, sizeof *index);
        }
    }
    return index;
}

void weft_mesh_index_grid(weft_mesh *mesh, int columns, int rows)
{
    uint32_t(*fine_end)[3] = index_squares(mesh->index, columns, rows, 1);
    if (columns % 2 == 1 && rows % 2 == 1)
        mesh->coarse_count = (int)(index_squares(fine_end, columns, rows, 2) - fine_end);
}
