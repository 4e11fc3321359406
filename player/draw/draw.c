#include "player/draw/player.h"

#include "player/draw/lighting.h"
#include "player/draw/player_parts.h"
#include "player/scene/false_colour.h"

#include <stdio.h>

enum { INTERACTIVE_COMPONENTS = 16 };

/* A frame samples few directions of the environment. A fold that sees none of them is not black: its visibility is at
 * least this. */
static const double visibility_of_none = 0.12;

static weft_lighting lighting_of(const weft_player *p, const weft_scene *scene, const weft_sampling *sampling)
{
    weft_lighting lighting = weft_lighting_of(scene, p->environment, sampling->frame);
    if (!sampling->neighbours_differ)
        weft_lighting_without_interleaving(&lighting);
    return lighting;
}

/* Only for a frame that is seen by itself: an interactive one, and the first that converges. Saved pictures are
 * unbiased. */
static double least_visibility_of(const weft_sampling *sampling)
{
    bool is_alone = sampling->frame < 0 || (sampling->frame == 0 && sampling->neighbours_differ);
    return is_alone ? visibility_of_none : 0;
}

static void set_lights(const weft_player *p, GLuint program, const weft_scene *scene, const weft_sampling *sampling)
{
    weft_lighting lighting = lighting_of(p, scene, sampling);
    weft_gl_set_int(program, "light_count", lighting.count);
    int held = weft_lighting_stored(&lighting);
    glUniform3fv(weft_gl_uniform(program, "light_direction"), held, lighting.direction[0]);
    glUniform3fv(weft_gl_uniform(program, "light_irradiance"), held, lighting.irradiance[0]);
    weft_gl_set_int(program, "scene_count", lighting.scene_count);
    weft_gl_set_int(program, "interleave_count", lighting.interleave_count);
    weft_gl_set_int(program, "key_count", lighting.key_count);
    weft_gl_set_int(program, "sample_count", lighting.sample_count);
    weft_gl_set_float(program, "least_visibility", least_visibility_of(sampling));
    /* Interactive frames under many lights have no time for more. */
    weft_gl_set_int(program, "shadow_taps", sampling->frame < 0 && lighting.sample_count > 0 ? 1 : 4);
    for (int i = 0; i < lighting.sample_count; i++) {
        char name[32];
        snprintf(name, sizeof name, "sample_direction[%d]", i);
        weft_gl_set_vec3(program, name, (double)lighting.sample[i].x, (double)lighting.sample[i].y,
                         (double)lighting.sample[i].z);
    }
}

void weft_player_set_point(const weft_player *p, GLuint program, const weft_scene *scene, const weft_pane *pane,
                           const weft_layer *layer)
{
    weft_player_set_rays(program, scene, pane);
    set_lights(p, program, scene, &pane->sampling);
    weft_gl_set_float(program, "sequence", weft_player_sequence(p, pane->sampling.frame));
    weft_layer_bind(layer, program);
    if (!weft_scene_has_shadows(scene))
        return;
    weft_vec3 eye = weft_orbit_eye(&scene->orbit, p->centre, p->radius);
    weft_gl_set_vec3(program, "eye", eye.x, eye.y, eye.z);
    weft_shadow_map_bind(&p->shadow, program, WEFT_SHADOW_UNIT);
}

static void set_shown(const weft_player *p, GLuint program, const weft_scene *scene, weft_mode mode)
{
    weft_gl_set_int(program, "opaque", weft_player_is_opaque(p, mode));
    weft_gl_set_float(program, "exposure", scene->exposure);
    weft_gl_set_int(program, "show_level", scene->show_level);
    weft_gl_set_int(program, "show_extrapolation", scene->show_extrapolation);
    glUniform3fv(weft_gl_uniform(program, "level_palette"), WEFT_LEVEL_COLOURS, weft_level_palette[0]);
    glUniform3fv(weft_gl_uniform(program, "extrapolation_tint"), WEFT_EXTRAPOLATION_TINTS, weft_extrapolation_tint[0]);
    /* A ring was measured to within rounding. */
    weft_gl_set_vec2(program, "last_ring", p->last_ring_z[mode][0] - 1e-3, p->last_ring_z[mode][1] - 1e-3);
}

weft_code weft_player_check_mode(const weft_player *p, weft_mode mode, weft_error *error)
{
    static const char *const needs[WEFT_MODE_COUNT] = {"a dataset", "a material", "a weave or microcylinder cloth"};
    if (!p->triangle_count)
        return weft_fail(error, WEFT_BAD_USAGE, "there is no mesh to draw");
    if (!p->has[mode])
        return weft_fail(error, WEFT_BAD_USAGE, "mode '%s' needs %s", weft_mode_name(mode), needs[mode]);
    return WEFT_OK;
}

/* ---- Panes ---- */

static void draw_screen(const weft_player *p)
{
    glBindVertexArray(p->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/* Only where the depth is that of nothing. */
static void draw_screen_behind(const weft_player *p)
{
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glDepthRangef(1, 1);
    draw_screen(p);
    glDepthRangef(0, 1);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

typedef void draw_there(const weft_player *p);

static void use_environment(const weft_player *p, const weft_scene *scene, const weft_pane *pane)
{
    GLuint program = p->environment_background;
    glUseProgram(program);
    weft_player_set_rays(program, scene, pane);
    weft_gl_bind(program, "map", 0, GL_TEXTURE_2D, p->environment_map);
    weft_gl_set_float(program, "strength", scene->environment_strength * scene->exposure);
    weft_gl_set_float(program, "turn", scene->environment_turn_rad / (2 * WEFT_PI));
}

static void draw_background(const weft_player *p, const weft_scene *scene, const weft_pane *pane, draw_there *draw)
{
    glDisable(GL_BLEND);
    if (scene->ground) {
        weft_player_use_ground(p, scene, pane);
    } else if (scene->environment && p->environment) {
        use_environment(p, scene, pane);
    } else {
        glUseProgram(p->background);
    }
    draw(p);
}

static weft_code shade_layer(weft_player *p, const weft_scene *scene, const weft_pane *pane, const weft_layer *layer,
                             GLuint target, weft_error *error)
{
    GLuint program;
    const weft_variant variant = weft_player_variant(p, scene, pane);
    WEFT_TRY(weft_programs_find(&p->programs, &variant, &program, error));
    glUseProgram(program);
    weft_player_set_point(p, program, scene, pane, layer);
    set_shown(p, program, scene, pane->mode);
    weft_player_bind_mode(p, scene, pane->mode, program);
    /* A converging frame may take longer, and shows less noise. */
    if (pane->mode == WEFT_MODE_ANALYTIC && !weft_player_has_threads(p))
        weft_gl_set_int(program, "chosen_places", pane->sampling.frame < 0 ? 1 : 3);
    weft_player_shade(p, pane, layer, target);
    return WEFT_OK;
}

/* Nothing of the background is drawn that opaque cloth hides. */
static weft_code draw_opaque_pane(weft_player *p, const weft_scene *scene, const weft_pane *pane, GLuint target,
                                  weft_error *error)
{
    WEFT_TRY(weft_player_draw_layers(p, scene, pane, 1, error));
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glViewport(pane->left, 0, pane->width, pane->height);
    WEFT_TRY(shade_layer(p, scene, pane, &p->layer[0], target, error));
    draw_background(p, scene, pane, draw_screen_behind);
    return WEFT_OK;
}

/* Through the holes of the cloth one more layer is seen, and the background. Reflectance is that of the whole texel,
 * holes included, and takes no further factor. */
static weft_code draw_pane_with_holes(weft_player *p, const weft_scene *scene, const weft_pane *pane, GLuint target,
                                      weft_error *error)
{
    WEFT_TRY(weft_player_draw_layers(p, scene, pane, WEFT_LAYER_COUNT, error));
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glViewport(pane->left, 0, pane->width, pane->height);
    weft_code code = WEFT_OK;
    draw_background(p, scene, pane, draw_screen);
    for (int i = WEFT_LAYER_COUNT - 1; code == WEFT_OK && i >= 0; i--) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        code = shade_layer(p, scene, pane, &p->layer[i], target, error);
    }
    glDisable(GL_BLEND);
    return code;
}

static weft_code draw_pane(weft_player *p, const weft_scene *scene, const weft_pane *pane, GLuint target,
                           weft_error *error)
{
    return weft_player_is_opaque(p, pane->mode) ? draw_opaque_pane(p, scene, pane, target, error)
                                                : draw_pane_with_holes(p, scene, pane, target, error);
}

/* ---- Layouts ---- */

static weft_code draw_panes(weft_player *p, const weft_scene *scene, const weft_pane *whole, GLuint target,
                            weft_error *error)
{
    int panes = scene->pane_count;
    for (int i = 0; i < panes; i++) {
        int left = whole->width * i / panes, right = whole->width * (i + 1) / panes;
        const weft_pane pane = {scene->pane[i], left, right - left, whole->height, whole->sampling};
        WEFT_TRY(draw_pane(p, scene, &pane, target, error));
    }
    glViewport(0, 0, whole->width, whole->height);
    return WEFT_OK;
}

static weft_code draw_wipe(weft_player *p, const weft_scene *scene, const weft_pane *whole, GLuint target,
                           weft_error *error)
{
    int line = (int)lround(scene->divider * whole->width);
    weft_code code = WEFT_OK;
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; code == WEFT_OK && i < 2; i++) {
        weft_pane pane = *whole;
        pane.mode = scene->pane[i];
        glScissor(i == 0 ? 0 : line, 0, i == 0 ? line : whole->width - line, whole->height);
        code = draw_pane(p, scene, &pane, target, error);
    }
    glDisable(GL_SCISSOR_TEST);
    return code;
}

static weft_code keep_picture(weft_player *p, const weft_pane *whole, weft_error *error)
{
    if (p->kept_width != whole->width || p->kept_height != whole->height) {
        glDeleteTextures(1, &p->kept);
        p->kept_width = p->kept_height = 0;
        WEFT_TRY(weft_gl_texture((weft_texture_format){GL_RGBA32F, GL_RGBA, GL_FLOAT}, whole->width, whole->height, 0,
                                 NULL, &p->kept, error));
        p->kept_width = whole->width;
        p->kept_height = whole->height;
    }
    glBindTexture(GL_TEXTURE_2D, p->kept);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, whole->width, whole->height);
    return weft_gl_check("keeping a picture", error);
}

static weft_code draw_difference(weft_player *p, const weft_scene *scene, const weft_pane *whole, GLuint target,
                                 weft_error *error)
{
    weft_pane pane = *whole;
    pane.mode = scene->pane[0];
    WEFT_TRY(draw_pane(p, scene, &pane, target, error));
    WEFT_TRY(keep_picture(p, whole, error));
    pane.mode = scene->pane[1];
    WEFT_TRY(draw_pane(p, scene, &pane, target, error));
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
    glUseProgram(p->copy);
    weft_gl_bind(p->copy, "frame", 0, GL_TEXTURE_2D, p->kept);
    draw_screen(p);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
    return WEFT_OK;
}

static weft_code draw_pane_labels(weft_player *p, const weft_scene *scene, int width, int height, int margin,
                                  weft_error *error)
{
    for (int i = 0; scene->pane_count > 1 && i < scene->pane_count; i++)
        WEFT_TRY(weft_label_draw(&p->labels, width, height, width * i / scene->pane_count + margin, margin, false,
                                 weft_mode_name(scene->pane[i]), &weft_plain_ink, error));
    return WEFT_OK;
}

weft_code weft_player_draw_labels(weft_player *p, const weft_scene *scene, int width, int height, weft_error *error)
{
    int margin = weft_label_size(height) / 2;
    if (!scene->labels)
        return WEFT_OK;
    if (scene->layout == WEFT_LAYOUT_DIFFERENCE)
        return weft_legend_draw(&p->labels, width, height, scene->pane[1], error);
    if (scene->layout == WEFT_LAYOUT_PANES)
        return draw_pane_labels(p, scene, width, height, margin, error);
    WEFT_TRY(weft_label_draw(&p->labels, width, height, margin, margin, false, weft_mode_name(scene->pane[0]),
                             &weft_plain_ink, error));
    return weft_label_draw(&p->labels, width, height, width - margin, margin, true, weft_mode_name(scene->pane[1]),
                           &weft_plain_ink, error);
}

static weft_code check_scene(const weft_player *p, const weft_scene *scene, int width, int height, weft_error *error)
{
    int panes = weft_scene_panes(scene);
    if (width < panes || height < 1 || panes < 1 || panes > WEFT_MODE_COUNT)
        return weft_fail(error, WEFT_BAD_USAGE, "%d panes do not fit into %d x %d pixels", panes, width, height);
    for (int i = 0; i < panes; i++)
        WEFT_TRY(weft_player_check_mode(p, scene->pane[i], error));
    return WEFT_OK;
}

/* The first components hold most of what is seen. */
static weft_scene with_few_components(const weft_scene *scene)
{
    weft_scene few = *scene;
    few.components = few.components < INTERACTIVE_COMPONENTS ? few.components : INTERACTIVE_COMPONENTS;
    return few;
}

weft_code weft_player_draw(weft_player *p, const weft_scene *asked, int width, int height, weft_sampling sampling,
                           weft_error *error)
{
    static weft_code (*const draw[WEFT_LAYOUT_COUNT])(weft_player *, const weft_scene *, const weft_pane *, GLuint,
                                                      weft_error *) = {draw_panes, draw_wipe, draw_difference};
    const weft_scene few = with_few_components(asked), *scene = sampling.interactive ? &few : asked;
    WEFT_TRY(check_scene(p, scene, width, height, error));
    GLint target;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    const weft_pane whole = {.width = width, .height = height, .sampling = sampling};
    WEFT_TRY(weft_player_draw_shadows(p, scene, sampling.frame, error));
    WEFT_TRY(weft_player_advance_ground(p, scene, &whole, error));
    WEFT_TRY(draw[scene->layout](p, scene, &whole, (GLuint)target, error));
    p->frames_drawn++;
    WEFT_TRY(weft_player_draw_labels(p, scene, width, height, error));
    return weft_gl_check("drawing", error);
}
