#include "player/gl/gl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The first uniform that was set and that no shader of its program declares; until weft_gl_check reports it. */
static _Thread_local char undeclared[64];

static const char *error_name(GLenum code)
{
    switch (code) {
    case GL_INVALID_ENUM:
        return "invalid enum";
    case GL_INVALID_VALUE:
        return "invalid value";
    case GL_INVALID_OPERATION:
        return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY:
        return "out of memory";
    default:
        return "unknown error";
    }
}

weft_code weft_gl_check(const char *action, weft_error *error)
{
    GLenum first = glGetError();
    if (first == GL_NO_ERROR && !undeclared[0])
        return WEFT_OK;
    /* A lost context reports for ever. */
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; i++)
        continue;
    if (undeclared[0]) {
        weft_error_set(error, WEFT_SYSTEM, "no shader declares the uniform '%s', which is set while %s", undeclared,
                       action);
        undeclared[0] = 0;
        return WEFT_SYSTEM;
    }
    return weft_fail(error, WEFT_SYSTEM, "OpenGL: %s while %s", error_name(first), action);
}

/* ---- Programs ---- */

enum { MAX_PARTS = 16 };

static const char *preamble(void)
{
    return epoxy_is_desktop_gl()
               ? "#version 330 core\n"
               : "#version 300 es\n"
                 "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
                 "precision highp sampler2DArray;\nprecision highp sampler3D;\nprecision highp isampler2D;\n"
                 "precision highp usampler2DArray;\n";
}

static const char *stage_name(GLenum stage)
{
    return stage == GL_VERTEX_SHADER ? "vertex" : "fragment";
}

static weft_code fail_log(const char *name, const char *stage, char *log, weft_error *error)
{
    log[strcspn(log, "\n")] = '\0';
    return weft_fail(error, WEFT_SYSTEM, "the %s shader of '%s' does not %s", stage, name, log[0] ? log : "compile");
}

static weft_code compile(const char *name, GLenum stage, const char *const *part, GLuint *shader, weft_error *error)
{
    const char *source[MAX_PARTS] = {preamble()};
    int count = 1;
    for (; *part; part++) {
        if (count == MAX_PARTS)
            return weft_fail(error, WEFT_SYSTEM, "the %s shader of '%s' has more than %d parts", stage_name(stage),
                             name, MAX_PARTS - 1);
        source[count++] = *part;
    }
    *shader = glCreateShader(stage);
    glShaderSource(*shader, count, source, NULL);
    glCompileShader(*shader);
    GLint compiled;
    glGetShaderiv(*shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return WEFT_OK;
    char log[400] = "compile: ";
    size_t used = strlen(log);
    glGetShaderInfoLog(*shader, (GLsizei)(sizeof log - used), NULL, log + used);
    return fail_log(name, stage_name(stage), log, error);
}

static weft_code link(const char *name, GLuint program, GLuint vertex, GLuint fragment, weft_error *error)
{
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glBindAttribLocation(program, WEFT_ATTRIBUTE_POSITION, "position");
    glBindAttribLocation(program, WEFT_ATTRIBUTE_NORMAL, "normal");
    glBindAttribLocation(program, WEFT_ATTRIBUTE_TANGENT, "tangent");
    glBindAttribLocation(program, WEFT_ATTRIBUTE_COORDINATE, "coordinate");
    glLinkProgram(program);
    GLint linked;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked)
        return WEFT_OK;
    char log[400] = "link: ";
    size_t used = strlen(log);
    glGetProgramInfoLog(program, (GLsizei)(sizeof log - used), NULL, log + used);
    return fail_log(name, "linked", log, error);
}

weft_code weft_gl_program(const char *name, const char *const *vertex, const char *const *fragment, GLuint *program,
                          weft_error *error)
{
    GLuint vertex_shader = 0, fragment_shader = 0;
    *program = glCreateProgram();
    weft_code code = compile(name, GL_VERTEX_SHADER, vertex, &vertex_shader, error);
    if (code == WEFT_OK)
        code = compile(name, GL_FRAGMENT_SHADER, fragment, &fragment_shader, error);
    if (code == WEFT_OK)
        code = link(name, *program, vertex_shader, fragment_shader, error);
    glDeleteShader(vertex_shader);
    glDeleteShader(fragment_shader);
    if (code != WEFT_OK) {
        glDeleteProgram(*program);
        *program = 0;
        weft_gl_check("building a program", NULL);
    }
    return code;
}

/* ---- Uniforms ---- */

/* Where `word` stands in the text by itself, or NULL. */
static const char *find_word(const char *text, const char *word, size_t length)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    const char *at = strstr(text, word);
    while (at && ((at > text && strchr(letters, at[-1])) || (at[length] && strchr(letters, at[length]))))
        at = strstr(at + 1, word);
    return at;
}

/* Whether a declaration "uniform ...;" of the text has the name. */
static bool declares(char *text, const char *name)
{
    bool found = false;
    for (const char *at = find_word(text, "uniform", 7); at && !found; at = find_word(at, "uniform", 7)) {
        char *end = strchr(at, ';');
        if (!end)
            break;
        *end = 0;
        found = find_word(at, name, strlen(name)) != NULL;
        at = end + 1;
    }
    return found;
}

static bool shader_declares(GLuint shader, const char *name)
{
    GLint size = 0;
    glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &size);
    char *text = calloc((size_t)size + 1, 1);
    if (!text)
        return true;
    glGetShaderSource(shader, size, NULL, text);
    bool found = declares(text, name);
    free(text);
    return found;
}

/* Compilers remove what no pixel needs; only a name that the text does not have either is wrong. */
static void note_undeclared(GLuint program, const char *name)
{
    GLuint shader[2];
    GLsizei count = 0;
    char array[sizeof undeclared];
    snprintf(array, sizeof array, "%.*s", (int)strcspn(name, "["), name);
    glGetAttachedShaders(program, 2, &count, shader);
    for (GLsizei i = 0; i < count; i++)
        if (shader_declares(shader[i], array))
            return;
    if (!undeclared[0])
        memcpy(undeclared, array, sizeof undeclared);
}

GLint weft_gl_uniform(GLuint program, const char *name)
{
    GLint location = glGetUniformLocation(program, name);
    if (location < 0)
        note_undeclared(program, name);
    return location;
}

void weft_gl_set_int(GLuint program, const char *name, int value)
{
    glUniform1i(weft_gl_uniform(program, name), value);
}

void weft_gl_set_float(GLuint program, const char *name, double value)
{
    glUniform1f(weft_gl_uniform(program, name), (float)value);
}

void weft_gl_set_vec2(GLuint program, const char *name, double x, double y)
{
    glUniform2f(weft_gl_uniform(program, name), (float)x, (float)y);
}

void weft_gl_set_vec3(GLuint program, const char *name, double x, double y, double z)
{
    glUniform3f(weft_gl_uniform(program, name), (float)x, (float)y, (float)z);
}

void weft_gl_set_vec4(GLuint program, const char *name, double x, double y, double z, double w)
{
    glUniform4f(weft_gl_uniform(program, name), (float)x, (float)y, (float)z, (float)w);
}

/* ---- Textures ---- */

void weft_gl_bind(GLuint program, const char *name, int unit, GLenum target, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(target, texture);
    weft_gl_set_int(program, name, unit);
}

int weft_gl_max_size(void)
{
    GLint size = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &size);
    return size;
}

int weft_gl_max_layers(void)
{
    GLint layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    return layers;
}

bool weft_gl_has_bc6h(void)
{
    int version = epoxy_gl_version();
    if (!epoxy_is_desktop_gl())
        return epoxy_has_gl_extension("GL_EXT_texture_compression_bptc");
    return version >= 42 || (epoxy_has_gl_extension("GL_ARB_texture_compression_bptc") &&
                             epoxy_has_gl_extension("GL_ARB_texture_storage"));
}

static void set_nearest(GLenum target)
{
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

weft_code weft_gl_texture(weft_texture_format format, int width, int height, int layers, const void *data,
                          GLuint *texture, weft_error *error)
{
    if (width > weft_gl_max_size() || height > weft_gl_max_size() || layers > weft_gl_max_layers())
        return weft_fail(error, WEFT_SYSTEM,
                         "this graphics driver holds textures up to %d x %d and %d layers; %d x %d and %d are needed",
                         weft_gl_max_size(), weft_gl_max_size(), weft_gl_max_layers(), width, height, layers);
    GLenum target = layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    glGenTextures(1, texture);
    glBindTexture(target, *texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (format.layout == 0)
        glTexStorage3D(target, 1, format.internal, width, height, layers);
    else if (layers > 0)
        glTexImage3D(target, 0, (GLint)format.internal, width, height, layers, 0, format.layout, format.type, data);
    else
        glTexImage2D(target, 0, (GLint)format.internal, width, height, 0, format.layout, format.type, data);
    set_nearest(target);
    return weft_gl_check("making a texture", error);
}
