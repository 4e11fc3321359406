/* Lengths, nuggets and trend of kriged maps: those with the least error of values that are left out (Dubrule 1983). */
#include "btf/direction/kriged_map.h"
#include "compress/components/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Views and components that decide; those of a single view have lengths of their own. */
enum {
    MOST_VIEWS = 12,
    MOST_COMPONENTS = 8,
    NODES = 8,             /* at which values of different views are compared, of a square of ... */
    SIDE = 16,             /* ... so many nodes along a side, which are ... */
    SIDE_OF_ONE_VIEW = 32, /* ... those of the maps themselves (compress/components/model.c) */
    LENGTHS = 8,
    NUGGETS = 8,
    CANDIDATES = LENGTHS * NUGGETS
};

static const float length_of[LENGTHS] = {0.15f, 0.25f, 0.4f, 0.6f, 1, 1.6f, 2.5f, 5},
                   nugget_of[NUGGETS] = {1e-5f, 1e-4f, 1e-3f, 1e-2f, 0.03f, 0.1f, 0.3f, 1};

/* Of maps over the lights of few views: they are continued far, and towards a plane. */
static const float trend_of_few_views = 10;

/* What stands beside the variance of a node in the weight of what is left out of it. */
static const double least_variance = 0.05;

/* Values at some places, and what the square of an error counts for at each. */
typedef struct left_out {
    int count, component_count;
    weft_place *place; /* [count] */
    float *noise;      /* [count] */
    float *value;      /* [count][component][3] */
    double *weight;    /* [count] */
} left_out;

static void left_out_free(left_out *set)
{
    free(set->place);
    free(set->noise);
    free(set->value);
    free(set->weight);
}

static weft_code left_out_create(int count, int component_count, left_out *set, weft_error *error)
{
    size_t all = (size_t)count;
    *set = (left_out){.count = count,
                      .component_count = component_count,
                      .place = malloc(all * sizeof *set->place),
                      .noise = calloc(all, sizeof *set->noise),
                      .value = malloc(all * 3 * (size_t)component_count * sizeof *set->value),
                      .weight = malloc(all * sizeof *set->weight)};
    return set->place && set->noise && set->value && set->weight
               ? WEFT_OK
               : weft_fail_memory(error, "values to leave out", all * 3 * (size_t)component_count * sizeof(float));
}

/* Adds the weighted squares of the errors of each component. */
static weft_code add_errors(const left_out *set, const weft_kriged_grid *grid, float nugget, bool ordinary,
                            double *error_of, weft_error *error)
{
    size_t series = 3 * (size_t)set->component_count;
    weft_kriged_map *map = NULL;
    float *residual = malloc((size_t)set->count * series * sizeof *residual);
    if (!residual)
        return weft_fail_memory(error, "errors of values left out", (size_t)set->count * series * sizeof *residual);
    weft_code code = weft_kriged_map_create(&(weft_kriged_places){.grid = grid,
                                                                  .place = set->place,
                                                                  .noise = set->noise,
                                                                  .count = set->count,
                                                                  .nugget = nugget,
                                                                  .ordinary = ordinary},
                                            &map, error);
    if (code == WEFT_OK)
        code = weft_kriged_map_leave_out(map, set->value, (int)series, residual, error);
    for (size_t i = 0; i < (size_t)set->count && code == WEFT_OK; i++)
        for (size_t k = 0; k < series; k++)
            error_of[k / 3] += set->weight[i] * (double)residual[i * series + k] * (double)residual[i * series + k];
    weft_kriged_map_free(map);
    free(residual);
    return code;
}

/* What is tried of one length: of half vectors, or of directions. */
typedef struct square {
    int side;
    bool of_half_vectors, ordinary;
    float trend;
} square;

/* error_of [NUGGETS][component_count], summed over the sets. */
static weft_code try_nuggets(const left_out *set, int set_count, const weft_kriged_grid *grid, bool ordinary,
                             double *error_of, weft_error *error)
{
    size_t count = (size_t)set[0].component_count;
    weft_code result = WEFT_OK;
#pragma omp parallel for schedule(dynamic)
    for (int nugget = 0; nugget < NUGGETS; nugget++)
        for (int i = 0; i < set_count; i++) {
            weft_error own = {0};
            weft_code code =
                add_errors(&set[i], grid, nugget_of[nugget], ordinary, error_of + (size_t)nugget * count, &own);
            if (code == WEFT_OK)
                continue;
#pragma omp critical(weft_try_nuggets)
            {
                result = code;
                if (error)
                    *error = own;
            }
        }
    return result;
}

/* error_of [CANDIDATES][component_count]. */
static weft_code try_candidates(const left_out *set, int set_count, const square *of, double *error_of,
                                weft_error *error)
{
    size_t row = NUGGETS * (size_t)set[0].component_count;
    memset(error_of, 0, LENGTHS * row * sizeof *error_of);
    for (int i = 0; i < LENGTHS; i++) {
        weft_kriged_grid grid;
        WEFT_TRY(weft_kriged_grid_create(of->side, of->of_half_vectors, length_of[i], of->trend, &grid, error));
        weft_code code = try_nuggets(set, set_count, &grid, of->ordinary, error_of + (size_t)i * row, error);
        weft_kriged_grid_free(&grid);
        if (code != WEFT_OK)
            return code;
    }
    return WEFT_OK;
}

/* Of the components first .. last - 1 together. */
static int best_candidate(const double *error_of, size_t count, size_t first, size_t last)
{
    int best = 0;
    double least = INFINITY;
    for (int candidate = 0; candidate < CANDIDATES; candidate++) {
        double sum = 0;
        for (size_t k = first; k < last; k++)
            sum += error_of[(size_t)candidate * count + k];
        if (sum < least) {
            least = sum;
            best = candidate;
        }
    }
    return best;
}

/* ---- Over the light or half vector ---- */

static void take_image(const weft_component_images *images, const weft_factorisation *factorisation,
                       const weft_components *powers, int view, size_t image, left_out *set, size_t at)
{
    weft_vec3 light = images->light[image], half_vector = weft_half_vector(light, images->view[view]);
    double divisor = (double)weft_components_divisor(powers, light, half_vector);
    set->place[at] = weft_components_are_over_half_vector(powers->kind) ? weft_place_of_half_vector(half_vector)
                                                                        : weft_place_of_direction(light);
    set->weight[at] = 1 / (divisor * divisor);
    for (size_t k = 0; k < (size_t)set->component_count; k++)
        for (size_t c = 0; c < 3; c++)
            set->value[(at * (size_t)set->component_count + k) * 3 + c] =
                (float)(divisor * sqrt(factorisation->variance[k]) *
                        (double)(factorisation->vector[k * factorisation->length + 3 * image + c] /
                                 images->weight[image]));
}

static weft_code take_view(const weft_component_images *images, const weft_factorisation *factorisation,
                           const weft_components *powers, int view, int component_count, left_out *set,
                           weft_error *error)
{
    size_t first = images->first[view], count = images->first[view + 1] - first;
    WEFT_TRY(left_out_create((int)count, component_count, set, error));
    for (size_t i = 0; i < count; i++)
        take_image(images, factorisation, powers, view, first + i, set, i);
    return WEFT_OK;
}

/* All components share what the most important of them leave least by; those of one view have their own. */
static void set_lengths(const double *error_of, int tried, weft_component_plan *plan, int count, bool each)
{
    for (int k = 0; k < count; k++) {
        int best = each ? best_candidate(error_of, (size_t)tried, (size_t)k, (size_t)k + 1)
                        : best_candidate(error_of, (size_t)tried, 0, (size_t)tried);
        plan->length[k] = length_of[best / NUGGETS];
        plan->nugget[k] = nugget_of[best % NUGGETS];
    }
}

static weft_code choose_inner(const weft_component_images *images, const weft_factorisation *factorisation,
                              weft_component_plan *plan, weft_error *error)
{
    left_out set[MOST_VIEWS] = {0};
    double error_of[CANDIDATES * WEFT_COMPONENTS_MAX];
    weft_components powers = weft_component_plan_powers(plan);
    int views = images->view_count < MOST_VIEWS ? images->view_count : MOST_VIEWS, count = factorisation->count;
    int tried = images->view_count == 1 || count < MOST_COMPONENTS ? count : MOST_COMPONENTS;
    weft_code code = WEFT_OK;
    for (int i = 0; i < views && code == WEFT_OK; i++)
        code = take_view(images, factorisation, &powers, (int)((long)i * images->view_count / views), tried, &set[i],
                         error);
    if (code == WEFT_OK)
        code = try_candidates(set, views,
                              &(square){images->view_count == 1 ? SIDE_OF_ONE_VIEW : SIDE,
                                        weft_components_are_over_half_vector(plan->kind), false, plan->trend},
                              error_of, error);
    if (code == WEFT_OK)
        set_lengths(error_of, tried, plan, count, images->view_count == 1);
    for (int i = 0; i < views; i++)
        left_out_free(&set[i]);
    return code;
}

/* ---- Over the views ---- */

/* Some nodes that all views share: in steps of the golden section over those within 60 degrees. */
static int shared_node(int number)
{
    double radius = sqrt((number + 0.5) / NODES) * 0.28, azimuth = 2.399963229728653 * number;
    int x = (int)lround((0.5 + radius * cos(azimuth)) * (SIDE - 1)),
        y = (int)lround((0.5 + radius * sin(azimuth)) * (SIDE - 1));
    return y * SIDE + x;
}

/* What the map of one view says at these. */
static weft_code take_nodes(const weft_component_images *images, const weft_factorisation *factorisation,
                            const weft_component_plan *plan, const weft_kriged_grid *grid, int view, left_out *at,
                            weft_error *error)
{
    size_t series = 3 * (size_t)at[0].component_count, nodes = (size_t)grid->node_count;
    weft_components powers = weft_component_plan_powers(plan);
    weft_kriged_map *map = NULL;
    left_out own = {0};
    float *value = malloc(nodes * series * sizeof *value), *variance = malloc(nodes * sizeof *variance);
    weft_code code = value && variance
                         ? take_view(images, factorisation, &powers, view, at[0].component_count, &own, error)
                         : weft_fail_memory(error, "values to leave out", nodes * series * sizeof *value);
    if (code == WEFT_OK)
        code = weft_kriged_map_create(
            &(weft_kriged_places){.grid = grid, .place = own.place, .count = own.count, .nugget = plan->nugget[0]},
            &map, error);
    if (code == WEFT_OK)
        code = weft_kriged_map_solve(map, own.value, (int)series, value, error);
    if (code == WEFT_OK)
        code = weft_kriged_map_variances(map, variance, error);
    for (int i = 0; i < NODES && code == WEFT_OK; i++) {
        size_t node = (size_t)shared_node(i);
        at[i].place[view] = weft_place_of_direction(images->view[view]);
        at[i].noise[view] = variance[node];
        at[i].weight[view] = 1 / (least_variance + (double)variance[node]);
        memcpy(at[i].value + series * (size_t)view, value + series * node, series * sizeof *value);
    }
    weft_kriged_map_free(map);
    left_out_free(&own);
    free(value);
    free(variance);
    return code;
}

static weft_code take_views(const weft_component_images *images, const weft_factorisation *factorisation,
                            const weft_component_plan *plan, left_out *at, weft_error *error)
{
    weft_kriged_grid grid;
    WEFT_TRY(weft_kriged_grid_create(SIDE, weft_components_are_over_half_vector(plan->kind), plan->length[0],
                                     plan->trend, &grid, error));
    weft_code code = WEFT_OK;
    for (int view = 0; view < images->view_count && code == WEFT_OK; view++)
        code = take_nodes(images, factorisation, plan, &grid, view, at, error);
    weft_kriged_grid_free(&grid);
    return code;
}

static weft_code choose_over_views(const weft_component_images *images, const weft_factorisation *factorisation,
                                   weft_component_plan *plan, weft_error *error)
{
    left_out at[NODES] = {0};
    double error_of[CANDIDATES * WEFT_COMPONENTS_MAX];
    int tried = factorisation->count < MOST_COMPONENTS ? factorisation->count : MOST_COMPONENTS;
    weft_code code = WEFT_OK;
    for (int i = 0; i < NODES && code == WEFT_OK; i++)
        code = left_out_create(images->view_count, tried, &at[i], error);
    if (code == WEFT_OK)
        code = take_views(images, factorisation, plan, at, error);
    if (code == WEFT_OK)
        code = try_candidates(at, NODES, &(square){.side = SIDE, .ordinary = true}, error_of, error);
    if (code == WEFT_OK) {
        int best = best_candidate(error_of, (size_t)tried, 0, (size_t)tried);
        plan->view_length = length_of[best / NUGGETS];
        plan->view_nugget = nugget_of[best % NUGGETS];
    }
    for (int i = 0; i < NODES; i++)
        left_out_free(&at[i]);
    return code;
}

weft_code weft_component_model_choose_lengths(const weft_component_images *images,
                                              const weft_factorisation *factorisation, weft_component_plan *plan,
                                              weft_error *error)
{
    enum { FEW_VIEWS = 4 };
    plan->trend = images->view_count < FEW_VIEWS ? trend_of_few_views : 0;
    plan->view_length = 1;
    plan->view_nugget = 1e-3f;
    WEFT_TRY(choose_inner(images, factorisation, plan, error));
    return images->view_count < FEW_VIEWS ? WEFT_OK : choose_over_views(images, factorisation, plan, error);
}
