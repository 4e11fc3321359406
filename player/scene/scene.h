/* All that says what a picture shows, but for the files: plain values, copied freely, written into every screenshot. */
#ifndef WEFT_PLAYER_SCENE_SCENE_H
#define WEFT_PLAYER_SCENE_SCENE_H

#include "base/picture/image.h"
#include "btf/direction/direction.h"
#include "player/scene/orbit.h"

#include <stdbool.h>

typedef enum weft_mode { WEFT_MODE_RAW, WEFT_MODE_COMPRESSED, WEFT_MODE_ANALYTIC, WEFT_MODE_COUNT } weft_mode;

/* "raw", "compressed", "analytic" and NULL, in the order of weft_mode. */
extern const char *const weft_mode_names[];

/* One of them. Pure. */
const char *weft_mode_name(weft_mode mode);

/* How the modes share the picture. PANES: side by side with one camera. WIPE: pane[0] left of the divider, pane[1]
 * right of it. DIFFERENCE: pane[1] - pane[0] in false colour, red where pane[1] is brighter, blue where darker. */
typedef enum weft_layout { WEFT_LAYOUT_PANES, WEFT_LAYOUT_WIPE, WEFT_LAYOUT_DIFFERENCE, WEFT_LAYOUT_COUNT } weft_layout;

/* Which mip level is shown: between the two that fit the pixel's footprint, the nearest of them, the finest everywhere,
 * or a given one. */
typedef enum weft_level_choice {
    WEFT_LEVEL_TRILINEAR,
    WEFT_LEVEL_NEAREST,
    WEFT_LEVEL_NONE,
    WEFT_LEVEL_FIXED,
    WEFT_LEVEL_CHOICE_COUNT
} weft_level_choice;

/* How neighbouring texels, levels and measured directions are interpolated. EXACT evaluates all of them in every frame.
 * STOCHASTIC evaluates one, drawn by its weight, in every pixel (Pharr et al. 2024): noisy while things move, and the
 * same picture in the mean of the frames while they rest. AUTO is EXACT where that is fast. */
typedef enum weft_filter { WEFT_FILTER_AUTO, WEFT_FILTER_EXACT, WEFT_FILTER_STOCHASTIC, WEFT_FILTER_COUNT } weft_filter;

/* From linear radiance to the screen's: cut off at 1, or bent to it from 1/2 on so that highlights keep their shape. */
typedef enum weft_tone { WEFT_TONE_CLIP, WEFT_TONE_SOFT, WEFT_TONE_COUNT } weft_tone;

/* A distant light; the direction is of the world, theta from its z. */
typedef struct weft_light {
    weft_angles direction;
    double irradiance[3]; /* on a surface that faces it, divided by pi: 1 shows reflectance */
} weft_light;

/* Of radiance, mean of the channels: where the colours of a difference end. */
#define WEFT_SCENE_FULL_DIFFERENCE 0.1f

enum { WEFT_SCENE_MAX_LIGHTS = 4, WEFT_SCENE_MAX_LOBES = 3 };

typedef struct weft_scene {
    weft_orbit orbit;
    weft_light light[WEFT_SCENE_MAX_LIGHTS]; /* the first is the key light: it casts shadows and is dragged */
    int light_count;                         /* may be 0 under an environment */
    double key_size_rad;                     /* of the key light, as a radius on the sky: how soft its shadow is */
    bool shadows;                            /* of the key light and, roughly, of the environment */
    bool ground;                             /* that takes them, before a backdrop, in the place of the background */
    bool environment;            /* lit by the player's environment map, if it has one, besides the lights */
    double environment_turn_rad; /* of the map about the world's z */
    double environment_strength;
    bool environment_reference; /* sum every light of the map instead of a representative few: slow */
    double exposure;
    weft_tone tone;
    double repeat; /* materials for one unit of the mesh's texture coordinate u; along v such that texels are square */
    weft_level_choice level_choice;
    double level; /* with WEFT_LEVEL_FIXED; may be fractional */
    weft_filter filter;
    weft_layout layout;
    double divider; /* of WEFT_LAYOUT_WIPE, 0 (left) to 1 */
    int pane_count; /* of WEFT_LAYOUT_PANES; the others show two */
    weft_mode pane[WEFT_MODE_COUNT];
    bool relief; /* the dataset and the components of the material are seen through their heights, where they have some
                  */
    /* What the compressed material is evaluated with */
    int components;                  /* its first components, where it has some; 0: its lobes */
    bool lobe[WEFT_SCENE_MAX_LOBES]; /* each lobe on or off */
    bool view_table, light_table;
    int noise_seed; /* of the weave's irregularities; 0: none */
    /* What is drawn over the truth */
    bool show_level;         /* the mip level in false colour */
    bool show_extrapolation; /* tint where view or light lies beyond the last measured ring */
    bool labels;             /* the name of its mode in each pane */
} weft_scene;

/* A light from the upper left, the drape seen from above its rim, eight materials across it, compressed. */
weft_scene weft_scene_default(void);

/* The modes in the order of their panes: pane_count of them side by side, else two. Pure. */
int weft_scene_panes(const weft_scene *scene);

/* Whether there is light that casts shadows. Pure. */
bool weft_scene_has_shadows(const weft_scene *scene);

/* The same scene under the default light alone, without environment and ground. Pure. */
weft_scene weft_scene_in_bare_light(const weft_scene *scene);

/* A scene without any light gets the default one. In place. */
void weft_scene_keep_lit(weft_scene *scene);

/* Linear radiance as the screen shows it (GLSL twin: player/draw/shaders/present.frag.glsl): tone, sRGB, and the line
 * of a wipe; or a signed difference in false colour. In place. */
void weft_scene_show(const weft_scene *scene, weft_image *image);

#endif
