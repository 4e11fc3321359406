/* All 256 cases, alone and against every neighbour. */
#include "geometry/yarn/cube_cases.h"
#include "tests/support/cmocka_all.h"

#include <stdbool.h>
#include <string.h>

static weft_cube_case cases[WEFT_CUBE_CASES];

static int build(void **state)
{
    (void)state;
    weft_cube_cases_build(cases);
    return 0;
}

/* uses[a][b]: triangles of a case with the directed side from edge a to edge b. */
static void count_sides(const weft_cube_case *c, int uses[WEFT_CUBE_EDGES][WEFT_CUBE_EDGES])
{
    memset(uses, 0, sizeof(int) * WEFT_CUBE_EDGES * WEFT_CUBE_EDGES);
    for (int i = 0; i < c->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            uses[c->edge[i][k]][c->edge[i][(k + 1) % 3]]++;
}

/* Bit 2 axis + high of the faces of the cube that hold an edge. */
static unsigned faces_of(int edge)
{
    int corner = weft_cube_edge_corner(edge), axis = edge / 4;
    unsigned faces = 0;
    for (int i = 0; i < 3; i++)
        if (i != axis)
            faces |= 1u << (2 * i + (corner >> i & 1));
    return faces;
}

static void vertices_lie_on_exactly_the_edges_whose_ends_differ(void **state)
{
    (void)state;
    for (int inside = 0; inside < WEFT_CUBE_CASES; inside++) {
        unsigned used = 0, differ = 0;
        for (int i = 0; i < cases[inside].triangle_count; i++)
            for (int k = 0; k < 3; k++)
                used |= 1u << cases[inside].edge[i][k];
        for (int edge = 0; edge < WEFT_CUBE_EDGES; edge++) {
            int a = weft_cube_edge_corner(edge), b = a | 1 << edge / 4;
            differ |= (unsigned)((inside >> a ^ inside >> b) & 1) << edge;
        }
        assert_int_equal(used, differ);
    }
}

/* A side is inside the cube, where two triangles share it in opposite directions, or in a face, where one has it. */
static void sides_are_shared_inside_and_single_in_faces(void **state)
{
    (void)state;
    for (int inside = 0; inside < WEFT_CUBE_CASES; inside++) {
        int uses[WEFT_CUBE_EDGES][WEFT_CUBE_EDGES];
        count_sides(&cases[inside], uses);
        for (int a = 0; a < WEFT_CUBE_EDGES; a++) {
            for (int b = 0; b < WEFT_CUBE_EDGES; b++) {
                if (a == b || uses[a][b] == 0)
                    continue;
                assert_int_equal(uses[a][b], 1);
                assert_int_equal(uses[b][a], faces_of(a) & faces_of(b) ? 0 : 1);
            }
        }
    }
}

/* The edge of the cube beyond the face where axis = high that is this edge of the cube before it. */
static int edge_beyond(int edge, int axis)
{
    int first = edge / 4 == 0 ? 1 : 0;
    return edge ^ (first == axis ? 1 : 2);
}

static void neighbours_agree_on_every_face(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        for (int low = 0; low < WEFT_CUBE_CASES; low++) {
            for (int high = 0; high < WEFT_CUBE_CASES; high++) {
                bool meet = true;
                for (int c = 0; c < WEFT_CUBE_CORNERS; c++)
                    meet &= (c >> axis & 1) || (low >> (c | 1 << axis) & 1) == (high >> c & 1);
                if (!meet)
                    continue;
                int of_low[WEFT_CUBE_EDGES][WEFT_CUBE_EDGES], of_high[WEFT_CUBE_EDGES][WEFT_CUBE_EDGES];
                count_sides(&cases[low], of_low);
                count_sides(&cases[high], of_high);
                unsigned face = 1u << (2 * axis + 1);
                for (int a = 0; a < WEFT_CUBE_EDGES; a++)
                    for (int b = 0; b < WEFT_CUBE_EDGES; b++)
                        if (a != b && (faces_of(a) & faces_of(b) & face))
                            assert_int_equal(of_low[a][b], of_high[edge_beyond(b, axis)][edge_beyond(a, axis)]);
            }
        }
    }
}

/* Twice the area vector of a triangle with its vertices in the middles of the edges, in half cells. */
static void area_of(const int edge[3], int area[3])
{
    int p[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            p[k][i] = edge[k] / 4 == i ? 1 : 2 * (weft_cube_edge_corner(edge[k]) >> i & 1);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, l = (i + 2) % 3;
        area[i] = (p[1][j] - p[0][j]) * (p[2][l] - p[0][l]) - (p[1][l] - p[0][l]) * (p[2][j] - p[0][j]);
    }
}

static void a_single_corner_is_cut_off_facing_outward(void **state)
{
    (void)state;
    for (int c = 0; c < WEFT_CUBE_CORNERS; c++) {
        int area[3], of_rest[3];
        assert_int_equal(cases[1 << c].triangle_count, 1);
        area_of(cases[1 << c].edge[0], area);
        assert_int_equal(cases[255 ^ 1 << c].triangle_count, 1);
        area_of(cases[255 ^ 1 << c].edge[0], of_rest);
        for (int i = 0; i < 3; i++) {
            assert_true((c >> i & 1 ? -area[i] : area[i]) > 0);
            assert_true((c >> i & 1 ? -of_rest[i] : of_rest[i]) < 0);
        }
    }
}

int test_cube_cases(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_lie_on_exactly_the_edges_whose_ends_differ),
        cmocka_unit_test(sides_are_shared_inside_and_single_in_faces),
        cmocka_unit_test(neighbours_agree_on_every_face),
        cmocka_unit_test(a_single_corner_is_cut_off_facing_outward),
    };
    return cmocka_run_group_tests(tests, build, NULL);
}
