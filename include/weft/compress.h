/* Compression: a dataset becomes a material. */
#ifndef WEFT_COMPRESS_H
#define WEFT_COMPRESS_H

#include "weft/dataset.h"
#include "weft/material.h"
#include "weft/progress.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What an error of a sample counts for. */
typedef enum weft_sample_weights {
    WEFT_WEIGHTS_EVEN,    /* alike, as in least squares of linear light */
    WEFT_WEIGHTS_SCREEN,  /* less the brighter the sample, about as little as a screen shows of it */
    WEFT_WEIGHTS_BY_MODEL /* components: as on a screen; lobes: all alike */
} weft_sample_weights;

/* As many components as the number of images suggests, or lobes where these are few (weft_compress_default_options). */
enum { WEFT_COMPONENTS_AUTOMATIC = -1 };

typedef struct weft_compress_options {
    int component_count; /* 4..64, a multiple of 4; 0: lobes; WEFT_COMPONENTS_AUTOMATIC */
    int lobe_count; /* without components: at most so many, 1..3, with T where the samples can carry it; 0: a diffuse
                       term */
    weft_sample_weights weights; /* not of the sparse model */
    bool levels;                 /* mip levels, each fitted to the mean samples of its groups of texels */
    bool heights;                /* components are seen through those of the dataset, where it has some */
    bool finer; /* as many components again, which hold what rounding to 8 bits leaves of the coefficients of the first,
                   which have 15 bits then: it tells what rounding costs. At most 32 components */
    const uint8_t *held_out; /* [image_count] images that the fit must not see (non-zero), or NULL */
    /* These change nothing in the result: */
    uint64_t memory_bytes;       /* that the process may take; 0: a quarter of what there is */
    const char *checkpoint_path; /* keeps what is done until the caller removes it; NULL: none */
    weft_log log;                /* hears of checkpoints that are used or discarded */
} weft_compress_options;

/* WEFT_COMPONENTS_AUTOMATIC: 8 components for fewer than 20 images, 16 for fewer than 100, else 32; lobes, 2 of them,
 * for fewer than 20 near images. Levels, heights, nothing held out, a quarter of the memory, no checkpoint. Pure. */
WEFT_API weft_compress_options weft_compress_default_options(void);

/* Fits a material to a dataset: every texel of every mip level.
 *
 *   components  f(l, v) l_z = max(0, sum_k c_k B_k(l, v))^p: the dataset, a matrix of texels by images, is
 *               factorised; its coefficients c_k are 8-bit, and the tables B_k are interpolated to other directions by
 *               kriging (docs/reference/compression.md).
 *   lobes       each texel by itself: f(l, v) = T(v) (rho + sum_i lobe_i), by non-linear least squares (Lafortune et
 * al. 1997; Daubert et al. 2001).
 *
 * The caller closes *result with weft_material_close, or writes it with weft_material_write. `options` and `progress`
 * may be NULL. Uses OpenMP; the result does not depend on the number of threads. Nothing else may use a dataset
 * meanwhile. The errors that the metadata hold are those of the samples that were fitted; `weft compress` also measures
 * the error on directions that were not.
 *
 * Errors: WEFT_BAD_USAGE for options out of range, where every image is held out, or where the memory allowed does not
 * suffice; WEFT_BAD_INPUT for a dataset without any valid sample; those of reading it; WEFT_OUT_OF_MEMORY; WEFT_SYSTEM
 * for a checkpoint that cannot be opened or written. */
WEFT_API weft_code weft_material_fit(weft_dataset *dataset, const weft_compress_options *options,
                                     const weft_progress *progress, weft_material **result, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
