#include "player/player.h"

#include "player/player_parts.h"

static const double automatic = -1000, finest_of_all = -100;

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

void weft_player_set_surface(const weft_player *p, GLuint program, const weft_scene *scene, weft_mode mode,
                             double aspect, double shift_x, double shift_y, double level_bias)
{
    float matrix[16];
    weft_orbit_clip_of_world(&scene->orbit, p->centre, p->radius, aspect, shift_x, shift_y, matrix);
    weft_vec3 eye = weft_orbit_eye(&scene->orbit, p->centre, p->radius);
    weft_vec3 light = weft_direction_of_angles(scene->light[0].direction);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "clip_of_world"), 1, GL_FALSE, matrix);
    weft_gl_set_vec3(program, "eye", eye.x, eye.y, eye.z);
    weft_gl_set_vec3(program, "light_direction", light.x, light.y, light.z);
    weft_gl_set_float(program, "repeat", scene->repeat);
    weft_gl_set_vec2(program, "texel_count", p->texel_count[mode][0], p->texel_count[mode][1]);
    weft_gl_set_float(program, "level_choice", level_uniform(scene));
    weft_gl_set_float(program, "level_bias", level_bias);
    weft_gl_set_float(program, "exposure", scene->exposure);
}

void weft_player_draw_mesh(const weft_player *p)
{
    glBindVertexArray(p->vertex_array);
    glDrawElements(GL_TRIANGLES, p->index_count, GL_UNSIGNED_INT, NULL);
    glBindVertexArray(0);
}

weft_code weft_player_check_mode(const weft_player *p, weft_mode mode, weft_error *error)
{
    static const char *const needs[WEFT_MODE_COUNT] = {"a dataset", "a material", "a weave"};
    if (!p->index_count)
        return weft_fail(error, WEFT_BAD_USAGE, "there is no mesh to draw");
    if (!p->has[mode])
        return weft_fail(error, WEFT_BAD_USAGE, "mode '%s' needs %s", weft_mode_name(mode), needs[mode]);
    return WEFT_OK;
}

static void bind_mode(const weft_player *p, weft_mode mode, GLuint program)
{
    switch (mode) {
    case WEFT_MODE_RAW:
        weft_raw_texture_bind(&p->raw, program);
        break;
    case WEFT_MODE_COMPRESSED:
        weft_material_texture_bind(&p->material, program);
        break;
    default:
        weft_weave_texture_bind(&p->weave, program);
        break;
    }
}

static void draw_background(const weft_player *p)
{
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glUseProgram(p->background);
    glBindVertexArray(p->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/* Holes of the cloth show what was drawn before: the background, or the cloth behind where it came first. Reflectance is
 * that of the whole texel, holes included, and takes no further factor. */
static void draw_pane(const weft_player *p, const weft_scene *scene, weft_mode mode, int width, int height,
                      weft_sampling sampling)
{
    draw_background(p);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    GLuint program = p->shade[mode];
    weft_player_set_surface(p, program, scene, mode, (double)width / height, sampling.shift_x / width,
                            sampling.shift_y / height, sampling.level_bias);
    bind_mode(p, mode, program);
    weft_player_draw_mesh(p);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
}

static void draw_labels(const weft_player *p, const weft_scene *scene, int width, int height)
{
    int scale = height / 240 > 1 ? height / 240 : 1, margin = 4 * scale;
    for (int i = 0; scene->labels && scene->pane_count > 1 && i < scene->pane_count; i++)
        weft_overlay_text(&p->overlay, width, height, width * i / scene->pane_count + margin, margin, scale,
                          weft_mode_name(scene->pane[i]));
    if (scene->help)
        weft_overlay_text(&p->overlay, width, height, margin, margin, scale, scene->help);
}

weft_code weft_player_draw(weft_player *p, const weft_scene *scene, int width, int height, weft_sampling sampling,
                           weft_error *error)
{
    int panes = scene->pane_count;
    if (width < panes || height < 1 || panes < 1 || panes > WEFT_MODE_COUNT)
        return weft_fail(error, WEFT_BAD_USAGE, "%d panes do not fit into %d x %d pixels", panes, width, height);
    for (int i = 0; i < panes; i++)
        WEFT_TRY(weft_player_check_mode(p, scene->pane[i], error));
    glClear(GL_DEPTH_BUFFER_BIT);
    for (int i = 0; i < panes; i++) {
        int left = width * i / panes, right = width * (i + 1) / panes;
        glViewport(left, 0, right - left, height);
        draw_pane(p, scene, scene->pane[i], right - left, height, sampling);
    }
    glViewport(0, 0, width, height);
    draw_labels(p, scene, width, height);
    return weft_gl_check("drawing", error);
}
