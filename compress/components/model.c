#include "compress/components/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nodes and smoothness of the maps, chosen once on four cloths and left alone (docs/notes/components.md). Smooth ones
 * serve scattered images. */
static const struct {
    int light_side, view_side;
    float light_smoothness, view_smoothness, view_variance_threshold;
} usual[] = {
    [WEFT_COMPONENTS_OF_LIGHT] = {16, 16, 1e-2f, 3e-3f, 10},
    [WEFT_COMPONENTS_OF_HALF_VECTOR] = {16, 10, 1e-3f, 3e-3f, 10},
    [WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED] = {16, 10, 1e-3f, 3e-3f, 10},
    [WEFT_COMPONENTS_KRIGED_OVER_LIGHT] = {16, 16, 0, 0, 0},
    [WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR] = {16, 10, 0, 0, 0},
};

/* A single view has finer maps for its nodes, which are the same for all directions of view. */
enum { SIDE_OF_ONE_VIEW = 32, LEAST_SIDE = 4 };

weft_components weft_component_plan_powers(const weft_component_plan *plan)
{
    weft_components powers = {.kind = plan->kind,
                              .exponent = plan->exponent,
                              .incidence_power = plan->incidence_power,
                              .cosine_power = plan->cosine_power,
                              .least_incidence = plan->least_incidence};
    if (!weft_components_are_kriged(plan->kind))
        weft_components_set_implied(&powers);
    return powers;
}

static void put_direction(weft_vec3 direction, float *xyz)
{
    xyz[0] = (float)direction.x;
    xyz[1] = (float)direction.y;
    xyz[2] = (float)direction.z;
}

/* Of the lights. */
static float least_cosine(const weft_component_images *images)
{
    weft_real least = 1;
    for (int i = 0; i < images->image_count; i++)
        least = fmin(least, images->light[i].z);
    return (float)fmax(least, (weft_real)1e-3);
}

static void fill_directions(const weft_component_images *images, weft_components *components)
{
    for (int i = 0; i < images->view_count; i++)
        put_direction(images->view[i], components->view + 3 * i);
    for (int i = 0; i < images->image_count; i++)
        put_direction(images->light[i], components->light + 3 * i);
    memcpy(components->first, images->first, ((size_t)images->view_count + 1) * sizeof *components->first);
}

/* Without the weights. */
static float component_at(const weft_component_images *images, const float *vector, size_t i)
{
    return vector[i] / images->weight[i / 3];
}

static void fill_values(const weft_component_images *images, const weft_factorisation *factorisation,
                        weft_components *components)
{
    size_t count = (size_t)components->component_count, series = 3 * count;
    for (size_t k = 0; k < count; k++) {
        const float *vector = factorisation->vector + k * factorisation->length;
        float most = 0;
        for (size_t i = 0; i < 3 * (size_t)components->image_count; i++)
            most = fmaxf(most, fabsf(component_at(images, vector, i)));
        components->scale[k] = most;
        for (size_t i = 0; i < (size_t)components->image_count; i++)
            for (size_t c = 0; c < 3; c++)
                components->value[i * series + 3 * k + c] =
                    weft_half_of_float(most > 0 ? component_at(images, vector, 3 * i + c) / most : 0);
    }
}

weft_code weft_component_model_create(const weft_component_images *images, const weft_factorisation *factorisation,
                                      const weft_component_plan *plan, int width, int height, int level_count,
                                      weft_components **result, weft_error *error)
{
    weft_components shape = weft_component_plan_powers(plan);
    bool is_one_view = images->view_count == 1 && weft_components_are_kriged(plan->kind);
    size_t count = (size_t)factorisation->count;
    shape.component_count = factorisation->count;
    shape.view_count = images->view_count;
    shape.image_count = images->image_count;
    shape.light_side = is_one_view ? SIDE_OF_ONE_VIEW : usual[plan->kind].light_side;
    shape.view_side = is_one_view ? LEAST_SIDE : usual[plan->kind].view_side;
    shape.light_smoothness = usual[plan->kind].light_smoothness;
    shape.view_smoothness = usual[plan->kind].view_smoothness;
    shape.view_variance_threshold = usual[plan->kind].view_variance_threshold;
    shape.least_cosine = least_cosine(images);
    shape.view_length = plan->view_length;
    shape.view_nugget = plan->view_nugget;
    shape.trend = plan->trend;
    WEFT_TRY(weft_components_create(&shape, width, height, level_count, result, error));
    fill_directions(images, *result);
    fill_values(images, factorisation, *result);
    memcpy((*result)->length, plan->length, count * sizeof *plan->length);
    memcpy((*result)->nugget, plan->nugget, count * sizeof *plan->nugget);
    return WEFT_OK;
}

static void copy_twice(const weft_components *from, weft_components *to)
{
    size_t count = (size_t)from->component_count;
    memcpy(to->view, from->view, 3 * (size_t)from->view_count * sizeof *to->view);
    memcpy(to->light, from->light, 3 * (size_t)from->image_count * sizeof *to->light);
    memcpy(to->first, from->first, ((size_t)from->view_count + 1) * sizeof *to->first);
    for (size_t half = 0; half < 2; half++) {
        memcpy(to->scale + half * count, from->scale, count * sizeof *to->scale);
        memcpy(to->length + half * count, from->length, count * sizeof *to->length);
        memcpy(to->nugget + half * count, from->nugget, count * sizeof *to->nugget);
    }
    for (size_t i = 0; i < 2 * (size_t)from->image_count; i++)
        memcpy(to->value + 3 * i * count, from->value + 3 * (i / 2) * count, 3 * count * sizeof *to->value);
}

weft_code weft_component_model_double(weft_components **components, weft_error *error)
{
    const weft_components *from = *components;
    weft_components shape = *from, *twice;
    shape.component_count = 2 * from->component_count;
    WEFT_TRY(
        weft_components_create(&shape, from->level[0].width, from->level[0].height, from->level_count, &twice, error));
    copy_twice(from, twice);
    weft_components_free(*components);
    *components = twice;
    return WEFT_OK;
}

static void factors_of_view(const weft_component_maps *maps, const weft_component_images *images, int view,
                            float *factor)
{
    size_t count = (size_t)maps->components->component_count;
    float at[3 * WEFT_COMPONENTS_MAX];
    for (size_t i = images->first[view]; i < images->first[view + 1]; i++) {
        weft_component_factors(maps, images->light[i], images->view[view], at);
        for (size_t k = 0; k < 3 * count; k++)
            factor[k / 3 * images->length + 3 * i + k % 3] = images->weight[i] * at[k];
    }
}

void weft_component_model_factors(const weft_component_maps *maps, const weft_component_images *images, float *factor)
{
    memset(factor, 0, (size_t)maps->components->component_count * images->length * sizeof *factor);
#pragma omp parallel for schedule(dynamic)
    for (int view = 0; view < images->view_count; view++)
        factors_of_view(maps, images, view, factor);
}

void weft_component_model_factors_alone(const weft_component_maps *maps, const weft_component_images *images,
                                        float *factor)
{
    memset(factor, 0, (size_t)maps->components->component_count * images->length * sizeof *factor);
    for (int view = 0; view < images->view_count; view++)
        factors_of_view(maps, images, view, factor);
}
