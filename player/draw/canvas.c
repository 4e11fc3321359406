#include "player/draw/canvas.h"

#include "player/gl/shaders.h"

#include <math.h>
#include <stdlib.h>

static const weft_texture_format float_format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};

static weft_code check_framebuffer(weft_error *error)
{
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver does not draw into float textures (0x%x)", status);
    return weft_gl_check("making a canvas", error);
}

/* The two buffers share their depth: only one of them is drawn into at a time. */
static weft_code create_buffer(const weft_canvas *c, GLuint *buffer, GLuint *texture, weft_error *error)
{
    WEFT_TRY(weft_gl_texture(float_format, c->width, c->height, 0, NULL, texture, error));
    glGenFramebuffers(1, buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, *buffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *texture, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, c->depth);
    return check_framebuffer(error);
}

weft_code weft_canvas_create(int width, int height, weft_canvas *c, weft_error *error)
{
    const char *const vertex[] = {weft_glsl_fullscreen_vert, NULL};
    const char *const add[] = {weft_glsl_add_frag, NULL}, *const present[] = {weft_glsl_present_frag, NULL};
    const char *const enlarge[] = {weft_glsl_enlarge_frag, NULL};
    *c = (weft_canvas){.width = width, .height = height};
    glGenVertexArrays(1, &c->vertex_array);
    glGenRenderbuffers(1, &c->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, c->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    WEFT_TRY(create_buffer(c, &c->frame_buffer, &c->frame, error));
    WEFT_TRY(create_buffer(c, &c->sum_buffer, &c->sum, error));
    WEFT_TRY(weft_gl_program("add", vertex, add, &c->add_program, error));
    WEFT_TRY(weft_gl_program("enlarge", vertex, enlarge, &c->enlarge_program, error));
    WEFT_TRY(weft_gl_program("present", vertex, present, &c->present_program, error));
    weft_canvas_clear(c);
    return WEFT_OK;
}

void weft_canvas_free(weft_canvas *c)
{
    glUseProgram(0); /* a program in use would outlive its deletion */
    glDeleteFramebuffers(1, &c->frame_buffer);
    glDeleteFramebuffers(1, &c->sum_buffer);
    glDeleteRenderbuffers(1, &c->depth);
    glDeleteTextures(1, &c->frame);
    glDeleteTextures(1, &c->sum);
    glDeleteVertexArrays(1, &c->vertex_array);
    glDeleteProgram(c->add_program);
    glDeleteProgram(c->enlarge_program);
    glDeleteProgram(c->present_program);
    *c = (weft_canvas){0};
}

void weft_canvas_clear(weft_canvas *c)
{
    c->frame_count = 0;
}

void weft_canvas_begin_frame(weft_canvas *c)
{
    glBindFramebuffer(GL_FRAMEBUFFER, c->frame_count > 0 ? c->frame_buffer : c->sum_buffer);
    glViewport(0, 0, c->width, c->height);
    c->drawn_width = c->width;
    c->drawn_height = c->height;
}

static int side_of(int whole, double share)
{
    int side = (int)lround(share * whole);
    return side < 1 ? 1 : side < whole ? side : whole;
}

void weft_canvas_begin_small_frame(weft_canvas *c, double side)
{
    weft_canvas_clear(c);
    c->drawn_width = side_of(c->width, side);
    c->drawn_height = side_of(c->height, side);
    glBindFramebuffer(GL_FRAMEBUFFER, c->frame_buffer);
    glViewport(0, 0, c->drawn_width, c->drawn_height);
}

/* With the program in use. */
static void draw_over_everything(const weft_canvas *c, int left, GLuint program, const char *sampler, GLuint texture)
{
    glViewport(left, 0, c->width, c->height);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(c->vertex_array);
    weft_gl_bind(program, sampler, 0, GL_TEXTURE_2D, texture);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindTexture(GL_TEXTURE_2D, 0);
}

static void enlarge_frame(const weft_canvas *c)
{
    glBindFramebuffer(GL_FRAMEBUFFER, c->sum_buffer);
    glDisable(GL_BLEND);
    glUseProgram(c->enlarge_program);
    weft_gl_set_vec2(c->enlarge_program, "drawn", c->drawn_width, c->drawn_height);
    weft_gl_set_vec2(c->enlarge_program, "enlarged", c->width, c->height);
    draw_over_everything(c, 0, c->enlarge_program, "frame", c->frame);
}

static bool is_small(const weft_canvas *c)
{
    return c->drawn_width < c->width || c->drawn_height < c->height;
}

void weft_canvas_end_frame(weft_canvas *c)
{
    if (is_small(c))
        enlarge_frame(c);
    if (c->frame_count++ == 0)
        return;
    glBindFramebuffer(GL_FRAMEBUFFER, c->sum_buffer);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(c->add_program);
    draw_over_everything(c, 0, c->add_program, "frame", c->frame);
    glDisable(GL_BLEND);
}

void weft_canvas_present(const weft_canvas *c, const weft_scene *scene, int left)
{
    glDisable(GL_BLEND);
    glUseProgram(c->present_program);
    weft_gl_set_float(c->present_program, "frame_share", 1.0 / (c->frame_count > 0 ? c->frame_count : 1));
    weft_gl_set_int(c->present_program, "tone", scene->tone);
    weft_gl_set_int(c->present_program, "difference", scene->layout == WEFT_LAYOUT_DIFFERENCE);
    weft_gl_set_float(c->present_program, "full_difference", (double)WEFT_SCENE_FULL_DIFFERENCE);
    weft_gl_set_float(c->present_program, "divider", scene->layout == WEFT_LAYOUT_WIPE ? scene->divider : -1);
    weft_gl_set_int(c->present_program, "left", left);
    draw_over_everything(c, left, c->present_program, "sum", c->sum);
}

weft_code weft_canvas_read(const weft_canvas *c, weft_image *image, weft_error *error)
{
    size_t row = (size_t)c->width * 4;
    float *rgba = malloc(row * (size_t)c->height * sizeof *rgba);
    if (!rgba)
        return weft_fail_memory(error, "picture", row * (size_t)c->height * sizeof *rgba);
    glBindFramebuffer(GL_FRAMEBUFFER, c->sum_buffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, c->width, c->height, GL_RGBA, GL_FLOAT, rgba);
    weft_code code = weft_gl_check("reading the picture", error);
    if (code == WEFT_OK)
        code = weft_image_create(c->width, c->height, image, error);
    for (int y = 0; code == WEFT_OK && y < c->height; y++) {
        const float *source = rgba + (size_t)(c->height - 1 - y) * row;
        for (int x = 0; x < c->width; x++) {
            for (int i = 0; i < 3; i++)
                image->pixels[3 * ((size_t)y * (size_t)c->width + (size_t)x) + (size_t)i] =
                    source[4 * x + i] / (float)c->frame_count;
        }
    }
    free(rgba);
    return code;
}
