#include "tests/reflectance/twin_stage.h"

#include "player/gl/gl.h"
#include "player/gl/shaders.h"
#include "tests/support/expect_ok.h"
#include "tests/support/keep_modules.h"

#include <stdlib.h>

enum { MAX_SOURCES = 8 };

static const char fragment_main[] = "uniform sampler2D table;\n"
                                    "uniform sampler2D query;\n"
                                    "out vec4 colour;\n"
                                    "void main()\n"
                                    "{\n"
                                    "    ivec2 at = ivec2(gl_FragCoord.xy);\n"
                                    "    colour = twin(table, texelFetch(query, at, 0),\n"
                                    "                  texelFetch(query, at + ivec2(0, 128), 0),\n"
                                    "                  texelFetch(query, at + ivec2(0, 256), 0));\n"
                                    "}\n";

static GLuint upload(const float *rgba, int width, int height)
{
    const weft_texture_format format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    weft_error error = {0};
    GLuint texture;
    expect_ok(weft_gl_texture(format, width, height, 0, rgba, &texture, &error), &error);
    return texture;
}

static GLuint link_program(const char *const *sources)
{
    const char *const vertex[] = {weft_glsl_fullscreen_vert, NULL};
    const char *fragment[MAX_SOURCES + 2] = {0};
    int count = 0;
    while (sources[count] && count < MAX_SOURCES) {
        fragment[count] = sources[count];
        count++;
    }
    fragment[count] = fragment_main;
    weft_error error = {0};
    GLuint program;
    expect_ok(weft_gl_program("twins", vertex, fragment, &program, &error), &error);
    return program;
}

static void draw(GLuint program, GLuint table, GLuint query, float (*result)[4])
{
    GLuint target = upload(NULL, TWIN_WIDTH, TWIN_HEIGHT), buffer, vertices;
    glGenFramebuffers(1, &buffer);
    glGenVertexArrays(1, &vertices);
    glBindFramebuffer(GL_FRAMEBUFFER, buffer);
    glBindVertexArray(vertices);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glViewport(0, 0, TWIN_WIDTH, TWIN_HEIGHT);
    glUseProgram(program);
    weft_gl_bind(program, "table", 0, GL_TEXTURE_2D, table);
    weft_gl_bind(program, "query", 1, GL_TEXTURE_2D, query);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, TWIN_WIDTH, TWIN_HEIGHT, GL_RGBA, GL_FLOAT, result);
    weft_error error = {0};
    expect_ok(weft_gl_check("drawing the twins", &error), &error);
    glUseProgram(0);
    glDeleteFramebuffers(1, &buffer);
    glDeleteVertexArrays(1, &vertices);
    glDeleteTextures(1, &target);
}

void twin_run(weft_gl_profile profile, const char *const *sources, const twin_table *table, twin_queries queries,
              float (*result)[4])
{
    weft_headless *headless;
    weft_error error = {0};
    if (weft_headless_create(profile, &headless, &error) != WEFT_OK) {
        print_message("skipped: %s\n", error.message);
        exit(77);
    }
    keep_modules_loaded();
    GLuint program = link_program(sources);
    GLuint of_table = upload(table->rgba, table->width, table->height);
    GLuint of_query = upload(queries[0][0], TWIN_WIDTH, TWIN_BANDS * TWIN_HEIGHT);
    draw(program, of_table, of_query, result);
    glDeleteTextures(1, &of_query);
    glDeleteTextures(1, &of_table);
    glDeleteProgram(program);
    weft_headless_free(headless);
}

static void (*compare_dialect)(weft_gl_profile profile);

static void desktop_shader_equals_c(void **state)
{
    (void)state;
    compare_dialect(WEFT_GL_CORE);
}

static void embedded_shader_equals_c(void **state)
{
    (void)state;
    compare_dialect(WEFT_GL_ES);
}

int twin_main(const char *name, void (*compare)(weft_gl_profile profile))
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(desktop_shader_equals_c),
        cmocka_unit_test(embedded_shader_equals_c),
    };
    compare_dialect = compare;
    return cmocka_run_group_tests_name(name, tests, NULL, NULL);
}
