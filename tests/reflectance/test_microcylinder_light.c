/* Microcylinder cloth under spherical-Gaussian light: the reference vectors of environment light and of table entries.
 * Built twice: in double, and in single precision. */
#include "reflectance/spherical_gaussian.h"
#include "tests/reflectance/microcylinder_cloths.h"
#include "tests/reflectance/tangent_quadrature.h"
#include "tests/reflectance/vectors.h"

enum { ENVIRONMENT_ROWS = 204, TABLE_ROWS = 204, LIGHTS = 2 };

/* The vectors are converged to about 1e-5, relative for the light (one row in 204: 2.5e-5), absolute for table entries
 * (one in twenty, most with lobes round the end of a thread, is no better than that). Plain sums over up to 3e7
 * directions for three such rows (20 and 87 of the table, 103 of the light) agree with the quadrature here instead. */
static const double table_tolerance = 1e-5;
static const double tolerance = 3e-5 + 20 * (double)WEFT_REAL_EPSILON;

typedef struct gaussian_light {
    double radiance[3];
    weft_vec3 centre;
    weft_real width;
} gaussian_light;

/* A tangent of a cloth, seen from `view` and lit. */
typedef struct lit_tangent {
    const weft_prepared_cloth *cloth;
    int thread;
    const weft_thread_tangent *tangent;
    weft_vec3 view;
    gaussian_light light[LIGHTS];
    double whole;  /* integral of the first light */
    double sum[3]; /* per channel; for a table entry only the first */
} lit_tangent;

/* M P / sum of P over all tangents. */
static double visible_share(const lit_tangent *lit, const weft_thread_angles *angles, weft_vec3 light)
{
    double own = 0, all = 0;
    for (int j = 0; j < WEFT_CLOTH_THREADS; j++) {
        const weft_cloth_thread *thread = &lit->cloth->cloth.thread[j];
        double projection = weft_thread_projection(thread->axis, lit->cloth->cloth.sigma, light, lit->view);
        all += projection * thread->sample_count;
        own = j == lit->thread ? projection : own;
    }
    return all > 0 ? weft_thread_shadowing(angles, lit->cloth->cloth.sigma) * own / all : 0;
}

static void add_table_entry(void *context, weft_vec3 direction, double solid_angle)
{
    lit_tangent *lit = context;
    double gaussian = weft_spherical_gaussian(direction, lit->light[0].centre, lit->light[0].width) * solid_angle;
    if (gaussian < 1e-14)
        return;
    weft_thread_angles angles = weft_thread_angles_of(lit->tangent, direction, lit->view);
    lit->whole += gaussian;
    lit->sum[0] += gaussian * visible_share(lit, &angles, direction);
}

static void add_environment(void *context, weft_vec3 direction, double solid_angle)
{
    lit_tangent *lit = context;
    double radiance[3] = {0};
    for (int k = 0; k < LIGHTS; k++)
        for (int c = 0; c < 3; c++)
            radiance[c] += lit->light[k].radiance[c] *
                           (double)weft_spherical_gaussian(direction, lit->light[k].centre, lit->light[k].width);
    if (radiance[0] + radiance[1] + radiance[2] < 1e-12)
        return;
    weft_thread_angles angles = weft_thread_angles_of(lit->tangent, direction, lit->view);
    double share = visible_share(lit, &angles, direction) * angles.cos_theta_light * solid_angle *
                   lit->cloth->cloth.thread[lit->thread].area_share;
    if (!(share > 0))
        return;
    weft_rgb scattering = weft_thread_scattering(&lit->cloth->cloth.thread[lit->thread].optics, &angles);
    lit->sum[0] += share * radiance[0] * scattering.r;
    lit->sum[1] += share * radiance[1] * scattering.g;
    lit->sum[2] += share * radiance[2] * scattering.b;
}

static void table_entries_match_every_row(void **state)
{
    (void)state;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    reference_vectors v = vectors_open("microcylinder_T.csv", TABLE_ROWS);
    int relative = 0;
    for (int row = 0; row < TABLE_ROWS; row++) {
        lit_tangent lit = {.cloth = reference_cloth_named(cloths, vectors_text(&v, row, "cloth")),
                           .thread = (int)vectors_number(&v, row, "thread") - 1,
                           .view = vectors_direction(&v, row, "wo")};
        lit.tangent = &lit.cloth->tangent[lit.thread][(int)vectors_number(&v, row, "tangent") - 1];
        lit.light[0].centre = vectors_direction(&v, row, "xi");
        lit.light[0].width = (weft_real)vectors_number(&v, row, "sigma");
        tangent_quadrature(lit.tangent, lit.view, (double)WEFT_PI, fmin(1.2 * (double)lit.light[0].width, 0.4),
                           add_table_entry, &lit);
        double expected = vectors_number(&v, row, "T"), actual = lit.sum[0] / lit.whole;
        vectors_check_within(&v, row, "T", actual, expected > 0 ? table_tolerance : 0);
        relative += fabs(actual - expected) <= tolerance * expected;
    }
    print_message("%d of %d table entries within %.3g relative\n", relative, TABLE_ROWS, tolerance);
    assert_true(relative >= TABLE_ROWS * 9 / 10);
    vectors_close(&v);
}

static gaussian_light light_at(const reference_vectors *v, int row, int index)
{
    gaussian_light light;
    char column[] = "L1_r", centre[] = "xi1_", width[] = "sigma1";
    column[1] = centre[2] = width[5] = (char)('1' + index);
    for (int c = 0; c < 3; c++) {
        column[3] = "rgb"[c];
        light.radiance[c] = vectors_number(v, row, column);
    }
    light.centre = vectors_direction(v, row, centre);
    light.width = (weft_real)vectors_number(v, row, width);
    return light;
}

/* Narrow enough for the lights and for the lobe of the surface. */
static double step_for(const lit_tangent *lit)
{
    double step = fmin(2.8 * (double)lit->cloth->cloth.thread[lit->thread].optics.gamma_s, 0.4);
    for (int k = 0; k < LIGHTS; k++) {
        const double *radiance = lit->light[k].radiance;
        if (radiance[0] + radiance[1] + radiance[2] > 0)
            step = fmin(step, 1.5 * (double)lit->light[k].width);
    }
    return step;
}

static void add_tangents(lit_tangent *lit)
{
    for (lit->thread = 0; lit->thread < WEFT_CLOTH_THREADS; lit->thread++) {
        double step = step_for(lit);
        for (int i = 0; i < lit->cloth->cloth.thread[lit->thread].sample_count; i++) {
            lit->tangent = &lit->cloth->tangent[lit->thread][i];
            tangent_quadrature(lit->tangent, lit->view, (double)WEFT_PI / 2, step, add_environment, lit);
        }
    }
}

static void environment_light_matches_every_row(void **state)
{
    (void)state;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    reference_vectors v = vectors_open("microcylinder_env.csv", ENVIRONMENT_ROWS);
    for (int row = 0; row < ENVIRONMENT_ROWS; row++) {
        lit_tangent lit = {.cloth = reference_cloth_named(cloths, vectors_text(&v, row, "cloth")),
                           .view = vectors_direction(&v, row, "wo"),
                           .light = {light_at(&v, row, 0), light_at(&v, row, 1)}};
        add_tangents(&lit);
        const char *const column[] = {"Lo_r", "Lo_g", "Lo_b"};
        for (int c = 0; c < 3; c++)
            vectors_check_within(&v, row, column[c], lit.sum[c], tolerance * vectors_number(&v, row, column[c]));
    }
    vectors_close(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_entries_match_every_row),
        cmocka_unit_test(environment_light_matches_every_row),
    };
    return cmocka_run_group_tests_name("microcylinder light", tests, NULL, NULL);
}
