/* What the player's tests share: a context, invented materials and datasets, and the comparison of pictures. */
#ifndef WEFT_TESTS_PLAYER_STAGE_H
#define WEFT_TESTS_PLAYER_STAGE_H

#include "player/draw/player.h"
#include "player/gl/context.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/expect_ok.h"

/* A context and a player with the drape on it; ends the program with 77 where there is no OpenGL. */
typedef struct stage {
    weft_headless *headless;
    weft_player *player;
} stage;

int stage_open(void **state);
int stage_close(void **state);

/* A uniform number in [0, 1). */
double stage_uniform(uint64_t *state);

/* Woven stripes: turned frames, two lobes of the given exponents, a table over the first `views` directions of ubo81
 * (0: none), with opacity below 1 here and there, and a light table over the last `lights`. All levels. */
void stage_material(int width, int height, int lobes, int views, int lights, weft_material *material);

/* Adds components that are smooth in light and view, with coefficients at random, some of them held by their ceilings.
 */
void stage_components(weft_components_kind kind, int component_count, weft_material *material);

/* Gives it hills of 0.6 mm, two heights along each side of a texel, on the finest `levels`; or only a plane. */
void stage_heights(bool hills, int levels, weft_material *material);

/* A checkerboard of a dark matt and a bright shining cloth with one texel a field, whose mip levels are exact means:
 * the lobes of all texels have the same shape. */
void stage_checker(int size, weft_material *material);

/* Far dataset of the first `views` x `lights` directions of ubo81, smooth in directions, textured in place. */
void stage_dataset(const char *path, int size, int views, int lights, weft_values values, bool holes);

/* Value of one pixel as the player's picture has it before its background: BRDF x pi x cosine and opacity. */
typedef weft_rgba stage_evaluator(void *context, const weft_surface_sample *at);

typedef struct stage_difference {
    double rmse, largest; /* of 8-bit sRGB values, in units of 1/255 */
    long pixels;
} stage_difference;

/* Draws one pane of the scene and compares its pixels on the mesh with the evaluator at what the shader saw there.
 * Pixels whose opacity is below 1 are left out: they show what is behind. */
stage_difference stage_compare(weft_player *player, weft_scene scene, weft_mode mode, int width, int height,
                               stage_evaluator *evaluate, void *context);

/* Size of the pictures that shaders are compared in. */
enum { STAGE_SHADED_WIDTH = 160, STAGE_SHADED_HEIGHT = 120 };

/* Prints the difference of a picture of that size, and fails unless the RMSE is below 1/255 and no pixel is further off
 * than 4/255, on graphics cards 8/255. */
void stage_expect_small(const char *what, stage_difference difference);

weft_vec3 stage_vector(const float v[3]);

/* A surface of that BRDF x pi under the light, which may be below the horizon. */
weft_rgba stage_lit(weft_rgb brdf_pi, weft_vec3 light, double opacity);

#endif
