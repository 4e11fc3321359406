/* Which triangles separate the corners of a cube (Lorensen and Cline 1987), for all 256 cases, by construction.
 *
 * On each face every run of inside corners is cut off by one line, which depends on the signs of that face alone, so
 * that two cubes agree on the face between them. The lines join to loops. A loop is cut into triangles by diagonals
 * none of which lies in a face, so that no two cubes share a diagonal. Both together make every surface closed and
 * manifold, ambiguous faces included: there, the inside corners are kept apart.
 *
 * Corner c lies at x = c & 1, y = c >> 1 & 1, z = c >> 2 & 1. Edge e runs along the axis e / 4 from the corner whose
 * two other coordinates are the bits of e % 4, the lower axis first. Private to this folder. */
#ifndef WEFT_GEOMETRY_YARN_CUBE_CASES_H
#define WEFT_GEOMETRY_YARN_CUBE_CASES_H

enum { WEFT_CUBE_CORNERS = 8, WEFT_CUBE_EDGES = 12, WEFT_CUBE_CASES = 256, WEFT_CUBE_MAX_TRIANGLES = 5 };

typedef struct weft_cube_case {
    int triangle_count;
    int edge[WEFT_CUBE_MAX_TRIANGLES][3]; /* anticlockwise seen from outside */
} weft_cube_case;

/* Bit c of an index into `cases` is set where corner c is inside. Pure. */
void weft_cube_cases_build(weft_cube_case cases[WEFT_CUBE_CASES]);

/* The corner from which an edge runs along its axis. Pure. */
int weft_cube_edge_corner(int edge);

#endif
