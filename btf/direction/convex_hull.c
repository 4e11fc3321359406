#include "btf/direction/convex_hull.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

__extension__ typedef __int128 wide;

/* 38 bits: the determinant of three differences then takes less than 3 x 39 + 3 bits. */
static const double grid_per_unit = 0x1p38;
static const double merge_distance = 1e-5;

typedef struct lattice_point {
    int64_t x, y, z;
} lattice_point;

typedef struct lattice_normal {
    wide x, y, z;
} lattice_normal;

typedef struct horizon_edge {
    int from, to, outside; /* corners, and the face beyond that stays */
} horizon_edge;

typedef struct hull_builder {
    int count;
    lattice_point *point;   /* [count + 1], the origin last */
    weft_hull_face *face;   /* [face_count]; free where corner[0] < 0 */
    lattice_normal *normal; /* outward, of each face */
    bool *visible;          /* of each face, from the point being added */
    int *free_face;         /* stack of the free faces */
    horizon_edge *horizon;
    int *fan; /* [count + 1] new face that starts at a corner of the horizon */
    int face_count, free_count, horizon_count;
} hull_builder;

static lattice_point lattice_point_of(weft_vec3 direction)
{
    double x = direction.x, y = direction.y, z = direction.z;
    double scale = grid_per_unit / sqrt(x * x + y * y + z * z);
    return (lattice_point){llrint(x * scale), llrint(y * scale), llrint(z * scale)};
}

static lattice_point difference(lattice_point a, lattice_point b)
{
    return (lattice_point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static bool coincide(lattice_point a, lattice_point b)
{
    lattice_point d = difference(a, b);
    double limit = merge_distance * grid_per_unit;
    return (double)d.x * d.x + (double)d.y * d.y + (double)d.z * d.z < limit * limit;
}

static lattice_normal normal_of(lattice_point a, lattice_point b, lattice_point c)
{
    lattice_point u = difference(b, a), v = difference(c, a);
    return (lattice_normal){(wide)u.y * v.z - (wide)u.z * v.y, (wide)u.z * v.x - (wide)u.x * v.z,
                            (wide)u.x * v.y - (wide)u.y * v.x};
}

static wide height(lattice_normal normal, lattice_point d)
{
    return normal.x * d.x + normal.y * d.y + normal.z * d.z;
}

static int take_face(hull_builder *hull, int a, int b, int c)
{
    int face = hull->free_count > 0 ? hull->free_face[--hull->free_count] : hull->face_count++;
    hull->face[face] = (weft_hull_face){{a, b, c}, {-1, -1, -1}};
    hull->normal[face] = normal_of(hull->point[a], hull->point[b], hull->point[c]);
    hull->visible[face] = false;
    return face;
}

static void link_face(weft_hull_face *face, int first_corner, int neighbour)
{
    int side = face->corner[0] == first_corner ? 0 : face->corner[1] == first_corner ? 1 : 2;
    face->neighbour[side] = neighbour;
}

static bool mark_visible(hull_builder *hull, lattice_point point)
{
    bool any = false;
    for (int f = 0; f < hull->face_count; f++) {
        int corner = hull->face[f].corner[0];
        hull->visible[f] = corner >= 0 && height(hull->normal[f], difference(point, hull->point[corner])) > 0;
        any |= hull->visible[f];
    }
    return any;
}

static void find_horizon(hull_builder *hull)
{
    hull->horizon_count = 0;
    for (int f = 0; f < hull->face_count; f++) {
        const weft_hull_face *face = &hull->face[f];
        for (int i = 0; hull->visible[f] && i < 3; i++) {
            if (!hull->visible[face->neighbour[i]])
                hull->horizon[hull->horizon_count++] =
                    (horizon_edge){face->corner[i], face->corner[(i + 1) % 3], face->neighbour[i]};
        }
    }
}

static void release_visible(hull_builder *hull)
{
    for (int f = 0; f < hull->face_count; f++) {
        if (!hull->visible[f])
            continue;
        hull->face[f].corner[0] = -1;
        hull->free_face[hull->free_count++] = f;
    }
}

/* Faces in the plane of the new point count as hidden, so that the seen ones stay one connected patch. */
static void add_point(hull_builder *hull, int point)
{
    if (!mark_visible(hull, hull->point[point]))
        return;
    find_horizon(hull);
    release_visible(hull);
    for (int i = 0; i < hull->horizon_count; i++) {
        horizon_edge edge = hull->horizon[i];
        int face = take_face(hull, edge.from, edge.to, point);
        hull->face[face].neighbour[0] = edge.outside;
        link_face(&hull->face[edge.outside], edge.to, face);
        hull->fan[edge.from] = face;
    }
    for (int i = 0; i < hull->horizon_count; i++) {
        int face = hull->fan[hull->horizon[i].from], next = hull->fan[hull->horizon[i].to];
        hull->face[face].neighbour[1] = next;
        hull->face[next].neighbour[2] = face;
    }
}

static void start_tetrahedron(hull_builder *hull, int a, int b, int c)
{
    const int origin = hull->count;
    take_face(hull, a, b, c);
    take_face(hull, a, c, origin);
    take_face(hull, c, b, origin);
    take_face(hull, b, a, origin);
    static const int neighbour[4][3] = {{3, 2, 1}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    for (int f = 0; f < 4; f++) {
        for (int i = 0; i < 3; i++)
            hull->face[f].neighbour[i] = neighbour[f][i];
    }
}

/* Starts from the origin and the first three directions that are linearly independent; false where there are none. */
static bool start(hull_builder *hull)
{
    const lattice_point *point = hull->point, origin = point[hull->count];
    int b = 1;
    lattice_normal normal = {0, 0, 0};
    for (; b < hull->count; b++) {
        normal = normal_of(origin, point[0], point[b]);
        if (normal.x != 0 || normal.y != 0 || normal.z != 0)
            break;
    }
    for (int c = b + 1; c < hull->count; c++) {
        wide volume = height(normal, point[c]);
        if (volume == 0)
            continue;
        if (volume > 0)
            start_tetrahedron(hull, 0, b, c);
        else
            start_tetrahedron(hull, 0, c, b);
        return true;
    }
    return false;
}

static bool repeats_earlier(const hull_builder *hull, int point)
{
    for (int i = 0; i < point; i++) {
        if (coincide(hull->point[i], hull->point[point]))
            return true;
    }
    return false;
}

static void grow(hull_builder *hull)
{
    if (!start(hull))
        return;
    for (int i = 0; i < hull->count; i++) {
        if (!repeats_earlier(hull, i))
            add_point(hull, i);
    }
}

/* Moves the faces in use to the front. */
static int compact(hull_builder *hull)
{
    int *renumbered = hull->free_face, used = 0;
    for (int f = 0; f < hull->face_count; f++)
        renumbered[f] = hull->face[f].corner[0] < 0 ? -1 : used++;
    for (int f = 0; f < hull->face_count; f++) {
        if (renumbered[f] < 0)
            continue;
        for (int i = 0; i < 3; i++)
            hull->face[f].neighbour[i] = renumbered[hull->face[f].neighbour[i]];
        hull->face[renumbered[f]] = hull->face[f];
    }
    return used;
}

static void release(hull_builder *hull)
{
    free(hull->point);
    free(hull->normal);
    free(hull->visible);
    free(hull->free_face);
    free(hull->horizon);
    free(hull->fan);
}

static bool allocate(hull_builder *hull)
{
    /* A closed surface of triangles on n points has 2 n - 4 faces and 3 n - 6 edges. */
    size_t points = (size_t)hull->count + 1, faces = 2 * points;
    hull->point = calloc(points, sizeof *hull->point);
    hull->face = calloc(faces, sizeof *hull->face);
    hull->normal = calloc(faces, sizeof *hull->normal);
    hull->visible = calloc(faces, sizeof *hull->visible);
    hull->free_face = calloc(faces, sizeof *hull->free_face);
    hull->horizon = calloc(faces, sizeof *hull->horizon);
    hull->fan = calloc(points, sizeof *hull->fan);
    return hull->point && hull->face && hull->normal && hull->visible && hull->free_face && hull->horizon && hull->fan;
}

weft_code weft_convex_hull(const weft_vec3 *direction, int count, weft_hull_face **face, int *face_count,
                           weft_error *error)
{
    hull_builder hull = {.count = count};
    if (!allocate(&hull)) {
        free(hull.face);
        release(&hull);
        return weft_fail_memory(error, "convex hull", (unsigned long long)count * sizeof(weft_hull_face));
    }
    for (int i = 0; i < count; i++)
        hull.point[i] = lattice_point_of(direction[i]);
    grow(&hull);
    *face_count = compact(&hull);
    *face = hull.face;
    release(&hull);
    return WEFT_OK;
}
