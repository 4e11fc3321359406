/* weave.glsl and woven.glsl give what weft_weave_locate and weft_weave_brdf give, noise included, and weave_mean.glsl
 * what weft_weave_tabulated_mean gives, in both dialects of GLSL. */
#include "btf/direction/direction.h"
#include "player/gl/shaders.h"
#include "reflectance/weave/shader_table.h"
#include "tests/reflectance/random.h"
#include "tests/reflectance/twin_stage.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <stdlib.h>

static const uint64_t noise_seed = 0x123456789abcdefull;

/* U, V; light; view. The seed is the noise seed above, its lower half first. */
static const char twin_source[] = "vec4 twin(sampler2D table, vec4 place, vec4 light, vec4 view)\n"
                                  "{\n"
                                  "    uvec2 seed = uvec2(0x89abcdefu, 0x01234567u);\n"
                                  "    WeavePoint point = weave_locate(table, place.xy, seed);\n"
                                  "    return vec4(weave_brdf(table, point, light.xyz, view.xyz), point.intensity);\n"
                                  "}\n";

static void fill_queries(twin_queries image)
{
    uint64_t random = 11;
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        const float band[3][4] = {{(float)random_between(&random, -20, 20), (float)random_between(&random, -20, 20)},
                                  {(float)light.x, (float)light.y, (float)light.z},
                                  {(float)view.x, (float)view.y, (float)view.z}};
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 4; c++)
                image[k][i][c] = band[k][c];
    }
}

static weft_vec3 direction_of(const float v[4])
{
    return weft_vec3_of((weft_real)v[0], (weft_real)v[1], (weft_real)v[2]);
}

static bool close_to(double a, double b)
{
    return fabs(a - b) <= 2e-3 * fabs(b) + 1e-5;
}

/* Number of queries that differ; those within rounding of the edge of a band, a noise cell or a pattern cell may. */
static int count_different(const weft_weave *weave, twin_queries image, float (*result)[4], int *lit)
{
    int different = 0;
    *lit = 0;
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_weave_point point =
            weft_weave_locate(weave, (weft_real)image[0][i][0], (weft_real)image[0][i][1], noise_seed);
        weft_vec3 light = direction_of(image[1][i]), view = direction_of(image[2][i]);
        weft_rgb f = weft_weave_brdf(weave, &point, light, view);
        *lit += weft_weave_specular(weave, &point, light, view) > 0;
        different += !(close_to((double)result[i][0], f.r) && close_to((double)result[i][1], f.g) &&
                       close_to((double)result[i][2], f.b) && close_to((double)result[i][3], point.intensity));
    }
    return different;
}

static void freeze_radii(weft_weave *weave)
{
    for (int i = 0; i < weave->yarn_count; i++) {
        weave->yarn[i].segment.frozen_radius = true;
        weave->yarn[i].prepared = weft_segment_prepare(&weave->yarn[i].segment);
    }
}

static void compare_fabric(const char *name, bool frozen, weft_gl_profile profile, twin_queries queries)
{
    static const char *const sources[] = {weft_glsl_woven, weft_glsl_weave, twin_source, NULL};
    static float result[TWIN_QUERIES][4];
    char path[512];
    weft_weave weave;
    weft_error error = {0};
    int lit, width, height;
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    if (weft_weave_read(path, NULL, 0, &weave, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    if (frozen)
        freeze_radii(&weave);
    weft_weave_table(&weave, NULL, &width, &height);
    float *rgba = calloc((size_t)width * (size_t)height, 4 * sizeof *rgba);
    assert_non_null(rgba);
    weft_weave_table(&weave, rgba, &width, &height);
    twin_run(profile, sources, &(twin_table){rgba, width, height}, queries, result);
    int different = count_different(&weave, queries, result, &lit);
    print_message("%s: %d of %d differ, %d lit\n", name, different, TWIN_QUERIES, lit);
    assert_true(lit > TWIN_QUERIES / 50);
    assert_true(different < TWIN_QUERIES / 1000);
    free(rgba);
    weft_weave_free(&weave);
}

/* ---- The mean of the tile ---- */

static const char mean_source[] =
    "vec4 twin(sampler2D means, vec4 place, vec4 light, vec4 view)\n"
    "{\n"
    "    vec3 sum = vec3(0.0);\n"
    "    for (int k = 0; k < textureSize(means, 0).y; k++)\n"
    "        sum += weave_mean_of_kind(means, weave_kind(means, k), light.xyz, view.xyz);\n"
    "    bool lit = light.z > 0.0 && view.z > 0.0;\n"
    "    return vec4(lit ? sum + weave_mean_diffuse(means) : vec3(0.0), 1.0);\n"
    "}\n";

static void compare_means(const char *name, bool noisy, weft_gl_profile profile, twin_queries queries)
{
    const char *const sources[] = {noisy ? "#define NOISE true\n" : "#define NOISE false\n",
                                   "#define STAPLES true\n#define FILAMENTS true\n",
                                   weft_glsl_woven,
                                   weft_glsl_weave,
                                   weft_glsl_weave_mean,
                                   mean_source,
                                   NULL};
    static float result[TWIN_QUERIES][4];
    char path[512];
    weft_weave weave;
    weft_weave_means means;
    weft_error error = {0};
    int different = 0;
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    if (weft_weave_read(path, NULL, 0, &weave, NULL, &error) != WEFT_OK ||
        weft_weave_means_of(&weave, noisy, &means, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    twin_run(profile, sources, &(twin_table){means.texel[0], WEFT_WEAVE_MEAN_WIDTH, means.kinds}, queries, result);
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_rgb f = weft_weave_tabulated_mean(&means, direction_of(queries[1][i]), direction_of(queries[2][i]));
        different += !(close_to((double)result[i][0], f.r) && close_to((double)result[i][2], f.b));
    }
    print_message("mean of %s: %d of %d differ\n", name, different, TWIN_QUERIES);
    assert_true(different < TWIN_QUERIES / 500);
    weft_weave_means_free(&means);
    weft_weave_free(&weave);
}

static void compare_fabrics(weft_gl_profile profile)
{
    static twin_queries queries;
    fill_queries(queries);
    compare_fabric("cotton_denim", false, profile, queries);
    compare_fabric("silk_charmeuse", false, profile, queries);
    compare_fabric("silk_charmeuse", true, profile, queries);
    compare_fabric("silk_shantung", false, profile, queries);
    compare_means("cotton_denim", false, profile, queries);
    compare_means("cotton_twill", true, profile, queries);
    compare_means("silk_charmeuse", false, profile, queries);
    compare_means("silk_shantung", true, profile, queries);
}

int test_glsl_twins(void)
{
    return twin_main("GLSL twins", compare_fabrics);
}
