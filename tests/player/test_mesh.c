#include "base/atomic_file.h"
#include "base/real.h"
#include "player/mesh/mesh.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const obj_path = "test_mesh.obj";

static double dot(const float a[3], const float b[3])
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

static double distance(const float a[3], const float b[3])
{
    double x = (double)a[0] - (double)b[0], y = (double)a[1] - (double)b[1], z = (double)a[2] - (double)b[2];
    return sqrt(x * x + y * y + z * z);
}

static double triangle_area(const weft_mesh *mesh, int t)
{
    const float *a = mesh->vertex[mesh->index[t][0]].position, *b = mesh->vertex[mesh->index[t][1]].position;
    const float *c = mesh->vertex[mesh->index[t][2]].position;
    double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a), s = (ab + bc + ca) / 2;
    return sqrt(fmax(0, s * (s - ab) * (s - bc) * (s - ca)));
}

static double area(const weft_mesh *mesh)
{
    double sum = 0;
    for (int t = 0; t < mesh->triangle_count; t++)
        sum += triangle_area(mesh, t);
    return sum;
}

static void expect_frames(const weft_mesh *mesh)
{
    for (int i = 0; i < mesh->vertex_count; i++) {
        const weft_vertex *v = &mesh->vertex[i];
        assert_float_equal(dot(v->normal, v->normal), 1, 1e-5);
        assert_float_equal(dot(v->tangent, v->tangent), 1, 1e-5);
        assert_float_equal(dot(v->normal, v->tangent), 0, 1e-5);
        assert_true(v->tangent[3] == 1 || v->tangent[3] == -1);
    }
    for (int t = 0; t < mesh->triangle_count; t++) {
        for (int c = 0; c < 3; c++)
            assert_true(mesh->index[t][c] < (uint32_t)mesh->vertex_count);
    }
}

static weft_mesh built_in(const char *name)
{
    weft_mesh mesh;
    weft_error error = {0};
    assert_int_equal(weft_mesh_open(name, &mesh, &error), WEFT_OK);
    expect_frames(&mesh);
    return mesh;
}

/* ---- Built in ---- */

static void the_plane_is_a_unit_square_that_faces_up(void **state)
{
    (void)state;
    weft_mesh mesh = built_in("plane");
    assert_float_equal(area(&mesh), 1, 1e-6);
    assert_float_equal(mesh.vertex[0].normal[2], 1, 0);
    weft_mesh_free(&mesh);
}

static void the_sphere_has_its_area_and_normals_that_point_out(void **state)
{
    (void)state;
    weft_mesh mesh = built_in("sphere");
    assert_float_equal(area(&mesh), WEFT_PI, 0.01);
    for (int i = 0; i < mesh.vertex_count; i++)
        assert_float_equal(dot(mesh.vertex[i].normal, mesh.vertex[i].position), 0.5, 1e-5);
    weft_mesh_free(&mesh);
}

static void computed_tangents_of_the_sphere_equal_the_exact_ones(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_mesh mesh = built_in("sphere");
    weft_vertex exact = mesh.vertex[20 * 129 + 40];
    assert_int_equal(weft_mesh_compute_normals(&mesh, NULL, &error), WEFT_OK);
    assert_int_equal(weft_mesh_compute_tangents(&mesh, &error), WEFT_OK);
    const weft_vertex *computed = &mesh.vertex[20 * 129 + 40];
    assert_true(dot(exact.normal, computed->normal) > 0.9999);
    assert_true(dot(exact.tangent, computed->tangent) > 0.9999);
    assert_float_equal(computed->tangent[3], 1, 0);
    weft_mesh_free(&mesh);
}

static void the_drape_keeps_the_size_of_the_cloth(void **state)
{
    (void)state;
    weft_mesh mesh = built_in("drape");
    assert_float_equal(area(&mesh), 1, 0.03);
    double worst = 0;
    for (int t = 0; t < mesh.triangle_count; t++) {
        const weft_vertex *a = &mesh.vertex[mesh.index[t][0]], *b = &mesh.vertex[mesh.index[t][1]];
        double du = (double)a->coordinate[0] - (double)b->coordinate[0];
        double dv = (double)a->coordinate[1] - (double)b->coordinate[1];
        worst = fmax(worst, fabs(distance(a->position, b->position) / sqrt(du * du + dv * dv) - 1));
    }
    assert_true(worst < 0.15);
    weft_mesh_free(&mesh);
}

/* As a mesh of their own, which shares its vertices and indices. */
static weft_mesh coarse_part(const weft_mesh *mesh)
{
    weft_mesh part = *mesh;
    part.index += mesh->triangle_count;
    part.triangle_count = mesh->coarse_count;
    part.coarse_count = 0;
    return part;
}

static void coarse_triangles_are_a_quarter_as_many_on_the_same_surface(void **state)
{
    (void)state;
    static const char *const names[] = {"drape", "sphere"};
    for (int i = 0; i < 2; i++) {
        weft_mesh mesh = built_in(names[i]), coarse = coarse_part(&mesh);
        assert_int_equal(4 * mesh.coarse_count, mesh.triangle_count);
        assert_float_equal(area(&coarse) / area(&mesh), 1, 0.005);
        expect_frames(&coarse);
        weft_mesh_free(&mesh);
    }
    weft_mesh plane = built_in("plane");
    assert_int_equal(plane.coarse_count, 0);
    weft_mesh_free(&plane);
}

static void the_drape_lies_on_its_table_and_hangs_over_the_rim(void **state)
{
    (void)state;
    weft_mesh mesh = built_in("drape");
    int on_table = 0, hanging = 0;
    for (int i = 0; i < mesh.vertex_count; i++) {
        const float *p = mesh.vertex[i].position;
        double radial = hypot((double)p[0], (double)p[1]);
        on_table += radial < 0.2 && fabs((double)p[2]) < 0.01 && mesh.vertex[i].normal[2] > 0.99f;
        hanging += p[2] < -0.1f;
        /* The table is 0.06 thick; no part of the cloth is in it. */
        assert_true(radial > 0.2 || p[2] > -0.01f || p[2] < -0.05f);
    }
    assert_true(on_table > mesh.vertex_count / 12);
    assert_true(hanging > mesh.vertex_count / 5);
    weft_mesh_free(&mesh);
}

static void the_drape_is_the_same_every_time(void **state)
{
    (void)state;
    weft_mesh a = built_in("drape"), b = built_in("drape");
    assert_memory_equal(a.vertex, b.vertex, (size_t)a.vertex_count * sizeof *a.vertex);
    weft_mesh_free(&a);
    weft_mesh_free(&b);
}

/* ---- OBJ ---- */

static weft_code read_text(const char *text, size_t size, weft_mesh *mesh, weft_error *error)
{
    assert_int_equal(weft_write_file(obj_path, text, size, error), WEFT_OK);
    weft_code code = weft_mesh_read_obj(obj_path, mesh, error);
    unlink(obj_path);
    return code;
}

static const char quad[] = "# a square facing y, which is up in OBJ\n"
                           "o square\r\n"
                           "v 0 0 0\nv 2 0 0\n  v 2 0 -1\nv 0 0 -1\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                           "usemtl cloth\n"
                           "f 1/1 2/2 3/3 -1/-1 # behind\n";

static void an_obj_polygon_becomes_a_fan_with_computed_frames_and_z_up(void **state)
{
    (void)state;
    weft_mesh mesh;
    weft_error error = {0};
    assert_int_equal(read_text(quad, strlen(quad), &mesh, &error), WEFT_OK);
    expect_frames(&mesh);
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.triangle_count, 2);
    assert_float_equal(area(&mesh), 2, 1e-6);
    assert_float_equal(mesh.vertex[0].normal[2], 1, 1e-6);
    assert_float_equal(mesh.vertex[0].tangent[0], 1, 1e-6);
    weft_mesh_free(&mesh);
}

static void given_normals_are_kept_and_seams_split_vertices(void **state)
{
    (void)state;
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt .5 .5\nvn 0 0 2\n"
                               "f 1/1/1 2/2/1 3/3/1\nf 2/4/1 4/3/1 3/1/1\n";
    weft_mesh mesh;
    weft_error error = {0};
    assert_int_equal(read_text(text, strlen(text), &mesh, &error), WEFT_OK);
    assert_int_equal(mesh.vertex_count, 6);
    assert_float_equal(mesh.vertex[0].normal[1], -1, 1e-6);
    weft_mesh_free(&mesh);
}

static void mirrored_coordinates_turn_the_bitangent(void **state)
{
    (void)state;
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 0 -1\nvt 0 0\nvt -1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    weft_mesh mesh;
    weft_error error = {0};
    assert_int_equal(read_text(text, strlen(text), &mesh, &error), WEFT_OK);
    assert_float_equal(mesh.vertex[0].tangent[0], -1, 1e-6);
    assert_float_equal(mesh.vertex[0].tangent[3], -1, 0);
    weft_mesh_free(&mesh);
}

typedef struct hostile {
    const char *text, *message;
} hostile;

static void a_bad_obj_is_refused_with_its_line(void **state)
{
    (void)state;
    static const hostile cases[] = {
        {"", "faces"},
        {"v 1 2 3\n", "faces"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 2/1\n", ":3: a face refers to v 2"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 0/1\n", ":3: a face refers to v 0"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 -2/1\n", ":3: a face refers to v -2"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 1/9\n", ":3: a face refers to vt 9"},
        {"v 0 0 0\nvt 0 0\nf 1/1/1 1/1/1 1/1/1\n", ":3: a face refers to vn 1"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 99999999999999999999/1\n", ":3: a face refers to v"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1\n", ":3: a face needs"},
        {"v 0 0 0\nvt 0 0\nf\t \n", ":3: a face needs"},
        {"v 0 0 0\nvt 0 0\nf a b c\n", ":3: a face corner"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 1/1x\n", ":3: a face corner"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/1 1/1\f1/1\n", ":3: a face corner"},
        {"v 0 0 0\nf 1 1 1\n", ":2: a face has no texture coordinates"},
        {"v 0 nan 0\nvt 0 0\nf 1/1 1/1 1/1\n", ":1: a number is not finite"},
        {"v 0 1e99 0\nvt 0 0\nf 1/1 1/1 1/1\n", ":1: a number is not finite"},
        {"v 0 0\nvt 0 0\nf 1/1 1/1 1/1\n", ":1: a number is missing"},
        {"v 0 0 zero\nvt 0 0\nf 1/1 1/1 1/1\n", ":1: a number is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        weft_mesh mesh;
        weft_error error = {0};
        assert_int_equal(read_text(cases[i].text, strlen(cases[i].text), &mesh, &error), WEFT_BAD_INPUT);
        if (!strstr(error.message, cases[i].message) || !strstr(error.message, obj_path))
            fail_msg("case %zu says: %s", i, error.message);
        assert_null(mesh.vertex);
    }
}

static void an_obj_cut_anywhere_is_read_or_refused_but_never_crashes(void **state)
{
    (void)state;
    for (size_t size = 0; size < strlen(quad); size++) {
        weft_mesh mesh;
        weft_error error = {0};
        weft_code code = read_text(quad, size, &mesh, &error);
        assert_true(code == WEFT_OK || code == WEFT_BAD_INPUT);
        weft_mesh_free(&mesh);
    }
}

static void a_missing_or_binary_obj_is_bad_input(void **state)
{
    (void)state;
    weft_mesh mesh;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_mesh_open("no-such.obj", &mesh, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no-such.obj"));
    assert_int_equal(read_text("v 0 0 0\n\0f", 10, &mesh, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "zero byte"));
}

int test_mesh(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_plane_is_a_unit_square_that_faces_up),
        cmocka_unit_test(the_sphere_has_its_area_and_normals_that_point_out),
        cmocka_unit_test(computed_tangents_of_the_sphere_equal_the_exact_ones),
        cmocka_unit_test(the_drape_keeps_the_size_of_the_cloth),
        cmocka_unit_test(coarse_triangles_are_a_quarter_as_many_on_the_same_surface),
        cmocka_unit_test(the_drape_lies_on_its_table_and_hangs_over_the_rim),
        cmocka_unit_test(the_drape_is_the_same_every_time),
        cmocka_unit_test(an_obj_polygon_becomes_a_fan_with_computed_frames_and_z_up),
        cmocka_unit_test(given_normals_are_kept_and_seams_split_vertices),
        cmocka_unit_test(mirrored_coordinates_turn_the_bitangent),
        cmocka_unit_test(a_bad_obj_is_refused_with_its_line),
        cmocka_unit_test(an_obj_cut_anywhere_is_read_or_refused_but_never_crashes),
        cmocka_unit_test(a_missing_or_binary_obj_is_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
