/* The shading programs, built when they are first used: each with what it must do as constants, so that a picture pays
 * for nothing else. */
#ifndef WEFT_PLAYER_DRAW_PROGRAMS_H
#define WEFT_PLAYER_DRAW_PROGRAMS_H

#include "player/gl/gl.h"
#include "player/scene/scene.h"

enum { WEFT_MAX_LIGHTS = 52 }; /* of one frame: those of the scene and 48 of the environment */

/* What a program does. */
typedef struct weft_variant {
    weft_mode mode;
    bool stochastic, shadows, one_light;
    int chosen_lights;       /* of the environment, by chance; 0: all of it */
    bool casts;              /* draws the shadow of cloth with holes */
    int plot;                /* 0: of the picture; 1, 2: of lights, of views (player/draw/probe.h) */
    bool opacity;            /* raw and components: some is below 1 */
    bool relief;             /* raw and components: through the heights */
    bool threads;            /* analytic: microcylinders, else a weave */
    bool noise;              /* analytic: that of the weave */
    bool staples, filaments; /* analytic: kinds of yarn that shine from afar */
    /* Of the compressed material: */
    int component_groups;          /* four components each, in the place of lobes; 0: lobes */
    int drawn_groups;              /* the first of them, which are evaluated */
    bool over_half_vector, kriged; /* their maps (player/texture/material_texture.h) */
    int lobe_count;
    bool view_table, light_table;
    bool pruned; /* tinted where the scene that it was pruned for does not reach */
} weft_variant;

enum { WEFT_PROGRAM_CAPACITY = 32, WEFT_VARIANT_TEXT = 896 };

/* In the order of their building; the oldest goes where there is no room. */
typedef struct weft_programs {
    int count;
    struct {
        char text[WEFT_VARIANT_TEXT]; /* what its shaders differ in from others: the key */
        GLuint name;
    } program[WEFT_PROGRAM_CAPACITY];
} weft_programs;

/* Start from a zeroed value. */
void weft_programs_free(weft_programs *programs);

/* *program stays owned by `programs`. Errors: WEFT_SYSTEM where the driver refuses the source. */
weft_code weft_programs_find(weft_programs *programs, const weft_variant *variant, GLuint *program, weft_error *error);

/* The same for the program that draws a layer of the surface (player/draw/shaders/surface.frag.glsl) and for the one
 * that writes the inputs of the shading (player/draw/shaders/geometry.frag.glsl). */
weft_code weft_programs_find_surface(weft_programs *programs, bool behind, GLuint *program, weft_error *error);
weft_code weft_programs_find_geometry(weft_programs *programs, bool shadows, GLuint *program, weft_error *error);

#endif
