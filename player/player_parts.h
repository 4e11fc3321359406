/* The inside of weft_player, shared by the files that make it. */
#ifndef WEFT_PLAYER_PLAYER_PARTS_H
#define WEFT_PLAYER_PLAYER_PARTS_H

#include "player/material_texture.h"
#include "player/overlay.h"
#include "player/player.h"
#include "player/raw_texture.h"
#include "player/weave_texture.h"

struct weft_player {
    /* Mesh */
    GLuint vertex_array, vertex_buffer, index_buffer;
    GLsizei index_count;
    weft_vec3 centre;
    double radius;
    /* What may lie on it */
    bool has[WEFT_MODE_COUNT];
    weft_raw_texture raw;
    weft_material_texture material;
    weft_weave_texture weave;
    double texel_count[WEFT_MODE_COUNT][2]; /* of level 0, for one material */
    /* Programs */
    GLuint shade[WEFT_MODE_COUNT], background, geometry;
    GLuint empty_array;
    weft_overlay overlay;
};

/* Uses `program` and sets what player/shaders/surface.glsl needs; the picture has the given aspect. */
void weft_player_set_surface(const weft_player *player, GLuint program, const weft_scene *scene, weft_mode mode,
                             double aspect, double shift_x, double shift_y, double level_bias);

/* Draws the mesh with the program in use. */
void weft_player_draw_mesh(const weft_player *player);

/* Errors: WEFT_BAD_USAGE unless a mesh and the mode are there. */
weft_code weft_player_check_mode(const weft_player *player, weft_mode mode, weft_error *error);

#endif
