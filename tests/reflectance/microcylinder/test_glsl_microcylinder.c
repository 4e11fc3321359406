/* microcylinder.glsl gives what weft_microcylinder_scattering gives, both weightings, in both dialects of GLSL, on
 * random and extreme directions. */
#include "player/gl/shaders.h"
#include "tests/reflectance/microcylinder/microcylinder_cloths.h"
#include "tests/reflectance/random.h"
#include "tests/reflectance/twin_stage.h"
#include "tests/support/cmocka_all.h"

static const char twin_source[] =
    "vec4 twin(sampler2D table, vec4 a, vec4 light, vec4 view)\n"
    "{\n"
    "    ThreadTangent tangent = thread_tangent_of(int(a.y), a.z);\n"
    "    ThreadAngles angles = thread_angles_of(tangent, light.xyz, view.xyz);\n"
    "    if (a.w > 0.5)\n"
    "        return vec4(microcylinder_brdf(table, a.x > 0.5, light.xyz, view.xyz), angles.cos_theta_difference);\n"
    "    return vec4(microcylinder_scattering(table, a.x > 0.5, light.xyz, view.xyz), angles.phi_difference);\n"
    "}\n";

/* Anywhere, grazing, along a thread, or tied to another direction: the same or mirrored. */
static weft_vec3 extreme_direction(uint64_t *random, weft_vec3 other)
{
    weft_vec3 d = random_direction(random);
    switch (random_bits(random) % 8) {
    case 0:
        return weft_unit(weft_vec3_of(d.x, d.y, 1e-4));
    case 1:
        return weft_unit(weft_vec3_of(d.x, d.y * 1e-4, d.z * 1e-4));
    case 2:
        return other;
    case 3:
        return weft_vec3_of(-other.x, -other.y, other.z);
    default:
        return d;
    }
}

static void fill_queries(twin_queries queries)
{
    uint64_t random = 31;
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_vec3 light = extreme_direction(&random, weft_vec3_of(0, 0, 1));
        weft_vec3 view = extreme_direction(&random, light);
        const float band[TWIN_BANDS][4] = {
            {(float)(i & 1), (float)(i >> 1 & 1), (float)random_between(&random, -1.6, 1.6), (float)(i >> 2 & 1)},
            {(float)light.x, (float)light.y, (float)light.z},
            {(float)view.x, (float)view.y, (float)view.z}};
        for (int k = 0; k < TWIN_BANDS; k++)
            for (int c = 0; c < 4; c++)
                queries[k][i][c] = band[k][c];
    }
}

static weft_vec3 direction_of(const float v[4])
{
    return weft_vec3_of((weft_real)v[0], (weft_real)v[1], (weft_real)v[2]);
}

static bool close_to(float actual, double expected, double absolute)
{
    return fabs((double)actual - expected) <= 1e-3 * fabs(expected) + absolute;
}

static bool query_agrees(const weft_prepared_cloth *cloth, twin_queries queries, int i, const float result[4])
{
    const float *choice = queries[0][i];
    weft_cloth_weighting weighting = choice[0] > 0.5f ? WEFT_CLOTH_AS_PRINTED : WEFT_CLOTH_BY_AREA;
    weft_vec3 light = direction_of(queries[1][i]), view = direction_of(queries[2][i]);
    weft_thread_tangent tangent =
        weft_thread_tangent_of(choice[1] > 0.5f ? WEFT_AXIS_Y : WEFT_AXIS_X, (weft_real)choice[2]);
    weft_thread_angles angles = weft_thread_angles_of(&tangent, light, view);
    bool brdf = choice[3] > 0.5f;
    weft_rgb value = brdf ? weft_microcylinder_brdf(cloth, weighting, light, view)
                          : weft_microcylinder_scattering(cloth, weighting, light, view);
    /* A direction nearly along the tangent has no azimuth in single precision. */
    bool has_azimuth = fmin(angles.cos_theta_light, angles.cos_theta_view) > 2e-3;
    double angle = brdf ? angles.cos_theta_difference : angles.phi_difference;
    return close_to(result[0], value.r, 1e-5) && close_to(result[1], value.g, 1e-5) &&
           close_to(result[2], value.b, 1e-5) && (close_to(result[3], angle, 1e-4) || !(brdf || has_azimuth));
}

static void compare_cloth(weft_gl_profile profile, const reference_cloth *cloth, twin_queries queries)
{
    static float result[TWIN_QUERIES][4], rgba[WEFT_MICROCYLINDER_TABLE_WIDTH][4];
    const char *const sources[] = {weft_glsl_microcylinder, twin_source, NULL};
    weft_microcylinder_table(&cloth->prepared, rgba);
    twin_run(profile, sources, &(twin_table){rgba[0], WEFT_MICROCYLINDER_TABLE_WIDTH, 1}, queries, result);
    int different = 0;
    for (int i = 0; i < TWIN_QUERIES; i++)
        different += !query_agrees(&cloth->prepared, queries, i, result[i]);
    print_message("%s: %d of %d differ\n", cloth->name, different, TWIN_QUERIES);
    assert_int_equal(different, 0);
}

static void compare_dialect(weft_gl_profile profile)
{
    static twin_queries queries;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    fill_queries(queries);
    for (int i = 0; i < REFERENCE_CLOTHS; i++)
        compare_cloth(profile, &cloths[i], queries);
}

int test_glsl_microcylinder(void)
{
    return twin_main("GLSL twin of microcylinder cloth", compare_dialect);
}
