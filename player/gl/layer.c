#include "player/gl/layer.h"

static weft_code attach(GLenum attachment, GLuint texture, weft_error *error)
{
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
    return weft_gl_check("making a layer", error);
}

weft_code weft_layer_resize(weft_layer *layer, int width, int height, weft_error *error)
{
    const weft_texture_format float_format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    const weft_texture_format half_format = {GL_RGBA16F, GL_RGBA, GL_FLOAT};
    const weft_texture_format depth_format = {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT};
    if (layer->width >= width && layer->height >= height)
        return WEFT_OK;
    weft_layer_free(layer);
    WEFT_TRY(weft_gl_texture(float_format, width, height, 0, NULL, &layer->rotation, error));
    WEFT_TRY(weft_gl_texture(float_format, width, height, 0, NULL, &layer->place, error));
    WEFT_TRY(weft_gl_texture(half_format, width, height, 0, NULL, &layer->sides, error));
    WEFT_TRY(weft_gl_texture(depth_format, width, height, 0, NULL, &layer->depth, error));
    glGenFramebuffers(1, &layer->buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, layer->buffer);
    WEFT_TRY(attach(GL_COLOR_ATTACHMENT0, layer->rotation, error));
    WEFT_TRY(attach(GL_COLOR_ATTACHMENT1, layer->place, error));
    WEFT_TRY(attach(GL_COLOR_ATTACHMENT2, layer->sides, error));
    WEFT_TRY(attach(GL_DEPTH_ATTACHMENT, layer->depth, error));
    glDrawBuffers(3, (const GLenum[]){GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2});
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver does not draw into three float textures");
    layer->width = width;
    layer->height = height;
    return WEFT_OK;
}

void weft_layer_free(weft_layer *layer)
{
    glDeleteFramebuffers(1, &layer->buffer);
    glDeleteTextures(1, &layer->rotation);
    glDeleteTextures(1, &layer->place);
    glDeleteTextures(1, &layer->sides);
    glDeleteTextures(1, &layer->depth);
    *layer = (weft_layer){0};
}

void weft_layer_bind(const weft_layer *layer, GLuint program)
{
    weft_gl_bind(program, "surface_rotation", WEFT_ROTATION_UNIT, GL_TEXTURE_2D, layer->rotation);
    weft_gl_bind(program, "surface_place", WEFT_PLACE_UNIT, GL_TEXTURE_2D, layer->place);
    weft_gl_bind(program, "surface_sides", WEFT_SIDES_UNIT, GL_TEXTURE_2D, layer->sides);
}
