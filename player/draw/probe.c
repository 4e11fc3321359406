#include "player/draw/probe.h"

#include "player/draw/player_parts.h"
#include "player/gl/shaders.h"

#include <string.h>

/* ---- Under a pixel ---- */

/* The pane under column x of a picture that wide, and the mode it shows. */
static weft_mode mode_at(const weft_scene *scene, int width, int x)
{
    if (scene->layout == WEFT_LAYOUT_WIPE)
        return scene->pane[x < scene->divider * width ? 0 : 1];
    if (scene->layout == WEFT_LAYOUT_DIFFERENCE)
        return scene->pane[1];
    int pane = 0;
    while (pane + 1 < scene->pane_count && x >= width * (pane + 1) / scene->pane_count)
        pane++;
    return scene->pane[pane];
}

static void read_pixel(GLuint buffer, GLenum attachment, int x, int y, float value[4])
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, buffer);
    glReadBuffer(attachment);
    glReadPixels(x, y, 1, 1, GL_RGBA, GL_FLOAT, value);
}

static bool is_covered(GLuint buffer, int x, int y)
{
    float depth;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, buffer);
    glReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    return depth < 1;
}

static weft_vec3 rotated_back(const float q[4], weft_vec3 direction)
{
    weft_vec3 axis = {-(weft_real)q[0], -(weft_real)q[1], -(weft_real)q[2]};
    weft_vec3 twice = weft_scale(weft_cross(axis, direction), 2);
    return weft_add(direction, weft_add(weft_scale(twice, (weft_real)q[3]), weft_cross(axis, twice)));
}

static weft_pane pane_at(const weft_scene *scene, const weft_canvas *canvas, int x)
{
    weft_pane pane = {.width = canvas->width, .height = canvas->height, .sampling = {.frame = 0}};
    int panes = scene->layout == WEFT_LAYOUT_PANES ? scene->pane_count : 1;
    for (int i = 0; i < panes; i++) {
        int left = canvas->width * i / panes, right = canvas->width * (i + 1) / panes;
        if (x >= left && x < right) {
            pane.left = left;
            pane.width = right - left;
        }
    }
    return pane;
}

static void find_directions(const weft_scene *scene, const weft_pane *pane, const float rotation[4], bool mirrored,
                            double x, double y, weft_probe *probe)
{
    weft_orbit_axes ray = weft_orbit_rays(&scene->orbit, pane->width, pane->height, 0, 0);
    weft_vec3 forward = weft_add(weft_add(weft_scale(ray.right, (weft_real)x), weft_scale(ray.up, (weft_real)y)),
                                 weft_scale(ray.backward, -1));
    probe->view = rotated_back(rotation, weft_unit(weft_scale(forward, -1)));
    probe->light = rotated_back(rotation, weft_direction_of_angles(scene->light[0].direction));
    if (mirrored) {
        probe->view.y = -probe->view.y;
        probe->light.y = -probe->light.y;
    }
    probe->view.z = fmax(probe->view.z, (weft_real)0.02);
    probe->view = weft_unit(probe->view);
}

static int last_level(const weft_player *p, weft_mode mode)
{
    return mode == WEFT_MODE_COMPRESSED ? p->material.layout.level_count - 1
           : mode == WEFT_MODE_RAW      ? p->raw.plan.layout.level_count - 1
                                        : 0;
}

static void find_texel(const weft_player *p, weft_probe *probe)
{
    double width = p->texel_count[probe->mode][0], height = p->texel_count[probe->mode][1];
    probe->texel_level = (int)weft_clamp(round(probe->level), 0, last_level(p, probe->mode));
    double columns = fmax(1, ceil(ldexp(width, -probe->texel_level)));
    double rows = fmax(1, ceil(ldexp(height, -probe->texel_level)));
    probe->texel_x = (int)fmin(floor((probe->u - floor(probe->u)) * columns), columns - 1);
    probe->texel_y = (int)fmin(floor((-probe->v - floor(-probe->v)) * rows), rows - 1);
}

weft_code weft_probe_read(weft_player *p, const weft_scene *scene, const weft_canvas *canvas, int x, int y,
                          weft_probe *probe, weft_error *error)
{
    *probe = (weft_probe){.mode = mode_at(scene, canvas->width, x)};
    int row = canvas->height - 1 - y;
    if (x < 0 || row < 0 || x >= canvas->width || row >= canvas->height || !p->layer[0].buffer)
        return WEFT_OK;
    float rotation[4], place[4], sum[4];
    read_pixel(canvas->sum_buffer, GL_COLOR_ATTACHMENT0, x, row, sum);
    for (int c = 0; c < 3 && canvas->frame_count > 0; c++)
        probe->radiance[c] = (double)sum[c] / canvas->frame_count;
    probe->on_mesh = is_covered(p->layer[0].buffer, x, row);
    if (probe->on_mesh) {
        weft_pane pane = pane_at(scene, canvas, x);
        read_pixel(p->layer[0].buffer, GL_COLOR_ATTACHMENT0, x, row, rotation);
        read_pixel(p->layer[0].buffer, GL_COLOR_ATTACHMENT1, x, row, place);
        probe->u = (double)place[0];
        probe->v = (double)place[1];
        probe->level = (double)place[2];
        find_directions(scene, &pane, rotation, place[3] < 0, x + 0.5 - pane.left, row + 0.5, probe);
        find_texel(p, probe);
    }
    return weft_gl_check("reading a pixel", error);
}

/* ---- Plots ---- */

static weft_code make_target(weft_texture_format format, int size, GLuint *texture, GLuint *buffer, weft_error *error)
{
    WEFT_TRY(weft_gl_texture(format, 2 * size, size, 0, NULL, texture, error));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glGenFramebuffers(1, buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, *buffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *texture, 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver does not draw plots into textures");
    return weft_gl_check("making plots", error);
}

weft_code weft_probe_plots_create(int size, weft_probe_plots *plots, weft_error *error)
{
    const weft_texture_format linear = {GL_RGBA32F, GL_RGBA, GL_FLOAT}, shown = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    const char *const vertex[] = {weft_glsl_fullscreen_vert, NULL}, *const present[] = {weft_glsl_present_frag, NULL};
    *plots = (weft_probe_plots){.size = size};
    glGenVertexArrays(1, &plots->vertex_array);
    WEFT_TRY(make_target(linear, size, &plots->linear, &plots->buffer, error));
    WEFT_TRY(make_target(shown, size, &plots->shown, &plots->shown_buffer, error));
    return weft_gl_program("plots", vertex, present, &plots->program, error);
}

void weft_probe_plots_free(weft_probe_plots *plots)
{
    glUseProgram(0); /* a program in use would outlive its deletion */
    glDeleteFramebuffers(1, &plots->buffer);
    glDeleteFramebuffers(1, &plots->shown_buffer);
    glDeleteTextures(1, &plots->linear);
    glDeleteTextures(1, &plots->shown);
    glDeleteVertexArrays(1, &plots->vertex_array);
    glDeleteProgram(plots->program);
    *plots = (weft_probe_plots){0};
}

/* Pixels of a plot that are drawn, and where the plot begins. */
typedef struct plot_window {
    int left, width, height; /* pixels */
    double origin_x, origin_y, size;
} plot_window;

static weft_code draw_plot(weft_player *p, const weft_scene *scene, const weft_probe *probe, int plot,
                           const plot_window *window, weft_error *error)
{
    GLuint program;
    weft_scene alone = *scene;
    alone.environment = alone.shadows = alone.show_level = alone.show_extrapolation = false;
    alone.light_count = 1;
    alone.filter = WEFT_FILTER_EXACT;
    const weft_pane pane = {probe->mode, window->left, window->width, window->height, {.frame = 0}};
    weft_variant variant = weft_player_variant(p, &alone, &pane);
    variant.plot = plot;
    WEFT_TRY(weft_programs_find(&p->programs, &variant, &program, error));
    glViewport(pane.left, 0, pane.width, pane.height);
    glUseProgram(program);
    weft_player_bind_mode(p, &alone, probe->mode, program);
    weft_gl_set_vec2(program, "pane_origin", window->origin_x, window->origin_y);
    weft_gl_set_vec3(program, "probe_light", probe->light.x, probe->light.y, probe->light.z);
    weft_gl_set_vec3(program, "probe_view", probe->view.x, probe->view.y, probe->view.z);
    weft_gl_set_vec3(program, "probe_place", probe->u, probe->v, probe->level);
    weft_gl_set_float(program, "plot_size", window->size);
    weft_gl_set_float(program, "exposure", scene->exposure);
    weft_gl_set_int(program, "show_level", 0);
    weft_gl_set_int(program, "show_extrapolation", 0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return WEFT_OK;
}

static weft_code draw_disc(const weft_probe_plots *plots, weft_player *p, const weft_scene *scene,
                           const weft_probe *probe, int plot, weft_error *error)
{
    int left = (plot - 1) * plots->size;
    const plot_window window = {left, plots->size, plots->size, left, 0, plots->size};
    return draw_plot(p, scene, probe, plot, &window, error);
}

/* A disc of one pixel across, moved so that the light of the probe falls on the centre of the pixel that is drawn: it
 * lies at x, y times sqrt(1 - z) / sin theta, from -1 to 1. */
static plot_window window_at_light(const weft_probe *probe)
{
    double x = (double)probe->light.x, y = (double)probe->light.y, across = hypot(x, y);
    double scale = across > 0 ? sqrt(fmax(0, 1 - (double)probe->light.z)) / across : 0;
    return (plot_window){0, 1, 1, 0.5 - (1 + scale * x) / 2, 0.5 - (1 + scale * y) / 2, 1};
}

weft_code weft_probe_value(weft_probe_plots *plots, weft_player *p, const weft_scene *scene, const weft_probe *probe,
                           double value[3], weft_error *error)
{
    const plot_window window = window_at_light(probe);
    weft_scene unexposed = *scene;
    float pixel[4];
    unexposed.exposure = 1;
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(plots->vertex_array);
    glBindFramebuffer(GL_FRAMEBUFFER, plots->buffer);
    WEFT_TRY(draw_plot(p, &unexposed, probe, 1, &window, error));
    read_pixel(plots->buffer, GL_COLOR_ATTACHMENT0, 0, 0, pixel);
    for (int c = 0; c < 3; c++)
        value[c] = (double)pixel[c];
    return weft_gl_check("evaluating a texel", error);
}

weft_code weft_probe_plots_draw(weft_probe_plots *plots, weft_player *p, const weft_scene *scene,
                                const weft_probe *probe, weft_error *error)
{
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(plots->vertex_array);
    glBindFramebuffer(GL_FRAMEBUFFER, plots->buffer);
    for (int plot = 1; plot <= 2; plot++)
        WEFT_TRY(draw_disc(plots, p, scene, probe, plot, error));
    glBindFramebuffer(GL_FRAMEBUFFER, plots->shown_buffer);
    glViewport(0, 0, 2 * plots->size, plots->size);
    glUseProgram(plots->program);
    weft_gl_set_float(plots->program, "frame_share", 1);
    weft_gl_set_int(plots->program, "left", 0);
    weft_gl_set_int(plots->program, "tone", scene->tone);
    weft_gl_set_int(plots->program, "difference", 0);
    weft_gl_set_float(plots->program, "divider", -1);
    weft_gl_set_int(plots->program, "keeps_opacity", 1);
    weft_gl_bind(plots->program, "sum", 0, GL_TEXTURE_2D, plots->linear);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return weft_gl_check("drawing plots", error);
}
