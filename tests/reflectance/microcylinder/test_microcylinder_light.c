/* Microcylinder cloth under spherical-Gaussian light: the reference vectors of environment light and of table entries.
 * Built twice: in double, and in single precision. */
#include "tests/reflectance/microcylinder/microcylinder_cloths.h"
#include "tests/reflectance/microcylinder/tangent_quadrature.h"
#include "tests/reflectance/vectors.h"
#include "tests/support/suite.h"

#include <string.h>

/* Light that comes from everywhere takes its time: every third row is tested, and every one where the argument "all"
 * asks for it. Single precision, which shares the formulas, is held to every sixth of both. */
enum {
    ENVIRONMENT_ROWS = 204,
    TABLE_ROWS = 204,
    LIGHTS = 2,
    IS_SINGLE = sizeof(weft_real) == sizeof(float),
    TABLE_STEP = IS_SINGLE ? 6 : 1,
    ENVIRONMENT_STEP = IS_SINGLE ? 6 : 3
};

/* Both files say that they are converged to about 1e-5, and hold no condition. */
static const double tolerance = 1e-5 + 20 * (double)WEFT_REAL_EPSILON;

/* Rows that are not: their printed value is farther than 1e-5 from the integral. The values here come from another
 * program, which shares no code with Weft: the formulas literally, nested adaptive Gauss-Kronrod rules over elevation
 * and azimuth to 1e-9 (table) and 1e-7 (light). All of these rows have kinks of M or P within the lobe, or a lobe whose
 * centre is below the horizon. */
typedef struct unconverged_row {
    int row;
    const char *column;
    double converged;
} unconverged_row;

enum { UNCONVERGED_ENTRIES = 10, UNCONVERGED_LIGHTS = 3 };

static const unconverged_row unconverged_entry[UNCONVERGED_ENTRIES] = {
    {18, "T", 0.000250285189},  {32, "T", 0.0224647293},    {69, "T", 0.0582232935},  {81, "T", 7.76702506e-07},
    {85, "T", 0.0100327494},    {103, "T", 0.0278655717},   {151, "T", 0.0319502026}, {154, "T", 0.0283779658},
    {173, "T", 2.66094678e-07}, {188, "T", 9.05423483e-05},
};
static const unconverged_row unconverged_light[UNCONVERGED_LIGHTS] = {
    {101, "Lo_r", 3.77919905e-05},
    {101, "Lo_g", 0.000120070206},
    {101, "Lo_b", 2.34655033e-05},
};
static const double converged_tolerance = 1e-6 + 20 * (double)WEFT_REAL_EPSILON;

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

static double spherical_gaussian(weft_vec3 direction, const gaussian_light *light)
{
    double distance = (double)(weft_length(weft_subtract(direction, light->centre)) / light->width);
    return exp(-distance * distance);
}

static void add_table_entry(void *context, weft_vec3 direction, double solid_angle)
{
    lit_tangent *lit = context;
    double gaussian = spherical_gaussian(direction, &lit->light[0]) * solid_angle;
    if (gaussian < 1e-16)
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
            radiance[c] += lit->light[k].radiance[c] * spherical_gaussian(direction, &lit->light[k]);
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

/* The printed value where it is converged, else the converged one; counts the latter. */
static void check_integral(reference_vectors *v, int row, const char *column, double actual,
                           const unconverged_row *unconverged, int count, int *named)
{
    double expected = vectors_number(v, row, column);
    for (int i = 0; i < count; i++) {
        if (unconverged[i].row != row || strcmp(unconverged[i].column, column) != 0)
            continue;
        double converged = unconverged[i].converged;
        assert_true(fabs(expected - converged) > 1e-5 * converged);
        assert_true(fabs(actual - converged) <= converged_tolerance * converged);
        ++*named;
        return;
    }
    vectors_check_within(v, row, column, actual, tolerance * expected);
}

static double table_entry(const reference_vectors *v, int row, const reference_cloth *cloths)
{
    lit_tangent lit = {.cloth = reference_cloth_named(cloths, vectors_text(v, row, "cloth")),
                       .thread = (int)vectors_number(v, row, "thread") - 1,
                       .view = vectors_direction(v, row, "wo")};
    lit.tangent = &lit.cloth->tangent[lit.thread][(int)vectors_number(v, row, "tangent") - 1];
    lit.light[0].centre = vectors_direction(v, row, "xi");
    lit.light[0].width = (weft_real)vectors_number(v, row, "sigma");
    tangent_quadrature(lit.tangent, lit.view, (double)WEFT_PI, fmin(0.4 * (double)lit.light[0].width, 0.13),
                       add_table_entry, &lit);
    return lit.sum[0] / lit.whole;
}

static void table_entries_match_every_row(void **state)
{
    (void)state;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    reference_vectors v = vectors_open("microcylinder_T.csv", TABLE_ROWS);
    int named = 0;
    for (int row = 0; row < TABLE_ROWS; row += TABLE_STEP)
        check_integral(&v, row, "T", table_entry(&v, row, cloths), unconverged_entry, UNCONVERGED_ENTRIES, &named);
    assert_true(IS_SINGLE || named == UNCONVERGED_ENTRIES);
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
            step = fmin(step, 1.2 * (double)lit->light[k].width);
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

static void environment_light_matches_the_rows(void **state)
{
    (void)state;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    reference_vectors v = vectors_open("microcylinder_env.csv", ENVIRONMENT_ROWS);
    int named = 0;
    const int step = suite_argument ? 1 : ENVIRONMENT_STEP;
    for (int row = step - 1; row < ENVIRONMENT_ROWS; row += step) {
        lit_tangent lit = {.cloth = reference_cloth_named(cloths, vectors_text(&v, row, "cloth")),
                           .view = vectors_direction(&v, row, "wo"),
                           .light = {light_at(&v, row, 0), light_at(&v, row, 1)}};
        add_tangents(&lit);
        const char *const column[] = {"Lo_r", "Lo_g", "Lo_b"};
        for (int c = 0; c < 3; c++)
            check_integral(&v, row, column[c], lit.sum[c], unconverged_light, UNCONVERGED_LIGHTS, &named);
    }
    assert_true(IS_SINGLE || named == UNCONVERGED_LIGHTS);
    vectors_close(&v);
}

int test_microcylinder_light(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_entries_match_every_row),
        cmocka_unit_test(environment_light_matches_the_rows),
    };
    return cmocka_run_group_tests_name("microcylinder light", tests, NULL, NULL);
}
