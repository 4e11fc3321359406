#include "geometry/yarn/cube_cases.h"

#include <stdbool.h>

enum { CUBE_FACES = 6 };

/* Anticlockwise seen from outside of the cube. */
typedef struct cube_face {
    int corner[4], edge[4]; /* edge i joins the corners i and i + 1 */
} cube_face;

/* The loop through a cube, as edges in order; and where each edge leads to. */
typedef struct cube_loop {
    int count, edge[WEFT_CUBE_EDGES];
} cube_loop;

int weft_cube_edge_corner(int edge)
{
    int axis = edge / 4, first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    return (edge & 1) << first | (edge >> 1 & 1) << second;
}

static int edge_between(int a, int b)
{
    for (int edge = 0; edge < WEFT_CUBE_EDGES; edge++) {
        int from = weft_cube_edge_corner(edge), to = from | 1 << edge / 4;
        if ((a == from && b == to) || (a == to && b == from))
            return edge;
    }
    return -1;
}

static cube_face face_of(int index)
{
    int axis = index / 2, high = index % 2, first = 1 << (axis + 1) % 3, second = 1 << (axis + 2) % 3;
    cube_face face = {{0, high ? first : second, first | second, high ? second : first}, {0}};
    for (int i = 0; i < 4; i++)
        face.corner[i] |= high << axis;
    for (int i = 0; i < 4; i++)
        face.edge[i] = edge_between(face.corner[i], face.corner[(i + 1) % 4]);
    return face;
}

/* One line for each run of inside corners: from the edge where the run begins to the edge where it ends. */
static void add_lines(const cube_face *face, int inside, int next[WEFT_CUBE_EDGES])
{
    for (int i = 0; i < 4; i++) {
        int begin = (i + 3) % 4, end = i;
        if (!(inside >> face->corner[i] & 1) || (inside >> face->corner[begin] & 1))
            continue;
        while (inside >> face->corner[(end + 1) % 4] & 1)
            end = (end + 1) % 4;
        next[face->edge[begin]] = face->edge[end];
    }
}

/* Takes the loop through `start` out of `next`. */
static cube_loop take_loop(int next[WEFT_CUBE_EDGES], int start)
{
    cube_loop loop = {0};
    for (int edge = start; next[edge] >= 0;) {
        int following = next[edge];
        loop.edge[loop.count++] = edge;
        next[edge] = -1;
        edge = following;
    }
    return loop;
}

static bool in_one_face(int a, int b)
{
    for (int i = 0; i < CUBE_FACES; i++) {
        cube_face face = face_of(i);
        int found = 0;
        for (int k = 0; k < 4; k++)
            found += face.edge[k] == a || face.edge[k] == b;
        if (found == 2)
            return true;
    }
    return false;
}

static bool may_join(const cube_loop *loop, int i, int j)
{
    return j - i == 1 || !in_one_face(loop->edge[i], loop->edge[j]);
}

/* Triangles of the part of a loop from i to j, added to `to`; false, and nothing added, where there are none. */
static bool cut(const cube_loop *loop, int i, int j, weft_cube_case *to)
{
    if (j - i < 2)
        return true;
    int before = to->triangle_count;
    for (int k = i + 1; k < j; k++) {
        if (!may_join(loop, i, k) || !may_join(loop, k, j))
            continue;
        if (cut(loop, i, k, to) && cut(loop, k, j, to)) {
            int *triangle = to->edge[to->triangle_count++];
            triangle[0] = loop->edge[i];
            triangle[1] = loop->edge[k];
            triangle[2] = loop->edge[j];
            return true;
        }
        to->triangle_count = before;
    }
    return false;
}

static weft_cube_case build_case(int inside)
{
    weft_cube_case built = {0};
    int next[WEFT_CUBE_EDGES];
    for (int edge = 0; edge < WEFT_CUBE_EDGES; edge++)
        next[edge] = -1;
    for (int i = 0; i < CUBE_FACES; i++) {
        cube_face face = face_of(i);
        add_lines(&face, inside, next);
    }
    for (int edge = 0; edge < WEFT_CUBE_EDGES; edge++) {
        cube_loop loop = take_loop(next, edge);
        cut(&loop, 0, loop.count - 1, &built);
    }
    return built;
}

void weft_cube_cases_build(weft_cube_case cases[WEFT_CUBE_CASES])
{
    for (int inside = 0; inside < WEFT_CUBE_CASES; inside++)
        cases[inside] = build_case(inside);
}
