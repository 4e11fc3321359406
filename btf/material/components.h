/* Components of a material: the reflectance of a texel as a sum of a few factors, shared by all texels, each under a
 * coefficient of the texel's own (a factorised BTF).
 *
 * For each colour channel, r = reflectance times cosine, as in the dataset:
 *
 *     r(l, v) = sum_k c_k B_k(l, v),   held to the floor of the texel times l_z
 *                                      .. the ceiling of the texel times min(1, l_z / least_cosine)
 *
 * c_k are whole numbers of -127 .. 127, the most important first, so that the first few alone are a coarser material.
 * B_k is stored as its values at the images of a dataset. Between them it is a smooth map (btf/direction/smooth_map.h):
 * first over the lights of each view, then over the views.
 *
 *     WEFT_COMPONENTS_OF_LIGHT: at a node of the view map, a paraboloid map of l holds B_k
 *     WEFT_COMPONENTS_OF_HALF_VECTOR: a concentric map of h = (l + v) / |l + v| holds B_k (l . h)
 *     WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED: the same map holds B_k (l . h)^2
 *
 * A highlight of a mirror stays at one half vector whatever the view, so that the other two interpolate it between
 * lights and views that are far apart; how it grows towards the horizon tells them apart. All maps are 0 where the
 * light is at the horizon.
 *
 * Interpolation is linear in the coefficients: texels and mip levels are filtered before anything is evaluated. */
#ifndef WEFT_BTF_MATERIAL_COMPONENTS_H
#define WEFT_BTF_MATERIAL_COMPONENTS_H

#include "base/half.h"
#include "base/status.h"
#include "base/vector.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef enum weft_components_kind {
    WEFT_COMPONENTS_OF_LIGHT,
    WEFT_COMPONENTS_OF_HALF_VECTOR,
    WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED,
    WEFT_COMPONENTS_KINDS
} weft_components_kind;

enum {
    WEFT_COMPONENTS_MAX = 64,
    WEFT_COMPONENTS_GROUP = 4,       /* components that are stored, and fetched, together */
    WEFT_COMPONENTS_MAX_LEVELS = 16, /* as many as a material may have */
    WEFT_COMPONENTS_LARGEST_CODE = 127,
    WEFT_CEILING_SIDE = 8, /* texels along a side of a square that has one ceiling and one floor */
    WEFT_COMPONENTS_MAX_IMAGES = 1 << 20,
    WEFT_COMPONENTS_MAX_VIEWS = 4096
};

/* The coefficients of one mip level. */
typedef struct weft_components_level {
    int width, height;
    int8_t *coefficient; /* [component_count / 4][height][width][4] */
    uint8_t *ceiling;    /* [ceil(height / 8)][ceil(width / 8)] weft_ceiling_of_code */
    uint8_t *floor;      /* [ceil(height / 8)][ceil(width / 8)][3] weft_floor_of_code */
} weft_components_level;

typedef struct weft_components {
    weft_components_kind kind;
    int component_count;    /* 4 .. 64, a multiple of 4 */
    int view_count;         /* distinct views */
    int image_count;        /* of all views */
    int light_side;         /* nodes along a side of the maps over l or h */
    int view_side;          /* of those over v */
    float light_smoothness; /* of the same maps */
    float view_smoothness;
    float least_cosine;            /* of the lights: nearer the horizon r falls in proportion to l_z, 0 < it <= 1 */
    float view_variance_threshold; /* variance of a node over l or h at which its view counts a quarter; 0: all count
                                      alike */
    float *view;                   /* [view_count][3] unit, z > 0 */
    float *light;                  /* [image_count][3] unit, z > 0; view by view */
    uint32_t *first;               /* [view_count + 1] the images of view i are first[i] .. first[i + 1] - 1 */
    float *scale;                  /* [component_count] what a coefficient of 1 and a value of 1 stand for */
    weft_half *value;              /* [image_count][component_count][3] B_k, divided by its scale */
    int level_count;
    weft_components_level level[WEFT_COMPONENTS_MAX_LEVELS];
} weft_components;

/* Allocates all arrays, zeroed, for the counts that are set in `shape`; sizes of levels are those of the mip chain of
 * width x height. Errors: WEFT_BAD_USAGE for counts out of range, WEFT_SYSTEM. The caller frees with
 * weft_components_free.
 */
weft_code weft_components_create(const weft_components *shape, int width, int height, int level_count,
                                 weft_components **result, weft_error *error);
void weft_components_free(weft_components *components);

/* Takes the finest level away; there must be another. */
void weft_components_drop_finest(weft_components *components);

/* Takes the coarsest away. */
void weft_components_drop_coarsest(weft_components *components);

/* ---- Ceilings and floors ---- */

/* 2^((code - 192) / 8), about 6e-8 .. 235. Pure. */
float weft_ceiling_of_code(uint8_t code);

/* The least code whose ceiling is at least `value`; 255 beyond. Pure. */
uint8_t weft_ceiling_code(float value);

/* A reflectance in each channel that a square does not fall below: 0 for code 0, else
 * 2^(floor(code / 16) - 13) (1 + (code mod 16) / 16), about 1.3e-4 .. 7.8. Pure. */
float weft_floor_of_code(uint8_t code);

/* A floor is a float of 4 bits of mantissa, whose exponent begins here: the lower bits of a float cut off. */
enum { WEFT_FLOOR_SHIFT = 19, WEFT_FLOOR_FIRST = (127 - 13) << 4 };

/* The largest code whose floor is at most `value`; 0 of what is no number. Here, so that loops over all samples become
 * vectors. Pure. */
static inline uint8_t weft_floor_code(float value)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    int32_t code = (bits >> WEFT_FLOOR_SHIFT) - WEFT_FLOOR_FIRST;
    code = code < 255 ? code : 255;
    return (uint8_t)(code > 0 && value == value ? code : 0);
}

/* Number of ceilings of a level. Pure. */
size_t weft_ceiling_count(int width, int height);

/* Whether all values are whole numbers of -2048 .. 2048, as a file holds them. Pure. */
bool weft_components_have_differences(const weft_components *components);

#endif
