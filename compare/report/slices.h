/* BRDF slices as Irawan and Marschner (2012, figures 16 to 21) print them: for seven exitant directions the hemisphere
 * of incident directions in projection onto the cloth, warp upward; one row for the data, one for each model. */
#ifndef WEFT_COMPARE_REPORT_SLICES_H
#define WEFT_COMPARE_REPORT_SLICES_H

#include "base/numeric/error_summary.h"
#include "base/picture/image.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "evaluate/model.h"

/* ---- Contender ---- */

/* The data and the models that are compared with it, as mean BRDFs. */

enum { WEFT_CONTENDER_COUNT = 4 }; /* data, compressed, analytic, BARD */

typedef struct weft_contender {
    const char *name;
    weft_model *model;
    weft_real level; /* whose mean is taken: of a material the finest level of at most 1024 texels */
} weft_contender;

/* The first is the data. Freed with weft_contenders_close. */
typedef struct weft_contenders {
    int count;
    weft_contender contender[WEFT_CONTENDER_COUNT];
} weft_contenders;

/* `weave` and `bard` (a dataset as `weft bard` writes it) may be NULL. Errors: those of weft_model_open. */
weft_code weft_contenders_open(const char *dataset, const char *material_path, const weft_material *material,
                               const char *weave, const char *bard, weft_contenders *contenders, weft_error *error);
void weft_contenders_close(weft_contenders *contenders);

/* Mean BRDF over the material for one pair of directions, as `weft eval` gives it without texture coordinates. */
weft_code weft_contender_brdf(const weft_contender *contender, weft_vec3 light, weft_vec3 view, weft_rgb *brdf,
                              weft_error *error);

/* The error of each contender's mean BRDF against that of the data, error [count], over the directions of all images
 * (an even choice of at most about 7000); entry 0 is zero. Errors: those of weft_model_brdf; WEFT_SYSTEM for memory. */
weft_code weft_contenders_measure(const weft_contenders *contenders, const weft_dataset_layout *layout,
                                  const weft_progress *progress, weft_error_summary *result, weft_error *error);

enum {
    WEFT_SLICE_VIEWS = 7,
    WEFT_SLICE_RINGS = 15,
    WEFT_SLICE_AZIMUTHS = 36,
    WEFT_SLICE_LIGHTS = 1 + WEFT_SLICE_RINGS * WEFT_SLICE_AZIMUTHS
};

/* Freed with weft_slices_free. */
typedef struct weft_slices {
    int view_count;                   /* 0: the dataset has too few images */
    weft_vec3 view[WEFT_SLICE_VIEWS]; /* exitant directions */
    double largest_theta_rad;         /* of the outermost ring */
    /* Incident directions: the normal, then ring by ring outward, in each from azimuth 0 in equal steps. */
    weft_vec3 light[WEFT_SLICE_LIGHTS];
    int row_count;
    const char *name[WEFT_CONTENDER_COUNT];
    weft_rgb *brdf; /* [row_count][view_count][WEFT_SLICE_LIGHTS] mean over the material, 1/sr; NaN without data */
} weft_slices;

/* Evaluates every contender. The exitant directions are the views of the dataset nearest to the normal, 30 degrees
 * (azimuths 0 and 90) and 60 degrees (azimuths 0, 45, 90, 135), each once; the rings reach as far as the lights of the
 * dataset, at most 85 degrees. Errors: those of weft_model_brdf; WEFT_SYSTEM for memory. */
weft_code weft_slices_make(const weft_dataset_layout *layout, const weft_contenders *contenders,
                           const weft_progress *progress, weft_slices *slices, weft_error *error);
void weft_slices_free(weft_slices *slices);

/* A row's values for one view, [WEFT_SLICE_LIGHTS]. */
const weft_rgb *weft_slices_values(const weft_slices *slices, int row, int view);

/* The value at (x, y) of the projected hemisphere, |(x, y)| <= 1, bilinear in the angles; NaN outside the rings. Pure.
 */
weft_rgb weft_slices_at(const weft_slices *slices, int row, int view, double x, double y);

/* A row as a linear picture, its views side by side, `size` pixels each, times pi; `mask` [size][size view_count] (may
 * be NULL) is 1 where there is no value. The caller frees the image. Errors: WEFT_SYSTEM. */
weft_code weft_slices_picture(const weft_slices *slices, int row, int size, weft_image *image, uint8_t *mask,
                              weft_error *error);

/* The numbers: lx, ly, lz, vx, vy, vz and NAME_r, NAME_g, NAME_b of each row, a table that `weft eval` takes. Errors:
 * WEFT_SYSTEM. */
weft_code weft_slices_write(const weft_slices *slices, const char *path, weft_error *error);

#endif
