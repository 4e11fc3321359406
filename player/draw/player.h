/* The player: one mesh under one light, with the measured samples, the compressed material and the analytic cloth on
 * it.
 *
 * Light is directional and its irradiance is pi on a surface that faces it, so that the picture shows reflectance:
 * radiance = BRDF x pi x cos(theta_light) x exposure. All functions need the OpenGL context that was current at
 * creation. */
#ifndef WEFT_PLAYER_DRAW_PLAYER_H
#define WEFT_PLAYER_DRAW_PLAYER_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "player/draw/canvas.h"
#include "player/mesh/mesh.h"
#include "player/scene/scene.h"
#include "player/texture/weave_texels.h"
#include "reflectance/microcylinder/microcylinder.h"

#include <stdbool.h>

typedef struct weft_player weft_player;

/* The caller frees with weft_player_free. Errors: WEFT_SYSTEM. */
weft_code weft_player_create(weft_player **result, weft_error *error);
void weft_player_free(weft_player *player);

/* What is shown; each may be set again. Nothing of the arguments is kept. Errors: WEFT_SYSTEM, WEFT_BAD_INPUT; what was
 * shown before then stays. */
weft_code weft_player_set_mesh(weft_player *player, const weft_mesh *mesh, weft_error *error);
weft_code weft_player_set_material(weft_player *player, const weft_material *material, weft_error *error);
/* As half floats or, where those do not fit, with a shared exponent, 0.2 % off. *skipped_levels receives the number of
 * finest levels that did not fit (0 where all did). */
weft_code weft_player_set_dataset(weft_player *player, weft_dataset *dataset, const weft_progress *progress,
                                  int *skipped_levels, weft_error *error);
/* Laid on one material, and repeated with it. */
weft_code weft_player_set_weave(weft_player *player, const weft_weave *weave, const weft_weave_layout *layout,
                                weft_error *error);
/* The same of what another thread has computed. */
weft_code weft_player_set_weave_texels(weft_player *player, const weft_weave_texels *texels,
                                       const weft_weave_layout *layout, weft_error *error);
/* Microcylinder cloth in the place of a weave. */
weft_code weft_player_set_threads(weft_player *player, const weft_microcylinder_cloth *cloth, weft_error *error);
/* Whether mode analytic shows that. */
bool weft_player_has_threads(const weft_player *player);
/* Grows whenever a weave or threads are set; 0: none yet. */
long weft_player_weave_revision(const weft_player *player);
/* Lays the weave that is there in another way. */
void weft_player_lay_weave(weft_player *player, const weft_weave_layout *layout);
/* How it was laid last. */
weft_weave_layout weft_player_weave_layout(const weft_player *player);

bool weft_player_has(const weft_player *player, weft_mode mode);
/* Takes the data of a mode away. */
void weft_player_clear(weft_player *player, weft_mode mode);
bool weft_player_has_mesh(const weft_player *player);

/* Bytes of graphics memory that the data of a mode take; 0 without it. */
size_t weft_player_bytes(const weft_player *player, weft_mode mode);

/* How the samples of raw are kept: "half floats", ...; "" where there are none. */
const char *weft_player_raw_format(const weft_player *player);
/* Number of components of the material; 0 without. */
int weft_player_layer_count(const weft_player *player);
/* How many of them draw it in this scene, which may ask for the first alone, or for lobes in their place: 0. All of
 * them where it has no lobes. */
int weft_player_drawn_components(const weft_player *player, const weft_scene *scene);
/* What the material has: how many lobes, -1 without a diffuse term either; and whether T and S. */
void weft_player_material_parts(const weft_player *player, int *lobe_count, bool *view_table, bool *light_table);
/* Largest measured angle of the views and lights of a mode, from the normal. */
void weft_player_last_ring(const weft_player *player, weft_mode mode, double *view_rad, double *light_rad);

/* Lights everything from `image`, where the scene asks for it (player/scene/environment.h says how the map lies, and
 * how many regions it may take); NULL takes the environment away. Errors: those of weft_environment_of_image; what was
 * there then stays. */
weft_code weft_player_set_environment(weft_player *player, const weft_image *image, int region_count,
                                      weft_error *error);
bool weft_player_has_environment(const weft_player *player);

/* How one frame samples its pixels. */
typedef struct weft_sampling {
    double shift_x, shift_y; /* of the picture, pixels */
    double level_bias;       /* added to the level of detail */
    /* A pixel that is so many times as long as wide on the material, or less, has the level of its width: frames of a
     * mean see places all along it. Below 1 as 1: the level of its length. */
    double longest_pixel;
    long frame; /* number of the frame in a mean; -1: a single frame, to be good by itself */
    /* Interleaved sampling of the environment (player/draw/lighting.h): a mean of few frames has grain instead of a
     * wrong brightness. A mean of many frames is smooth without it. */
    bool neighbours_differ;
    /* Fast and approximate: WEFT_FILTER_AUTO is stochastic, only the first 16 components are drawn, and two random
     * lights of the environment a pixel. */
    bool interactive;
} weft_sampling;

/* Draws into the current framebuffer, width x height pixels of floats: linear radiance, or the signed difference of two
 * modes where the layout is that. Every pane's mode must be there, and a mesh.
 * Errors: WEFT_BAD_USAGE where not; WEFT_SYSTEM. */
weft_code weft_player_draw(weft_player *player, const weft_scene *scene, int width, int height, weft_sampling sampling,
                           weft_error *error);

/* Draws the words of the scene alone, which weft_player_draw draws last, over a picture in the current framebuffer.
 * Errors: WEFT_SYSTEM. */
weft_code weft_player_draw_labels(weft_player *player, const weft_scene *scene, int width, int height,
                                  weft_error *error);

/* The picture as the mean of samples x samples frames on a grid within each pixel; linear (weft_scene_show makes it
 * what the screen shows). With environment_reference at least 128 frames, lit by all lights of the map. The caller
 * frees `image`. Errors: those of weft_player_draw; WEFT_BAD_USAGE for a size or number of samples out of range. */
weft_code weft_player_picture(weft_player *player, const weft_scene *scene, int width, int height, int samples,
                              const weft_progress *progress, weft_image *image, weft_error *error);

/* Whether the dataset or the material has heights (`weft relief`), and from where to where they lie; range_mm [2] may
 * be NULL. */
bool weft_player_relief_mm(const weft_player *player, double *range_mm);

/* ---- What the shaders saw, for the evaluators in C ---- */

/* One pixel, in the frame of the surface (weft_material_sample and its like take these as they are). */
typedef struct weft_surface_sample {
    float light[3], level;
    float view[3], covered; /* 1 on the mesh, 0 beside it */
    float u, v, key_share;  /* key_share: of the first light that is not in shadow */
    float sides[4];         /* of the sample, texels (cells of a weave): across, up */
} weft_surface_sample;

/* The inputs of the reflectance of `mode` for the scene's first frame, one pane: sample [height][width], row 0 at the
 * top. The caller frees *sample. Errors: those of weft_player_draw. */
weft_code weft_player_read_surface(weft_player *player, const weft_scene *scene, weft_mode mode, int width, int height,
                                   weft_surface_sample **sample, weft_error *error);

#endif
