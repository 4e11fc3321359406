/* bard.glsl gives what weft_bard_brdf gives, both maps, in both dialects of GLSL, on random and extreme inputs. */
#include "tests/reflectance/bard_fixture.h"
#include "tests/reflectance/twin_stage.h"

extern const char twin_glsl_bard[];

static const char twin_source[] =
    "vec4 twin(sampler2D table, vec4 a, vec4 light, vec4 view)\n"
    "{\n"
    "    BardPoint point = bard_locate(a.x > 0.5, light.xyz, view.xyz);\n"
    "    float f = bard_brdf(a.x > 0.5, a.y, table, light.xyz, view.xyz);\n"
    "    return vec4(f, point.gain, point.direction.z, bard_grid_lookup(table, view.xyz));\n"
    "}\n";

/* Shaders may take subnormal numbers for 0. */
static float as_in_a_shader(weft_real x)
{
    return fabs(x) < (weft_real)1.2e-38 ? 0 : (float)x;
}

static void fill_queries(twin_queries queries)
{
    uint64_t random = 23;
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_vec3 light = bard_extreme_direction(&random, weft_vec3_of(1, 0, 0));
        weft_vec3 view = bard_extreme_direction(&random, light);
        const float band[TWIN_BANDS][4] = {{i % 4 == 0 ? 1 : 0, (float)random_between(&random, 0, 1)},
                                           {as_in_a_shader(light.x), as_in_a_shader(light.y), as_in_a_shader(light.z)},
                                           {as_in_a_shader(view.x), as_in_a_shader(view.y), as_in_a_shader(view.z)}};
        for (int k = 0; k < TWIN_BANDS; k++)
            for (int c = 0; c < 4; c++)
                queries[k][i][c] = band[k][c];
    }
}

static weft_vec3 direction_of(const float v[4])
{
    return weft_vec3_of((weft_real)v[0], (weft_real)v[1], (weft_real)v[2]);
}

static bool close_to(float actual, double expected)
{
    return fabs((double)actual - expected) <= 1e-3 * fabs(expected) + 1e-5;
}

static bool query_agrees(const weft_bard_grid *grid, twin_queries queries, int i, const float result[4])
{
    weft_bard_map map = queries[0][i][0] > 0.5f ? WEFT_BARD_PRINTED : WEFT_BARD_IN_PLANE;
    weft_vec3 light = direction_of(queries[1][i]), view = direction_of(queries[2][i]);
    weft_bard_point point = weft_bard_locate(map, light, view);
    double f = weft_bard_brdf(map, (double)queries[0][i][1], weft_bard_grid_lookup, grid, light, view);
    return close_to(result[0], f) && close_to(result[1], point.gain) && close_to(result[2], point.direction.z) &&
           close_to(result[3], weft_bard_grid_lookup(grid, view));
}

/* The printed map needs the azimuth of a view along the normal, which has none, and jumps behind the projection: there
 * each may have its own answer. */
static void compare_dialect(weft_gl_profile profile)
{
    static twin_queries queries;
    static float result[TWIN_QUERIES][4], rgba[BARD_TABLE_THETAS * BARD_TABLE_PHIS][4];
    bard_table table;
    bard_table_read(&table);
    for (int i = 0; i < BARD_TABLE_THETAS * BARD_TABLE_PHIS; i++)
        rgba[i][0] = (float)table.value[i];
    weft_bard_grid grid = bard_table_grid(&table);
    const char *const sources[] = {twin_glsl_bard, twin_source, NULL};
    fill_queries(queries);
    twin_run(profile, sources, &(twin_table){rgba[0], BARD_TABLE_PHIS, BARD_TABLE_THETAS}, queries, result);
    int different[2] = {0};
    for (int i = 0; i < TWIN_QUERIES; i++)
        different[queries[0][i][0] > 0.5f] += !query_agrees(&grid, queries, i, result[i]);
    print_message("in plane: %d of %d differ, printed: %d of %d\n", different[0], TWIN_QUERIES * 3 / 4, different[1],
                  TWIN_QUERIES / 4);
    assert_int_equal(different[0], 0);
    assert_true(different[1] < TWIN_QUERIES / 200);
}

int test_glsl_bard(void)
{
    return twin_main("GLSL twin of BARD", compare_dialect);
}
