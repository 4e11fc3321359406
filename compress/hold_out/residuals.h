/* The residuals of held-out photographs: what a model says of them, beside what they say, texel by texel and of means
 * over ever larger squares of texels, as mip levels have them. */
#ifndef WEFT_COMPRESS_HOLD_OUT_RESIDUALS_H
#define WEFT_COMPRESS_HOLD_OUT_RESIDUALS_H

#include "compress/hold_out/trial.h"

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
    int level_count; /* of the excerpt: level k has squares of 2^k x 2^k of its texels */
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
    const uint8_t *level;        /* [texel] of an excerpt whose texels are of several levels (excerpt_levels.h); NULL:
                                    they are of level 0, and means over squares of them are those of the others */
} weft_residuals_taken;

/* Adds the residuals of what is said of some images of an excerpt. `moved` are the same samples as a material says them
 * whose stored numbers were moved by a step each (compress/hold_out/rounding.h), or NULL. Errors: WEFT_SYSTEM for
 * memory.
 */
weft_code weft_residuals_add(weft_residuals *residuals, const weft_excerpt *excerpt, const weft_asked_samples *asked,
                             const weft_asked_samples *moved, const weft_residuals_taken *taken, weft_error *error);

#endif
