/* The certificate of a material, made of the residuals of photographs that were held out of fits like it. */
#ifndef WEFT_COMPRESS_HOLD_OUT_CERTIFY_H
#define WEFT_COMPRESS_HOLD_OUT_CERTIFY_H

#include "btf/dataset/dataset.h"
#include "btf/material/certificate.h"
#include "btf/material/material.h"
#include "compress/hold_out/trial.h"

/* ---- Residuals ---- */

/* The residuals of held-out photographs: what a model says of them, beside what they say, texel by texel and of means
 * over ever larger squares of texels, as mip levels have them. */

enum { WEFT_RESIDUAL_LEVELS = 6 };

/* Of one channel of a texel, or of a square of texels, in one image; reflectance times cosine. */
typedef struct weft_residual {
    float prediction, error; /* error: |sample - prediction| */
    float moved;             /* what rounding for storage does to the prediction, as a standard error */
    uint32_t image;          /* numbered through all splits */
    uint8_t view, light;     /* rings of ubo81 */
    uint8_t flags;           /* why the image is held out */
} weft_residual;

/* Freed with weft_residuals_free. */
typedef struct weft_residuals {
    int level_count; /* of the subset: level k has squares of 2^k x 2^k of its texels */
    size_t count[WEFT_RESIDUAL_LEVELS], capacity[WEFT_RESIDUAL_LEVELS];
    weft_residual *value[WEFT_RESIDUAL_LEVELS];
} weft_residuals;
void weft_residuals_free(weft_residuals *residuals);

/* Which residuals are added. */
typedef struct weft_residuals_taken {
    uint32_t first_image; /* images are numbered from it on */
    size_t most;          /* of a level, about: of every texel every n-th image is taken, beginning with another one
                             at each. Texels differ more than images do, and none is left out */
    int first_level, last_level; /* others stay as they are */
    const uint8_t *level;        /* [texel] of a subset whose texels are of several levels (subset_levels.h); NULL:
                                    they are of level 0, and means over squares of them are those of the others */
} weft_residuals_taken;

/* Adds the residuals of what is said of some images of a subset. `moved` are the same samples as a material says them
 * whose stored numbers were moved by a step each (compress/hold_out/rounding.h), or NULL. Errors: WEFT_SYSTEM for
 * memory.
 */
weft_code weft_residuals_add(weft_residuals *residuals, const weft_texel_subset *subset,
                             const weft_asked_samples *asked, const weft_asked_samples *moved,
                             const weft_residuals_taken *taken, weft_error *error);

/* The certificate for `probability`, from residuals of images that were held out, and those of images that were fitted,
 * of the same fits. The levels may be of different texels; the scale is that of level 0. It is a normalised split
 * conformal interval (Lei et al. 2018, 5.2), of images as groups (Lee, Barber and Willett 2023). The scale is the
 * quantile of the residuals by predicted value, times a factor for each ring of the view and one for each ring of the
 * light, found in turns. Squares of at most `neighbours` texels along a side, a power of two, are of texels that lie
 * beside each other: level k of a material takes its quantile from squares of 2^k of those. A larger square of the
 * subset is of texels that lie `spacing` apart, in texels: coarser levels take theirs from the largest one that lies
 * within their texels, which has no more texels than they, so that it is rather too large. Sets everything but
 * direction_count and registration. *found is false where nothing was held out or all of it is black. Errors:
 * WEFT_SYSTEM for memory.
 */
weft_code weft_certify(const weft_residuals *held, const weft_residuals *fitted, double probability, double spacing,
                       int neighbours, weft_certificate *certificate, bool *found, weft_error *error);

/* ---- Rounding ---- */

/* What it costs that the numbers of a material are rounded to be stored. */

/* Moves every stored number of level 0 by one step, up or down at random: half floats, codes of tables, frames,
 * coefficients of components, whose steps are what their codes lie apart where they were rounded, and their values at
 * the images. A number that was rounded is off by up to half a step, evenly: a standard error of 1 / sqrt(12) steps. So
 * what this does to a prediction is sqrt(12) times what rounding did, as far as a prediction is linear in so small a
 * change. (`weft compress` rounds the sharpest lobes first and fits the rest again, which makes up for some of it: the
 * figure is an upper one.) 0 stays 0, and no sign changes. Deterministic. */
void weft_material_move_by_steps(weft_material *material);

/* ---- Registration error ---- */

/* What it costs that photographs do not lie on each other exactly. */

/* The part of registration in a certificate that has all else: a photograph that is displaced by d texels along each
 * axis, as a standard error, is off by d |gradient| where the texture has that gradient. d is the standard error of
 * the photograph's viewpoint, as `weft register` wrote it to the provenance of the dataset; the gradient is that of at
 * most 16 x 16 texels from the middle, and of means over squares of them for coarser levels, where d counts in their
 * texels. The share is 1.96 times the root mean square over the views of a ring, in half widths. A dataset that does
 * not say how well it was registered leaves has_registration false. Errors: those of reading; WEFT_SYSTEM for memory.
 */
weft_code weft_certify_registration(weft_dataset *dataset, weft_certificate *certificate, weft_error *error);

#endif
