/* What every file of the player that speaks OpenGL shares: errors, programs, textures. A context must be current. */
#ifndef WEFT_PLAYER_GL_GL_H
#define WEFT_PLAYER_GL_GL_H

#include "base/status.h"

#include <epoxy/gl.h>
#include <stdbool.h>

/* Reports and clears OpenGL's error flags, and the first uniform that was set though its program does not declare it.
 * Errors: WEFT_SYSTEM "OpenGL: invalid operation while ACTION". */
weft_code weft_gl_check(const char *action, weft_error *error);

/* Vertex attributes of every program, by location. */
enum { WEFT_ATTRIBUTE_POSITION, WEFT_ATTRIBUTE_NORMAL, WEFT_ATTRIBUTE_TANGENT, WEFT_ATTRIBUTE_COORDINATE };

/* Compiles and links a program from parts (NULL-terminated arrays of source text), for GLSL 3.30 core or GLSL ES 3.00
 * as the context has it; #version and precisions are put in front. The caller deletes *program. Errors: WEFT_SYSTEM
 * with the first line of the compiler's complaint, or for more than 15 parts. */
weft_code weft_gl_program(const char *name, const char *const *vertex, const char *const *fragment, GLuint *program,
                          weft_error *error);

/* The location of a uniform; -1 where the compiler removed it, and setting it does nothing. A name that no shader of
 * the program declares is an error: the next weft_gl_check names it. */
GLint weft_gl_uniform(GLuint program, const char *name);

/* Uniforms by name, of the program in use; names are checked likewise. */
void weft_gl_set_int(GLuint program, const char *name, int value);
void weft_gl_set_float(GLuint program, const char *name, double value);
void weft_gl_set_vec2(GLuint program, const char *name, double x, double y);
void weft_gl_set_vec3(GLuint program, const char *name, double x, double y, double z);
void weft_gl_set_vec4(GLuint program, const char *name, double x, double y, double z, double w);

/* Binds a texture to a unit and tells the sampler `name`. */
void weft_gl_bind(GLuint program, const char *name, int unit, GLenum target, GLuint texture);

/* A texture of one level, fetched by texel: nearest, clamped. `layers` 0 makes a 2D texture, otherwise an array. `data`
 * may be NULL. `layout` 0 makes an array of compressed blocks, filled later. Bound to the active unit on return.
 * Errors: WEFT_SYSTEM where the size is over the driver's limit or memory. The caller deletes *texture. */
typedef struct weft_texture_format {
    GLenum internal, layout, type;
} weft_texture_format;
weft_code weft_gl_texture(weft_texture_format format, int width, int height, int layers, const void *data,
                          GLuint *texture, weft_error *error);

/* Limits of the driver. */
int weft_gl_max_size(void);
int weft_gl_max_layers(void);

/* The driver decodes player/raw/bc6h.h: part of OpenGL 4.2, an extension of 3.3 and of ES 3.0. */
bool weft_gl_has_bc6h(void);

#endif
