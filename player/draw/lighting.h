/* The lights of one frame: the lights of the scene, then samples of the environment. Pure: no OpenGL. */
#ifndef WEFT_PLAYER_DRAW_LIGHTING_H
#define WEFT_PLAYER_DRAW_LIGHTING_H

#include "player/draw/programs.h"
#include "player/scene/environment.h"
#include "player/scene/scene.h"

/* Shadow rays of one pixel in a converging frame: places on the key light, and directions of the environment. All
 * pixels of a frame share them, because other directions in neighbouring pixels leave a hatch in soft shadows. An
 * interactive frame takes the middle of the key light and two directions. */
enum { WEFT_KEY_PLACES = 4, WEFT_ENVIRONMENT_SAMPLES = 8, WEFT_INTERACTIVE_SAMPLES = 2 };

/* Interleaved sampling (Keller and Heidrich 2001): the 4 x 2 pixels of a block are lit by different strata of the
 * environment. A mean of few frames then has fine grain instead of a wrong brightness everywhere. */
enum { WEFT_INTERLEAVED_LIGHTS = 8 };

typedef struct weft_lighting {
    int count;                           /* that one pixel is lit by */
    float direction[WEFT_MAX_LIGHTS][3]; /* of the world, unit, toward the light */
    float irradiance[WEFT_MAX_LIGHTS][3];
    int scene_count; /* the first of them are the lights of the scene */
    /* The others follow, interleave_count of each. In pixels of index k (interleave_index of surface.glsl) light i is
     * stored at scene_count + (i - scene_count) x interleave_count + k. */
    int interleave_count;
    int key_count;                  /* 0 without a light of the scene, 1 where the first has no size */
    weft_vec3 key[WEFT_KEY_PLACES]; /* shadows of these are those of the first light */
    /* Directions of the environment, chosen by brightness. Their mean visibility is that of the environment. Those of
     * successive frames fill the gaps. */
    int sample_count; /* 0 without an environment */
    weft_vec3 sample[WEFT_ENVIRONMENT_SAMPLES];
} weft_lighting;

/* `environment` may be NULL. frame: number of the frame in a mean that converges, or -1 for an interactive frame
 * (player/scene/environment.h). There is always a light; it may be black. The direction and the places of a key light
 * with a size move with the frame; frame 0 begins with its middle. */
weft_lighting weft_lighting_of(const weft_scene *scene, const weft_environment *environment, long frame);

/* The n-th direction from which the first light, or an environment, lights level ground. A direction is as likely as it
 * is bright there. The first n are evenly distributed, for any n. */
weft_vec3 weft_lighting_key_place(const weft_scene *scene, long number);
weft_vec3 weft_lighting_ground_place(const weft_scene *scene, const weft_environment *environment, long number);

/* All pixels get the lights of index 0. */
void weft_lighting_without_interleaving(weft_lighting *lighting);

/* Number of lights in its arrays. */
int weft_lighting_stored(const weft_lighting *lighting);

/* Number of lights of one pixel. */
int weft_lighting_count(const weft_scene *scene, const weft_environment *environment);

#endif
