#include "player/draw/shadow.h"

#include "player/gl/shaders.h"

#include <math.h>
#include <string.h>

enum { SIDE = 1024 };

weft_code weft_shadow_map_create(weft_shadow_map *map, weft_error *error)
{
    const weft_texture_format format = {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT};
    const char *const vertex[] = {weft_glsl_surface_vert, NULL}, *const fragment[] = {weft_glsl_depth_frag, NULL};
    *map = (weft_shadow_map){0};
    WEFT_TRY(weft_gl_program("shadow", vertex, fragment, &map->program, error));
    WEFT_TRY(weft_gl_texture(format, SIDE, SIDE, WEFT_SHADOW_LAYERS, NULL, &map->depth, error));
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glGenFramebuffers(1, &map->buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, map->buffer);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, map->depth, 0, 0);
    glDrawBuffers(1, (const GLenum[]){GL_NONE});
    glReadBuffer(GL_NONE);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver does not draw into depth textures");
    return weft_gl_check("making a shadow map", error);
}

void weft_shadow_map_free(weft_shadow_map *map)
{
    glDeleteFramebuffers(1, &map->buffer);
    glDeleteTextures(1, &map->depth);
    glDeleteProgram(map->program);
    *map = (weft_shadow_map){0};
}

static void set_row(float matrix[16], int row, weft_vec3 axis, double scale, weft_vec3 centre, double constant)
{
    matrix[row] = (float)((double)axis.x * scale);
    matrix[4 + row] = (float)((double)axis.y * scale);
    matrix[8 + row] = (float)((double)axis.z * scale);
    matrix[12 + row] = (float)(constant - scale * (double)weft_dot(axis, centre));
}

/* `size` is the side of the ball in what the matrix leads to, `middle` the place of its centre. */
static void look_along(weft_vec3 light, weft_vec3 centre, double radius, double size, double middle, float matrix[16])
{
    weft_vec3 aside = fabs((double)light.z) < 0.9 ? weft_vec3_of(0, 0, 1) : weft_vec3_of(1, 0, 0);
    weft_vec3 right = weft_unit(weft_cross(aside, light)), up = weft_cross(light, right);
    double scale = size / (2 * radius);
    memset(matrix, 0, 16 * sizeof *matrix);
    set_row(matrix, 0, right, scale, centre, middle);
    set_row(matrix, 1, up, scale, centre, middle);
    set_row(matrix, 2, light, -scale, centre, middle);
    matrix[15] = 1;
}

void weft_shadow_map_forget(weft_shadow_map *map)
{
    memset(map->light, 0, sizeof map->light);
}

bool weft_shadow_map_begin(weft_shadow_map *map, int layer, bool is_soft, weft_vec3 light, weft_vec3 centre,
                           double radius, GLuint program)
{
    int side = is_soft ? SIDE / 2 : SIDE;
    weft_vec3 change = weft_subtract(light, map->light[layer]);
    if (weft_dot(change, change) == 0 && map->share[layer] >= (float)side / SIDE)
        return false;
    map->light[layer] = light;
    map->share[layer] = (float)side / SIDE;
    map->texel = 2 * 1.01 * radius / SIDE;
    float clip_of_world[16];
    look_along(light, centre, 1.01 * radius, 2, 0, clip_of_world);
    look_along(light, centre, 1.01 * radius, 1, 0.5, map->of_world[layer]);
    glBindFramebuffer(GL_FRAMEBUFFER, map->buffer);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, map->depth, 0, layer);
    glViewport(0, 0, side, side);
    glScissor(0, 0, side, side);
    glEnable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    /* Both sides of a thin cloth are lit: its depth is moved away from the light by its slope and a little more. */
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(2.5f, 16);
    glUseProgram(program);
    glUniformMatrix4fv(weft_gl_uniform(program, "clip_of_world"), 1, GL_FALSE, clip_of_world);
    return true;
}

void weft_shadow_map_end(void)
{
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_TEST);
}

void weft_shadow_map_bind(const weft_shadow_map *map, GLuint program, int unit)
{
    weft_gl_bind(program, "shadow_map", unit, GL_TEXTURE_2D_ARRAY, map->depth);
    weft_gl_set_float(program, "shadow_texel", map->texel);
    glUniform1fv(weft_gl_uniform(program, "shadow_share"), WEFT_SHADOW_LAYERS, map->share);
    glUniformMatrix4fv(weft_gl_uniform(program, "shadow_of_world"), WEFT_SHADOW_LAYERS, GL_FALSE, map->of_world[0]);
}
