/* Reflectance transformation imaging: how a texel that one camera photographed under many lamps is usually carried to
 * other lamps. All texels with the same lamps share the weights of their photographs,
 *
 *     value(l) = sum_i w_i(l) value_i
 *
 * because each model is linear in the photographs: with its functions P of the light, and A = 1 for a fit by least
 * squares or the kernel of a spline, k(l) = 0 or the kernel between l and the lamps,
 *
 *     w = A^-1 (k + P (P' A^-1 P)^-1 (p - P' A^-1 k))
 *
 * The values are those that a screen shows, coded by the curve of sRGB, as is usual. Lights are unit vectors.
 *
 *   PTM  polynomial texture maps (Malzbender, Gelb and Wolters 2001): 1, x, y, x^2, xy, y^2
 *   HSH  hemispherical harmonics (Gautron et al. 2004) up to order 2 or 3: spherical harmonics in 2 z - 1 and the
 * azimuth RBF  a thin-plate spline (Duchon 1977) of x and y through the photographs */
#ifndef WEFT_COMPARE_RTI_RTI_H
#define WEFT_COMPARE_RTI_RTI_H

#include "btf/dataset/dataset.h"

typedef enum weft_rti_model {
    WEFT_RTI_PTM,
    WEFT_RTI_HSH_2,
    WEFT_RTI_HSH_3,
    WEFT_RTI_RBF,
    WEFT_RTI_MODELS
} weft_rti_model;

/* "PTM", "HSH of order 2", ... Pure. */
const char *weft_rti_name(weft_rti_model model);

/* Numbers that are kept of a texel and channel, a byte each: coefficients, or all photographs of a spline. Pure. */
int weft_rti_coefficients(weft_rti_model model, int photographs);

/* Fewer photographs do not determine the model. Pure. */
int weft_rti_least_photographs(weft_rti_model model);

/* The weights of photographs under light [count] for each of the lights asked [asked_count]: weight
 * [asked_count][count]. Where lamps do not determine all functions, as on one ring, one of the solutions is given. A
 * light below the horizon counts as at it. Errors: WEFT_BAD_INPUT for lights that do not determine the model or are no
 * numbers; WEFT_OUT_OF_MEMORY. Thread-safe. */
weft_code weft_rti_weights(weft_rti_model model, const weft_vec3 *light, int count, const weft_vec3 *asked,
                           int asked_count, double *weight, weft_error *error);

/* ---- Texels in memory ---- */

/* Whether the lamps of a layout are carried to others so: one view, far lights, and photographs enough even without
 * every fifth. Pure. */
bool weft_rti_is_for(weft_rti_model model, const weft_dataset_layout *layout);

/* Predicts every image of every texel from those that are neither masked nor have left_out[image] != 0: `samples`
 * [texel_count][image_count][3], `mask` [texel_count][image_count], predicted [texel_count][image_count][3] in the
 * quantity of the layout; NaN for a texel of too few. Errors: WEFT_OUT_OF_MEMORY. */
weft_code weft_rti_predict_texels(const weft_dataset_layout *layout, const uint8_t *left_out, weft_rti_model model,
                                  const weft_half *samples, const uint8_t *mask, long texel_count, weft_half *predicted,
                                  weft_error *error);

#endif
