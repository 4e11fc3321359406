#include "player/draw/programs.h"

#include "player/draw/lighting.h"
#include "player/draw/shadow.h"
#include "player/gl/layer.h"
#include "player/gl/shaders.h"
#include "player/scene/false_colour.h"

#include <stdio.h>
#include <string.h>

/* ---- Variants ---- */

static const char *name_of(bool value)
{
    return value ? "true" : "false";
}

/* What a program shades. */
static const char *model_of(const weft_variant *v)
{
    return v->mode == WEFT_MODE_RAW          ? "raw"
           : v->mode == WEFT_MODE_COMPRESSED ? (v->component_groups > 0 ? "components" : "lobes")
           : v->threads                      ? "threads"
                                             : "weave";
}

static const char *light_count_of(const weft_variant *v)
{
    return v->one_light ? "1" : v->chosen_lights > 0 ? "(scene_count + CHOSEN_LIGHTS)" : "light_count";
}

/* The constants of a variant, after its name: no two variants have the same text. */
static void define(const char *name, const weft_variant *v, char text[WEFT_VARIANT_TEXT])
{
    snprintf(
        text, WEFT_VARIANT_TEXT,
        "// %s\n#define CASTS %s\n"
        "#define MAX_LIGHTS %d\n#define SHADOW_LAYERS %d\n#define KEY_PLACES %d\n#define LEVEL_COLOURS %d\n"
        "#define LIGHT_COUNT %s\n#define ONE_LIGHT %s\n#define CHOSEN_LIGHTS %d\n"
        "#define STOCHASTIC %s\n#define SHADOWS %s\n#define PLOT %d\n#define OPACITY %s\n"
        "#define LOBES %d\n#define VIEW_TABLE %s\n#define LIGHT_TABLE %s\n#define NOISE %s\n"
        "#define COMPONENT_GROUPS %d\n#define DRAWN_GROUPS %d\n#define OVER_HALF_VECTOR %s\n#define KRIGED %s\n#define "
        "RELIEF %s\n"
        "#define PRUNED %d\n#define STAPLES %s\n#define FILAMENTS %s\n",
        name, name_of(v->casts), WEFT_MAX_LIGHTS, WEFT_SHADOW_LAYERS, WEFT_KEY_PLACES, WEFT_LEVEL_COLOURS,
        light_count_of(v), name_of(v->one_light), v->chosen_lights, name_of(v->stochastic), name_of(v->shadows),
        v->plot, name_of(v->opacity), v->lobe_count, name_of(v->view_table), name_of(v->light_table), name_of(v->noise),
        v->component_groups, v->drawn_groups, name_of(v->over_half_vector), name_of(v->kriged), name_of(v->relief),
        v->pruned, name_of(v->staples), name_of(v->filaments));
}

/* ---- Programs ---- */

/* Some drivers count a sampler as used that no pixel reads, and none draws where samplers of two types share a unit.
 * All begin on unit 0, and what only pictures bind would stay there in a plot. */
static void place_samplers(GLuint program, const char *const *part)
{
    while (*part && *part != weft_glsl_surface)
        part++;
    if (!*part)
        return;
    glUseProgram(program);
    weft_gl_set_int(program, "surface_rotation", WEFT_ROTATION_UNIT);
    weft_gl_set_int(program, "surface_place", WEFT_PLACE_UNIT);
    weft_gl_set_int(program, "surface_sides", WEFT_SIDES_UNIT);
    weft_gl_set_int(program, "shadow_map", WEFT_SHADOW_UNIT);
}

/* Of those that are kept in the order of their building. */
static void forget_oldest(weft_programs *p)
{
    glUseProgram(0); /* a program in use would outlive its deletion */
    glDeleteProgram(p->program[0].name);
    p->count--;
    memmove(p->program, p->program + 1, (size_t)p->count * sizeof *p->program);
}

void weft_programs_free(weft_programs *p)
{
    glUseProgram(0);
    for (int i = 0; i < p->count; i++)
        glDeleteProgram(p->program[i].name);
    *p = (weft_programs){0};
}

/* The program of this text, which its fragment shader begins with; built unless it is there. */
static weft_code find(weft_programs *p, const char *text, const char *name, const char *vertex,
                      const char *const *fragment, GLuint *program, weft_error *error)
{
    int i = 0;
    while (i < p->count && strcmp(p->program[i].text, text) != 0)
        i++;
    if (i == p->count) {
        const char *const vertex_parts[] = {vertex, NULL};
        WEFT_TRY(weft_gl_program(name, vertex_parts, fragment, program, error));
        place_samplers(*program, fragment);
        if (p->count == WEFT_PROGRAM_CAPACITY)
            forget_oldest(p);
        i = p->count++;
        p->program[i].name = *program;
        snprintf(p->program[i].text, sizeof p->program[i].text, "%s", text);
    }
    *program = p->program[i].name;
    return WEFT_OK;
}

/* What the fragment shader of a model has between the surface and its last part. */
static const char *const *parts_of(const weft_variant *v)
{
    static const char *const raw[] = {weft_glsl_directions, weft_glsl_relief, weft_glsl_raw, NULL};
    static const char *const lobes[] = {weft_glsl_directions, weft_glsl_tables, weft_glsl_lafortune,
                                        weft_glsl_compressed, NULL};
    static const char *const components[] = {weft_glsl_directions, weft_glsl_tables,     weft_glsl_components,
                                             weft_glsl_relief,     weft_glsl_factorised, NULL};
    static const char *const weave[] = {weft_glsl_woven, weft_glsl_weave, weft_glsl_weave_mean, weft_glsl_analytic,
                                        NULL};
    static const char *const threads[] = {weft_glsl_microcylinder, weft_glsl_threads, NULL};
    return v->mode == WEFT_MODE_RAW          ? raw
           : v->mode == WEFT_MODE_COMPRESSED ? (v->component_groups > 0 ? components : lobes)
           : v->threads                      ? threads
                                             : weave;
}

enum { MOST_PARTS = 5 };

weft_code weft_programs_find(weft_programs *p, const weft_variant *v, GLuint *program, weft_error *error)
{
    char text[WEFT_VARIANT_TEXT];
    const char *fragment[3 + MOST_PARTS + 3] = {text, weft_glsl_rotation, weft_glsl_surface};
    int count = 3;
    define(model_of(v), v, text);
    for (const char *const *part = parts_of(v); *part; part++)
        fragment[count++] = *part;
    if (v->casts)
        fragment[count++] = weft_glsl_mesh_point;
    fragment[count] = v->casts ? weft_glsl_cast_frag : weft_glsl_shade_frag;
    return find(p, text, model_of(v), v->casts ? weft_glsl_surface_vert : weft_glsl_fullscreen_vert, fragment, program,
                error);
}

weft_code weft_programs_find_surface(weft_programs *p, bool behind, GLuint *program, weft_error *error)
{
    char text[64];
    snprintf(text, sizeof text, "// surface\n#define BEHIND %s\n", name_of(behind));
    const char *const fragment[] = {text, weft_glsl_mesh_point, weft_glsl_surface_frag, NULL};
    return find(p, text, "surface", weft_glsl_surface_vert, fragment, program, error);
}

weft_code weft_programs_find_geometry(weft_programs *p, bool shadows, GLuint *program, weft_error *error)
{
    char text[WEFT_VARIANT_TEXT];
    const weft_variant variant = {.shadows = shadows};
    define("geometry", &variant, text);
    const char *const fragment[] = {text, weft_glsl_rotation, weft_glsl_surface, weft_glsl_geometry_frag, NULL};
    return find(p, text, "geometry", weft_glsl_fullscreen_vert, fragment, program, error);
}
