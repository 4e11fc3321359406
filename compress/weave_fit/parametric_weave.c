/* Creation of the model, its residuals and its colours. */
#include "compress/weave_fit/parametric_weave.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WEIGHT_FLOOR 0.05 /* of the mean value: darker data are not fitted more closely */

/* ---- Creation ---- */

static double brightness(weft_rgb value)
{
    return (value.r + value.g + value.b) / 3;
}

/* Any first images of the order are spread evenly over all: multiples of the golden ratio. */
static weft_code order_images(weft_fit_weave_model *model, weft_error *error)
{
    int count = model->mean->count, placed = 0;
    char *taken = calloc((size_t)count, 1);
    if (!taken)
        return weft_fail_memory(error, "the order of the images", (size_t)count);
    for (int i = 0; placed < count; i++) {
        int image = (int)(fmod((i + 0.5) * 0.61803398874989485, 1.0) * count);
        while (taken[image])
            image = (image + 1) % count;
        taken[image] = 1;
        model->order[placed++] = image;
    }
    free(taken);
    return WEFT_OK;
}

/* In the frame of a sample that has been turned by a small `askew`, to first order. */
static weft_vec3 turned_back(weft_vec3 d, const double askew[3])
{
    return weft_unit(weft_vec3_of(d.x + askew[2] * d.y - askew[1] * d.z, d.y + askew[0] * d.z - askew[2] * d.x,
                                  d.z + askew[1] * d.x - askew[0] * d.y));
}

static void turn_directions(weft_fit_weave_model *model, const double askew[3])
{
    memcpy(model->askew, askew, sizeof model->askew);
    for (int i = 0; i < model->mean->count; i++) {
        weft_vec3 light = turned_back(model->mean->light[model->order[i]], askew);
        weft_vec3 view = turned_back(model->mean->view[model->order[i]], askew);
        model->light[0][i] = light;
        model->view[0][i] = view;
        model->light[1][i] = weft_vec3_of(-light.y, light.x, light.z);
        model->view[1][i] = weft_vec3_of(-view.y, view.x, view.z);
    }
}

static void weigh_images(weft_fit_weave_model *model)
{
    const weft_mean_brdf *mean = model->mean;
    double sum = 0;
    for (int i = 0; i < mean->count; i++)
        sum += brightness(mean->value[i]);
    for (int i = 0; i < mean->count; i++) {
        weft_rgb value = mean->value[model->order[i]];
        const double rgb[3] = {value.r, value.g, value.b};
        model->weight[i] = 1 / (fmax(brightness(value), 0) + WEIGHT_FLOOR * sum / mean->count);
        for (int k = 0; k < 3; k++)
            model->target[k * mean->count + i] = rgb[k] * model->weight[i];
    }
}

static weft_code allocate(weft_fit_weave_model *model, weft_error *error)
{
    size_t count = (size_t)model->mean->count;
    model->group_of = calloc((size_t)model->weave->yarn_count, sizeof *model->group_of);
    model->order = calloc(count, sizeof *model->order);
    model->weight = calloc(count, sizeof *model->weight);
    model->rows = calloc(count * WEFT_FIT_WEAVE_COLUMNS, sizeof *model->rows);
    model->target = calloc(3 * count, sizeof *model->target);
    model->part = calloc(count, sizeof *model->part);
    for (int i = 0; i < 2; i++) {
        model->light[i] = calloc(count, sizeof *model->light[i]);
        model->view[i] = calloc(count, sizeof *model->view[i]);
    }
    if (model->group_of && model->order && model->weight && model->rows && model->target && model->part &&
        model->light[0] && model->light[1] && model->view[0] && model->view[1])
        return WEFT_OK;
    return weft_fail_memory(error, "fit of a weave", count * (WEFT_FIT_WEAVE_COLUMNS + 18) * sizeof(double));
}

static weft_code allocate_shapes(weft_fit_weave_model *model, weft_error *error)
{
    size_t count = (size_t)model->mean->count;
    for (int group = 0; group < model->group_count; group++) {
        for (int i = 0; i < WEFT_FIT_WEAVE_REMEMBERED; i++) {
            model->group[group].shape[i].value = calloc(count, sizeof(double));
            if (!model->group[group].shape[i].value)
                return weft_fail_memory(error, "reflectance of segments", count * sizeof(double));
        }
    }
    return WEFT_OK;
}

/* Of the shape and the colours; psi of a filament is none. */
static int count_unknowns(const weft_fit_weave_model *model)
{
    int unknowns = WEFT_FIT_WEAVE_FIRST_GROUP + 3 * (1 + model->group_count);
    for (int group = 0; group < model->group_count; group++)
        unknowns += WEFT_FIT_WEAVE_OWN - (model->group[group].staple ? 0 : 1);
    return unknowns;
}

weft_code weft_fit_weave_model_create(const weft_mean_brdf *mean, weft_weave *weave, weft_fit_weave_model *model,
                                      double *parameters, weft_error *error)
{
    *model = (weft_fit_weave_model){.mean = mean, .weave = weave};
    WEFT_TRY(allocate(model, error));
    WEFT_TRY(weft_fit_weave_group_yarns(model, error));
    WEFT_TRY(allocate_shapes(model, error));
    weft_fit_weave_start(model, parameters);
    int unknowns = count_unknowns(model);
    if (3 * mean->count < 2 * unknowns)
        return weft_fail(error, WEFT_BAD_INPUT, "%d images are too few for the %d unknowns of this weave", mean->count,
                         unknowns);
    WEFT_TRY(order_images(model, error));
    turn_directions(model, parameters + WEFT_FIT_WEAVE_ASKEW);
    weigh_images(model);
    model->looked_at = mean->count;
    return WEFT_OK;
}

void weft_fit_weave_model_free(weft_fit_weave_model *model)
{
    for (int group = 0; group < model->group_count; group++) {
        for (int i = 0; i < WEFT_FIT_WEAVE_REMEMBERED; i++)
            free(model->group[group].shape[i].value);
    }
    for (int i = 0; i < 2; i++) {
        free(model->light[i]);
        free(model->view[i]);
    }
    free(model->group_of);
    free(model->order);
    free(model->weight);
    free(model->rows);
    free(model->target);
    free(model->part);
    *model = (weft_fit_weave_model){0};
}

void weft_fit_weave_look_at(weft_fit_weave_model *model, int images)
{
    model->looked_at = images < model->mean->count ? images : model->mean->count;
}

/* ---- Residuals ---- */

static void fill_rows(weft_fit_weave_model *model, const double *parameters)
{
    int columns = 1 + model->group_count;
    const double *reflectance[WEFT_FIT_WEAVE_GROUPS];
    for (int group = 0; group < model->group_count; group++)
        reflectance[group] = weft_fit_weave_reflectance(model, group, parameters);
    for (int i = 0; i < model->looked_at; i++) {
        double *row = model->rows + i * columns;
        double phase = weft_phase_function(parameters[WEFT_FIT_WEAVE_ALPHA], parameters[WEFT_FIT_WEAVE_BETA],
                                           -weft_dot(model->light[0][i], model->view[0][i]));
        row[0] = model->weight[i] / WEFT_PI;
        for (int group = 0; group < model->group_count; group++)
            row[1 + group] = model->weight[i] * phase * reflectance[group][i];
    }
}

static weft_code solve_colours(weft_fit_weave_model *model, weft_error *error)
{
    for (int k = 0; k < 3; k++)
        WEFT_TRY(weft_non_negative_least_squares(model->looked_at, 1 + model->group_count, model->rows,
                                                 model->target + k * model->mean->count, model->coefficient[k], error));
    return WEFT_OK;
}

static void compute_residuals(void *context, const double *parameters, double *residuals)
{
    weft_fit_weave_model *model = context;
    int columns = 1 + model->group_count;
    turn_directions(model, parameters + WEFT_FIT_WEAVE_ASKEW);
    fill_rows(model, parameters);
    if (model->code == WEFT_OK)
        model->code = solve_colours(model, &model->error);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < model->looked_at; i++) {
            double sum = -model->target[k * model->mean->count + i];
            for (int column = 0; column < columns; column++)
                sum += model->rows[i * columns + column] * model->coefficient[k][column];
            residuals[k * model->looked_at + i] = sum;
        }
    }
}

weft_least_squares weft_fit_weave_problem(weft_fit_weave_model *model)
{
    return (weft_least_squares){.parameter_count = model->parameter_count,
                                .residual_count = 3 * model->looked_at,
                                .low = model->low,
                                .high = model->high,
                                .least_step = model->least_step,
                                .residuals = compute_residuals,
                                .context = model};
}

weft_code weft_fit_weave_cost(weft_fit_weave_model *model, const double *parameters, double *cost, weft_error *error)
{
    size_t count = 3 * (size_t)model->looked_at;
    double *residuals = calloc(count, sizeof *residuals);
    if (!residuals)
        return weft_fail_memory(error, "residuals", count * sizeof *residuals);
    compute_residuals(model, parameters, residuals);
    *cost = 0;
    for (size_t i = 0; i < count; i++)
        *cost += residuals[i] * residuals[i] / 2;
    free(residuals);
    if (model->code != WEFT_OK && error)
        *error = model->error;
    return model->code;
}

/* ---- Apply ---- */

/* What was found, put into the weave. */

static void apply_shapes(weft_fit_weave_model *model, const double *parameters)
{
    for (int i = 0; i < model->weave->yarn_count; i++) {
        weft_segment *segment = &model->weave->yarn[i].segment;
        int group = model->group_of[i];
        if (group >= 0)
            *segment = weft_fit_weave_segment(model, i, parameters + weft_fit_weave_index(group, WEFT_FIT_WEAVE_PSI));
        segment->alpha = parameters[WEFT_FIT_WEAVE_ALPHA];
        segment->beta = parameters[WEFT_FIT_WEAVE_BETA];
    }
}

/* kd of a yarn so that their mean is `wanted`: scaled, or all alike where there was none. */
static double rescaled(double kd, double mean, double wanted)
{
    return mean > 0 ? kd * wanted / mean : wanted;
}

static void apply_colours(weft_fit_weave_model *model)
{
    weft_weave *weave = model->weave;
    double mean[3] = {0}, scale = weave->specular_scale > 0 ? 1 / weave->specular_scale : 0;
    for (int i = 0; i < weave->yarn_count; i++) {
        mean[0] += weave->yarn[i].cell_fraction * weave->yarn[i].kd.r;
        mean[1] += weave->yarn[i].cell_fraction * weave->yarn[i].kd.g;
        mean[2] += weave->yarn[i].cell_fraction * weave->yarn[i].kd.b;
    }
    for (int i = 0; i < weave->yarn_count; i++) {
        weft_yarn *yarn = &weave->yarn[i];
        int column = 1 + model->group_of[i];
        yarn->kd = (weft_rgb){rescaled(yarn->kd.r, mean[0], model->coefficient[0][0]),
                              rescaled(yarn->kd.g, mean[1], model->coefficient[1][0]),
                              rescaled(yarn->kd.b, mean[2], model->coefficient[2][0])};
        if (column > 0)
            yarn->ks = (weft_rgb){scale * model->coefficient[0][column], scale * model->coefficient[1][column],
                                  scale * model->coefficient[2][column]};
    }
}

weft_code weft_fit_weave_model_apply(weft_fit_weave_model *model, const double *parameters, weft_error *error)
{
    double cost;
    weft_fit_weave_look_at(model, model->mean->count);
    WEFT_TRY(weft_fit_weave_cost(model, parameters, &cost, error));
    apply_shapes(model, parameters);
    weft_weave_update(model->weave);
    apply_colours(model);
    return WEFT_OK;
}
