#include "study/fit_weave.h"

#include "btf/direction.h"
#include "study/fit_weave_model.h"
#include "study/least_squares.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Directions looked at by the coarse grid and by the search that follows; the last steps look at all. */
enum { GRID_IMAGES = 250, SEARCH_IMAGES = 500, GRID_STEPS = 5, GRID_SWEEPS = 2 };

/* ---- Coarse grid ---- */

typedef struct grid_best {
    double cost;
    double parameters[WEFT_FIT_WEAVE_PARAMETERS];
} grid_best;

static weft_code try_point(weft_fit_weave_model *model, const double *parameters, grid_best *best, weft_error *error)
{
    double cost;
    WEFT_TRY(weft_fit_weave_cost(model, parameters, &cost, error));
    if (cost < best->cost) {
        best->cost = cost;
        memcpy(best->parameters, parameters, sizeof best->parameters);
    }
    return WEFT_OK;
}

/* Twist and inclination of one group over their whole range, the others as they are. A filament has no twist. */
static weft_code search_group(weft_fit_weave_model *model, int group, grid_best *best, weft_error *error)
{
    double point[WEFT_FIT_WEAVE_PARAMETERS];
    int umax = weft_fit_weave_umax(model, group), psi = weft_fit_weave_psi(model, group);
    memcpy(point, best->parameters, sizeof point);
    for (int i = 0; i < GRID_STEPS; i++) {
        point[umax] = model->low[umax] + (model->high[umax] - model->low[umax]) * (i + 0.5) / GRID_STEPS;
        for (int j = 0; j < (psi < 0 ? 1 : GRID_STEPS); j++) {
            if (psi >= 0)
                point[psi] = model->low[psi] + (model->high[psi] - model->low[psi]) * (j + 0.5) / GRID_STEPS;
            WEFT_TRY(try_point(model, point, best, error));
        }
    }
    return WEFT_OK;
}

static weft_code search_grid(weft_fit_weave_model *model, double *parameters, weft_error *error)
{
    grid_best best = {.cost = INFINITY};
    weft_fit_weave_look_at(model, GRID_IMAGES);
    WEFT_TRY(try_point(model, parameters, &best, error));
    for (int sweep = 0; sweep < GRID_SWEEPS; sweep++) {
        for (int group = 0; group < model->group_count; group++)
            WEFT_TRY(search_group(model, group, &best, error));
    }
    memcpy(parameters, best.parameters, sizeof best.parameters);
    return WEFT_OK;
}

/* ---- Least squares ---- */

static weft_code solve(weft_fit_weave_model *model, int images, double *parameters, double *deviation, double *cost,
                       weft_error *error)
{
    weft_fit_weave_look_at(model, images);
    weft_least_squares problem = {.parameter_count = model->parameter_count,
                                  .residual_count = 3 * model->looked_at,
                                  .low = model->low,
                                  .high = model->high,
                                  .residuals = weft_fit_weave_residuals,
                                  .context = model};
    WEFT_TRY(weft_least_squares_solve(&problem, parameters, deviation, error));
    return weft_fit_weave_cost(model, parameters, cost, error);
}

/* From the start that was given and from the best of the grid: the better end, refined on all images. */
static weft_code search(weft_fit_weave_model *model, const weft_progress *progress, double *parameters,
                        double *deviation, weft_error *error)
{
    double other[WEFT_FIT_WEAVE_PARAMETERS], cost, other_cost;
    memcpy(other, parameters, sizeof other);
    WEFT_TRY(search_grid(model, other, error));
    weft_progress_report(progress, "fitting", 1, 4);
    WEFT_TRY(solve(model, SEARCH_IMAGES, parameters, deviation, &cost, error));
    weft_progress_report(progress, "fitting", 2, 4);
    WEFT_TRY(solve(model, SEARCH_IMAGES, other, deviation, &other_cost, error));
    weft_progress_report(progress, "fitting", 3, 4);
    if (other_cost < cost)
        memcpy(parameters, other, sizeof other);
    WEFT_TRY(solve(model, model->mean->count, parameters, deviation, &cost, error));
    weft_progress_report(progress, "fitting", 4, 4);
    return WEFT_OK;
}

/* ---- Errors and the report ---- */

static int compare_doubles(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static double largest_value(const weft_mean_brdf *mean)
{
    double largest = 0;
    for (int i = 0; i < mean->count; i++)
        largest = fmax(largest, fmax(mean->value[i].r, fmax(mean->value[i].g, mean->value[i].b)));
    return largest;
}

weft_code weft_fit_weave_measure(const weft_mean_brdf *mean, const weft_weave *weave, weft_fit_weave_error *result,
                                 weft_error *error)
{
    size_t size = 3 * (size_t)mean->count * sizeof(double);
    double *relative = malloc(size), threshold = 1e-4 * largest_value(mean);
    if (!relative)
        return weft_fail_memory(error, "relative errors", size);
    weft_rgb *predicted = malloc((size_t)mean->count * sizeof *predicted);
    if (!predicted) {
        free(relative);
        return weft_fail_memory(error, "predicted reflectance", (size_t)mean->count * sizeof *predicted);
    }
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < mean->count; i++)
        predicted[i] = weft_weave_mean_brdf(weave, mean->light[i], mean->view[i]);
    size_t count = 0;
    for (int i = 0; i < mean->count; i++) {
        const double data[3] = {mean->value[i].r, mean->value[i].g, mean->value[i].b};
        const double model[3] = {predicted[i].r, predicted[i].g, predicted[i].b};
        for (int k = 0; k < 3; k++) {
            if (data[k] > threshold)
                relative[count++] = fabs(model[k] - data[k]) / data[k];
        }
    }
    qsort(relative, count, sizeof *relative, compare_doubles);
    *result = (weft_fit_weave_error){0};
    if (count > 0) {
        result->median_relative = relative[count / 2];
        result->percentile80_relative = relative[count * 4 / 5];
    }
    free(relative);
    free(predicted);
    return WEFT_OK;
}

static void describe_group(const weft_fit_weave_model *model, int index, const double *deviation,
                           weft_fit_weave_group *group)
{
    int psi = weft_fit_weave_psi(model, index), umax = weft_fit_weave_umax(model, index);
    const weft_segment *segment = &model->weave->yarn[model->group[index].yarn].segment;
    *group = (weft_fit_weave_group){.warp = model->weave->yarn[model->group[index].yarn].warp,
                                    .staple = psi >= 0,
                                    .yarn = model->group[index].yarn,
                                    .psi_deg = weft_deg_of_rad(segment->psi),
                                    .umax_deg = weft_deg_of_rad(segment->umax),
                                    .kappa = segment->kappa,
                                    .psi_deviation = psi >= 0 ? weft_deg_of_rad(deviation[psi]) : 0,
                                    .umax_deviation = weft_deg_of_rad(deviation[umax]),
                                    .kappa_deviation = deviation[umax + 1]};
}

static void describe(const weft_fit_weave_model *model, const double *deviation, weft_fit_weave_report *report)
{
    const weft_segment *segment = &model->weave->yarn[model->group[0].yarn].segment;
    report->image_count = model->mean->count;
    report->group_count = model->group_count;
    report->alpha = segment->alpha;
    report->beta = segment->beta;
    report->alpha_deviation = deviation[WEFT_FIT_WEAVE_ALPHA];
    report->beta_deviation = deviation[WEFT_FIT_WEAVE_BETA];
    for (int group = 0; group < model->group_count; group++)
        describe_group(model, group, deviation, &report->group[group]);
}

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

weft_code weft_fit_weave(const weft_mean_brdf *mean, weft_weave *weave, const weft_progress *progress,
                         weft_fit_weave_report *report, weft_error *error)
{
    double began = seconds_now(), parameters[WEFT_FIT_WEAVE_PARAMETERS] = {0};
    double deviation[WEFT_FIT_WEAVE_PARAMETERS] = {0};
    weft_fit_weave_model model;
    *report = (weft_fit_weave_report){0};
    WEFT_TRY(weft_fit_weave_measure(mean, weave, &report->before, error));
    WEFT_TRY(weft_fit_weave_model_create(mean, weave, &model, parameters, error));
    weft_code code = search(&model, progress, parameters, deviation, error);
    if (code == WEFT_OK)
        code = weft_fit_weave_model_apply(&model, parameters, error);
    if (code == WEFT_OK) {
        describe(&model, deviation, report);
        code = weft_fit_weave_measure(mean, weave, &report->after, error);
    }
    weft_fit_weave_model_free(&model);
    report->seconds = seconds_now() - began;
    return code;
}
