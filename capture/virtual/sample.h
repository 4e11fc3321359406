/* What lies in the opening of the target: a weave, flat in the plane of the target; a stitch, whose yarns reach up to
 * that plane and which goes on below it; or a checker of patches whose reflectance is a formula. */
#ifndef WEFT_CAPTURE_VIRTUAL_SAMPLE_H
#define WEFT_CAPTURE_VIRTUAL_SAMPLE_H

#include "capture/virtual/virtual_settings.h"
#include "geometry/light/stitch_sample.h"
#include "reflectance/weave/batch.h"

#include <stddef.h>

/* ---- Colours ---- */

static inline weft_rgb weft_rgb_add(weft_rgb a, weft_rgb b)
{
    return (weft_rgb){a.r + b.r, a.g + b.g, a.b + b.b};
}

static inline weft_rgb weft_rgb_scale(weft_rgb a, double scale)
{
    return (weft_rgb){a.r * scale, a.g * scale, a.b * scale};
}

static inline weft_rgb weft_rgb_multiply(weft_rgb a, weft_rgb b)
{
    return (weft_rgb){a.r * b.r, a.g * b.g, a.b * b.b};
}

/* ---- Samples ---- */

/* A weave laid out in tiles. */
typedef struct weft_virtual_cloth {
    weft_weave weave;
    weft_woven_table *table; /* of the weave, for batches */
    double opening_mm;
    int tiles_x, tiles_y; /* across the opening: whole, so that the material repeats */
    uint64_t noise_seed;  /* 0 = no noise */
} weft_virtual_cloth;

/* The point of the weave at a point of the plate inside the opening, mm. Pure. */
weft_weave_point weft_virtual_cloth_locate(const weft_virtual_cloth *cloth, double x_mm, double y_mm);

typedef struct weft_virtual_sample {
    double opening_mm;
    bool is_checker;          /* else one of the following */
    weft_virtual_cloth flat;  /* empty where the sample has depth */
    weft_stitch_sample *deep; /* NULL where it is flat */
} weft_virtual_sample;

/* Reads NAME.stitch as a stitch and any other file as a weave. The tiles of a stitch have their own size; the lower
 * left corner of one is that of the opening. The caller frees with weft_virtual_sample_free. Errors: those of
 * weft_weave_read and weft_stitch_sample_read; WEFT_BAD_INPUT for settings that a stitch cannot follow. */
weft_code weft_virtual_sample_read(const char *path, const weft_virtual_settings *settings, uint64_t seed,
                                   weft_virtual_sample *sample, char warning[WEFT_MESSAGE_SIZE], weft_error *error);
void weft_virtual_sample_free(weft_virtual_sample *sample);

/* Owned by the sample. */
const char *weft_virtual_sample_name(const weft_virtual_sample *sample);

/* Where a ray through a point of the opening, mm from its centre, and toward `view` leads in a sample with depth: as
 * weft_stitch_sample_see. */
int weft_virtual_sample_see(const weft_virtual_sample *sample, double x_mm, double y_mm, weft_vec3 view, uint64_t key,
                            uint32_t index, weft_seen_vertex *vertex);

/* shade [count] = pi BRDF cos(theta_light) at a point of the opening, mm from its centre, toward `view` under each of
 * `count` far lights toward light[i]; all are unit vectors. Of a sample with depth it is the estimate of one path of
 * light, `index` of the sequence `key`. Thread-safe.
 *
 * The checker has 4 x 4 squares, counted from the lower left. Each is diffuse,
 *     red = 0.10 + 0.75 ((5 i + 3 j) mod 7) / 6, green, blue the same of (3 i + 5 j) and (2 i + 6 j),
 * but for (1, 2), which is diffuse of 0.2 and has a highlight of Blinn (1977) over it: pi BRDF = 0.2 +
 * 0.15 (n + 8) / 8 cos(half)^n, n = 40. */
void weft_virtual_sample_shade(const weft_virtual_sample *sample, double x_mm, double y_mm, const weft_vec3 *light,
                               int count, weft_vec3 view, uint64_t key, uint32_t index, weft_rgb *shade);

/* The same under one light. */
weft_rgb weft_virtual_sample_reflect(const weft_virtual_sample *sample, double x_mm, double y_mm, weft_vec3 light,
                                     weft_vec3 view, uint64_t key, uint32_t index);

#endif
