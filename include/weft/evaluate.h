/* Evaluation: any model of Weft as a BRDF, at a place, on a mip level, or as a mean over the whole of it.
 *
 * A model is a material (.weft), a dataset (.btf.h5: its photographs, interpolated), a weave (.wv) or a cloth of
 * microcylinders (.mc).
 *
 * Value of a texel of a material, as BRDF x pi = f(l, v):
 *   components   f l_z = sum_k c_k B_k(l, v), clamped to the bounds of the texel (a factorised BTF; c_k are the
 *                coefficients of the texel, B_k are shared by all texels);
 *   lobes        f = T(v) (rho + sum_i max(0, l' . diag(Cx, Cy, Cz)_i . v')^N_i), l' and v' in the frame of the texel
 *                (Daubert, Lensch, Heidrich and Seidel 2001, eq. 1 and 2).
 * docs/reference/weft-format.md has both in full.
 *
 * Frame of all directions: right-handed, x along the weft (u), y along the warp (v), z the surface normal. `light`
 * points to the light and `view` to the camera; both point away from the surface and need not be unit vectors.
 *
 * Texture coordinates: (0, 0) is the lower left corner, v points up, the material repeats in both. One unit is the
 * whole material, or one tile of a weave. */
#ifndef WEFT_EVALUATE_H
#define WEFT_EVALUATE_H

#include "weft/material.h"
#include "weft/types.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_model weft_model;

/* How to open a model; zeros are the defaults. */
typedef struct weft_model_options {
    uint64_t noise_seed;             /* of a weave; 0: without its noise */
    const weft_parameter *parameter; /* [parameter_count] for the $NAMES in a weave or a cloth of microcylinders */
    int parameter_count;
    bool interval;   /* the intervals of its certificate will be asked for */
    bool lobes;      /* of a material that has components, too: its lobes */
    bool flat;       /* a dataset without its heights */
    bool as_printed; /* microcylinders: weights of the article (Sadeghi et al. 2013), not by area */
} weft_model_options;

/* Opens a .weft, .btf.h5, .wv or .mc file. `options` may be NULL. The caller closes it with weft_model_close. Errors:
 * WEFT_BAD_INPUT (WEFT_MISSING, WEFT_DAMAGED, WEFT_NOT_SUPPORTED) for a file that cannot be used, and where intervals
 * are asked for and there is no certificate; WEFT_BAD_USAGE for intervals of lobes; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_model_open(const char *path, const weft_model_options *options, weft_model **result,
                                   weft_error *error);

/* NULL is fine. */
WEFT_API void weft_model_close(weft_model *model);

/* The material of a model; owned by the model. NULL where it is no material. */
WEFT_API const weft_material *weft_model_material(const weft_model *model);

/* Mip levels: those of a material, else 1. Pure. */
WEFT_API int weft_model_level_count(const weft_model *model);

/* The mip level for a footprint: log2 of its longer side in texels of level 0, at least 0, at most the coarsest level;
 * the rule of OpenGL 4.5, section 8.14.1, and of weft's player. `footprint` is {du/dx, dv/dx, du/dy, dv/dy}: how far
 * the texture coordinates move from one pixel to the next across and up. 0 where the model has no levels. Pure. */
WEFT_API double weft_model_level_of_footprint(const weft_model *model, const double footprint[4]);

/* ---- Values ----
 *
 * All take arrays of `count` queries and use OpenMP (omp_set_num_threads, OMP_NUM_THREADS) where there are many. The
 * result does not depend on the number of threads. Thread-safe for materials, weaves and microcylinders. A dataset is
 * read while it is evaluated: one thread at a time may read datasets. */

/* Writes the BRDF in 1/sr, linear sRGB, without the cosine, to brdf [count][3]: 0 where light or view is below the
 * horizon, NaN where a dataset holds no valid sample.
 *
 *   uv     [count][2] texture coordinates; NULL: the mean over the whole model (of a weave: over its tile, without
 *          noise). The mean reads all of it for each query.
 *   level  [count] mip levels of a material, which may be fractional; NULL: 0. Filtered as the player filters:
 *          coefficients of components, or values of lobes, are interpolated between the four nearest texels and the two
 *          nearest levels. Beyond the coarsest level: the coarsest.
 *   light, view  [count][3].
 *
 * Errors: WEFT_BAD_USAGE for a direction without length, a level that is negative, and a level other than 0 of a model
 * without levels; WEFT_OUT_OF_MEMORY; those of reading a dataset. */
WEFT_API weft_code weft_evaluate(weft_model *model, size_t count, const double *uv, const double *level,
                                 const double *light, const double *view, double *brdf, weft_error *error);

/* The opacity, 0 .. 1, to opacity [count]: 1 where the model knows of no holes; 0 where the view is below the horizon.
 * Arguments and errors: those of weft_evaluate; `uv` may not be NULL (WEFT_BAD_USAGE). */
WEFT_API weft_code weft_evaluate_opacity(const weft_model *model, size_t count, const double *uv, const double *level,
                                         const double *view, double *opacity, weft_error *error);

/* Half the width of the interval of the certificate about values that weft_evaluate gave, 1/sr, to half_width
 * [count][3]: 0 below the horizon. Errors: WEFT_BAD_USAGE where the model was not opened with `interval`, and as
 * above. */
WEFT_API weft_code weft_evaluate_half_width(const weft_model *model, size_t count, const double *level,
                                            const double *light, const double *view, const double *brdf,
                                            double *half_width, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
