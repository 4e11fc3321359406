/* Which kind of map scattered images have: what the first two kinds say of the images that they are fitted to. None of
 * these lies where the maps have their values, so that this is a question of interpolation. */
#include "compress/components/model.h"

#include <math.h>
#include <stdlib.h>

/* The components that say most decide: maps of all would take as long as the rest of the fit. */
enum { MOST_COMPONENTS = 4 };

typedef struct comparison {
    const weft_dataset_layout *layout;
    const weft_component_images *images;
    const weft_training *training;
    const weft_factorisation *components;
    const weft_component_maps *maps;
} comparison;

static void add_errors(const comparison *c, const float *factor, int texel, const float *coefficient, double *square,
                       double *energy)
{
    const float *vector = c->training->vector + (size_t)texel * c->training->length;
    const uint8_t *known = c->training->known + (size_t)texel * c->training->image_count;
    size_t length = c->images->length;
    for (size_t i = 0; i < 3 * (size_t)c->images->image_count; i++) {
        float value = 0;
        if (!known[i / 3])
            continue;
        for (size_t k = 0; k < (size_t)c->components->count; k++)
            value += coefficient[k] * factor[k * length + i];
        double difference = (double)(fmaxf(value, 0) - vector[i]);
        *square += difference * difference;
        *energy += (double)vector[i] * (double)vector[i];
    }
}

/* Every texel by its own factors: as many as near images are completed for would do, but far ones take no longer. */
static weft_code add_near(const comparison *c, double *square, double *energy, weft_error *error)
{
    enum { MOST_TEXELS = 96 };
    weft_near_projector projector;
    int texels = c->training->texel_count, count = texels < MOST_TEXELS ? texels : MOST_TEXELS;
    WEFT_TRY(weft_near_projector_create(c->layout, c->components, c->maps, c->images, &projector, error));
    weft_code code = WEFT_OK;
    for (int i = 0; i < count && code == WEFT_OK; i++) {
        int texel = (int)((long)i * texels / count);
        float coefficient[WEFT_COMPONENTS_MAX];
        weft_near_projector_move(&projector, c->training->place[texel].x, c->training->place[texel].y);
        code = weft_near_projector_solve(&projector, c->training->vector + (size_t)texel * c->training->length,
                                         c->training->known + (size_t)texel * c->training->image_count, coefficient,
                                         error);
        if (code == WEFT_OK)
            add_errors(c, projector.factor, texel, coefficient, square, energy);
    }
    weft_near_projector_free(&projector);
    return code;
}

static weft_code add_far(const comparison *c, double *square, double *energy, weft_error *error)
{
    weft_near_projector shared; /* whose factors serve all texels */
    weft_projector projector = {0};
    WEFT_TRY(weft_near_projector_create(c->layout, c->components, c->maps, c->images, &shared, error));
    weft_component_model_factors(c->maps, c->images, shared.factor);
    weft_code code = weft_projector_create(&shared.prior, shared.factor, c->images->image_count, &projector, error);
    for (int texel = 0; texel < c->training->texel_count && code == WEFT_OK; texel++) {
        const float *vector = c->training->vector + (size_t)texel * c->training->length;
        const uint8_t *known = c->training->known + (size_t)texel * c->training->image_count;
        float coefficient[WEFT_COMPONENTS_MAX];
        code = weft_projector_solve(&projector, &vector, &known, 1, coefficient, error);
        if (code == WEFT_OK)
            add_errors(c, shared.factor, texel, coefficient, square, energy);
    }
    weft_projector_free(&projector);
    weft_near_projector_free(&shared);
    return code;
}

static weft_code try_kind(comparison *c, const weft_component_images *places, weft_components_kind kind,
                          double *error_of, weft_error *error)
{
    weft_components *components = NULL;
    weft_component_maps maps = {0};
    double square = 0, energy = 0;
    const weft_component_plan plan = {.kind = kind};
    WEFT_TRY(weft_component_model_create(places, c->components, &plan, 1, 1, 1, &components, error));
    weft_code code = weft_component_maps_create(components, &maps, error);
    c->maps = &maps;
    if (code == WEFT_OK)
        code = c->layout->distance == WEFT_NEAR ? add_near(c, &square, &energy, error)
                                                : add_far(c, &square, &energy, error);
    *error_of = energy > 0 ? sqrt(square / energy) : 0;
    c->maps = NULL;
    weft_component_maps_free(&maps);
    weft_components_free(components);
    return code;
}

weft_code weft_component_model_choose_scattered(const weft_dataset_layout *layout, const weft_component_images *images,
                                                const weft_training *training, const weft_component_images *places,
                                                const weft_factorisation *components, weft_component_plan *plan,
                                                double error_of[2], weft_error *error)
{
    weft_factorisation first = *components;
    first.count = components->count < MOST_COMPONENTS ? components->count : MOST_COMPONENTS;
    comparison c = {.layout = layout, .images = images, .training = training, .components = &first};
    WEFT_TRY(try_kind(&c, places, WEFT_COMPONENTS_OF_LIGHT, &error_of[0], error));
    WEFT_TRY(try_kind(&c, places, WEFT_COMPONENTS_OF_HALF_VECTOR, &error_of[1], error));
    *plan = (weft_component_plan){
        .kind = error_of[1] < error_of[0] ? WEFT_COMPONENTS_OF_HALF_VECTOR : WEFT_COMPONENTS_OF_LIGHT, .exponent = 1};
    return WEFT_OK;
}
