/* The model for a handful of images: a diffuse term and one mirror-like lobe a texel. Exponent and normal of a texel
 * are those under which its whole neighbourhood fits best, out of a shared set of exponents and slopes; rho and the
 * amplitude of each channel are the texel's own, non-negative least squares of the *relative* error. How sharp a
 * highlight and how steep a slope may be is chosen by leaving out one image after another. */
#ifndef WEFT_COMPRESS_SPARSE_SPARSE_H
#define WEFT_COMPRESS_SPARSE_SPARSE_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "compress/texel/texel.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- The samples ---- */

/* All samples of a dataset of few images in memory: the ground on which the sparse model borrows from neighbours. */

/* Owned by the caller. Arrays are [height][width][image_count] (times 3 where so marked); images held out are not in
 * it. */
typedef struct weft_sparse_field {
    int width, height, image_count;
    int level, whole_width, whole_height; /* the mip level, and the texels of level 0 */
    float *light, *view;                  /* x 3: unit directions */
    float *value;                         /* x 3: reflectance times cosine */
    float *weight;                        /* 0: not to be used; the share of valid texels in a group */
    float *image_weight;                  /* [image_count] what an image counts for, 1 in the mean */
} weft_sparse_field;

/* Reads a whole dataset; *masked_count receives the samples that cannot be used. Errors: those of reading, WEFT_SYSTEM
 * for memory. */
weft_code weft_sparse_field_read(weft_dataset *dataset, const uint8_t *held_out, weft_sparse_field *field,
                                 long *masked_count, weft_error *error);

/* The field of the next mip level: means over groups of 2 x 2 texels, each of which counts as the texels of level 0
 * that it stands for (fewer at the right and lower edge). */
weft_code weft_sparse_field_halve(const weft_sparse_field *field, weft_sparse_field *half, weft_error *error);

void weft_sparse_field_free(weft_sparse_field *field);

/* The freedom of the fit. */
typedef struct weft_sparse_setting {
    double largest_exponent; /* 0: diffuse only */
    /* A slope s must lower the neighbourhood's squared error by 1 + stiffness s^2; infinite: upright. */
    double stiffness;
} weft_sparse_setting;

/* One texel: rho + A max(0, l'.diag(-1, -1, 1).v')^N, the normal being (slope_x, slope_y, 1) normalised. */
typedef struct weft_sparse_texel {
    float slope_x, slope_y, exponent;
    float diffuse[3], amplitude[3];
} weft_sparse_texel;

/* Chooses the setting by cross-validation on the field, halved until it has at most 128 x 128 texels. With fewer than
 * four images, or `lobes` off, it is diffuse only. Errors: WEFT_SYSTEM for memory. */
weft_code weft_sparse_choose(const weft_sparse_field *field, bool lobes, weft_sparse_setting *setting,
                             weft_error *error);

/* Fits all texels: result [height][width]. Uses OpenMP; the number of threads leaves no trace. */
weft_code weft_sparse_fit(const weft_sparse_field *field, const weft_sparse_setting *setting, weft_sparse_texel *result,
                          weft_error *error);

/* Reflectance times cosine of channel k. Pure. */
float weft_sparse_value(const weft_sparse_texel *texel, const float light[3], const float view[3], int channel);

/* ---- The search ---- */

/* The search for the shape of every texel's lobe: all slopes and exponents tried on the whole field, errors pooled over
 * neighbourhoods, the best kept under each of several settings at once. */

enum {
    WEFT_SPARSE_EXPONENTS = 12, /* 4 .. 181, half an octave apart */
    WEFT_SPARSE_SETTINGS = 32   /* at most */
};

#define WEFT_SPARSE_FIRST_EXPONENT 4.0f

typedef struct weft_sparse_shape {
    float slope_x, slope_y, exponent;
} weft_sparse_shape;

/* Set field, left_out, setting_count and setting, then call create. */
typedef struct weft_sparse_search {
    const weft_sparse_field *field;
    int left_out; /* image that must not be seen, -1: none */
    int setting_count;
    const weft_sparse_setting *setting; /* [setting_count] */
    int worker_count;
    struct weft_sparse_worker *worker; /* [worker_count] one per thread */
    float *weight;                     /* [texel][image] of the relative error */
    float *grey;                       /* [texel][image] */
    weft_sparse_shape *shape;          /* [setting][texel] the choices, smoothed */
} weft_sparse_search;

/* Errors: WEFT_SYSTEM for memory; free it all the same. */
weft_code weft_sparse_search_create(weft_sparse_search *search, weft_error *error);
void weft_sparse_search_free(weft_sparse_search *search);

/* Fills `shape` for the present left_out. The number of threads leaves no trace. */
void weft_sparse_search_run(weft_sparse_search *search);

/* The texel's own rho and amplitudes for the shape chosen under a setting. Thread-safe. */
weft_sparse_texel weft_sparse_search_texel(const weft_sparse_search *search, int setting, size_t texel);

static inline size_t weft_sparse_texel_count(const weft_sparse_field *field)
{
    return (size_t)field->width * (size_t)field->height;
}

/* ---- As a material ---- */

/* Fits and measures all levels of `material`, whose shape is set: no table, at most one lobe. `setting` receives what
 * cross-validation chose. Errors: those of reading, WEFT_SYSTEM for memory. */
weft_code weft_sparse_material_fit(weft_dataset *dataset, const uint8_t *held_out, const weft_progress *progress,
                                   weft_material *material, weft_sparse_setting *setting, weft_texel_counts *counts,
                                   long *masked_count, weft_error *error);

#endif
