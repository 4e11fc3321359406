#include "btf/dataset/dataset.h"
#include "compare/error_budget/error_budget.h"
#include "evaluate/model.h"
#include "evaluate/raw_directions.h"
#include "geometry/light/sample_sequence.h"

#include <math.h>

/* What keeps the random numbers of a query apart: those of the query itself; of the cloth, and of the samples around,
 * for each of the two answers. */
enum { KEY_OF_QUERY = 0, KEY_OF_CLOTH = 1, KEY_OF_SAMPLES = 3 };

enum { NUMBERS_OF_QUERY = 6, REPORTED = 64 };

typedef struct asking {
    const weft_source_stages *stages;
    const weft_source_queries *queries;
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    weft_view_order order;
    weft_raw_directions directions;
    weft_model *registered, *fitted, *stored;
    double least_cosine;
} asking;

/* ---- The queries ---- */

typedef struct query {
    weft_cloth_texel texel;
    weft_query at;
    uint64_t key;
} query;

/* Evenly in [0, 1). */
static double uniform(uint64_t key, uint64_t number)
{
    return (double)(weft_sequence_key(key, number) >> 11) * 0x1p-53;
}

/* Evenly in solid angle about the normal. */
static weft_vec3 direction_within(double least_cosine, double across, double around)
{
    double z = 1 - across * (1 - least_cosine), radius = sqrt(1 - z * z), phi = 2 * WEFT_PI * around;
    return weft_vec3_of(radius * cos(phi), radius * sin(phi), z);
}

static query query_of(const asking *a, int number)
{
    const weft_dataset_layout *layout = a->layout;
    double drawn[NUMBERS_OF_QUERY];
    query q = {.key = weft_sequence_key(a->queries->seed, (uint64_t)number)};
    for (uint64_t i = 0; i < NUMBERS_OF_QUERY; i++)
        drawn[i] = uniform(weft_sequence_key(q.key, KEY_OF_QUERY), i);
    q.texel = (weft_cloth_texel){layout->width, layout->height, (int)(drawn[0] * layout->width),
                                 (int)(drawn[1] * layout->height)};
    q.at = (weft_query){.light = direction_within(a->least_cosine, drawn[2], drawn[3]),
                        .view = direction_within(a->least_cosine, drawn[4], drawn[5]),
                        .has_place = true,
                        .u = (q.texel.x + 0.5) / layout->width,
                        .v = 1 - (q.texel.y + 0.5) / layout->height};
    return q;
}

/* The lower of the outermost view and the outermost light. */
static double least_cosine_of(const weft_dataset_layout *layout)
{
    weft_real view = 1, light = 1;
    for (int i = 0; i < layout->view_count; i++)
        view = fmin(view, layout->view[i].z);
    for (int i = 0; i < layout->image_count; i++)
        light = fmin(light, layout->light[i].z);
    return (double)fmax(view, light);
}

/* ---- What the cloth says ---- */

/* Interpolated as raw BTF is: each sample divided by the cosine of its own light. */
static void ask_samples(const asking *a, const query *q, uint64_t key, double value[3])
{
    weft_raw_stencil stencil = weft_raw_stencil_of(&a->directions, &a->order, q->at.light, q->at.view);
    double sum[3] = {0};
    for (int i = 0; i < stencil.count; i++) {
        int image = stencil.image[i];
        weft_vec3 light = a->layout->light[image], view = a->layout->view[a->layout->view_of_image[image]];
        weft_rgb exact = weft_cloth_reflectance(a->stages->sample, &q->texel, light, view, a->queries->paths,
                                                weft_sequence_key(key, (uint64_t)i));
        double weight = stencil.weight[i] / (double)light.z;
        sum[0] += weight * exact.r;
        sum[1] += weight * exact.g;
        sum[2] += weight * exact.b;
    }
    for (int c = 0; c < 3; c++)
        value[c] = sum[c] * (double)q->at.light.z;
}

static void ask_cloth(const asking *a, const query *q, weft_source_answer *answer)
{
    for (uint64_t i = 0; i < 2; i++) {
        weft_rgb exact = weft_cloth_reflectance(a->stages->sample, &q->texel, q->at.light, q->at.view,
                                                a->queries->paths, weft_sequence_key(q->key, KEY_OF_CLOTH + i));
        answer->cloth[i][0] = exact.r;
        answer->cloth[i][1] = exact.g;
        answer->cloth[i][2] = exact.b;
        ask_samples(a, q, weft_sequence_key(q->key, KEY_OF_SAMPLES + i), answer->sampled[i]);
    }
}

/* ---- What is made of it ---- */

static weft_code ask_model(weft_model *model, const weft_query *at, double value[3], weft_error *error)
{
    weft_rgb brdf;
    WEFT_TRY(weft_model_brdf(model, at, &brdf, error));
    double scale = WEFT_PI * (double)at->light.z;
    value[0] = scale * brdf.r;
    value[1] = scale * brdf.g;
    value[2] = scale * brdf.b;
    return WEFT_OK;
}

/* Those that no registered sample answers are left out; the others move up. */
static weft_code ask_models(const asking *a, weft_source_answer *answer, weft_source_span *span, weft_error *error)
{
    for (int i = 0; i < a->queries->count; i++) {
        query q = query_of(a, i);
        weft_source_answer *to = &answer[i - span->unseen];
        *to = answer[i];
        WEFT_TRY(ask_model(a->registered, &q.at, to->registered, error));
        WEFT_TRY(ask_model(a->fitted, &q.at, to->fitted, error));
        WEFT_TRY(ask_model(a->stored, &q.at, to->stored, error));
        span->asked++;
        span->unseen += isnan(to->registered[0]);
    }
    return WEFT_OK;
}

/* ---- The whole ---- */

static weft_code prepare(asking *a, weft_error *error)
{
    const weft_model_options usual = {0};
    WEFT_TRY(weft_dataset_open(a->stages->registered, &a->dataset, error));
    a->layout = weft_dataset_get_layout(a->dataset);
    if (a->layout->distance != WEFT_FAR || a->layout->values != WEFT_REFLECTANCE_COSINE)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' was not registered from a session", a->stages->registered);
    a->least_cosine = least_cosine_of(a->layout);
    WEFT_TRY(weft_view_order_create(a->layout, NULL, &a->order, error));
    WEFT_TRY(weft_raw_directions_create(a->layout, &a->order, 0, 0, &a->directions, error));
    WEFT_TRY(weft_model_open(a->stages->registered, &usual, &a->registered, error));
    WEFT_TRY(weft_model_open(a->stages->fitted, &usual, &a->fitted, error));
    return weft_model_open(a->stages->stored, &usual, &a->stored, error);
}

static void put_away(asking *a)
{
    weft_model_close(a->stored);
    weft_model_close(a->fitted);
    weft_model_close(a->registered);
    weft_raw_directions_free(&a->directions);
    weft_view_order_free(&a->order);
    weft_dataset_close(a->dataset);
}

weft_code weft_source_answers(const weft_source_stages *stages, const weft_source_queries *queries,
                              const weft_progress *progress, weft_source_answer *answer, weft_source_span *span,
                              weft_error *error)
{
    asking a = {.stages = stages, .queries = queries};
    *span = (weft_source_span){0};
    weft_code code = prepare(&a, error);
    for (int first = 0; code == WEFT_OK && first < queries->count; first += REPORTED) {
        int end = first + REPORTED < queries->count ? first + REPORTED : queries->count;
        weft_progress_report(progress, "asking the cloth", first, queries->count);
#pragma omp parallel for schedule(dynamic, 4)
        for (int i = first; i < end; i++) {
            query q = query_of(&a, i);
            ask_cloth(&a, &q, &answer[i]);
        }
    }
    if (code == WEFT_OK)
        code = ask_models(&a, answer, span, error);
    span->theta_rad = acos(a.least_cosine);
    put_away(&a);
    return code;
}

/* ---- Cloth ---- */

/* Keeps the place in the texel apart from the bounces of the path, which count from 0. */
#define PLACE_KEY 0x10000u

weft_rgb weft_cloth_reflectance(const weft_virtual_sample *sample, const weft_cloth_texel *texel, weft_vec3 light,
                                weft_vec3 view, int paths, uint64_t key)
{
    double side = sample->opening_mm;
    weft_rgb sum = {0, 0, 0};
    for (uint32_t i = 0; i < (uint32_t)paths; i++) {
        double point[2];
        weft_sequence_point(weft_sequence_key(key, PLACE_KEY), i, point);
        double x_mm = ((texel->x + point[0]) / texel->width - 0.5) * side;
        double y_mm = (0.5 - (texel->y + point[1]) / texel->height) * side;
        weft_rgb value = weft_virtual_sample_reflect(sample, x_mm, y_mm, light, view, key, i);
        sum = (weft_rgb){sum.r + value.r, sum.g + value.g, sum.b + value.b};
    }
    return (weft_rgb){sum.r / paths, sum.g / paths, sum.b / paths};
}
