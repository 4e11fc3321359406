#include "player/draw/programs.h"

#include "player/draw/lighting.h"
#include "player/draw/shadow.h"
#include "player/gl/layer.h"
#include "player/gl/shaders.h"
#include "player/scene/false_colour.h"

#include <stdio.h>
#include <string.h>

static bool same_kind(const weft_program_kind *a, const weft_program_kind *b)
{
    return a->mode == b->mode && a->stochastic == b->stochastic && a->shadows == b->shadows &&
           a->one_light == b->one_light && a->chosen_lights == b->chosen_lights && a->casts == b->casts &&
           a->plot == b->plot && a->opacity == b->opacity && a->relief == b->relief && a->threads == b->threads &&
           a->noise == b->noise && a->component_groups == b->component_groups && a->drawn_groups == b->drawn_groups &&
           a->incidence_power == b->incidence_power && a->lobe_count == b->lobe_count &&
           a->view_table == b->view_table && a->light_table == b->light_table && a->fewer_bits == b->fewer_bits &&
           a->pruned == b->pruned;
}

static const char *name_of(bool value)
{
    return value ? "true" : "false";
}

static const char *light_count_of(const weft_program_kind *kind)
{
    return kind->one_light ? "1" : kind->chosen_lights > 0 ? "(scene_count + CHOSEN_LIGHTS)" : "light_count";
}

static void define(const weft_program_kind *kind, char *text, size_t size)
{
    snprintf(
        text, size,
        "#define MAX_LIGHTS %d\n#define SHADOW_LAYERS %d\n#define KEY_PLACES %d\n#define LEVEL_COLOURS %d\n#define "
        "LIGHT_COUNT %s\n#define "
        "ONE_LIGHT %s\n#define CHOSEN_LIGHTS %d\n"
        "#define STOCHASTIC %s\n#define SHADOWS %s\n#define PLOT %d\n#define OPACITY %s\n"
        "#define LOBES %d\n#define VIEW_TABLE %s\n#define LIGHT_TABLE %s\n#define FEWER_BITS %s\n#define NOISE %s\n"
        "#define COMPONENT_GROUPS %d\n#define DRAWN_GROUPS %d\n#define INCIDENCE_POWER %d\n#define RELIEF %s\n#define "
        "PRUNED "
        "%d\n",
        WEFT_MAX_LIGHTS, WEFT_SHADOW_LAYERS, WEFT_KEY_PLACES, WEFT_LEVEL_COLOURS, light_count_of(kind),
        name_of(kind->one_light), kind->chosen_lights, name_of(kind->stochastic), name_of(kind->shadows), kind->plot,
        name_of(kind->opacity), kind->lobe_count, name_of(kind->view_table), name_of(kind->light_table),
        name_of(kind->fewer_bits), name_of(kind->noise), kind->component_groups, kind->drawn_groups,
        kind->incidence_power, name_of(kind->relief), kind->pruned);
}

/* Some drivers count a sampler as used that no pixel reads, and none draws where samplers of two types share a unit.
 * All begin on unit 0, and what only pictures bind would stay there in a plot. */
static void place_samplers(GLuint program)
{
    glUseProgram(program);
    weft_gl_set_int(program, "surface_rotation", WEFT_ROTATION_UNIT);
    weft_gl_set_int(program, "surface_place", WEFT_PLACE_UNIT);
    weft_gl_set_int(program, "surface_sides", WEFT_SIDES_UNIT);
    weft_gl_set_int(program, "shadow_map", WEFT_SHADOW_UNIT);
}

static weft_code build(const weft_program_kind *kind, GLuint *program, weft_error *error)
{
    char constants[768];
    define(kind, constants, sizeof constants);
    const char *const vertex[] = {kind->casts ? weft_glsl_surface_vert : weft_glsl_fullscreen_vert, NULL};
    const char *mesh = kind->casts ? weft_glsl_mesh_point : "";
    const char *last = kind->casts ? weft_glsl_cast_frag : weft_glsl_shade_frag;
    const char *const raw[] = {constants,
                               weft_glsl_rotation,
                               weft_glsl_surface,
                               weft_glsl_directions,
                               weft_glsl_relief,
                               weft_glsl_raw,
                               mesh,
                               last,
                               NULL};
    const char *const compressed[] = {constants,
                                      weft_glsl_rotation,
                                      weft_glsl_surface,
                                      weft_glsl_directions,
                                      weft_glsl_tables,
                                      weft_glsl_lafortune,
                                      weft_glsl_compressed,
                                      mesh,
                                      last,
                                      NULL};
    const char *const factorised[] = {constants,
                                      weft_glsl_rotation,
                                      weft_glsl_surface,
                                      weft_glsl_directions,
                                      weft_glsl_tables,
                                      weft_glsl_components,
                                      weft_glsl_relief,
                                      weft_glsl_factorised,
                                      mesh,
                                      last,
                                      NULL};
    const char *const analytic[] = {constants,
                                    weft_glsl_rotation,
                                    weft_glsl_surface,
                                    weft_glsl_directions,
                                    weft_glsl_woven,
                                    weft_glsl_weave,
                                    weft_glsl_analytic,
                                    weft_glsl_shade_frag,
                                    NULL};
    const char *const threads[] = {constants,
                                   weft_glsl_rotation,
                                   weft_glsl_surface,
                                   weft_glsl_microcylinder,
                                   weft_glsl_threads,
                                   weft_glsl_shade_frag,
                                   NULL};
    const char *const *const fragment[WEFT_MODE_COUNT] = {raw, kind->component_groups > 0 ? factorised : compressed,
                                                          kind->threads ? threads : analytic};
    WEFT_TRY(weft_gl_program(weft_mode_name(kind->mode), vertex, fragment[kind->mode], program, error));
    place_samplers(*program);
    return WEFT_OK;
}

/* Of those that are kept in the order of their building; returns where the next one goes. */
static int forget_oldest(weft_programs *p)
{
    glUseProgram(0); /* a program in use would outlive its deletion */
    glDeleteProgram(p->name[0]);
    p->count--;
    memmove(p->kind, p->kind + 1, (size_t)p->count * sizeof *p->kind);
    memmove(p->name, p->name + 1, (size_t)p->count * sizeof *p->name);
    return p->count;
}

void weft_programs_free(weft_programs *p)
{
    glUseProgram(0);
    for (int i = 0; i < p->count; i++)
        glDeleteProgram(p->name[i]);
    for (int i = 0; i < 2; i++) {
        glDeleteProgram(p->surface[i]);
        glDeleteProgram(p->geometry[i]);
    }
    *p = (weft_programs){0};
}

weft_code weft_programs_find(weft_programs *p, const weft_program_kind *kind, GLuint *program, weft_error *error)
{
    int i = 0;
    while (i < p->count && !same_kind(&p->kind[i], kind))
        i++;
    if (i == WEFT_PROGRAM_CAPACITY)
        i = forget_oldest(p);
    if (i == p->count) {
        WEFT_TRY(build(kind, &p->name[i], error));
        p->kind[i] = *kind;
        p->count++;
    }
    *program = p->name[i];
    return WEFT_OK;
}

weft_code weft_programs_find_surface(weft_programs *p, bool behind, GLuint *program, weft_error *error)
{
    GLuint *wanted = &p->surface[behind];
    if (!*wanted) {
        char constants[64];
        snprintf(constants, sizeof constants, "#define BEHIND %s\n", name_of(behind));
        const char *const vertex[] = {weft_glsl_surface_vert, NULL};
        const char *const fragment[] = {constants, weft_glsl_mesh_point, weft_glsl_surface_frag, NULL};
        WEFT_TRY(weft_gl_program("surface", vertex, fragment, wanted, error));
    }
    *program = *wanted;
    return WEFT_OK;
}

/* A program of what lies on the surface or beside it: `fragment` after what every shading needs. */
static weft_code find_with_surface(const char *name, const char *fragment, bool shadows, GLuint *wanted,
                                   GLuint *program, weft_error *error)
{
    if (!*wanted) {
        const weft_program_kind kind = {.shadows = shadows};
        char constants[768];
        define(&kind, constants, sizeof constants);
        const char *const vertex[] = {weft_glsl_fullscreen_vert, NULL};
        const char *const parts[] = {constants, weft_glsl_rotation, weft_glsl_surface, fragment, NULL};
        WEFT_TRY(weft_gl_program(name, vertex, parts, wanted, error));
    }
    *program = *wanted;
    return WEFT_OK;
}

weft_code weft_programs_find_geometry(weft_programs *p, bool shadows, GLuint *program, weft_error *error)
{
    return find_with_surface("geometry", weft_glsl_geometry_frag, shadows, &p->geometry[shadows], program, error);
}
