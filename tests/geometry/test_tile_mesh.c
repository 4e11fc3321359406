/* Every shipped stitch as a surface: closed, manifold, oriented, periodic, and where its yarns are. */
#include "tests/geometry/shipped_stitches.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <omp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static weft_stitch shipped[SHIPPED_STITCHES];
static weft_tile_mesh shipped_mesh[SHIPPED_STITCHES];

static int open_shipped(void **state)
{
    (void)state;
    for (int i = 0; i < SHIPPED_STITCHES; i++)
        shipped_stitch_open(shipped_stitch[i], 0, &shipped[i], &shipped_mesh[i]);
    return 0;
}

static int close_shipped(void **state)
{
    (void)state;
    for (int i = 0; i < SHIPPED_STITCHES; i++) {
        weft_tile_mesh_free(&shipped_mesh[i]);
        weft_stitch_free(&shipped[i]);
    }
    return 0;
}

typedef struct side {
    int32_t from, to;
} side;

static int compare_sides(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(side));
}

static side *sorted_sides(const weft_tile_mesh *mesh, bool reversed)
{
    side *sides = malloc(3 * (size_t)mesh->triangle_count * sizeof *sides);
    assert_non_null(sides);
    for (int i = 0; i < 3 * mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangle[i / 3];
        int32_t a = mesh->original[t[i % 3]], b = mesh->original[t[(i + 1) % 3]];
        sides[i] = reversed ? (side){b, a} : (side){a, b};
    }
    qsort(sides, 3 * (size_t)mesh->triangle_count, sizeof *sides, compare_sides);
    return sides;
}

/* Each directed side once, and once the other way: closed, manifold along its edges, consistently oriented. */
static void check_closed(const weft_tile_mesh *mesh)
{
    size_t count = 3 * (size_t)mesh->triangle_count;
    side *forward = sorted_sides(mesh, false), *backward = sorted_sides(mesh, true);
    assert_memory_equal(forward, backward, count * sizeof *forward);
    for (size_t i = 1; i < count; i++)
        assert_true(compare_sides(&forward[i - 1], &forward[i]) != 0);
    free(forward);
    free(backward);
}

/* The triangles round a vertex form one fan: going from one to the next over shared sides visits all of them. */
static void check_fans(const weft_tile_mesh *mesh)
{
    size_t vertices = (size_t)mesh->vertex_count;
    int32_t *valence = calloc(vertices, sizeof *valence);
    assert_non_null(valence);
    size_t count = 3 * (size_t)mesh->triangle_count;
    side *spoke = sorted_sides(mesh, false);
    /* next[k]: the vertex after spoke k in its triangle, found through the sorted sides. */
    int32_t *third = malloc(count * sizeof *third);
    assert_non_null(third);
    for (int i = 0; i < 3 * mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangle[i / 3];
        side key = {mesh->original[t[i % 3]], mesh->original[t[(i + 1) % 3]]};
        side *found = bsearch(&key, spoke, count, sizeof *spoke, compare_sides);
        assert_non_null(found);
        third[found - spoke] = mesh->original[t[(i + 2) % 3]];
        valence[key.from]++;
    }
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && spoke[i - 1].from == spoke[i].from)
            continue;
        side at = spoke[i];
        int steps = 0;
        do {
            side *found = bsearch(&at, spoke, count, sizeof *spoke, compare_sides);
            assert_non_null(found);
            at.to = third[found - spoke];
            steps++;
        } while (at.to != spoke[i].to && steps <= valence[at.from]);
        assert_int_equal(steps, valence[at.from]);
    }
    free(valence);
    free(third);
    free(spoke);
}

static void check_borders(const weft_tile_mesh *mesh)
{
    for (int i = 0; i < mesh->vertex_count; i++) {
        int original = mesh->original[i];
        const float *at = mesh->position[i], *from = mesh->position[original];
        assert_int_equal(mesh->original[original], original);
        assert_true(at[0] >= 0 && at[0] <= mesh->width && at[1] >= 0 && at[1] <= mesh->height);
        if (original == i) {
            assert_true(at[0] < mesh->width && at[1] < mesh->height);
            continue;
        }
        assert_true(at[0] == from[0] || (from[0] == 0 && at[0] == mesh->width));
        assert_true(at[1] == from[1] || (from[1] == 0 && at[1] == mesh->height));
        assert_true(at[2] == from[2]);
        assert_memory_equal(mesh->normal[i], mesh->normal[original], sizeof *mesh->normal);
        assert_memory_equal(mesh->tangent[i], mesh->tangent[original], sizeof *mesh->tangent);
        assert_int_equal(mesh->yarn[i], mesh->yarn[original]);
    }
}

/* Vertices on the border x = 0 (axis 0) or y = 0 that are not repeated on the opposite one. */
static int unmatched(const weft_tile_mesh *mesh, int axis)
{
    int count = 0;
    for (int i = 0; i < mesh->vertex_count; i++) {
        float far = axis == 0 ? mesh->width : mesh->height;
        count += mesh->original[i] == i && mesh->position[i][axis] == 0;
        count -= mesh->original[i] != i && mesh->position[i][axis] == far &&
                 mesh->position[i][1 - axis] != (axis == 0 ? mesh->height : mesh->width);
    }
    return count;
}

static void every_shipped_stitch_is_closed_manifold_and_oriented(void **state)
{
    (void)state;
    for (int i = 0; i < SHIPPED_STITCHES; i++) {
        const weft_tile_mesh *mesh = &shipped_mesh[i];
        check_closed(mesh);
        check_fans(mesh);
    }
}

static void opposite_borders_match_vertex_by_vertex(void **state)
{
    (void)state;
    for (int i = 0; i < SHIPPED_STITCHES; i++) {
        const weft_tile_mesh *mesh = &shipped_mesh[i];
        check_borders(mesh);
        assert_int_equal(unmatched(mesh, 0), 0);
        assert_int_equal(unmatched(mesh, 1), 0);
    }
}

static double dot(const double a[3], const float b[3])
{
    return a[0] * (double)b[0] + a[1] * (double)b[1] + a[2] * (double)b[2];
}

static void triangle_area(const weft_tile_mesh *mesh, int triangle, double area[3])
{
    const uint32_t *t = mesh->triangle[triangle];
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = (double)mesh->position[t[1]][i] - (double)mesh->position[t[0]][i];
        v[i] = (double)mesh->position[t[2]][i] - (double)mesh->position[t[0]][i];
    }
    for (int i = 0; i < 3; i++)
        area[i] = (u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]) / 2;
}

/* Creases, where yarns touch, are a small part of the area. */
static void gradients_point_out_of_the_triangles(void **state)
{
    (void)state;
    for (int i = 0; i < SHIPPED_STITCHES; i++) {
        const weft_tile_mesh *mesh = &shipped_mesh[i];
        double all = 0, along = 0;
        for (int k = 0; k < mesh->triangle_count; k++) {
            double area[3];
            triangle_area(mesh, k, area);
            all += 3 * sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
            for (int c = 0; c < 3; c++)
                along += dot(area, mesh->normal[mesh->triangle[k][c]]);
        }
        print_message("%s: %.3f\n", shipped_stitch[i], along / all);
        assert_true(along > 0.9 * all);
    }
}

static void tangents_are_unit_and_perpendicular_to_normals(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_tile_mesh mesh;
    shipped_stitch_open("plain_knit", 0, &stitch, &mesh);
    for (int i = 0; i < mesh.vertex_count; i++) {
        const float *n = mesh.normal[i], *t = mesh.tangent[i];
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f);
        assert_true(fabsf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - 1) < 1e-5f);
        assert_true(fabsf(n[0] * t[0] + n[1] * t[1] + n[2] * t[2]) < 1e-5f);
    }
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

static const char straight_yarn[] = "stitch { tile = {2, 1}, resolution = 80, yarn { radius = {0.3, 0.2}, %s "
                                    "diffuse = {0.5, 0.5, 0.5}, points { {0, 0.5, 0}, {2, 0.5, 0} } } }";

static void straight_mesh(const char *extra, weft_stitch *stitch, weft_tile_mesh *mesh)
{
    char text[512];
    weft_error error = {0};
    *mesh = (weft_tile_mesh){0};
    snprintf(text, sizeof text, straight_yarn, extra);
    if (weft_stitch_parse(text, "straight", stitch, &error) != WEFT_OK ||
        weft_tile_mesh_create(stitch, 0, "straight", mesh, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

static void a_straight_yarn_has_the_volume_of_its_elliptic_cylinder(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_tile_mesh mesh;
    straight_mesh("", &stitch, &mesh);
    double volume = 0;
    for (int i = 0; i < mesh.triangle_count; i++) {
        double area[3];
        triangle_area(&mesh, i, area);
        /* Flux of (0, 0, z): the ends of the tile do not count. */
        volume += area[2] *
                  ((double)mesh.position[mesh.triangle[i][0]][2] + (double)mesh.position[mesh.triangle[i][1]][2] +
                   (double)mesh.position[mesh.triangle[i][2]][2]) /
                  3;
    }
    assert_true(fabs(volume / (3.14159265 * 0.3 * 0.2 * 2) - 1) < 0.01);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

/* On top of a yarn of one ply, fibres with t turns a mm lean by atan(2 pi t radius). */
static void fibre_twist_leans_the_fibres(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_tile_mesh mesh;
    straight_mesh("fibreTwist = 0.5,", &stitch, &mesh);
    int seen = 0;
    for (int i = 0; i < mesh.vertex_count; i++) {
        if (mesh.normal[i][2] < 0.9999f)
            continue;
        /* At the top of the ellipse the helix moves by 2 pi t times the semi-axis along the side: to -y. */
        assert_true(fabs((double)(mesh.tangent[i][1] / mesh.tangent[i][0]) + 2 * 3.14159265 * 0.5 * 0.3) < 0.02);
        seen++;
    }
    assert_true(seen > 20);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

static void plies_are_real_grooves(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_tile_mesh mesh;
    straight_mesh("plies = 2, twist = 0.5,", &stitch, &mesh);
    float least = 1, most = 0;
    for (int i = 0; i < mesh.vertex_count; i++) {
        float q = hypotf((mesh.position[i][1] - 0.5f) / 0.3f, mesh.position[i][2] / 0.2f);
        least = fminf(least, q);
        most = fmaxf(most, q);
    }
    assert_true(least < 0.6f && most > 0.97f && most < 1.02f);
    check_closed(&mesh);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

static void the_mesh_does_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    weft_stitch stitch, again;
    weft_tile_mesh one, many;
    omp_set_num_threads(1);
    shipped_stitch_open("twill", 0, &stitch, &one);
    omp_set_num_threads(3);
    shipped_stitch_open("twill", 0, &again, &many);
    assert_int_equal(one.vertex_count, many.vertex_count);
    assert_memory_equal(one.position, many.position, (size_t)one.vertex_count * sizeof *one.position);
    assert_memory_equal(one.normal, many.normal, (size_t)one.vertex_count * sizeof *one.normal);
    weft_tile_mesh_free(&one);
    weft_tile_mesh_free(&many);
    weft_stitch_free(&stitch);
    weft_stitch_free(&again);
}

int test_tile_mesh(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shipped_stitch_is_closed_manifold_and_oriented),
        cmocka_unit_test(opposite_borders_match_vertex_by_vertex),
        cmocka_unit_test(gradients_point_out_of_the_triangles),
        cmocka_unit_test(tangents_are_unit_and_perpendicular_to_normals),
        cmocka_unit_test(a_straight_yarn_has_the_volume_of_its_elliptic_cylinder),
        cmocka_unit_test(fibre_twist_leans_the_fibres),
        cmocka_unit_test(plies_are_real_grooves),
        cmocka_unit_test(the_mesh_does_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, open_shipped, close_shipped);
}
