/* Small datasets and materials with known contents. */
#ifndef WEFT_TESTS_SUPPORT_FIXTURE_H
#define WEFT_TESTS_SUPPORT_FIXTURE_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "reflectance/weave/weave.h"
#include "tests/support/expect_ok.h"

/* Reflectance (BRDF x pi) of a texel in a direction pair, whatever the test wants. */
typedef weft_rgb (*fixture_reflectance)(int x, int y, weft_vec3 light, weft_vec3 view);

/* What fixture_woven shows: a weave, a tile of width x height texels whose upper left corner is at (left, top). */
typedef struct fixture_weave {
    double width, height, left, top;
    weft_weave weave;
} fixture_weave;

extern fixture_weave fixture_cloth;

/* Each texel the mean of 4 x 4 points. */
weft_rgb fixture_woven(int x, int y, weft_vec3 light, weft_vec3 view);

/* Which samples are masked as saturated: none; that of texel (0, 0) in image 0; at random, one of five. */
typedef enum fixture_mask { FIXTURE_MASK_NONE, FIXTURE_MASK_ONE, FIXTURE_MASK_FIFTH } fixture_mask;

/* The first `ring_count` rings of ubo81 for views and lights (1, 7, 19, ... directions), all pairs, reflectance times
 * cosine. */
void fixture_far_dataset(const char *path, int width, int height, int ring_count, fixture_reflectance reflectance,
                         fixture_mask masked);

/* A few images with near lights above a square of 64 mm; view and light coincide, as with a phone's flash. */
void fixture_near_dataset(const char *path, int size, int image_count, fixture_reflectance reflectance);

/* Diffuse material of one level with rho = value(x, y), no lobes and no table. */
void fixture_diffuse_material(const char *path, int width, int height, weft_rgb (*value)(int x, int y));

#endif
