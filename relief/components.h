/* The principal components of the light vectors of a dataset. Private to the room. */
#ifndef WEFT_RELIEF_COMPONENTS_H
#define WEFT_RELIEF_COMPONENTS_H

#include "relief/features.h"

typedef struct weft_light_components {
    int length;       /* lights x 3 */
    float *component; /* [length][WEFT_FEATURES] orthonormal columns, the strongest first */
    float *mean;      /* [view_count][length] of every photograph: what stands in for masked samples */
    double explained; /* share of the energy */
} weft_light_components;

/* From the texels of 8 x 8 places spread over the material, in all views. Not centred: what is compared later are
 * differences, whose energy the mean would not change. Errors: WEFT_BAD_INPUT where no sample there is valid or all are
 * black; those of reading; WEFT_SYSTEM. The caller frees with weft_light_components_free. */
weft_code weft_light_components_find(weft_dataset *dataset, const weft_relief_views *views,
                                     weft_light_components *components, weft_error *error);
void weft_light_components_free(weft_light_components *components);

/* The light vector of a view in a texel: value [length] from sample [image_count][3] and mask [image_count], masked
 * ones from the mean, as bright as the others are to theirs; false where more than a quarter of them are masked.
 * Thread-safe. */
bool weft_light_vector(const weft_relief_views *views, const weft_light_components *components, int view,
                       const weft_half *sample, const uint8_t *mask, float *value);

#endif
