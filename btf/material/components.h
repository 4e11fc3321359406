/* Components of a material: the reflectance of a texel as a sum of a few factors, shared by all texels, each under a
 * coefficient of the texel's own (a factorised BTF).
 *
 * For each colour channel, r = reflectance times cosine, as in the dataset:
 *
 *     s(l, v) = sum_k c_k B_k(l, v),   r = max(0, s)^exponent, clamped (reflectance/components/components.h)
 *
 * With an exponent of 1 the components add linear light; with more they add coded values, as a screen shows them.
 * c_k are whole numbers of -127 .. 127, the most important first, so that the first few alone are a coarser material.
 * B_k is stored as its values at the images of a dataset. Between them it is a map: first over the lights of each view,
 * then over the views.
 *
 *     over the light: at a node of the view map, a paraboloid map of l holds B_k
 *     over the half vector: a concentric map of h = (l + v) / |l + v| holds B_k g(l, v)^(1 / exponent)
 *
 * g = (l . h)^incidence_power l_z^cosine_power. A highlight of a mirror stays at one half vector whatever the view, so
 * that maps over it interpolate between lights and views that are far apart; g tells how it grows towards the horizon.
 * Kriged maps (reflectance/components/kriged_maps.c) are found by lengths and nuggets; the others, which earlier
 * versions wrote, are smooth maps (btf/direction/smooth_map.h) that are 0 where the light is at the horizon.
 *
 * Interpolation is linear in the coefficients: texels and mip levels are filtered before anything is evaluated. */
#ifndef WEFT_BTF_MATERIAL_COMPONENTS_H
#define WEFT_BTF_MATERIAL_COMPONENTS_H

#include "base/half.h"
#include "base/status.h"
#include "base/vector.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* l . h is taken as at least this by the kinds of earlier versions, and where images say no more. */
#define WEFT_LEAST_INCIDENCE 0.0625f

typedef enum weft_components_kind {
    WEFT_COMPONENTS_OF_LIGHT,
    WEFT_COMPONENTS_OF_HALF_VECTOR,
    WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED,
    WEFT_COMPONENTS_KRIGED_OVER_LIGHT,
    WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR,
    WEFT_COMPONENTS_KINDS
} weft_components_kind;

static inline bool weft_components_are_kriged(weft_components_kind kind)
{
    return kind >= WEFT_COMPONENTS_KRIGED_OVER_LIGHT;
}

static inline bool weft_components_are_over_half_vector(weft_components_kind kind)
{
    return kind != WEFT_COMPONENTS_OF_LIGHT && kind != WEFT_COMPONENTS_KRIGED_OVER_LIGHT;
}

enum {
    WEFT_COMPONENTS_MAX = 64,
    WEFT_COMPONENTS_GROUP = 4,       /* components that are stored, and fetched, together */
    WEFT_COMPONENTS_MAX_LEVELS = 16, /* as many as a material may have */
    WEFT_COMPONENTS_LARGEST_CODE = 127,
    WEFT_CEILING_SIDE = 8, /* texels along a side of a square that has one ceiling and one floor */
    WEFT_COMPONENTS_MAX_IMAGES = 1 << 20,
    WEFT_COMPONENTS_MAX_VIEWS = 4096,
    WEFT_KRIGED_MAX_SIDE = 32,
    WEFT_KRIGED_MAX_VIEWS = 256, /* of kriged maps, whose equations are dense ... */
    WEFT_KRIGED_MAX_LIGHTS = 512 /* ... and of the lights of a view */
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
    float exponent;        /* 1 .. 4: of the sum of the components */
    float incidence_power; /* of l . h, 0 .. 4 */
    float cosine_power;    /* of l_z, -2 .. 2 */
    float least_incidence; /* l . h is taken as at least this, 0 < it <= 1 */
    /* Of kriged maps (btf/direction/kriged_map.h): */
    float view_length, view_nugget; /* over the views, ordinary */
    float *length, *nugget;         /* [component_count] over the light or half vector ... */
    float trend;                    /* ... and of all of these, 0 .. 1000 */
    float least_cosine;             /* of the lights: nearer the horizon r falls in proportion to l_z, 0 < it <= 1 */
    float view_variance_threshold;  /* variance of a node over l or h at which its view counts a quarter; 0: all count
                                       alike */
    float *view;                    /* [view_count][3] unit, z > 0 */
    float *light;                   /* [image_count][3] unit, z > 0; view by view */
    uint32_t *first;                /* [view_count + 1] the images of view i are first[i] .. first[i + 1] - 1 */
    float *scale;                   /* [component_count] what a coefficient of 1 and a value of 1 stand for */
    weft_half *value;               /* [image_count][component_count][3] B_k, divided by its scale */
    int level_count;
    weft_components_level level[WEFT_COMPONENTS_MAX_LEVELS];
} weft_components;

/* The powers that the kinds of earlier versions imply: linear values, l . h by the kind, at least 1/16. */
void weft_components_set_implied(weft_components *components);

/* base^exponent to 1e-5 of it, for a base of at least 2^-100 and a result of 2^-126 to 2^126; below and above it is
 * about that of these, and of NaN that of 2^-100. Here, and without branches, so that loops over all samples become
 * vectors. Pure. */
static inline float weft_power(float base, float exponent)
{
    const float least = 0x1p-100f, one_over_ln_2 = 1.44269504f, ln_2 = 0.69314718f;
    base = base > least ? base : least;
    int32_t bits, shift;
    memcpy(&bits, &base, sizeof bits);
    shift = (bits - 0x3f3504f3) >> 23; /* the mantissa from the root of 1/2 to that of 2 */
    bits -= shift * (1 << 23);
    float mantissa;
    memcpy(&mantissa, &bits, sizeof mantissa);
    float t = (mantissa - 1) / (mantissa + 1), u = t * t;
    float series = 2 * t * (1 + u * (1.0f / 3 + u * (1.0f / 5 + u * (1.0f / 7 + u / 9))));
    float power = exponent * ((float)shift + one_over_ln_2 * series);
    power = power > -126 ? power < 126 ? power : 126 : -126;
    float whole = (float)(int32_t)(power + (power > 0 ? 0.5f : -0.5f)), rest = ln_2 * (power - whole);
    float part = 1 + rest * (1 + rest * (1.0f / 2 + rest * (1.0f / 6 + rest * (1.0f / 24 + rest / 120))));
    int32_t scale = ((int32_t)whole + 127) * (1 << 23);
    float result;
    memcpy(&result, &scale, sizeof result);
    return result * part;
}

/* r of a sum s of components: max(0, s)^exponent, but s itself where the exponent is 1. Pure. */
static inline float weft_decoded(float exponent, float sum)
{
    return exponent == 1 ? sum : weft_power(sum, exponent);
}

/* The s that gives r >= 0: its inverse. Pure. */
static inline float weft_coded(float exponent, float value)
{
    return exponent == 1 ? value : weft_power(value, 1 / exponent);
}

/* Allocates all arrays, zeroed, for the counts that are set in `shape`, whose other numbers are copied; those of kinds
 * of earlier versions are implied. Sizes of levels are those of the mip
 * chain of width x height. Errors: WEFT_BAD_USAGE for counts out of range, WEFT_SYSTEM. The caller frees with
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
