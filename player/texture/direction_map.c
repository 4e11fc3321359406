#include "player/texture/direction_map.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = WEFT_DIRECTION_GRID * WEFT_DIRECTION_GRID };

/* A side of a triangle, its ends in ascending order, to find the triangle on the other side. */
typedef struct side {
    int low, high, simplex, opposite;
} side;

/* One set while it is being laid out. */
typedef struct layout {
    weft_direction_map *map;
    const weft_vec3 *direction;
    const int *label;
    int first;        /* simplex of this set */
    int (*corner)[3]; /* [simplex - first] indices of directions, -1 unused */
} layout;

/* Appends a simplex without neighbours; c < 0 makes an arc, b < 0 too a single direction. */
static int append(layout *l, int a, int b, int c)
{
    int number = l->map->simplex_count++;
    l->map->simplex[number] = (weft_simplex){.next = {-1, -1, -1}};
    memcpy(l->corner[number - l->first], (int[3]){a, b, c}, sizeof *l->corner);
    return number;
}

static bool is_arc(const layout *l, int simplex)
{
    return l->corner[simplex - l->first][2] < 0;
}

static weft_real handedness(const layout *l, const int corner[3])
{
    const weft_vec3 *d = l->direction;
    return weft_dot(weft_cross(d[corner[0]], d[corner[1]]), d[corner[2]]);
}

static int compare_sides(const void *a, const void *b)
{
    const side *s = a, *t = b;
    if (s->low != t->low)
        return s->low < t->low ? -1 : 1;
    return s->high < t->high ? -1 : s->high > t->high;
}

static void append_triangles(layout *l, const weft_triangulation *triangulation, side *sides)
{
    const int(*triangle)[3] = weft_triangulation_triangles(triangulation);
    for (int t = 0; t < weft_triangulation_triangle_count(triangulation); t++) {
        const int *c = triangle[t];
        bool flip = handedness(l, c) < 0;
        int number = append(l, c[0], c[flip ? 2 : 1], c[flip ? 1 : 2]);
        const int *corner = l->corner[number - l->first];
        for (int i = 0; i < 3; i++) {
            int p = corner[(i + 1) % 3], q = corner[(i + 2) % 3];
            *sides++ = (side){p < q ? p : q, p < q ? q : p, number, i};
        }
    }
}

/* The arc behind a side that bounds one triangle only, with the triangle to its left. */
static void append_border(layout *l, const side *s)
{
    const int *corner = l->corner[s->simplex - l->first];
    int arc = append(l, corner[(s->opposite + 1) % 3], corner[(s->opposite + 2) % 3], -1);
    l->map->simplex[arc].next[2] = (float)s->simplex;
    l->map->simplex[s->simplex].next[s->opposite] = (float)arc;
}

static void join_triangles(layout *l, side *sides, int count)
{
    qsort(sides, (size_t)count, sizeof *sides, compare_sides);
    for (int i = 0; i < count; i++) {
        if (i + 1 < count && compare_sides(&sides[i], &sides[i + 1]) == 0) {
            l->map->simplex[sides[i].simplex].next[sides[i].opposite] = (float)sides[i + 1].simplex;
            l->map->simplex[sides[i + 1].simplex].next[sides[i + 1].opposite] = (float)sides[i].simplex;
            i++;
        } else {
            append_border(l, &sides[i]);
        }
    }
}

static weft_vec3 cell_centre(int cell)
{
    weft_real column = (cell % WEFT_DIRECTION_GRID + (weft_real)0.5) * 2 / WEFT_DIRECTION_GRID - 1;
    weft_real row = (cell / WEFT_DIRECTION_GRID + (weft_real)0.5) * 2 / WEFT_DIRECTION_GRID - 1;
    weft_real x = (column + row) / 2, y = (column - row) / 2;
    return weft_unit((weft_vec3){x, y, 1 - fabs(x) - fabs(y)});
}

static bool has_corner(const int corner[3], int index)
{
    return index < 0 || corner[0] == index || corner[1] == index || corner[2] == index;
}

static bool holds(const layout *l, int simplex, const int corner[3])
{
    const int *candidate = l->corner[simplex - l->first];
    return has_corner(candidate, corner[0]) && has_corner(candidate, corner[1]) && has_corner(candidate, corner[2]);
}

/* The smallest simplex that has all the corners of a lookup: a triangle, an arc, or an arc that ends there; -1: none.
 * Arcs come last in a set. */
static int find_simplex(const layout *l, const int corner[3])
{
    int s = l->map->simplex_count - 1;
    while (s >= l->first && !holds(l, s, corner))
        s--;
    return s >= l->first ? s : -1;
}

static void fill_cells(const layout *l, const weft_triangulation *triangulation, int32_t *cell)
{
    for (int i = 0; i < CELLS; i++) {
        int found = find_simplex(l, weft_triangulation_lookup(triangulation, cell_centre(i)).index);
        cell[i] = found < 0 ? l->first : found;
    }
}

/* Directions on one great circle have no triangles; their arcs become known by looking them up. */
static void append_chain(layout *l, const weft_triangulation *triangulation, int capacity)
{
    for (int i = 0; i < CELLS; i++) {
        weft_barycentric at = weft_triangulation_lookup(triangulation, cell_centre(i));
        bool is_new = at.index[1] >= 0 && find_simplex(l, at.index) < 0;
        if (is_new && l->map->simplex_count - l->first < capacity)
            append(l, at.index[0], at.index[1], -1);
    }
    if (l->map->simplex_count == l->first)
        append(l, weft_triangulation_lookup(triangulation, cell_centre(0)).index[0], -1, -1);
}

static void join_arcs(layout *l)
{
    for (int a = l->first; a < l->map->simplex_count; a++) {
        for (int b = l->first; is_arc(l, a) && b < l->map->simplex_count; b++) {
            const int *arc = l->corner[a - l->first], *other = l->corner[b - l->first];
            if (a == b || !is_arc(l, b))
                continue;
            for (int end = 0; end < 2; end++) {
                if (arc[end] >= 0 && (other[0] == arc[end] || other[1] == arc[end]))
                    l->map->simplex[a].next[1 - end] = (float)b; /* there the weight of the other end is negative */
            }
        }
    }
}

static void set_form(weft_simplex *simplex, int slot, weft_vec3 form, int label)
{
    simplex->form[slot][0] = (float)form.x;
    simplex->form[slot][1] = (float)form.y;
    simplex->form[slot][2] = (float)form.z;
    simplex->form[slot][3] = (float)label;
}

static void set_forms(const layout *l, int number)
{
    weft_simplex *simplex = &l->map->simplex[number];
    const int *corner = l->corner[number - l->first];
    weft_vec3 d[3];
    int label[3];
    for (int i = 0; i < 3; i++) {
        int index = corner[i] >= 0 ? corner[i] : corner[0];
        d[i] = weft_unit(l->direction[index]);
        label[i] = l->label ? l->label[index] : index;
    }
    if (!is_arc(l, number)) {
        for (int i = 0; i < 3; i++)
            set_form(simplex, i, weft_cross(d[(i + 1) % 3], d[(i + 2) % 3]), label[i]);
        return;
    }
    weft_vec3 pole = weft_cross(d[0], d[1]);
    bool bounds = simplex->next[2] >= 0;
    set_form(simplex, 0, weft_cross(d[1], pole), label[0]);
    set_form(simplex, 1, weft_cross(pole, d[0]), label[1]);
    set_form(simplex, 2, weft_scale(pole, bounds ? -1 : 0), -1);
}

static weft_code reserve(weft_direction_map *map, int extra, weft_error *error)
{
    int needed = map->simplex_count + extra;
    if (needed > map->simplex_capacity) {
        int capacity = 2 * needed;
        weft_simplex *larger = realloc(map->simplex, (size_t)capacity * sizeof *larger);
        if (!larger)
            return weft_fail_memory(error, "direction map", (size_t)capacity * sizeof *larger);
        map->simplex = larger;
        map->simplex_capacity = capacity;
    }
    void *cell = realloc(map->cell, ((size_t)map->interleave_count + 1) * sizeof *map->cell);
    if (!cell)
        return weft_fail_memory(error, "direction map", ((size_t)map->interleave_count + 1) * sizeof *map->cell);
    map->cell = cell;
    return WEFT_OK;
}

static weft_code lay_out(weft_direction_map *map, const weft_vec3 *direction, const int *label, int count,
                         const weft_triangulation *triangulation, weft_error *error)
{
    int triangles = weft_triangulation_triangle_count(triangulation);
    int capacity = 4 * triangles + count + 1; /* triangles, their sides as arcs, or a chain of arcs */
    WEFT_TRY(reserve(map, capacity, error));
    layout l = {map, direction, label, map->simplex_count, calloc((size_t)capacity, sizeof *l.corner)};
    side *sides = calloc(3 * (size_t)triangles + 1, sizeof *sides);
    weft_code code = WEFT_OK;
    if (!l.corner || !sides) {
        code = weft_fail_memory(error, "direction map", (size_t)capacity * sizeof *l.corner);
    } else {
        append_triangles(&l, triangulation, sides);
        join_triangles(&l, sides, 3 * triangles);
        if (triangles == 0)
            append_chain(&l, triangulation, capacity);
        join_arcs(&l);
        for (int i = l.first; i < map->simplex_count; i++)
            set_forms(&l, i);
        fill_cells(&l, triangulation, map->cell[map->interleave_count]);
        map->interleave_count++;
    }
    free(l.corner);
    free(sides);
    return code;
}

weft_code weft_direction_map_add(weft_direction_map *map, const weft_vec3 *direction, const int *label, int count,
                                 weft_error *error)
{
    weft_triangulation *triangulation = NULL;
    WEFT_TRY(weft_triangulation_build(direction, count, &triangulation, error));
    weft_code code = lay_out(map, direction, label, count, triangulation, error);
    weft_triangulation_free(triangulation);
    return code;
}

void weft_direction_map_free(weft_direction_map *map)
{
    free(map->simplex);
    free(map->cell);
    *map = (weft_direction_map){0};
}

/* ---- On the graphics card ---- */

static int rows_for(int count, int per_row)
{
    return (count + per_row - 1) / per_row;
}

static weft_code upload_simplices(const weft_direction_map *map, GLuint *texture, weft_error *error)
{
    const weft_texture_format format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    int rows = rows_for(map->simplex_count, WEFT_DIRECTION_SIMPLICES_PER_ROW);
    weft_simplex *padded = calloc((size_t)rows * WEFT_DIRECTION_SIMPLICES_PER_ROW, sizeof *padded);
    if (!padded)
        return weft_fail_memory(error, "direction texture", (size_t)rows * WEFT_DIRECTION_SIMPLICES_PER_ROW);
    memcpy(padded, map->simplex, (size_t)map->simplex_count * sizeof *padded);
    weft_code code = weft_gl_texture(format, 4 * WEFT_DIRECTION_SIMPLICES_PER_ROW, rows, 0, padded, texture, error);
    free(padded);
    return code;
}

static weft_code upload_cells(const weft_direction_map *map, GLuint *texture, weft_error *error)
{
    const weft_texture_format format = {GL_R32I, GL_RED_INTEGER, GL_INT};
    int rows = rows_for(map->interleave_count, WEFT_DIRECTION_SETS_PER_ROW);
    WEFT_TRY(weft_gl_texture(format, WEFT_DIRECTION_SETS_PER_ROW * WEFT_DIRECTION_GRID, rows * WEFT_DIRECTION_GRID, 0,
                             NULL, texture, error));
    for (int set = 0; set < map->interleave_count; set++)
        glTexSubImage2D(GL_TEXTURE_2D, 0, set % WEFT_DIRECTION_SETS_PER_ROW * WEFT_DIRECTION_GRID,
                        set / WEFT_DIRECTION_SETS_PER_ROW * WEFT_DIRECTION_GRID, WEFT_DIRECTION_GRID,
                        WEFT_DIRECTION_GRID, GL_RED_INTEGER, GL_INT, map->cell[set]);
    return weft_gl_check("uploading directions", error);
}

weft_code weft_direction_texture_upload(const weft_direction_map *map, weft_direction_texture *texture,
                                        weft_error *error)
{
    *texture = (weft_direction_texture){0};
    WEFT_TRY(upload_simplices(map, &texture->simplex, error));
    return upload_cells(map, &texture->cell, error);
}

void weft_direction_texture_free(weft_direction_texture *texture)
{
    glDeleteTextures(1, &texture->simplex);
    glDeleteTextures(1, &texture->cell);
    *texture = (weft_direction_texture){0};
}

void weft_direction_texture_bind(const weft_direction_texture *texture, GLuint program, int unit)
{
    weft_gl_bind(program, "direction_simplex", unit, GL_TEXTURE_2D, texture->simplex);
    weft_gl_bind(program, "direction_cell", unit + 1, GL_TEXTURE_2D, texture->cell);
}
