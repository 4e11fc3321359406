#include "evaluate/model.h"

#include <math.h>

/* Fewer queries are done sooner than other threads are woken. */
enum { FEW_QUERIES = 64, QUERIES_AT_ONCE = 32 };

/* Queries as arrays; `uv`, `level` and `light` may be NULL. */
typedef struct queries {
    size_t count;
    const double *uv, *level, *light, *view;
} queries;

static weft_vec3 direction_at(const double *direction, size_t i)
{
    return weft_vec3_of(direction[3 * i], direction[3 * i + 1], direction[3 * i + 2]);
}

static weft_query query_at(const queries *q, size_t i)
{
    weft_query query = {.view = weft_unit(direction_at(q->view, i)), .has_place = q->uv != NULL};
    query.light = q->light ? weft_unit(direction_at(q->light, i)) : query.view;
    query.u = q->uv ? q->uv[2 * i] : 0;
    query.v = q->uv ? q->uv[2 * i + 1] : 0;
    query.level = q->level ? q->level[i] : 0;
    return query;
}

static void put(weft_rgb value, double to[3])
{
    to[0] = value.r;
    to[1] = value.g;
    to[2] = value.b;
}

/* ---- Everything is checked before anything is computed ---- */

static weft_code check_direction(const char *name, const double *direction, size_t i, weft_error *error)
{
    weft_vec3 d = direction_at(direction, i);
    double length = weft_length(d);
    return length > 0 && isfinite(length)
               ? WEFT_OK
               : weft_fail(error, WEFT_BAD_USAGE, "query %zu: %s %g, %g, %g is no direction", i, name, d.x, d.y, d.z);
}

static weft_code check(const weft_model *model, const queries *q, weft_error *error)
{
    bool has_levels = weft_model_material(model) != NULL;
    for (size_t i = 0; i < q->count; i++) {
        if (q->uv && !(isfinite(q->uv[2 * i]) && isfinite(q->uv[2 * i + 1])))
            return weft_fail(error, WEFT_BAD_USAGE, "query %zu: u, v are %g, %g", i, q->uv[2 * i], q->uv[2 * i + 1]);
        if (q->level && !(q->level[i] >= 0 && (has_levels || q->level[i] == 0)))
            return weft_fail(error, WEFT_BAD_USAGE, "query %zu: level %g%s", i, q->level[i],
                             q->level[i] > 0 ? ", but only a .weft has levels" : " is negative");
        if (q->light)
            WEFT_TRY(check_direction("light", q->light, i, error));
        WEFT_TRY(check_direction("view", q->view, i, error));
    }
    return WEFT_OK;
}

/* ---- Values ---- */

weft_code weft_evaluate(weft_model *model, size_t count, const double *uv, const double *level, const double *light,
                        const double *view, double *brdf, weft_error *error)
{
    const queries q = {count, uv, level, light, view};
    WEFT_TRY(check(model, &q, error));
    /* A mean uses all threads by itself. */
    bool is_shared = weft_model_is_thread_safe(model) && uv && count > FEW_QUERIES;
    weft_code code = WEFT_OK;
#pragma omp parallel for schedule(dynamic, QUERIES_AT_ONCE) if (is_shared)
    for (size_t i = 0; i < count; i++) {
        weft_query query = query_at(&q, i);
        weft_rgb value = {NAN, NAN, NAN};
        if (is_shared)
            weft_model_brdf(model, &query, &value, NULL);
        else if (code == WEFT_OK)
            code = weft_model_brdf(model, &query, &value, error);
        put(value, brdf + 3 * i);
    }
    return code;
}

weft_code weft_evaluate_opacity(const weft_model *model, size_t count, const double *uv, const double *level,
                                const double *view, double *opacity, weft_error *error)
{
    const queries q = {count, uv, level, NULL, view};
    if (!uv)
        return weft_fail(error, WEFT_BAD_USAGE, "opacity needs texture coordinates");
    WEFT_TRY(check(model, &q, error));
#pragma omp parallel for schedule(dynamic, QUERIES_AT_ONCE) if (count > FEW_QUERIES)
    for (size_t i = 0; i < count; i++) {
        weft_query query = query_at(&q, i);
        opacity[i] = weft_model_opacity(model, &query);
    }
    return WEFT_OK;
}

weft_code weft_evaluate_half_width(const weft_model *model, size_t count, const double *level, const double *light,
                                   const double *view, const double *brdf, double *half_width, weft_error *error)
{
    const queries q = {count, NULL, level, light, view};
    if (!weft_model_has_interval(model))
        return weft_fail(error, WEFT_BAD_USAGE, "the model was opened without intervals");
    WEFT_TRY(check(model, &q, error));
    for (size_t i = 0; i < count; i++) {
        weft_query query = query_at(&q, i);
        weft_rgb value = {brdf[3 * i], brdf[3 * i + 1], brdf[3 * i + 2]};
        put(weft_model_half_width(model, &query, &value), half_width + 3 * i);
    }
    return WEFT_OK;
}

/* ---- Levels ---- */

int weft_model_level_count(const weft_model *model)
{
    const weft_material *material = weft_model_material(model);
    return material ? weft_material_level_count(material) : 1;
}

double weft_model_level_of_footprint(const weft_model *model, const double footprint[4])
{
    const weft_material *material = weft_model_material(model);
    if (!material)
        return 0;
    int width = weft_material_width(material, 0), height = weft_material_height(material, 0);
    double across = hypot(footprint[0] * width, footprint[1] * height);
    double up = hypot(footprint[2] * width, footprint[3] * height);
    double level = log2(fmax(across, up));
    return level > 0 ? fmin(level, weft_material_level_count(material) - 1) : 0;
}
