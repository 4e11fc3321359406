/* Reflectance of invented texels, for tests and benches of the fitter. Deterministic. */
#ifndef WEFT_TESTS_SYNTHETIC_TEXEL_H
#define WEFT_TESTS_SYNTHETIC_TEXEL_H

#include "btf/dataset/dataset.h"
#include "compress/fit/fit.h"

#include <stdint.h>

typedef enum synthetic_kind {
    SYNTHETIC_LAFORTUNE, /* two Lafortune lobes x T: the model itself */
    SYNTHETIC_WARD,      /* two anisotropic Ward lobes on turned frames, view and light shadowing */
    SYNTHETIC_YARN,      /* two crossed yarns: fibre highlights on bent cylinders, parallax between them, shadowing */
    SYNTHETIC_KINDS
} synthetic_kind;

/* A uniform number in [0, 1). */
double synthetic_uniform(uint64_t *state);

/* ubo81 x ubo81, every view with every light. The caller frees with weft_dataset_layout_free. */
weft_code synthetic_layout(int width, int height, weft_dataset_layout *layout, weft_error *error);

/* Samples [image_count][3] of reflectance times cosine of the texel number `seed`, with `noise` (relative, Gaussian).
 * Texels whose seeds share the upper bits (seed / 64) belong to one material and vary slowly. */
void synthetic_texel(const weft_dataset_layout *layout, synthetic_kind kind, uint64_t seed, double noise,
                     float *samples);

/* The truth of a SYNTHETIC_LAFORTUNE texel, channel 0; T in [view_count]. */
void synthetic_truth(const weft_dataset_layout *layout, uint64_t seed, weft_fit *fit, double *table);

#endif
