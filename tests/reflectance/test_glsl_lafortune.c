/* lafortune.glsl gives what the C function gives, in both dialects of GLSL, beyond the bound of large lobes, too. */
#include "player/gl/shaders.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/reflectance/extremes.h"
#include "tests/reflectance/twin_stage.h"

/* a = (base, exponent); b = (red, green, blue, ceiling). */
static const char twin_source[] = "vec4 twin(sampler2D table, vec4 a, vec4 b, vec4 c)\n"
                                  "{\n"
                                  "    return vec4(under_ceiling(b.rgb, b.a), lobe_power(a.x, a.y));\n"
                                  "}\n";

static void fill_queries(twin_queries queries)
{
    uint64_t random = 7;
    for (int i = 0; i < TWIN_QUERIES; i++) {
        weft_real base = EXTREMES_PICK(&random, -1, 0, 1, 1.5, 40) * random_between(&random, 0.9, 1);
        weft_real exponent = random_bits(&random) % 8 ? extremes_logarithmic(&random, 0, 3.9) : 0;
        queries[0][i][0] = (float)base;
        queries[0][i][1] = (float)exponent;
        for (int c = 0; c < 3; c++)
            queries[1][i][c] = (float)extremes_logarithmic(&random, -6, 30);
        queries[1][i][3] = random_bits(&random) % 4 ? (float)extremes_logarithmic(&random, -7, 5) : 0;
    }
}

/* The logarithm of a power is as exact as that of its base, times the exponent. */
static bool agrees(const float query[4], float seen)
{
    const double largest = 1e30, exact = 3e-6, smallest = 1e-37;
    double base = (double)query[0], exponent = (double)query[1], expected = weft_lobe_power(base, exponent);
    double tolerance = exact * (10 + exponent * (1 + fabs(log(fmax(base, 1e-30)))));
    if (!(isfinite(seen) && (double)seen <= 1.01 * largest))
        return false;
    if (base == 0)
        return (double)seen == expected;
    return expected < smallest ? (double)seen < 2 * smallest : fabs(log((double)seen / expected)) <= tolerance;
}

static bool agrees_under_ceiling(const float query[4], const float seen[3])
{
    weft_rgba expected = weft_under_ceiling(
        (weft_rgba){(weft_real)query[0], (weft_real)query[1], (weft_real)query[2], 1}, (weft_real)query[3]);
    const double value[3] = {expected.r, expected.g, expected.b};
    bool agrees = true;
    for (int c = 0; c < 3; c++) {
        agrees = agrees && fabs((double)seen[c] - value[c]) <= 1e-5 * value[c] + 1e-36;
        agrees = agrees && (query[3] == 0 || seen[c] <= query[3]);
    }
    return agrees;
}

static void compare_dialect(weft_gl_profile profile)
{
    static twin_queries queries;
    static float result[TWIN_QUERIES][4];
    const char *const sources[] = {weft_glsl_lafortune, twin_source, NULL};
    const float unused[4] = {0};
    fill_queries(queries);
    twin_run(profile, sources, &(twin_table){unused, 1, 1}, queries, result);
    for (int i = 0; i < TWIN_QUERIES; i++) {
        if (!agrees(queries[0][i], result[i][3]))
            fail_msg("%.9g to the power of %.9g is %.9g", (double)queries[0][i][0], (double)queries[0][i][1],
                     (double)result[i][3]);
        if (!agrees_under_ceiling(queries[1][i], result[i]))
            fail_msg("%.9g, %.9g, %.9g under %.9g is %.9g, %.9g, %.9g", (double)queries[1][i][0],
                     (double)queries[1][i][1], (double)queries[1][i][2], (double)queries[1][i][3], (double)result[i][0],
                     (double)result[i][1], (double)result[i][2]);
    }
}

int test_glsl_lafortune(void)
{
    return twin_main("GLSL twin of lobes", compare_dialect);
}
