/* weave.glsl and woven.glsl give what weft_weave_locate and weft_weave_brdf give, noise included, in both dialects of
 * GLSL. */
#include "btf/direction/direction.h"
#include "player/gl/context.h"
#include "player/gl/gl.h"
#include "player/gl/shaders.h"
#include "reflectance/weave/shader_table.h"
#include "tests/reflectance/random.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/keep_modules.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 256, HEIGHT = 128, QUERIES = WIDTH * HEIGHT };

static const uint64_t noise_seed = 0x123456789abcdefull;

/* U, V; light; view; each four floats, in three bands of one texture. */
typedef float query_image[3][QUERIES][4];

static const char fragment_main[] = "uniform sampler2D table;\n"
                                    "uniform sampler2D query;\n"
                                    "uniform int seed_low;\n"
                                    "uniform int seed_high;\n"
                                    "out vec4 colour;\n"
                                    "void main()\n"
                                    "{\n"
                                    "    ivec2 at = ivec2(gl_FragCoord.xy);\n"
                                    "    vec2 place = texelFetch(query, at, 0).xy;\n"
                                    "    vec3 light = texelFetch(query, at + ivec2(0, 128), 0).xyz;\n"
                                    "    vec3 view = texelFetch(query, at + ivec2(0, 256), 0).xyz;\n"
                                    "    uvec2 seed = uvec2(uint(seed_low), uint(seed_high));\n"
                                    "    WeavePoint point = weave_locate(table, place, seed);\n"
                                    "    colour = vec4(weave_brdf(table, point, light, view), point.intensity);\n"
                                    "}\n";

static void expect_ok(weft_code code, const weft_error *error)
{
    if (code != WEFT_OK)
        fail_msg("%s", error->message);
}

static void fill_queries(query_image image)
{
    uint64_t random = 11;
    for (int i = 0; i < QUERIES; i++) {
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        const float band[3][4] = {{(float)random_between(&random, -20, 20), (float)random_between(&random, -20, 20)},
                                  {(float)light.x, (float)light.y, (float)light.z},
                                  {(float)view.x, (float)view.y, (float)view.z}};
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 4; c++)
                image[k][i][c] = band[k][c];
    }
}

static GLuint upload(const float *rgba, int width, int height)
{
    weft_error error = {0};
    GLuint texture;
    expect_ok(
        weft_gl_texture((weft_texture_format){GL_RGBA32F, GL_RGBA, GL_FLOAT}, width, height, 0, rgba, &texture, &error),
        &error);
    return texture;
}

static GLuint upload_weave(const weft_weave *weave)
{
    int width, height;
    weft_weave_table(weave, NULL, &width, &height);
    float *rgba = calloc((size_t)width * (size_t)height, 4 * sizeof *rgba);
    assert_non_null(rgba);
    weft_weave_table(weave, rgba, &width, &height);
    GLuint texture = upload(rgba, width, height);
    free(rgba);
    return texture;
}

static void draw(GLuint program, GLuint table, GLuint query, float (*result)[4])
{
    GLuint target = upload(NULL, WIDTH, HEIGHT), buffer, vertices;
    glGenFramebuffers(1, &buffer);
    glGenVertexArrays(1, &vertices);
    glBindFramebuffer(GL_FRAMEBUFFER, buffer);
    glBindVertexArray(vertices);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glViewport(0, 0, WIDTH, HEIGHT);
    glUseProgram(program);
    weft_gl_bind(program, "table", 0, GL_TEXTURE_2D, table);
    weft_gl_bind(program, "query", 1, GL_TEXTURE_2D, query);
    weft_gl_set_int(program, "seed_low", (int)(uint32_t)noise_seed);
    weft_gl_set_int(program, "seed_high", (int)(uint32_t)(noise_seed >> 32));
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_FLOAT, result);
    weft_error error = {0};
    expect_ok(weft_gl_check("drawing the twins", &error), &error);
    glDeleteFramebuffers(1, &buffer);
    glDeleteVertexArrays(1, &vertices);
    glDeleteTextures(1, &target);
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
static int count_different(const weft_weave *weave, query_image image, float (*result)[4], int *lit)
{
    int different = 0;
    *lit = 0;
    for (int i = 0; i < QUERIES; i++) {
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

static void compare_fabric(const char *name, bool frozen, GLuint program, GLuint query, query_image image,
                           float (*result)[4])
{
    char path[512];
    weft_weave weave;
    weft_error error = {0};
    int lit;
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    expect_ok(weft_weave_read(path, NULL, 0, &weave, NULL, &error), &error);
    if (frozen)
        freeze_radii(&weave);
    GLuint table = upload_weave(&weave);
    draw(program, table, query, result);
    int different = count_different(&weave, image, result, &lit);
    print_message("%s: %d of %d differ, %d lit\n", name, different, QUERIES, lit);
    assert_true(lit > QUERIES / 50);
    assert_true(different < QUERIES / 1000);
    glDeleteTextures(1, &table);
    weft_weave_free(&weave);
}

static void compare_fabrics(weft_gl_profile profile)
{
    static query_image image;
    static float result[QUERIES][4];
    weft_headless *headless;
    weft_error error = {0};
    if (weft_headless_create(profile, &headless, &error) != WEFT_OK) {
        print_message("skipped: %s\n", error.message);
        exit(77);
    }
    keep_modules_loaded();
    const char *const vertex[] = {weft_glsl_fullscreen_vert, NULL};
    const char *const fragment[] = {weft_glsl_woven, weft_glsl_weave, fragment_main, NULL};
    GLuint program;
    expect_ok(weft_gl_program("twins", vertex, fragment, &program, &error), &error);
    fill_queries(image);
    GLuint query = upload(image[0][0], WIDTH, 3 * HEIGHT);
    compare_fabric("cotton_denim", false, program, query, image, result);
    compare_fabric("silk_charmeuse", false, program, query, image, result);
    compare_fabric("silk_charmeuse", true, program, query, image, result);
    compare_fabric("silk_shantung", false, program, query, image, result);
    glDeleteTextures(1, &query);
    glUseProgram(0);
    glDeleteProgram(program);
    weft_headless_free(headless);
}

static void desktop_shader_equals_c(void **state)
{
    (void)state;
    compare_fabrics(WEFT_GL_CORE);
}

static void embedded_shader_equals_c(void **state)
{
    (void)state;
    compare_fabrics(WEFT_GL_ES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(desktop_shader_equals_c),
        cmocka_unit_test(embedded_shader_equals_c),
    };
    return cmocka_run_group_tests_name("GLSL twins", tests, NULL, NULL);
}
