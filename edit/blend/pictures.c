#include "edit/blend/steps.h"

#include "btf/dataset/measured.h"
#include "btf/direction/direction.h"
#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct pair {
    weft_vec3 light, view;
} pair;

/* ---- Directions ---- */

/* `share` of the angle of the cone away from its axis, turned by so many degrees about it. */
static weft_vec3 within(const weft_cone *cone, double share, double turn_deg)
{
    weft_vec3 beside = fabs(cone->axis.x) < 0.9 ? weft_vec3_of(1, 0, 0) : weft_vec3_of(0, 1, 0);
    weft_vec3 across = weft_unit(weft_cross(cone->axis, beside)), along = weft_cross(cone->axis, across);
    double angle = share * fmin(cone->angle_rad, weft_rad_of_deg(75)), turn = weft_rad_of_deg(turn_deg);
    weft_vec3 side = weft_add(weft_scale(across, cos(turn)), weft_scale(along, sin(turn)));
    weft_vec3 d = weft_add(weft_scale(cone->axis, cos(angle)), weft_scale(side, sin(angle)));
    d.z = fmax(d.z, 0.1);
    return weft_unit(d);
}

static weft_code choose_pairs(const weft_material *material, weft_blend_pairs which, pair pairs[WEFT_BLEND_PAIRS],
                              weft_error *error)
{
    bool known;
    weft_measured measured;
    WEFT_TRY(weft_measured_parse(material->metadata, &known, &measured, error));
    weft_cone everywhere = {weft_vec3_of(0, 0, 1), weft_rad_of_deg(75)};
    const weft_cone *view = known ? &measured.view : &everywhere, *light = known ? &measured.light : &everywhere;
    /* The second set lies between the directions of the first, in azimuth and in slant. */
    double between = which == WEFT_BLEND_JUDGES ? 0.5 : 0, slant = which == WEFT_BLEND_JUDGES ? 0.2 : 0;
    for (int i = 0; i < WEFT_BLEND_PAIRS; i++)
        pairs[i] = (pair){within(light, (i % 2 ? 0.8 : 0.4) - slant, 360.0 * (i + between) / WEFT_BLEND_PAIRS),
                          within(view, (i < 4 ? 0 : 0.6) + slant, 360.0 * 3 * (i + between) / WEFT_BLEND_PAIRS)};
    return WEFT_OK;
}

/* ---- Evaluation ---- */

typedef struct evaluation {
    const weft_material *material;
    weft_table_directions directions;
    weft_component_maps maps;
    pair pairs[WEFT_BLEND_PAIRS];
    float factor[WEFT_BLEND_PAIRS][3 * WEFT_COMPONENTS_MAX];
} evaluation;

static weft_code prepare(const weft_material *material, weft_blend_pairs which, evaluation *e, weft_error *error)
{
    *e = (evaluation){.material = material};
    WEFT_TRY(choose_pairs(material, which, e->pairs, error));
    WEFT_TRY(weft_table_directions_create(material, &e->directions, error));
    if (!material->components)
        return WEFT_OK;
    WEFT_TRY(weft_component_maps_create(material->components, &e->maps, error));
    for (int i = 0; i < WEFT_BLEND_PAIRS; i++)
        weft_component_factors(&e->maps, e->pairs[i].light, e->pairs[i].view, e->factor[i]);
    return WEFT_OK;
}

static void release(evaluation *e)
{
    weft_table_directions_free(&e->directions);
    weft_component_maps_free(&e->maps);
}

static void evaluate_texel(const evaluation *e, int x, int y, float value[WEFT_BLEND_VALUES])
{
    const weft_components *components = e->maps.components;
    for (int i = 0; i < WEFT_BLEND_PAIRS; i++, value += 4) {
        weft_vec3 light = e->pairs[i].light;
        weft_rgba seen = weft_material_texel(e->material, &e->directions, 0, x, y, light, e->pairs[i].view);
        weft_rgb r = {seen.r * light.z, seen.g * light.z, seen.b * light.z};
        if (components)
            r = weft_components_texel(components, components->component_count, e->factor[i], 0, x, y, light.z);
        value[0] = (float)sqrt(fmax(0, r.r));
        value[1] = (float)sqrt(fmax(0, r.g));
        value[2] = (float)sqrt(fmax(0, r.b));
        value[3] = (float)seen.a;
    }
}

weft_code weft_blend_pictures_make(const weft_material *material, weft_blend_pairs which, weft_blend_pictures *pictures,
                                   weft_error *error)
{
    WEFT_TRY(weft_blend_pictures_create(material->level[0].width, material->level[0].height, pictures, error));
    evaluation e;
    weft_code code = prepare(material, which, &e, error);
    if (code == WEFT_OK) {
#pragma omp parallel for schedule(dynamic, 4)
        for (int y = 0; y < pictures->height; y++)
            for (int x = 0; x < pictures->width; x++)
                evaluate_texel(&e, x, y, weft_blend_texel(pictures, x, y));
    } else
        weft_blend_pictures_free(pictures);
    release(&e);
    return code;
}

/* ---- Pictures ---- */

weft_code weft_blend_pictures_create(int width, int height, weft_blend_pictures *pictures, weft_error *error)
{
    size_t count = (size_t)width * (size_t)height * WEFT_BLEND_VALUES;
    *pictures = (weft_blend_pictures){width, height, calloc(count, sizeof(float))};
    return pictures->value ? WEFT_OK : weft_fail_memory(error, "pictures of the material", count * sizeof(float));
}

void weft_blend_pictures_free(weft_blend_pictures *pictures)
{
    free(pictures->value);
    *pictures = (weft_blend_pictures){0};
}

weft_code weft_blend_pictures_transpose(const weft_blend_pictures *pictures, weft_blend_pictures *result,
                                        weft_error *error)
{
    WEFT_TRY(weft_blend_pictures_create(pictures->height, pictures->width, result, error));
    for (int y = 0; y < pictures->height; y++)
        for (int x = 0; x < pictures->width; x++)
            memcpy(weft_blend_texel(result, y, x), weft_blend_texel(pictures, x, y), WEFT_BLEND_VALUES * sizeof(float));
    return WEFT_OK;
}

weft_code weft_blend_pictures_reduce(const weft_blend_pictures *pictures, int side, weft_blend_pictures *result,
                                     weft_error *error)
{
    WEFT_TRY(weft_blend_pictures_create(pictures->width / side, pictures->height / side, result, error));
    float share = 1 / ((float)side * (float)side);
    for (int y = 0; y < result->height * side; y++)
        for (int x = 0; x < result->width * side; x++) {
            const float *from = weft_blend_texel(pictures, x, y);
            float *to = weft_blend_texel(result, x / side, y / side);
            for (int i = 0; i < WEFT_BLEND_VALUES; i++)
                to[i] += share * from[i];
        }
    return WEFT_OK;
}

float weft_blend_difference(const weft_blend_pictures *a, int ax, int ay, const weft_blend_pictures *b, int bx, int by)
{
    const float *p = weft_blend_texel(a, ax, ay), *q = weft_blend_texel(b, bx, by);
    float sum = 0;
    for (int i = 0; i < WEFT_BLEND_VALUES; i++)
        sum += (p[i] - q[i]) * (p[i] - q[i]);
    return sum / WEFT_BLEND_VALUES;
}
