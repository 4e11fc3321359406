/* The lights of one frame: those of the scene, then those that stand for the environment. Pure: no OpenGL. */
#ifndef WEFT_PLAYER_DRAW_LIGHTING_H
#define WEFT_PLAYER_DRAW_LIGHTING_H

#include "player/draw/programs.h"
#include "player/scene/environment.h"
#include "player/scene/scene.h"

/* Places in the key light, and directions of the environment, from which every pixel of a frame at rest sees their
 * shadows: where neighbours see others of them, soft shadows have a hatch. A moving frame takes the middle of the key
 * light, and two directions. */
enum { WEFT_KEY_PLACES = 4, WEFT_FILL_DIRECTIONS = 8, WEFT_FILL_MOVING = 2 };

/* Neighbouring pixels at rest are lit from other parts of the environment, so that what a few frames lack is fine grain
 * instead of a lean of the whole picture. As many kinds of pixels at most: each block of 4 x 2 has all of them. */
enum { WEFT_LIGHT_SETS = 8 };

typedef struct weft_lighting {
    int count;                           /* that one pixel is lit by */
    float direction[WEFT_MAX_LIGHTS][3]; /* of the world, unit, toward the light */
    float irradiance[WEFT_MAX_LIGHTS][3];
    int scene_count; /* the first of them, which are the scene's */
    /* The others follow, set_count of each: the i-th of a pixel of kind k (pixel_kind of surface.glsl) is
     * scene_count + (i - scene_count) x set_count + k. */
    int set_count;
    int key_count;                  /* 0 without a light of the scene, 1 where the first has no size */
    weft_vec3 key[WEFT_KEY_PLACES]; /* what the mesh hides of these stands for what it hides of the first light */
    /* Of the environment, as likely as it is bright from there: what the mesh hides of these stands for what it hides
     * of all of it. Those that follow each other in time fill the gaps. */
    int fill_count; /* 0 without an environment */
    weft_vec3 fill[WEFT_FILL_DIRECTIONS];
} weft_lighting;

/* `environment` may be NULL. frame: number of the frame in the mean of a picture at rest, or -1 for a picture that
 * moves (player/scene/environment.h says what follows). There is always a light, though it may be black. With a key
 * light of some size its direction and its places move with the frame; frame 0 begins with its middle. */
weft_lighting weft_lighting_of(const weft_scene *scene, const weft_environment *environment, long frame);

/* Directions from which light falls on level ground: the n-th of the first light, and of an environment, each as likely
 * as the light is that it brings. They are even, however many there are. */
weft_vec3 weft_lighting_key_place(const weft_scene *scene, long number);
weft_vec3 weft_lighting_ground_place(const weft_scene *scene, const weft_environment *environment, long number);

/* Lights all pixels alike, as those of the first kind. */
void weft_lighting_keep_one_kind(weft_lighting *lighting);

/* How many its arrays hold. */
int weft_lighting_held(const weft_lighting *lighting);

/* Its number of lights. */
int weft_lighting_count(const weft_scene *scene, const weft_environment *environment);

#endif
