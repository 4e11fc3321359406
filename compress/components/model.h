/* The shared half of components: components at the images of a dataset, and what their maps make of them. */
#ifndef WEFT_COMPRESS_COMPONENTS_MODEL_H
#define WEFT_COMPRESS_COMPONENTS_MODEL_H

#include "compress/components/factorisation.h"
#include "reflectance/components/components.h"

/* Components without coefficients, for a material of width x height texels: a coefficient of 1 stands for a whole
 * component. `texels` names the size and the number of levels. The caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_create(const weft_component_images *images, const weft_factorisation *factorisation,
                                      weft_components_kind kind, int width, int height, int level_count,
                                      weft_components **result, weft_error *error);

/* Puts components without coefficients, which are freed, into the place of themselves twice over, one half behind the
 * other. Errors: WEFT_BAD_USAGE for more than WEFT_COMPONENTS_MAX, WEFT_SYSTEM. */
weft_code weft_component_model_double(weft_components **components, weft_error *error);

/* What the maps give at the images themselves, times their weights: factor [layer][images->length], aligned to 64
 * bytes. */
void weft_component_model_factors(const weft_component_maps *maps, const weft_component_images *images, float *factor);

/* The same by the calling thread alone. */
void weft_component_model_factors_alone(const weft_component_maps *maps, const weft_component_images *images,
                                        float *factor);

/* Which kind of maps predicts images better that it has not seen: a tenth of the views and of the lights are held out
 * of `training`, all kinds are fitted to the rest, and error_of receives the relative RMSE of each on what was held
 * out. All 0, and light, where there is too little to hold out. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_choose(const weft_component_images *images, const weft_training *training,
                                      int component_count, weft_components_kind *kind,
                                      double error_of[WEFT_COMPONENTS_KINDS], weft_error *error);

/* Which kind of maps says more of the images themselves, where the components belong to other directions `places`
 * (compress/components/completion.h): the first two kinds are fitted to the training texels. `layout` is that of the
 * dataset. Errors: WEFT_SYSTEM. */
weft_code weft_component_model_choose_scattered(const weft_dataset_layout *layout, const weft_component_images *images,
                                                const weft_training *training, const weft_component_images *places,
                                                const weft_factorisation *factorisation, weft_components_kind *kind,
                                                double error_of[2], weft_error *error);

#endif
