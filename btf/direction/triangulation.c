#include "btf/direction/triangulation.h"

#include "btf/direction/convex_hull.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A triangle of the hull is kept when its plane passes the origin at more than this (README of the reference
 * vectors, 1.3); what is left out closes the hull from below. */
static const double smallest_offset = 1e-9;

/* Directions that were rounded to single precision leave their great circle by less than this. */
static const double great_circle_offset = 1e-6;

enum { MAX_GRID = 64 };

/* q = a A + b B + c C has a = row[0] . q and so on. */
typedef struct triangle_cone {
    weft_vec3 row[3];
} triangle_cone;

/* Border arc from A to B: q projected on its plane is a A + b B. A == B is a single direction. */
typedef struct border_arc {
    int corner[2];
    weft_vec3 end[2], pole;
    weft_vec3 row[2];
} border_arc;

struct weft_triangulation {
    int triangle_count, arc_count;
    int (*triangle)[3];
    triangle_cone *cone; /* of each triangle */
    border_arc *arc;
    int grid;       /* cells along each side of each hemisphere */
    int *first;     /* [2 grid grid + 1] where the candidates of a cell start */
    int *candidate; /* triangles that meet a cell */
};

static weft_real plane_offset(weft_vec3 a, weft_vec3 b, weft_vec3 c)
{
    return weft_dot(weft_unit(weft_cross(weft_subtract(b, a), weft_subtract(c, a))), a);
}

static triangle_cone cone_of(weft_vec3 a, weft_vec3 b, weft_vec3 c)
{
    weft_vec3 bc = weft_cross(b, c);
    weft_real scale = 1 / weft_dot(a, bc);
    return (triangle_cone){
        {weft_scale(bc, scale), weft_scale(weft_cross(c, a), scale), weft_scale(weft_cross(a, b), scale)}};
}

static border_arc arc_of(const weft_vec3 *point, int a, int b)
{
    weft_vec3 normal = weft_cross(point[a], point[b]);
    weft_real sine = weft_length(normal);
    border_arc result = {.corner = {a, b}, .end = {point[a], point[b]}, .pole = weft_unit(normal)};
    if (sine > 0) {
        result.row[0] = weft_scale(weft_cross(point[b], result.pole), 1 / sine);
        result.row[1] = weft_scale(weft_cross(result.pole, point[a]), 1 / sine);
    }
    return result;
}

/* ---- Lookup ---- */

/* The octahedron laid flat: each hemisphere becomes a square of grid x grid cells. */
static int cell_of(const weft_triangulation *t, weft_vec3 d)
{
    weft_real scale = t->grid / (2 * (fabs(d.x) + fabs(d.y) + fabs(d.z)));
    int column = (int)weft_clamp((d.x + d.y) * scale + (weft_real)t->grid / 2, 0, t->grid - 1);
    int row = (int)weft_clamp((d.x - d.y) * scale + (weft_real)t->grid / 2, 0, t->grid - 1);
    return ((d.z < 0) * t->grid + row) * t->grid + column;
}

static weft_barycentric weights_in_triangle(const int corner[3], const weft_real coefficient[3])
{
    weft_barycentric at;
    weft_real sum = 0;
    for (int i = 0; i < 3; i++) {
        at.index[i] = corner[i];
        at.weight[i] = coefficient[i] > 0 ? coefficient[i] : 0;
        sum += at.weight[i];
    }
    for (int i = 0; i < 3; i++)
        at.weight[i] /= sum;
    return at;
}

/* On an edge rounding may leave every triangle with a negative coefficient: the one that comes closest is taken. */
static bool find_triangle(const weft_triangulation *t, weft_vec3 query, weft_barycentric *at)
{
    const weft_real rounding = -16 * (weft_real)WEFT_REAL_EPSILON;
    weft_real best = rounding, best_coefficient[3] = {0};
    int best_triangle = -1, cell = cell_of(t, query);
    for (int i = t->first[cell]; i < t->first[cell + 1]; i++) {
        const triangle_cone *cone = &t->cone[t->candidate[i]];
        weft_real a = weft_dot(cone->row[0], query), b = weft_dot(cone->row[1], query);
        weft_real c = weft_dot(cone->row[2], query);
        weft_real smallest = a < b ? (a < c ? a : c) : (b < c ? b : c);
        if (smallest < best)
            continue;
        best = smallest;
        best_triangle = t->candidate[i];
        best_coefficient[0] = a, best_coefficient[1] = b, best_coefficient[2] = c;
    }
    if (best_triangle < 0)
        return false;
    *at = weights_in_triangle(t->triangle[best_triangle], best_coefficient);
    return true;
}

/* Squared chord: unlike the cosine it still tells small angles apart in single precision. */
static weft_real squared_chord(weft_vec3 a, weft_vec3 b)
{
    weft_vec3 d = weft_subtract(a, b);
    return weft_dot(d, d);
}

static weft_barycentric nearest_on_arc(const border_arc *arc, weft_vec3 query, weft_real *distance)
{
    weft_real a = weft_dot(arc->row[0], query), b = weft_dot(arc->row[1], query);
    if (a >= 0 && b >= 0 && a + b > 0) {
        weft_vec3 foot = weft_add(weft_scale(arc->end[0], a), weft_scale(arc->end[1], b));
        *distance = squared_chord(query, weft_unit(foot));
        return (weft_barycentric){{arc->corner[0], arc->corner[1], -1}, {a / (a + b), b / (a + b), 0}};
    }
    weft_real distance_a = squared_chord(query, arc->end[0]), distance_b = squared_chord(query, arc->end[1]);
    int nearer = distance_b < distance_a;
    *distance = nearer ? distance_b : distance_a;
    return (weft_barycentric){{arc->corner[nearer], -1, -1}, {1, 0, 0}};
}

static bool is_end(const weft_barycentric *at)
{
    return at->index[1] < 0;
}

/* Beside a corner its distance and that of a foot on an arc differ by the square of what lies between them. Within
 * rounding the foot counts, which is never farther than the end of its arc. */
static weft_barycentric find_border(const weft_triangulation *t, weft_vec3 query)
{
    const weft_real rounding = 16 * (weft_real)WEFT_REAL_EPSILON;
    weft_real nearest;
    weft_barycentric at = nearest_on_arc(&t->arc[0], query, &nearest);
    for (int i = 1; i < t->arc_count; i++) {
        weft_real distance;
        weft_barycentric candidate = nearest_on_arc(&t->arc[i], query, &distance);
        if (distance + (is_end(&candidate) - is_end(&at)) * rounding < nearest) {
            nearest = distance;
            at = candidate;
        }
    }
    return at;
}

weft_barycentric weft_triangulation_lookup(const weft_triangulation *t, weft_vec3 query)
{
    weft_barycentric at;
    if (t->triangle_count > 0 && find_triangle(t, query, &at))
        return at;
    return find_border(t, query);
}

/* ---- Building ---- */

static weft_real offset_of_face(const weft_hull_face *face, const weft_vec3 *point, int count)
{
    const int *c = face->corner;
    if (c[0] == count || c[1] == count || c[2] == count)
        return 0;
    return plane_offset(point[c[0]], point[c[1]], point[c[2]]);
}

static bool is_kept(const weft_hull_face *face, const weft_vec3 *point, int count)
{
    return offset_of_face(face, point, count) > smallest_offset;
}

static bool is_great_circle(const weft_hull_face *face, int face_count, const weft_vec3 *point, int count)
{
    for (int f = 0; f < face_count; f++) {
        if (offset_of_face(&face[f], point, count) > great_circle_offset)
            return false;
    }
    return true;
}

static weft_code allocate_triangles(weft_triangulation *t, int count, int face_count, weft_error *error)
{
    size_t faces = (size_t)face_count + 1, arcs = 3 * (size_t)face_count + (size_t)count;
    t->triangle = calloc(faces, sizeof *t->triangle);
    t->cone = calloc(faces, sizeof *t->cone);
    t->arc = calloc(arcs, sizeof *t->arc);
    if (!t->triangle || !t->cone || !t->arc)
        return weft_fail_memory(error, "triangulation", faces * sizeof *t->cone + arcs * sizeof *t->arc);
    return WEFT_OK;
}

static void keep_triangles(weft_triangulation *t, const weft_vec3 *point, int count, const weft_hull_face *face,
                           int face_count)
{
    for (int f = 0; f < face_count; f++) {
        if (!is_kept(&face[f], point, count))
            continue;
        const int *c = face[f].corner;
        memcpy(t->triangle[t->triangle_count], c, sizeof face[f].corner);
        t->cone[t->triangle_count++] = cone_of(point[c[0]], point[c[1]], point[c[2]]);
        for (int i = 0; i < 3; i++) {
            if (!is_kept(&face[face[f].neighbour[i]], point, count))
                t->arc[t->arc_count++] = arc_of(point, c[i], c[(i + 1) % 3]);
        }
    }
}

typedef struct position {
    weft_real angle_rad;
    int index;
} position;

static int compare_positions(const void *a, const void *b)
{
    const position *p = a, *q = b;
    if (p->angle_rad != q->angle_rad)
        return p->angle_rad < q->angle_rad ? -1 : 1;
    return p->index - q->index;
}

/* The axis of the great circle through point[0] and the direction farthest from its line. */
static weft_vec3 circle_axis(const weft_vec3 *point, int count)
{
    weft_vec3 axis = {0, 0, 0};
    for (int i = 1; i < count; i++) {
        weft_vec3 normal = weft_cross(point[0], point[i]);
        if (weft_length(normal) > weft_length(axis))
            axis = normal;
    }
    return weft_unit(axis);
}

/* All directions on one great circle: a chain of arcs in their order along it. */
static weft_code chain_arcs(weft_triangulation *t, const weft_vec3 *point, int count, weft_error *error)
{
    position *order = calloc((size_t)count, sizeof *order);
    if (!order)
        return weft_fail_memory(error, "triangulation", (size_t)count * sizeof *order);
    weft_vec3 axis = circle_axis(point, count), across = weft_cross(axis, point[0]);
    for (int i = 0; i < count; i++)
        order[i] = (position){atan2(weft_dot(across, point[i]), weft_dot(point[0], point[i])), i};
    qsort(order, (size_t)count, sizeof *order, compare_positions);
    const weft_real merge_rad = 1e-5;
    for (int i = 1, last = 0; i < count; i++) {
        if (order[i].angle_rad - order[last].angle_rad < merge_rad)
            continue;
        t->arc[t->arc_count++] = arc_of(point, order[last].index, order[i].index);
        last = i;
    }
    free(order);
    if (t->arc_count == 0)
        t->arc[t->arc_count++] = arc_of(point, 0, 0);
    return WEFT_OK;
}

static weft_vec3 direction_of_square(int half, weft_real column, weft_real row)
{
    weft_real x = (column + row) / 2, y = (column - row) / 2;
    weft_real z = 1 - fabs(x) - fabs(y);
    return weft_unit((weft_vec3){x, y, half ? -z : z});
}

/* Centre of a cell and the sine of the angle to its farthest corner. */
static weft_vec3 cell_cap(const weft_triangulation *t, int half, int row, int column, weft_real *sine)
{
    const weft_real slack = 1e-4, step = (weft_real)2 / t->grid;
    weft_vec3 centre =
        direction_of_square(half, (column + (weft_real)0.5) * step - 1, (row + (weft_real)0.5) * step - 1);
    weft_real chord = 0;
    for (int i = 0; i < 4; i++) {
        weft_vec3 corner = direction_of_square(half, (column + i % 2) * step - 1, (row + i / 2) * step - 1);
        chord = fmax(chord, sqrt(squared_chord(centre, corner)));
    }
    *sine = fmin(chord + slack, 1);
    return centre;
}

/* False only where the whole cap lies beyond one side of the cone. */
static bool cone_meets_cap(const triangle_cone *cone, weft_vec3 centre, weft_real sine)
{
    for (int i = 0; i < 3; i++) {
        if (weft_dot(cone->row[i], centre) < -sine * weft_length(cone->row[i]))
            return false;
    }
    return true;
}

static weft_code reserve_candidates(weft_triangulation *t, size_t used, size_t *capacity, weft_error *error)
{
    if (used + (size_t)t->triangle_count <= *capacity)
        return WEFT_OK;
    *capacity = 2 * (*capacity + (size_t)t->triangle_count);
    int *larger = realloc(t->candidate, *capacity * sizeof *larger);
    if (!larger)
        return weft_fail_memory(error, "triangulation grid", *capacity * sizeof *larger);
    t->candidate = larger;
    return WEFT_OK;
}

static weft_code build_grid(weft_triangulation *t, weft_error *error)
{
    t->grid = 2 * (int)weft_clamp(ceil(sqrt((weft_real)t->triangle_count)), 1, (weft_real)MAX_GRID / 2);
    int side = t->grid, cells = 2 * side * side, used = 0;
    size_t capacity = 0;
    t->first = calloc((size_t)cells + 1, sizeof *t->first);
    if (!t->first)
        return weft_fail_memory(error, "triangulation grid", (size_t)cells * sizeof *t->first);
    for (int cell = 0; cell < cells; cell++) {
        weft_real sine;
        weft_vec3 centre = cell_cap(t, cell / (side * side), cell / side % side, cell % side, &sine);
        WEFT_TRY(reserve_candidates(t, (size_t)used, &capacity, error));
        for (int i = 0; i < t->triangle_count; i++) {
            if (cone_meets_cap(&t->cone[i], centre, sine))
                t->candidate[used++] = i;
        }
        t->first[cell + 1] = used;
    }
    return WEFT_OK;
}

static weft_code check_directions(const weft_vec3 *direction, int count, weft_error *error)
{
    if (count < 1)
        return weft_fail(error, WEFT_BAD_INPUT, "no directions to triangulate (%d)", count);
    for (int i = 0; i < count; i++) {
        weft_real length = weft_length(direction[i]);
        if (!(length > 0) || !isfinite(length))
            return weft_fail(error, WEFT_BAD_INPUT, "direction %d of %d is not a direction: (%g, %g, %g)", i, count,
                             (double)direction[i].x, (double)direction[i].y, (double)direction[i].z);
    }
    return WEFT_OK;
}

static weft_code build(weft_triangulation *t, const weft_vec3 *point, int count, weft_error *error)
{
    weft_hull_face *face;
    int face_count;
    WEFT_TRY(weft_convex_hull(point, count, &face, &face_count, error));
    weft_code code = allocate_triangles(t, count, face_count, error);
    if (code == WEFT_OK && is_great_circle(face, face_count, point, count)) {
        code = chain_arcs(t, point, count, error);
    } else if (code == WEFT_OK) {
        keep_triangles(t, point, count, face, face_count);
        code = build_grid(t, error);
    }
    free(face);
    return code;
}

weft_code weft_triangulation_build(const weft_vec3 *direction, int count, weft_triangulation **result,
                                   weft_error *error)
{
    *result = NULL;
    WEFT_TRY(check_directions(direction, count, error));
    weft_triangulation *t = calloc(1, sizeof *t);
    weft_vec3 *point = calloc((size_t)count, sizeof *point);
    weft_code code = WEFT_OK;
    if (!t || !point) {
        code = weft_fail_memory(error, "triangulation", (size_t)count * sizeof *point);
    } else {
        for (int i = 0; i < count; i++)
            point[i] = weft_unit(direction[i]);
        code = build(t, point, count, error);
    }
    free(point);
    if (code == WEFT_OK)
        *result = t;
    else
        weft_triangulation_free(t);
    return code;
}

void weft_triangulation_free(weft_triangulation *t)
{
    if (!t)
        return;
    free(t->triangle);
    free(t->cone);
    free(t->arc);
    free(t->first);
    free(t->candidate);
    free(t);
}

int weft_triangulation_triangle_count(const weft_triangulation *t)
{
    return t->triangle_count;
}

const int (*weft_triangulation_triangles(const weft_triangulation *t))[3]
{
    return (const int(*)[3])t->triangle;
}
