/* The inside of weft_player, shared by the files that make it. */
#ifndef WEFT_PLAYER_DRAW_PLAYER_PARTS_H
#define WEFT_PLAYER_DRAW_PLAYER_PARTS_H

#include "player/draw/player.h"
#include "player/draw/programs.h"
#include "player/draw/shadow.h"
#include "player/gl/label.h"
#include "player/gl/layer.h"
#include "player/raw/texture.h"
#include "player/scene/environment.h"
#include "player/texture/material_texture.h"
#include "player/texture/weave_texture.h"
#include "reflectance/lafortune/lafortune.h"

enum { WEFT_LAYER_COUNT = 2 };

/* Directions that make a whole sum, at full detail. */
enum { WEFT_GROUND_DIRECTIONS = 256 };

/* What the mesh hides of a distant light from the level ground that it stands on: a picture of the ground, summed over
 * directions of the light. It does not depend on the camera, so it is kept from frame to frame. Zeroed, it has no
 * directions. */
typedef struct weft_ground_shadow {
    GLuint buffer, depth, hidden; /* hidden: how many directions the mesh hides */
    int side;                     /* of the picture, texels */
    int count, whole;             /* directions summed, and in a whole sum */
    double light[3];              /* what light it is of, in the user's own terms */
    weft_vec3 middle;             /* of the ground that the sum covers, a square */
    double half_side;
} weft_ground_shadow;

/* On the ground: the first light of the scene, and all other light. */
enum { WEFT_GROUND_LIGHTS = 2 };

/* Which holes let light through, and how close they lie. */
typedef struct weft_shadow_holes {
    bool any, relief;
    weft_mode mode;
    double repeat[2]; /* materials for a unit of the mesh's coordinates */
} weft_shadow_holes;

struct weft_player {
    /* Mesh */
    GLuint vertex_array, vertex_buffer, index_buffer;
    int triangle_count, coarse_count; /* coarse ones come after the others (player/mesh/mesh.h) */
    weft_vec3 centre;
    double radius, lowest_z, highest_z;
    /* What may lie on it */
    bool has[WEFT_MODE_COUNT];
    weft_raw_texture raw;
    weft_material_texture material;
    weft_table_directions directions; /* of its tables */
    weft_weave_texture weave;         /* or, where there is a table of them, threads */
    weft_thread_texture threads;
    long weave_revision;
    double texel_count[WEFT_MODE_COUNT][2]; /* of level 0, for one material */
    double last_ring_z[WEFT_MODE_COUNT][2]; /* smallest z of the measured views and lights */
    /* Light */
    weft_environment *environment; /* or NULL */
    GLuint environment_map;
    weft_shadow_map shadow;
    weft_ground_shadow ground_shadow[WEFT_GROUND_LIGHTS];
    weft_shadow_holes shadow_holes; /* that both were drawn with */
    /* Programs */
    weft_programs programs;
    GLuint background, environment_background, ground, copy;
    GLuint empty_array;
    weft_labels labels;
    weft_layer layer[WEFT_LAYER_COUNT]; /* the second lies behind the first */
    GLuint kept;                        /* picture of the first mode of a difference */
    int kept_width, kept_height;
    unsigned frames_drawn;
};

/* A pane of `width` x `height` pixels, `left` pixels from the left edge of the frame. */
typedef struct weft_pane {
    weft_mode mode;
    int left, width, height;
    weft_sampling sampling;
} weft_pane;

/* Draws the first `layer_count` layers of the pane into player->layer. Leaves another framebuffer bound. Errors:
 * WEFT_SYSTEM. */
weft_code weft_player_draw_layers(weft_player *player, const weft_scene *scene, const weft_pane *pane, int layer_count,
                                  weft_error *error);

/* Sets what player/draw/shaders/surface.glsl needs, `program` being in use. */
void weft_player_set_point(const weft_player *player, GLuint program, const weft_scene *scene, const weft_pane *pane,
                           const weft_layer *layer);

/* Runs the program in use on every pixel of the layer that shows the mesh, and on no other: a triangle at the far end
 * of the depth range passes where something is nearer. `target` is the framebuffer that is bound, with 24 bits of
 * depth. */
void weft_player_shade(const weft_player *player, const weft_pane *pane, const weft_layer *layer, GLuint target);

/* Which program shades a pane, and its textures and switches. */
weft_variant weft_player_variant(const weft_player *player, const weft_scene *scene, const weft_pane *pane);
void weft_player_bind_mode(const weft_player *player, const weft_scene *scene, weft_mode mode, GLuint program);

/* Whether the cloth of a mode has no holes. */
bool weft_player_is_opaque(const weft_player *player, weft_mode mode);

/* Which program draws the shadow of cloth of the mode, which has holes. Soft shadows are means over many frames: there
 * a neighbour at random will do, without heights. */
weft_variant weft_player_casting_variant(const weft_player *player, const weft_scene *scene, weft_mode mode,
                                         bool is_soft);

/* Where the random choices of a frame begin. Successive frames start a golden section apart: evenly spread, however
 * many there are. */
double weft_player_sequence(const weft_player *player, long frame);

/* The share of the directions of a soft shadow that a picture of this size needs, (0, 1]: a penumbra of few pixels has
 * few steps. 1 from 128 pixels on. Pure. */
double weft_player_shadow_detail(int width, int height);

/* Draws what the shadows of the frame need, if it has any; leaves another framebuffer bound. Light passes through the
 * holes of the cloth, as the first mode that is shown and has holes knows them. Errors: WEFT_SYSTEM. */
weft_code weft_player_draw_shadows(weft_player *player, const weft_scene *scene, long frame, weft_error *error);

/* Adds to what the mesh hides of the lights from the ground, if the scene shows that and it is not whole yet: a few
 * directions, or all that it lacks. It begins anew where lights, mesh or holes are others. Leaves another framebuffer
 * bound. Errors: WEFT_SYSTEM. */
weft_code weft_player_advance_ground(weft_player *player, const weft_scene *scene, const weft_pane *whole,
                                     weft_error *error);
weft_code weft_player_finish_ground(weft_player *player, const weft_scene *scene, int width, int height,
                                    weft_error *error);

void weft_ground_shadow_free(weft_ground_shadow *shadow);

/* The program that draws the ground of a pane behind the mesh is in use then. */
void weft_player_use_ground(const weft_player *player, const weft_scene *scene, const weft_pane *pane);

/* What was drawn of shadows is drawn again. */
void weft_player_forget_shadows(weft_player *player);

/* Lets light through the holes that the scene shows, from now on. */
void weft_player_take_holes(weft_player *player, const weft_scene *scene);

/* The program that draws the mesh as it casts shadows, and what it needs, in use, but for its clip_of_world.
 * `sequence`: as weft_player_sequence has it. Errors: WEFT_SYSTEM. */
weft_code weft_player_find_caster(weft_player *player, const weft_scene *scene, bool is_soft, GLuint *program,
                                  weft_error *error);
void weft_player_set_caster(const weft_player *player, const weft_scene *scene, weft_vec3 light, double sequence,
                            GLuint program);

/* The triangles of the mesh; coarse ones where it has some. */
void weft_player_draw_mesh(const weft_player *player, bool coarse);

/* Sets the rays through the pixels of a pane, `program` being in use. */
void weft_player_set_rays(GLuint program, const weft_scene *scene, const weft_pane *pane);

/* Shows `texture`, which is taken. last_ring_z: the smallest z of the views and of the lights. */
void weft_player_take_raw(weft_player *player, weft_raw_texture *texture, const double last_ring_z[2]);

/* The smallest z of directions, 1 without any. Pure. */
double weft_player_last_ring_z(const weft_vec3 *direction, int count);

/* Draws the scale of a signed difference into it as differences: in the lower left corner of a picture of width x
 * height pixels that holds differences (the framebuffer in use), colours from -WEFT_SCENE_FULL_DIFFERENCE to it, and in
 * words what they say of `second`. Nothing where the picture is too small. Errors: WEFT_SYSTEM. */
weft_code weft_legend_draw(weft_labels *labels, int width, int height, weft_mode second, weft_error *error);

/* Errors: WEFT_BAD_USAGE unless a mesh and the mode are there. */
weft_code weft_player_check_mode(const weft_player *player, weft_mode mode, weft_error *error);

#endif
