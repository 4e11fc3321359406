/* Marching cubes over a periodic grid (Lorensen and Cline 1987, cases as in geometry/yarn/cube_cases.h). */
#include "geometry/yarn/cube_cases.h"
#include "geometry/yarn/solid_field.h"
#include "geometry/yarn/tile_mesh.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_NODES = 1 << 24, EDGE_STEPS = 4 };

/* Vertices keep this far from the nodes, in cells, so that no triangle loses its area. */
#define NODE_DISTANCE 0.02

/* Beyond the surface, in cells, by which the field must be known. */
#define MARGIN_CELLS 2.5

typedef struct polygoniser {
    const weft_segment_grid *grid;
    weft_tile_mesh *mesh;
    int cells[3];
    weft_vec3 cell;
    weft_real bottom;
    float *value; /* [cells z + 1][cells y][cells x] of the field at the nodes */
    /* [cells z + 1][cells y + 1][cells x + 1][3] vertex on the edge from a node along an axis; -1. */
    int32_t *vertex_of;
    int vertex_capacity, triangle_capacity;
} polygoniser;

static weft_vec3 node_place(const polygoniser *p, int x, int y, int z)
{
    return weft_vec3_of(x * p->cell.x, y * p->cell.y, p->bottom + z * p->cell.z);
}

static float node_value(const polygoniser *p, int x, int y, int z)
{
    return p->value[((size_t)z * (size_t)p->cells[1] + (size_t)(y % p->cells[1])) * (size_t)p->cells[0] +
                    (size_t)(x % p->cells[0])];
}

static int32_t *vertex_slot(const polygoniser *p, int x, int y, int z, int axis)
{
    size_t node = ((size_t)z * (size_t)(p->cells[1] + 1) + (size_t)y) * (size_t)(p->cells[0] + 1) + (size_t)x;
    return &p->vertex_of[3 * node + (size_t)axis];
}

static void evaluate_nodes(polygoniser *p)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int z = 0; z <= p->cells[2]; z++) {
        for (int y = 0; y < p->cells[1]; y++) {
            float *row = p->value + ((size_t)z * (size_t)p->cells[1] + (size_t)y) * (size_t)p->cells[0];
            for (int x = 0; x < p->cells[0]; x++)
                row[x] = (float)weft_yarn_field_value(p->grid, node_place(p, x, y, z));
        }
    }
}

static weft_code grow_array(void **array, size_t element, int capacity, weft_error *error)
{
    void *larger = realloc(*array, (size_t)capacity * element);
    if (!larger)
        return weft_fail_memory(error, "triangle mesh", (size_t)capacity * element);
    *array = larger;
    return WEFT_OK;
}

static weft_code grow_vertices(polygoniser *p, weft_error *error)
{
    weft_tile_mesh *mesh = p->mesh;
    if (mesh->vertex_count < p->vertex_capacity)
        return WEFT_OK;
    p->vertex_capacity = p->vertex_capacity ? 2 * p->vertex_capacity : 4096;
    WEFT_TRY(grow_array((void **)&mesh->position, sizeof *mesh->position, p->vertex_capacity, error));
    return grow_array((void **)&mesh->original, sizeof *mesh->original, p->vertex_capacity, error);
}

/* Where the field changes sign on the edge from `a`, where it is `value_a`, to `b`: false position with halving of the
 * end that stays (the Illinois rule, Dowell and Jarratt 1971), in parts of the edge. */
static weft_real crossing(const polygoniser *p, weft_vec3 a, weft_vec3 b, weft_real value_a, weft_real value_b)
{
    weft_real low = 0, high = 1, middle = (weft_real)0.5;
    const weft_stitch *stitch = p->grid->skeleton->stitch;
    bool a_inside = value_a < 0;
    for (int i = 0; i < EDGE_STEPS; i++) {
        weft_real share = value_a / (value_a - value_b);
        middle = low + (high - low) * weft_clamp(share, (weft_real)0.02, (weft_real)0.98);
        weft_vec3 place = weft_add(weft_scale(a, 1 - middle), weft_scale(b, middle));
        weft_real value = weft_yarn_field_value(p->grid, weft_place_in_tile(stitch, place));
        if ((value < 0) == a_inside) {
            low = middle;
            value_a = value;
            value_b /= 2;
        } else {
            high = middle;
            value_b = value;
            value_a /= 2;
        }
    }
    return weft_clamp(middle, (weft_real)NODE_DISTANCE, 1 - (weft_real)NODE_DISTANCE);
}

static weft_code add_vertex(polygoniser *p, weft_vec3 place, int32_t original, int32_t *slot, weft_error *error)
{
    weft_tile_mesh *mesh = p->mesh;
    WEFT_TRY(grow_vertices(p, error));
    *slot = mesh->vertex_count++;
    float *position = mesh->position[*slot];
    position[0] = (float)place.x;
    position[1] = (float)place.y;
    position[2] = (float)place.z;
    mesh->original[*slot] = original < 0 ? *slot : original;
    return WEFT_OK;
}

static weft_code add_original(polygoniser *p, int x, int y, int z, int axis, int32_t *slot, weft_error *error)
{
    int to_x = x + (axis == 0), to_y = y + (axis == 1), to_z = z + (axis == 2);
    weft_vec3 a = node_place(p, x, y, z), b = node_place(p, to_x, to_y, to_z);
    weft_real t = crossing(p, a, b, node_value(p, x, y, z), node_value(p, to_x, to_y, to_z));
    return add_vertex(p, weft_add(weft_scale(a, 1 - t), weft_scale(b, t)), -1, slot, error);
}

/* The vertex on an edge. On the far borders it is that of the near border again, one tile on. */
static weft_code vertex_on_edge(polygoniser *p, int x, int y, int z, int axis, int32_t *vertex, weft_error *error)
{
    int32_t *slot = vertex_slot(p, x, y, z, axis);
    int near_x = x % p->cells[0], near_y = y % p->cells[1];
    if (*slot < 0 && near_x == x && near_y == y)
        WEFT_TRY(add_original(p, x, y, z, axis, slot, error));
    if (*slot < 0) {
        int32_t original;
        WEFT_TRY(vertex_on_edge(p, near_x, near_y, z, axis, &original, error));
        const float *at = p->mesh->position[original];
        float far_x = near_x == x ? at[0] : at[0] + p->mesh->width,
              far_y = near_y == y ? at[1] : at[1] + p->mesh->height;
        WEFT_TRY(add_vertex(p, weft_vec3_of(far_x, far_y, at[2]), original, slot, error));
    }
    *vertex = *slot;
    return WEFT_OK;
}

static weft_code add_triangle(polygoniser *p, const int cell[3], const int edges[3], weft_error *error)
{
    weft_tile_mesh *mesh = p->mesh;
    if (mesh->triangle_count >= p->triangle_capacity) {
        p->triangle_capacity = p->triangle_capacity ? 2 * p->triangle_capacity : 4096;
        WEFT_TRY(grow_array((void **)&mesh->triangle, sizeof *mesh->triangle, p->triangle_capacity, error));
    }
    for (int i = 0; i < 3; i++) {
        int corner = weft_cube_edge_corner(edges[i]);
        int32_t vertex;
        WEFT_TRY(vertex_on_edge(p, cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2),
                                edges[i] / 4, &vertex, error));
        mesh->triangle[mesh->triangle_count][i] = (uint32_t)vertex;
    }
    mesh->triangle_count++;
    return WEFT_OK;
}

static int corners_inside(const polygoniser *p, int x, int y, int z)
{
    int inside = 0;
    for (int c = 0; c < WEFT_CUBE_CORNERS; c++)
        inside |= (node_value(p, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)) < 0) << c;
    return inside;
}

static weft_code add_triangles(polygoniser *p, weft_error *error)
{
    weft_cube_case cases[WEFT_CUBE_CASES];
    weft_cube_cases_build(cases);
    for (int z = 0; z < p->cells[2]; z++) {
        for (int y = 0; y < p->cells[1]; y++) {
            for (int x = 0; x < p->cells[0]; x++) {
                const weft_cube_case *found = &cases[corners_inside(p, x, y, z)];
                for (int i = 0; i < found->triangle_count; i++)
                    WEFT_TRY(add_triangle(p, (const int[3]){x, y, z}, found->edge[i], error));
            }
        }
    }
    return WEFT_OK;
}

static void store(float to[3], weft_vec3 from)
{
    to[0] = (float)from.x;
    to[1] = (float)from.y;
    to[2] = (float)from.z;
}

/* Normal, fibre and yarn of a vertex that is its own original. */
static void describe_vertex(const polygoniser *p, int vertex)
{
    weft_tile_mesh *mesh = p->mesh;
    const float *at = mesh->position[vertex];
    weft_vec3 place = weft_vec3_of(at[0], at[1], at[2]), tangent = weft_vec3_of(1, 0, 0);
    weft_vec3 normal = weft_yarn_field_normal(p->grid, place, p->cell.x / 20);
    int yarn = weft_yarn_field_fibre(p->grid, weft_place_in_tile(p->grid->skeleton->stitch, place), &tangent);
    tangent = weft_unit(weft_subtract(tangent, weft_scale(normal, weft_dot(normal, tangent))));
    store(mesh->normal[vertex], normal);
    store(mesh->tangent[vertex], tangent);
    mesh->yarn[vertex] = yarn < 0 ? 0 : yarn;
}

static weft_code describe_vertices(polygoniser *p, weft_error *error)
{
    weft_tile_mesh *mesh = p->mesh;
    size_t count = (size_t)mesh->vertex_count;
    mesh->normal = malloc(count * sizeof *mesh->normal);
    mesh->tangent = malloc(count * sizeof *mesh->tangent);
    mesh->yarn = malloc(count * sizeof *mesh->yarn);
    if (!mesh->normal || !mesh->tangent || !mesh->yarn)
        return weft_fail_memory(error, "triangle mesh", count * sizeof *mesh->normal);
#pragma omp parallel for schedule(static, 256)
    for (int i = 0; i < mesh->vertex_count; i++)
        if (mesh->original[i] == i)
            describe_vertex(p, i);
    for (int i = 0; i < mesh->vertex_count; i++) {
        int original = mesh->original[i];
        if (original == i)
            continue;
        memcpy(mesh->normal[i], mesh->normal[original], sizeof *mesh->normal);
        memcpy(mesh->tangent[i], mesh->tangent[original], sizeof *mesh->tangent);
        mesh->yarn[i] = mesh->yarn[original];
    }
    return WEFT_OK;
}

static weft_code size_grid(polygoniser *p, int resolution, const char *path, weft_error *error)
{
    const weft_stitch *stitch = p->grid->skeleton->stitch;
    weft_real edge = stitch->width / resolution, depth = p->grid->top - p->grid->bottom;
    p->cells[0] = resolution;
    p->cells[1] = (int)fmax(fmin(round(stitch->height / edge), MAX_NODES), 3);
    p->cells[2] = (int)fmin(ceil(depth / edge), MAX_NODES);
    double nodes = (double)p->cells[0] * p->cells[1] * p->cells[2];
    if (nodes > MAX_NODES)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "%s: a resolution of %d means a grid of %d x %d x %d = %.0f cells, at most %d", path,
                         resolution, p->cells[0], p->cells[1], p->cells[2], nodes, MAX_NODES);
    p->cell = weft_vec3_of(edge, stitch->height / p->cells[1], edge);
    p->bottom = (p->grid->bottom + p->grid->top - p->cells[2] * edge) / 2;
    return WEFT_OK;
}

static weft_code allocate_grid(polygoniser *p, weft_error *error)
{
    size_t values = (size_t)p->cells[0] * (size_t)p->cells[1] * (size_t)(p->cells[2] + 1);
    size_t edges = 3 * (size_t)(p->cells[0] + 1) * (size_t)(p->cells[1] + 1) * (size_t)(p->cells[2] + 1);
    p->value = malloc(values * sizeof *p->value);
    p->vertex_of = malloc(edges * sizeof *p->vertex_of);
    if (!p->value || !p->vertex_of)
        return weft_fail_memory(error, "grid", edges * sizeof *p->vertex_of);
    memset(p->vertex_of, 0xff, edges * sizeof *p->vertex_of);
    return WEFT_OK;
}

static void find_extent(weft_tile_mesh *mesh)
{
    mesh->bottom = INFINITY;
    mesh->top = -INFINITY;
    for (int i = 0; i < mesh->vertex_count; i++) {
        mesh->bottom = fminf(mesh->bottom, mesh->position[i][2]);
        mesh->top = fmaxf(mesh->top, mesh->position[i][2]);
    }
}

static weft_code polygonise(const weft_segment_grid *grid, int resolution, const char *path, weft_tile_mesh *mesh,
                            weft_error *error)
{
    polygoniser p = {.grid = grid, .mesh = mesh};
    weft_code code = size_grid(&p, resolution, path, error);
    if (code == WEFT_OK)
        code = allocate_grid(&p, error);
    if (code == WEFT_OK) {
        mesh->cell = (float)p.cell.x;
        evaluate_nodes(&p);
        code = add_triangles(&p, error);
    }
    if (code == WEFT_OK)
        code = describe_vertices(&p, error);
    find_extent(mesh);
    free(p.value);
    free(p.vertex_of);
    return code;
}

weft_code weft_tile_mesh_create(const weft_stitch *stitch, int resolution, const char *path, weft_tile_mesh *mesh,
                                weft_error *error)
{
    weft_yarn_skeleton skeleton;
    weft_segment_grid grid;
    int cells = resolution > 0 ? resolution : stitch->resolution;
    weft_real margin = stitch->blend + (weft_real)MARGIN_CELLS * stitch->width / cells;
    *mesh = (weft_tile_mesh){.width = (float)stitch->width, .height = (float)stitch->height};
    WEFT_TRY(weft_yarn_skeleton_create(stitch, path, &skeleton, error));
    weft_code code = weft_segment_grid_create(&skeleton, margin, path, &grid, error);
    if (code == WEFT_OK) {
        code = polygonise(&grid, cells, path, mesh, error);
        weft_segment_grid_free(&grid);
    }
    weft_yarn_skeleton_free(&skeleton);
    if (code != WEFT_OK)
        weft_tile_mesh_free(mesh);
    return code;
}

void weft_tile_mesh_free(weft_tile_mesh *mesh)
{
    free(mesh->position);
    free(mesh->normal);
    free(mesh->tangent);
    free(mesh->yarn);
    free(mesh->original);
    free(mesh->triangle);
    *mesh = (weft_tile_mesh){0};
}
