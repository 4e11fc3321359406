/* Data sets that lead a fit astray, and how bright a material of them becomes: for the test of bad input and the bench
 * that looks at more directions. Not thread-safe. */
#ifndef WEFT_TESTS_ADVERSARIES_H
#define WEFT_TESTS_ADVERSARIES_H

#include "btf/dataset/dataset.h"
#include "btf/material/material.h"

enum { ADVERSARY_TEXELS = 4, ADVERSARIES = 14 };

typedef weft_code adversary_arrangement(weft_dataset_layout *layout);
typedef double adversary_brightness(int image, weft_vec3 light, weft_vec3 view);

typedef struct adversary {
    const char *name;
    adversary_arrangement *arrange;   /* where the samples were taken */
    adversary_brightness *brightness; /* what they are; times another factor for each texel and channel */
} adversary;

extern const adversary adversaries[ADVERSARIES];

/* By texel and channel: the brightest sample r, the brightest r / cos(theta_light); the largest such cosine of all. */
typedef struct adversary_limits {
    double r[ADVERSARY_TEXELS][3], f[ADVERSARY_TEXELS][3], highest;
} adversary_limits;

/* Writes a dataset of ADVERSARY_TEXELS x 1 texels. Errors: those of weft_dataset_layout_allocate. */
weft_code adversary_write(const adversary *one, const char *path, adversary_limits *limits);

/* The largest value of level 0 over `trials` random lights and views, anywhere above the horizon, as a share of what
 * its samples allow the texel (compress/texel/texel.h); infinite where one is not finite or negative. Errors: those of
 * weft_table_directions_create. */
weft_code adversary_largest_share(const weft_material *material, const adversary_limits *limits, uint64_t seed,
                                  long trials, double *share, weft_error *error);

#endif
