#include "player/draw/ground_shadow.h"

#include <math.h>
#include <string.h>

enum { MAX_SIDE = 1024 };

void weft_ground_shadow_free(weft_ground_shadow *s)
{
    glDeleteFramebuffers(1, &s->buffer);
    glDeleteRenderbuffers(1, &s->depth);
    glDeleteTextures(1, &s->hidden);
    *s = (weft_ground_shadow){0};
}

static weft_code create(weft_ground_shadow *s, int side, weft_error *error)
{
    const weft_texture_format format = {GL_R16F, GL_RED, GL_HALF_FLOAT}; /* exact for whole numbers to 2048 */
    weft_ground_shadow_free(s);
    s->side = side;
    WEFT_TRY(weft_gl_texture(format, side, side, 0, NULL, &s->hidden, error));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glGenRenderbuffers(1, &s->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, s->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, side, side);
    glGenFramebuffers(1, &s->buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, s->hidden, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, s->depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver does not draw into textures of half floats");
    return weft_gl_check("making the shadow on the ground", error);
}

int weft_ground_shadow_directions(double detail)
{
    return (int)ceil(WEFT_GROUND_DIRECTIONS * detail);
}

weft_code weft_ground_shadow_clear(weft_ground_shadow *s, weft_vec3 middle, double half_side, double detail,
                                   weft_error *error)
{
    int side = (int)ceil(MAX_SIDE * detail);
    if (s->side != side)
        WEFT_TRY(create(s, side, error));
    s->count = 0;
    s->whole = weft_ground_shadow_directions(detail);
    s->middle = middle;
    s->half_side = half_side;
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    return WEFT_OK;
}

/* Of the n-th of a sequence that fills the square of a texel evenly (Roberts' R2), -1/2 to 1/2: edges of the sum are
 * smooth. */
static double shift_of(int n, double step)
{
    return fmod(0.5 + n * step, 1) - 0.5;
}

/* Down to the ground along the light. Column-major. All heights are as near: none is cut off. */
static void look_down(const weft_ground_shadow *s, weft_vec3 light, float matrix[16])
{
    double scale = 1 / s->half_side, texel = 2.0 / s->side;
    double slope[2] = {(double)(light.x / light.z), (double)(light.y / light.z)};
    const double middle[2] = {(double)s->middle.x, (double)s->middle.y};
    const double shift[2] = {shift_of(s->count, 0.7548776662466927), shift_of(s->count, 0.5698402909980532)};
    memset(matrix, 0, 16 * sizeof *matrix);
    for (int i = 0; i < 2; i++) {
        matrix[4 * i + i] = (float)scale;
        matrix[8 + i] = (float)(-slope[i] * scale);
        matrix[12 + i] = (float)(scale * (slope[i] * (double)s->middle.z - middle[i]) + shift[i] * texel);
    }
    matrix[15] = 1;
}

/* Each direction lies before the ones before it, and all of it at one depth: the first triangle of a place counts. */
void weft_ground_shadow_begin(weft_ground_shadow *s, weft_vec3 light, GLuint program)
{
    float clip_of_world[16], depth = 1 - (float)(s->count + 1) / (WEFT_GROUND_DIRECTIONS + 2);
    look_down(s, light, clip_of_world);
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glViewport(0, 0, s->side, s->side);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthRangef(depth, depth);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(program);
    glUniformMatrix4fv(weft_gl_uniform(program, "clip_of_world"), 1, GL_FALSE, clip_of_world);
}

void weft_ground_shadow_end(weft_ground_shadow *s)
{
    s->count++;
    glDepthRangef(0, 1);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
}
