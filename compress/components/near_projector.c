#include "compress/components/factorisation.h"
#include "compress/components/model.h"

#include <stdlib.h>

enum { ALIGNMENT = 64 };

weft_code weft_near_projector_create(const weft_dataset_layout *layout, const weft_factorisation *components,
                                     const weft_component_maps *maps, const weft_component_images *images,
                                     weft_near_projector *projector, weft_error *error)
{
    size_t bytes = (size_t)components->count * images->length * sizeof(float);
    *projector = (weft_near_projector){.layout = layout, .maps = maps, .prior = *components};
    projector->prior.length = images->length;
    WEFT_TRY(weft_component_images_copy(images, &projector->images, error));
    projector->factor = aligned_alloc(ALIGNMENT, bytes);
    if (projector->factor)
        return WEFT_OK;
    weft_near_projector_free(projector);
    return weft_fail_memory(error, "factors of components", bytes);
}

void weft_near_projector_free(weft_near_projector *projector)
{
    weft_component_images_free(&projector->images);
    free(projector->factor);
    *projector = (weft_near_projector){0};
}

void weft_near_projector_move(weft_near_projector *projector, int x, int y)
{
    weft_component_images_look_from(projector->layout, x, y, &projector->images);
}

weft_code weft_near_projector_solve(weft_near_projector *projector, const float *vector, const uint8_t *valid,
                                    float *coefficient, weft_error *error)
{
    weft_projector own;
    weft_component_model_factors_alone(projector->maps, &projector->images, projector->factor);
    WEFT_TRY(weft_projector_create(&projector->prior, projector->factor, projector->images.image_count, &own, error));
    weft_code code = weft_projector_solve(&own, &vector, &valid, 1, coefficient, error);
    weft_projector_free(&own);
    return code;
}
