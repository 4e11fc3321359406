#include "player/draw/lighting.h"
#include "player/draw/player_parts.h"

#include "player/draw/player.h"

static const double automatic = -1000, finest_of_all = -100;
static const double golden_ratio = 0.6180339887498949;
static const double smallest_triangle = 8; /* pixels */

double weft_player_sequence(const weft_player *p, long frame)
{
    return fmod((frame < 0 ? (double)p->frames_drawn : (double)frame) * golden_ratio, 1);
}

void weft_player_set_rays(GLuint program, const weft_scene *scene, const weft_pane *pane)
{
    weft_orbit_axes ray = weft_orbit_rays(&scene->orbit, pane->width, pane->height,
                                          pane->sampling.shift_x / pane->width, pane->sampling.shift_y / pane->height);
    weft_gl_set_vec3(program, "ray_right", ray.right.x, ray.right.y, ray.right.z);
    weft_gl_set_vec3(program, "ray_up", ray.up.x, ray.up.y, ray.up.z);
    weft_gl_set_vec3(program, "ray_forward", -ray.backward.x, -ray.backward.y, -ray.backward.z);
    weft_gl_set_vec2(program, "pane_origin", pane->left, 0);
}

static double level_uniform(const weft_scene *scene)
{
    switch (scene->level_choice) {
    case WEFT_LEVEL_NONE:
        return finest_of_all;
    case WEFT_LEVEL_FIXED:
        return scene->level;
    default:
        return automatic;
    }
}

void weft_player_draw_mesh(const weft_player *p, bool coarse)
{
    coarse = coarse && p->coarse_count > 0;
    size_t first = coarse ? (size_t)p->triangle_count : 0;
    glBindVertexArray(p->vertex_array);
    glDrawElements(GL_TRIANGLES, 3 * (coarse ? p->coarse_count : p->triangle_count), GL_UNSIGNED_INT,
                   (void *)(first * sizeof(uint32_t[3])));
    glBindVertexArray(0);
}

/* Rasterisers take blocks of some 4 x 4 pixels, so that smaller triangles cost as much. The pixels (of which a sampled
 * picture has more) are those of the ball round the mesh. */
static bool wants_coarse(const weft_player *p, const weft_scene *scene, const weft_pane *pane)
{
    double side = pane->width < pane->height ? pane->width : pane->height;
    double radius = exp2(-pane->sampling.level_bias) * side / (2 * weft_orbit_slope() * scene->orbit.distance);
    return WEFT_PI * radius * radius < smallest_triangle * p->triangle_count;
}

/* Width by height of what is shown. A cell of a weave need not be square, a texel is. */
static double proportion_of(const weft_player *p)
{
    const double *texels = p->texel_count[p->has[WEFT_MODE_RAW] ? WEFT_MODE_RAW : WEFT_MODE_COMPRESSED];
    return p->has[WEFT_MODE_RAW] || p->has[WEFT_MODE_COMPRESSED] ? texels[0] / texels[1] : 1;
}

/* What mesh_point.glsl needs. */
static void set_material(const weft_player *p, GLuint program, const weft_scene *scene, weft_mode mode)
{
    weft_gl_set_vec2(program, "repeat", scene->repeat, scene->repeat * proportion_of(p));
    weft_gl_set_vec2(program, "texel_count", p->texel_count[mode][0], p->texel_count[mode][1]);
    weft_gl_set_float(program, "level_choice", level_uniform(scene));
    weft_gl_set_int(program, "level_nearest", scene->level_choice == WEFT_LEVEL_NEAREST);
}

static void set_view(const weft_player *p, GLuint program, const weft_scene *scene, const weft_pane *pane)
{
    float matrix[16];
    weft_orbit_clip_of_world(&scene->orbit, p->centre, p->radius, (double)pane->width / pane->height,
                             pane->sampling.shift_x / pane->width, pane->sampling.shift_y / pane->height, matrix);
    glUniformMatrix4fv(weft_gl_uniform(program, "clip_of_world"), 1, GL_FALSE, matrix);
    weft_gl_set_float(program, "level_bias", pane->sampling.level_bias);
    weft_gl_set_float(program, "longest_pixel", fmax(pane->sampling.longest_pixel, 1));
    set_material(p, program, scene, pane->mode);
}

/* `front` is the layer that this one lies behind, or NULL. */
static weft_code draw_layer(weft_player *p, const weft_scene *scene, const weft_pane *pane, const weft_layer *front,
                            const weft_layer *layer, weft_error *error)
{
    GLuint program;
    WEFT_TRY(weft_programs_find_surface(&p->programs, front != NULL, &program, error));
    glBindFramebuffer(GL_FRAMEBUFFER, layer->buffer);
    glViewport(pane->left, 0, pane->width, pane->height);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    glUseProgram(program);
    set_view(p, program, scene, pane);
    if (front)
        weft_gl_bind(program, "front_depth", 0, GL_TEXTURE_2D, front->depth);
    weft_player_draw_mesh(p, wants_coarse(p, scene, pane));
    glDisable(GL_DEPTH_TEST);
    return WEFT_OK;
}

weft_code weft_player_draw_layers(weft_player *p, const weft_scene *scene, const weft_pane *pane, int layer_count,
                                  weft_error *error)
{
    for (int i = 0; i < layer_count; i++) {
        WEFT_TRY(weft_layer_resize(&p->layer[i], pane->left + pane->width, pane->height, error));
        WEFT_TRY(draw_layer(p, scene, pane, i > 0 ? &p->layer[i - 1] : NULL, &p->layer[i], error));
    }
    return WEFT_OK;
}

void weft_player_shade(const weft_player *p, const weft_pane *pane, const weft_layer *layer, GLuint target)
{
    int right = pane->left + pane->width;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, layer->buffer);
    glBlitFramebuffer(pane->left, 0, right, pane->height, pane->left, 0, right, pane->height, GL_DEPTH_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glDepthRangef(1, 1);
    glBindVertexArray(p->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthRangef(0, 1);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

/* ---- Shadows ---- */

static weft_shadow_holes holes_of(const weft_player *p, const weft_scene *scene)
{
    weft_shadow_holes holes = {.relief = scene->relief, .repeat = {scene->repeat, scene->repeat * proportion_of(p)}};
    for (int i = 0; i < weft_scene_panes(scene) && !holes.any; i++) {
        holes.mode = scene->pane[i];
        holes.any = !weft_player_is_opaque(p, holes.mode);
    }
    return holes;
}

/* What was drawn with other holes is drawn again. */
void weft_player_take_holes(weft_player *p, const weft_scene *scene)
{
    weft_shadow_holes now = holes_of(p, scene), *was = &p->shadow_holes;
    bool same = now.any ? was->any && now.relief == was->relief && now.mode == was->mode &&
                              now.repeat[0] == was->repeat[0] && now.repeat[1] == was->repeat[1]
                        : !was->any;
    if (!same)
        weft_player_forget_shadows(p);
    *was = now;
}

weft_code weft_player_find_caster(weft_player *p, const weft_scene *scene, bool is_soft, GLuint *program,
                                  weft_error *error)
{
    *program = p->shadow.program;
    if (!p->shadow_holes.any)
        return WEFT_OK;
    const weft_variant variant = weft_player_casting_variant(p, scene, p->shadow_holes.mode, is_soft);
    return weft_programs_find(&p->programs, &variant, program, error);
}

void weft_player_set_caster(const weft_player *p, const weft_scene *scene, weft_vec3 light, double sequence,
                            GLuint program)
{
    if (!p->shadow_holes.any)
        return;
    weft_mode mode = p->shadow_holes.mode;
    weft_player_bind_mode(p, scene, mode, program);
    set_material(p, program, scene, mode);
    weft_gl_set_float(program, "level_bias", 0);
    weft_gl_set_float(program, "longest_pixel", 1);
    weft_gl_set_float(program, "sequence", sequence);
    weft_gl_set_vec3(program, "toward_light", (double)light.x, (double)light.y, (double)light.z);
}

/* Coarse triangles will do for soft ones. */
static weft_code draw_shadow(weft_player *p, const weft_scene *scene, int layer, weft_vec3 light, bool is_soft,
                             long frame, weft_error *error)
{
    GLuint program;
    WEFT_TRY(weft_player_find_caster(p, scene, is_soft, &program, error));
    if (!weft_shadow_map_begin(&p->shadow, layer, is_soft, light, p->centre, p->radius, program))
        return WEFT_OK;
    weft_player_set_caster(p, scene, light, is_soft ? weft_player_sequence(p, frame) : 0, program);
    weft_player_draw_mesh(p, is_soft);
    weft_shadow_map_end();
    return WEFT_OK;
}

_Static_assert(WEFT_KEY_PLACES + WEFT_ENVIRONMENT_SAMPLES <= WEFT_SHADOW_LAYERS,
               "every shadow of a frame has its layer");

weft_code weft_player_draw_shadows(weft_player *p, const weft_scene *scene, long frame, weft_error *error)
{
    if (!weft_scene_has_shadows(scene))
        return WEFT_OK;
    weft_player_take_holes(p, scene);
    weft_lighting lighting = weft_lighting_of(scene, p->environment, frame);
    /* Light that moves over cloth with holes has no time for more. */
    bool is_soft = scene->key_size_rad > 0 || (frame < 0 && p->shadow_holes.any);
    for (int i = 0; i < lighting.key_count; i++)
        WEFT_TRY(draw_shadow(p, scene, i, lighting.key[i], is_soft, frame, error));
    for (int i = 0; i < lighting.sample_count; i++)
        WEFT_TRY(draw_shadow(p, scene, WEFT_KEY_PLACES + i, lighting.sample[i], true, frame, error));
    return WEFT_OK;
}
