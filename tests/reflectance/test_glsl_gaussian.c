/* spherical_gaussian.glsl gives what the C functions give, in both dialects of GLSL, on random and extreme inputs. */
#include "reflectance/gaussian/spherical_gaussian.h"
#include "tests/reflectance/extremes.h"
#include "tests/reflectance/twin_stage.h"

extern const char twin_glsl_spherical_gaussian[];

/* A mean beyond half a turn is no direction. a = (mean 1, width 1, mean 2, width 2); b, c = directions and, in w, a
 * gain and a distance. */
static const char twin_source[] = "vec4 twin(sampler2D table, vec4 a, vec4 b, vec4 c)\n"
                                  "{\n"
                                  "    CircularLobe lobe = circular_product(a.x, a.y, a.z, a.w);\n"
                                  "    GaussianSplit split = spherical_gaussian_split(b.xyz, c.xyz, a.y);\n"
                                  "    vec2 turned = vec2(cos(lobe.mean), sin(lobe.mean));\n"
                                  "    if (abs(lobe.mean) > 3.14160)\n"
                                  "        turned = vec2(9.0);\n"
                                  "    if (texelFetch(table, ivec2(0), 0).r > 0.5)\n"
                                  "        return vec4(turned, lobe.width, lobe.scale);\n"
                                  "    return vec4(spherical_gaussian(b.xyz, c.xyz, a.y), split.phi_width,\n"
                                  "                circular_gaussian(a.x, a.z, a.y), gaussian_sigmoid(b.w, c.w));\n"
                                  "}\n";

static weft_real width_of(uint64_t *random)
{
    return random_bits(random) & 1 ? EXTREMES_PICK(random, 0, 1e-9, 1e-3, 0.5, 1e4, 1e18)
                                   : extremes_logarithmic(random, -2, 1);
}

static void fill_queries(twin_queries queries)
{
    uint64_t random = 31;
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_vec3 b = random_direction(&random), c = random_bits(&random) & 1 ? random_direction(&random) : b;
        weft_real mean = random_between(&random, -3.1, 3.1);
        weft_real other = random_bits(&random) % 4 ? random_between(&random, -3.1, 3.1) : mean;
        weft_real first = width_of(&random), second = width_of(&random);
        const float band[TWIN_BANDS][4] = {
            {(float)mean, (float)first, (float)other, (float)second},
            {(float)b.x, (float)b.y, (float)b.z, (float)EXTREMES_PICK(&random, 0, 1, 30, 1e30)},
            {(float)c.x, (float)c.y, (float)c.z, (float)random_between(&random, -2, 2)}};
        for (int k = 0; k < TWIN_BANDS; k++)
            for (int j = 0; j < 4; j++)
                queries[k][i][j] = band[k][j];
    }
}

static bool close_to(float actual, double expected)
{
    return fabs((double)actual - expected) <= 2e-3 * fabs(expected) + 1e-4;
}

/* Where 1 / width amplifies the rounding of an angle to the value itself, single precision has no answer. */
static bool is_resolved(double width)
{
    return width > 2e-3 || width < 1e-8;
}

static bool lobe_agrees(const float a[4], const float result[4])
{
    weft_circular_lobe lobe = weft_circular_product((double)a[0], (double)a[1], (double)a[2], (double)a[3]);
    bool wide = lobe.width >= 1e3; /* nearly opposite lobes, or both constant: the mean is rounding */
    bool resolved = is_resolved(fmin((double)a[1], (double)a[3]));
    return (wide || (close_to(result[0], cos(lobe.mean)) && close_to(result[1], sin(lobe.mean)))) &&
           (wide ? result[2] >= 100 : close_to(result[2], lobe.width)) &&
           (!resolved || close_to(result[3], lobe.scale));
}

static bool values_agree(twin_queries queries, int i, const float result[4])
{
    const float *a = queries[0][i], *b = queries[1][i], *c = queries[2][i];
    weft_vec3 direction = weft_vec3_of((double)b[0], (double)b[1], (double)b[2]);
    weft_vec3 centre = weft_vec3_of((double)c[0], (double)c[1], (double)c[2]);
    double width = (double)a[1];
    weft_gaussian_split split = weft_spherical_gaussian_split(direction, centre, width);
    return (!is_resolved(width) || (close_to(result[0], weft_spherical_gaussian(direction, centre, width)) &&
                                    close_to(result[2], weft_circular_gaussian((double)a[0], (double)a[2], width)))) &&
           close_to(result[1], split.phi_width) && close_to(result[3], weft_sigmoid((double)b[3], (double)c[3]));
}

static void compare_dialect(weft_gl_profile profile)
{
    static twin_queries queries;
    static float result[TWIN_QUERIES][4];
    const char *const sources[] = {twin_glsl_spherical_gaussian, twin_source, NULL};
    fill_queries(queries);
    for (int part = 0; part < 2; part++) {
        const float choice[4] = {(float)part};
        twin_run(profile, sources, &(twin_table){choice, 1, 1}, queries, result);
        int different = 0;
        for (int i = 0; i < TWIN_QUERIES; i++)
            different += part ? !lobe_agrees(queries[0][i], result[i]) : !values_agree(queries, i, result[i]);
        print_message("%s: %d of %d differ\n", part ? "product" : "values", different, TWIN_QUERIES);
        assert_int_equal(different, 0);
    }
}

int test_glsl_gaussian(void)
{
    return twin_main("GLSL twin of Gaussians", compare_dialect);
}
