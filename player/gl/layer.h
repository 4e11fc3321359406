/* One layer of the mesh as the eye sees it: for every pixel, the axes of the surface and its place on the material. The
 * shading then runs once a pixel, whatever the triangles and however many lie behind each other. */
#ifndef WEFT_PLAYER_GL_LAYER_H
#define WEFT_PLAYER_GL_LAYER_H

#include "player/gl/gl.h"

typedef struct weft_layer {
    int width, height;
    GLuint buffer, rotation, place, sides,
        depth; /* player/draw/shaders/surface.frag.glsl says what the textures hold */
} weft_layer;

/* Makes the layer at least this large. The caller frees with weft_layer_free, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_layer_resize(weft_layer *layer, int width, int height, weft_error *error);
void weft_layer_free(weft_layer *layer);

/* Texture units of the samplers that a picture has and a plot has not. */
enum { WEFT_ROTATION_UNIT = 12, WEFT_PLACE_UNIT = 13, WEFT_SHADOW_UNIT = 14, WEFT_SIDES_UNIT = 15 };

/* Sets surface_rotation, surface_place and surface_sides of player/draw/shaders/surface.glsl. */
void weft_layer_bind(const weft_layer *layer, GLuint program);

#endif
