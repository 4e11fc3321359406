#include "bench/numerics/glsl.h"

#include "player/gl/context.h"
#include "player/gl/gl.h"
#include "player/gl/shaders.h"
#include "reflectance/woven/woven.h"
#include "tests/support/keep_modules.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A picture of SIDE x SIDE queries; the numbers of a query lie in BANDS pictures of four, one above the other. */
enum { SIDE = 128, QUERIES = SIDE * SIDE, BANDS = 8, NUMBERS = 4 * BANDS };

static const char unpack[] = "uniform sampler2D query;\n"
                             "out vec4 colour;\n"
                             "void main()\n"
                             "{\n"
                             "    float q[32];\n"
                             "    for (int k = 0; k < 8; k++) {\n"
                             "        vec4 v = texelFetch(query, ivec2(gl_FragCoord.xy) + ivec2(0, 128 * k), 0);\n"
                             "        q[4 * k] = v.x; q[4 * k + 1] = v.y; q[4 * k + 2] = v.z; q[4 * k + 3] = v.w;\n"
                             "    }\n";

#define VECTOR(i, j, k) "vec3(q[" #i "], q[" #j "], q[" #k "])"
#define THREAD                                                                                                         \
    "    ThreadTangent tangent = thread_tangent_of(int(q[0]), q[1] * 0.01745329252);\n"                                \
    "    ThreadOptics optics = ThreadOptics(q[2], q[3], q[4], q[5], vec3(q[6]));\n"                                    \
    "    ThreadAngles angles = thread_angles_of(tangent, " VECTOR(8, 9, 10) ", " VECTOR(11, 12, 13) ");\n"
#define TEXTURE                                                                                                        \
    "    Segment segment = Segment(q[0], q[1], q[2], q[19], q[17], q[18], q[4], q[5], q[6], q[7], q[8], q[20]);\n"     \
    "    float f = prepared_texture(segment, q[4], vec2(q[9], q[10]), " VECTOR(11, 12, 13) ", " VECTOR(14, 15,         \
                                                                                                       16) ");\n"
#define RETURN(value) "    colour = vec4(" value ");\n}\n"

typedef struct twin {
    const char *model; /* source of the functions; NULL: there is no twin */
    const char *value; /* the rest of main(), which sets `colour` */
} twin;

static const twin twins[NUMERICS_MODELS] = {
    [NUMERICS_LOBE_POWER] = {weft_glsl_lafortune, RETURN("lobe_power(q[0], q[1])")},
    [NUMERICS_FRESNEL_REFLECTANCE] = {weft_glsl_microcylinder, RETURN("fresnel_reflectance(q[0], q[1])")},
    [NUMERICS_FRESNEL_TRANSMITTANCE] = {weft_glsl_microcylinder, RETURN("fresnel_transmittance(q[0], q[1])")},
    [NUMERICS_THREAD_SCATTERING] = {weft_glsl_microcylinder, THREAD RETURN("thread_scattering(optics, angles).r")},
    [NUMERICS_THREAD_SHADOWING] = {weft_glsl_microcylinder, THREAD RETURN("thread_shadowing(angles, q[7])")},
    [NUMERICS_THREAD_PROJECTION] = {weft_glsl_microcylinder, RETURN("thread_projection(int(q[0]), q[7], " VECTOR(
                                                                 8, 9, 10) ", " VECTOR(11, 12, 13) ")")},
    [NUMERICS_STAPLE_TEXTURE] = {weft_glsl_woven, TEXTURE RETURN("q[21] > 0.5 ? f : 0.0")},
    [NUMERICS_FILAMENT_TEXTURE] = {weft_glsl_woven, TEXTURE RETURN("q[21] > 0.5 ? f : 0.0")}};

/* A shader computes in single precision, and may take numbers below the least normal one for 0. */
static const numerics_set shader_set = {.name = "GLSL", .roundoff = (double)(FLT_EPSILON / 2), .single = true};

static weft_headless *headless;

weft_code numerics_glsl_open(weft_error *error)
{
    WEFT_TRY(weft_headless_create(WEFT_GL_CORE, &headless, error));
    keep_modules_loaded();
    return WEFT_OK;
}

void numerics_glsl_close(void)
{
    weft_headless_free(headless);
}

const char *numerics_glsl_renderer(void)
{
    return weft_gl_renderer();
}

bool numerics_glsl_has(numerics_id id)
{
    return twins[id].model;
}

/* ---- One picture ---- */

/* Where the picture of a program is drawn, and what it reads. */
typedef struct stage {
    GLuint program, target, buffer, vertices;
} stage;

static weft_code stage_create(numerics_id id, stage *s, weft_error *error)
{
    const weft_texture_format format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    const char *const vertex[] = {weft_glsl_fullscreen_vert, NULL};
    const char *const fragment[] = {twins[id].model, unpack, twins[id].value, NULL};
    WEFT_TRY(weft_gl_program("numerics", vertex, fragment, &s->program, error));
    WEFT_TRY(weft_gl_texture(format, SIDE, SIDE, 0, NULL, &s->target, error));
    glGenFramebuffers(1, &s->buffer);
    glGenVertexArrays(1, &s->vertices);
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glBindVertexArray(s->vertices);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, s->target, 0);
    glViewport(0, 0, SIDE, SIDE);
    return weft_gl_check("preparing twins", error);
}

static void stage_free(stage *s)
{
    glUseProgram(0);
    glDeleteFramebuffers(1, &s->buffer);
    glDeleteVertexArrays(1, &s->vertices);
    glDeleteTextures(1, &s->target);
    glDeleteProgram(s->program);
}

static weft_code draw(const stage *s, float (*query)[QUERIES][4], float (*result)[4], weft_error *error)
{
    const weft_texture_format format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    GLuint numbers;
    WEFT_TRY(weft_gl_texture(format, SIDE, BANDS * SIDE, 0, query, &numbers, error));
    glUseProgram(s->program);
    weft_gl_bind(s->program, "query", 0, GL_TEXTURE_2D, numbers);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_FLOAT, result);
    glDeleteTextures(1, &numbers);
    return weft_gl_check("drawing twins", error);
}

/* ---- Search ---- */

enum { GENERATIONS = 6, PARENTS = 32 };

typedef struct individual {
    double coordinate[NUMERICS_MAX_COORDINATES], argument[NUMERICS_MAX_ARGUMENTS];
    numerics_error error;
} individual;

/* What the processor prepares of a segment for its shader, behind the arguments. */
static void append_prepared(double *number)
{
    weft_segment segment = {number[0], number[1], number[2], number[3], number[4],
                            number[5], number[6], number[7], number[8], false};
    weft_prepared_segment prepared = weft_segment_prepare(&segment);
    number[17] = prepared.cot_psi;
    number[18] = prepared.inverse_sin_psi;
    number[19] = prepared.phase_scale;
    number[20] = 1;
    number[21] = prepared.admissible;
}

static void fill_query(numerics_id id, const individual *one, int index, float (*query)[QUERIES][4])
{
    double number[NUMBERS] = {0};
    memcpy(number, one->argument, sizeof one->argument);
    if (id == NUMERICS_STAPLE_TEXTURE || id == NUMERICS_FILAMENT_TEXTURE)
        append_prepared(number);
    for (int i = 0; i < NUMBERS; i++)
        query[i / 4][index][i % 4] = (float)number[i];
}

/* splitmix64, in [0, 1). */
static double uniform(uint64_t *state)
{
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}

/* The first generation is random. Later ones vary the worst of the one before in some of their coordinates, ever less.
 */
static void breed(individual *all, int count, int generation, const individual *parents, int coordinates,
                  uint64_t *random)
{
    for (int i = 0; i < count; i++) {
        const individual *parent = &parents[i % PARENTS];
        double step = 0.1 * pow(10, -4 * uniform(random) - generation / 2.0);
        for (int k = 0; k < coordinates; k++) {
            double moved = parent->coordinate[k] + step * tan(3.1 * (uniform(random) - 0.5));
            bool moves = uniform(random) < 2.5 / coordinates;
            all[i].coordinate[k] = generation == 0 ? uniform(random)
                                   : moves         ? fmin(fmax(moved, 0), 1 - 0x1p-53)
                                                   : parent->coordinate[k];
        }
    }
}

static void measure(numerics_id id, individual *all, int count, float (*result)[4])
{
    int numbers = numerics_number_count(numerics_domain_of(id));
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < count; i++) {
        numerics_value value = {(double)result[i][0], 0, 0};
        all[i].error = numerics_error_of_value(&shader_set, id, all[i].argument, numbers, value, false);
    }
}

static int by_size(const void *a, const void *b)
{
    double x = ((const individual *)a)->error.size[NUMERICS_RELATIVE];
    double y = ((const individual *)b)->error.size[NUMERICS_RELATIVE];
    return (x < y) - (x > y);
}

/* `all` in decreasing order of error. */
static void note(const individual *all, int count, int generation, numerics_found *found)
{
    if (all[0].error.size[NUMERICS_RELATIVE] > found->search.size) {
        found->search.size = all[0].error.size[NUMERICS_RELATIVE];
        memcpy(found->search.argument, all[0].argument, sizeof all[0].argument);
    }
    if (generation == 0) {
        found->random = found->search;
        found->median = all[count / 2].error.size[NUMERICS_RELATIVE];
    }
    for (int i = 0; i < count; i++) {
        found->jumps += all[i].error.jump;
        if (all[i].error.broken) {
            found->broken.size++;
            memcpy(found->broken.argument, all[i].argument, sizeof all[i].argument);
        }
    }
    found->evaluations += count;
}

weft_code numerics_glsl_search(numerics_id id, long evaluations, numerics_found *found, weft_error *error)
{
    static float query[BANDS][QUERIES][4], result[QUERIES][4];
    static individual all[QUERIES], parents[PARENTS];
    const numerics_domain *domain = numerics_domain_of(id);
    int count = (int)fmin(fmax((double)evaluations / GENERATIONS, 2 * PARENTS), QUERIES);
    uint64_t random = (uint64_t)id;
    stage s = {0};
    weft_code code = stage_create(id, &s, error);
    *found = (numerics_found){0};
    for (int generation = 0; generation < GENERATIONS && code == WEFT_OK; generation++) {
        breed(all, count, generation, parents, numerics_coordinate_count(domain), &random);
        for (int i = 0; i < count; i++) {
            numerics_place(domain, all[i].coordinate, true, all[i].argument);
            fill_query(id, &all[i], i, query);
        }
        code = draw(&s, query, result, error);
        measure(id, all, count, result);
        qsort(all, (size_t)count, sizeof *all, by_size);
        note(all, count, generation, found);
        memcpy(parents, all, sizeof parents);
    }
    stage_free(&s);
    return code;
}
