#include "study/fit_weave_model.h"

#include "btf/direction.h"
#include "study/least_squares.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where a search may go: the model is finite far beyond, but cloth is not there. */
#define LEAST_ANGLE_DEG 1.0
#define LARGEST_PSI_DEG 80.0
#define LARGEST_UMAX_DEG 89.0
#define LARGEST_SINE 0.98 /* of length / width */
#define LEAST_KAPPA (-0.97)
#define LARGEST_KAPPA 8.0
#define LARGEST_ALPHA 2.0
#define LARGEST_BETA 60.0

#define WEIGHT_FLOOR 0.05 /* of the mean value: darker data are not fitted more closely */

/* ---- Groups ---- */

static bool same_colour(weft_rgb a, weft_rgb b)
{
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

static bool same_fibres(const weft_yarn *a, const weft_yarn *b)
{
    return a->warp == b->warp && a->segment.psi == b->segment.psi && a->segment.umax == b->segment.umax &&
           a->segment.kappa == b->segment.kappa && same_colour(a->ks, b->ks);
}

static weft_code group_yarns(weft_fit_weave_model *model, weft_error *error)
{
    const weft_weave *weave = model->weave;
    for (int i = 0; i < weave->yarn_count; i++) {
        const weft_yarn *yarn = &weave->yarn[i];
        model->group_of[i] = -1;
        if (!yarn->admissible || !(yarn->cell_fraction * yarn->area_weight > 0))
            continue;
        int group = 0;
        while (group < model->group_count && !same_fibres(yarn, &weave->yarn[model->group[group].yarn]))
            group++;
        if (group == WEFT_FIT_WEAVE_GROUPS)
            return weft_fail(error, WEFT_BAD_INPUT, "the weave '%s' has more than %d kinds of yarn", weave->name,
                             WEFT_FIT_WEAVE_GROUPS);
        if (group == model->group_count)
            model->group[model->group_count++] = (weft_fit_weave_fibres){.yarn = i, .staple = yarn->segment.psi != 0};
        model->group_of[i] = group;
    }
    if (model->group_count == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "the weave '%s' has no segment with a highlight", weave->name);
    return WEFT_OK;
}

int weft_fit_weave_psi(const weft_fit_weave_model *model, int group)
{
    return model->group[group].staple ? model->group[group].first_parameter : -1;
}

int weft_fit_weave_umax(const weft_fit_weave_model *model, int group)
{
    return model->group[group].first_parameter + (model->group[group].staple ? 1 : 0);
}

/* ---- Parameters ---- */

static void set_parameter(weft_fit_weave_model *model, int index, double low, double high, double value,
                          double *parameters)
{
    model->low[index] = low;
    model->high[index] = high;
    parameters[index] = fmin(fmax(value, low), high);
}

/* The largest umax that all segments of a group admit. */
static double largest_umax(const weft_fit_weave_model *model, int group)
{
    double largest = weft_rad_of_deg(LARGEST_UMAX_DEG);
    for (int i = 0; i < model->weave->yarn_count; i++) {
        const weft_segment *segment = &model->weave->yarn[i].segment;
        double sine = LARGEST_SINE * segment->length / segment->width;
        if (model->group_of[i] == group && sine < 1)
            largest = fmin(largest, asin(sine));
    }
    return largest;
}

static void start_group(weft_fit_weave_model *model, int group, double *parameters)
{
    weft_fit_weave_fibres *fibres = &model->group[group];
    const weft_segment *segment = &model->weave->yarn[fibres->yarn].segment;
    double least = weft_rad_of_deg(LEAST_ANGLE_DEG), most = weft_rad_of_deg(LARGEST_PSI_DEG);
    fibres->first_parameter = model->parameter_count;
    if (fibres->staple)
        set_parameter(model, model->parameter_count++, segment->psi < 0 ? -most : least,
                      segment->psi < 0 ? -least : most, segment->psi, parameters);
    set_parameter(model, model->parameter_count++, least, largest_umax(model, group), segment->umax, parameters);
    set_parameter(model, model->parameter_count++, 1 + LEAST_KAPPA, 1 + LARGEST_KAPPA, 1 + segment->kappa, parameters);
}

static void start(weft_fit_weave_model *model, double *parameters)
{
    const weft_segment *fibre = &model->weave->yarn[model->group[0].yarn].segment;
    set_parameter(model, WEFT_FIT_WEAVE_ALPHA, 0, LARGEST_ALPHA, fibre->alpha, parameters);
    set_parameter(model, WEFT_FIT_WEAVE_BETA, 0, LARGEST_BETA, fibre->beta, parameters);
    model->parameter_count = WEFT_FIT_WEAVE_FIRST_GROUP;
    for (int group = 0; group < model->group_count; group++)
        start_group(model, group, parameters);
}

/* ---- Creation ---- */

static double brightness(weft_rgb value)
{
    return (value.r + value.g + value.b) / 3;
}

/* Any first images of the order are spread evenly over all: multiples of the golden ratio. */
static void order_images(weft_fit_weave_model *model)
{
    int count = model->mean->count, placed = 0;
    char *taken = calloc((size_t)count, 1);
    for (int i = 0; taken && placed < count; i++) {
        int image = (int)(fmod((i + 0.5) * 0.61803398874989485, 1.0) * count);
        while (taken[image])
            image = (image + 1) % count;
        taken[image] = 1;
        model->order[placed++] = image;
    }
    free(taken);
    for (int i = placed; i < count; i++)
        model->order[i] = i;
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
    if (model->group_of && model->order && model->weight && model->rows && model->target)
        return WEFT_OK;
    return weft_fail_memory(error, "fit of a weave", count * (WEFT_FIT_WEAVE_COLUMNS + 5) * sizeof(double));
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

weft_code weft_fit_weave_model_create(const weft_mean_brdf *mean, weft_weave *weave, weft_fit_weave_model *model,
                                      double *parameters, weft_error *error)
{
    *model = (weft_fit_weave_model){.mean = mean, .weave = weave};
    WEFT_TRY(allocate(model, error));
    WEFT_TRY(group_yarns(model, error));
    WEFT_TRY(allocate_shapes(model, error));
    start(model, parameters);
    int unknowns = model->parameter_count + 3 * (1 + model->group_count);
    if (3 * mean->count < 2 * unknowns)
        return weft_fail(error, WEFT_BAD_INPUT, "%d images are too few for the %d unknowns of this weave", mean->count,
                         unknowns);
    order_images(model);
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
    free(model->group_of);
    free(model->order);
    free(model->weight);
    free(model->rows);
    free(model->target);
    *model = (weft_fit_weave_model){0};
}

void weft_fit_weave_look_at(weft_fit_weave_model *model, int images)
{
    model->looked_at = images < model->mean->count ? images : model->mean->count;
}

/* ---- The reflectance of a group ---- */

/* With this alpha and beta = 0 the phase function is 1. */
static weft_prepared_segment without_phase(weft_segment segment, const weft_fit_weave_shape *shape)
{
    segment.psi = shape->psi;
    segment.umax = shape->umax;
    segment.kappa = shape->kappa;
    segment.alpha = 1 - 1 / (2 * WEFT_PI);
    segment.beta = 0;
    return weft_segment_prepare(&segment);
}

static weft_vec3 in_segment(bool warp, weft_vec3 d)
{
    return warp ? d : weft_vec3_of(-d.y, d.x, d.z);
}

/* Adds share times G of one segment to the images looked at. */
static void add_segment(const weft_fit_weave_model *model, const weft_prepared_segment *prepared, bool warp,
                        double share, double *value)
{
#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < model->looked_at; i++) {
        int image = model->order[i];
        value[i] += share * weft_prepared_reflectance(prepared, in_segment(warp, model->mean->light[image]),
                                                      in_segment(warp, model->mean->view[image]));
    }
}

static bool same_rectangle(const weft_segment *a, const weft_segment *b)
{
    return a->width == b->width && a->length == b->length && a->delta == b->delta;
}

/* F aw of all segments of a group with the rectangle of yarn `first`; 0 where an earlier yarn has the same. */
static double share_of(const weft_fit_weave_model *model, int group, int first)
{
    const weft_yarn *yarn = model->weave->yarn;
    double share = 0;
    for (int i = 0; i < model->weave->yarn_count; i++) {
        if (model->group_of[i] != group || !same_rectangle(&yarn[i].segment, &yarn[first].segment))
            continue;
        if (i < first)
            return 0;
        share += yarn[i].cell_fraction * yarn[i].area_weight;
    }
    return share;
}

static void compute_shape(const weft_fit_weave_model *model, int group, weft_fit_weave_shape *shape)
{
    memset(shape->value, 0, (size_t)model->looked_at * sizeof *shape->value);
    for (int i = 0; i < model->weave->yarn_count; i++) {
        double share = model->group_of[i] == group ? share_of(model, group, i) : 0;
        if (!(share > 0))
            continue;
        weft_prepared_segment prepared = without_phase(model->weave->yarn[i].segment, shape);
        add_segment(model, &prepared, model->weave->yarn[i].warp, share, shape->value);
    }
    shape->looked_at = model->looked_at;
}

/* G of a group at these parameters: remembered, or in the place of the one that was not used for longest. */
static const double *reflectance_of(weft_fit_weave_model *model, int group, const double *parameters)
{
    weft_fit_weave_fibres *fibres = &model->group[group];
    int umax = weft_fit_weave_umax(model, group);
    weft_fit_weave_shape wanted = {
        .psi = fibres->staple ? parameters[umax - 1] : 0, .umax = parameters[umax], .kappa = parameters[umax + 1] - 1};
    weft_fit_weave_shape *oldest = &fibres->shape[0];
    for (int i = 0; i < WEFT_FIT_WEAVE_REMEMBERED; i++) {
        weft_fit_weave_shape *known = &fibres->shape[i];
        if (known->looked_at == model->looked_at && known->psi == wanted.psi && known->umax == wanted.umax &&
            known->kappa == wanted.kappa) {
            known->used = ++model->clock;
            return known->value;
        }
        oldest = known->used < oldest->used ? known : oldest;
    }
    wanted.value = oldest->value;
    wanted.used = ++model->clock;
    *oldest = wanted;
    compute_shape(model, group, oldest);
    return oldest->value;
}

/* ---- Residuals ---- */

static void fill_rows(weft_fit_weave_model *model, const double *parameters)
{
    int columns = 1 + model->group_count;
    const double *reflectance[WEFT_FIT_WEAVE_GROUPS];
    for (int group = 0; group < model->group_count; group++)
        reflectance[group] = reflectance_of(model, group, parameters);
    for (int i = 0; i < model->looked_at; i++) {
        int image = model->order[i];
        double *row = model->rows + i * columns;
        double phase = weft_phase_function(parameters[WEFT_FIT_WEAVE_ALPHA], parameters[WEFT_FIT_WEAVE_BETA],
                                           -weft_dot(model->mean->light[image], model->mean->view[image]));
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

void weft_fit_weave_residuals(void *context, const double *parameters, double *residuals)
{
    weft_fit_weave_model *model = context;
    int columns = 1 + model->group_count;
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

weft_code weft_fit_weave_cost(weft_fit_weave_model *model, const double *parameters, double *cost, weft_error *error)
{
    size_t count = 3 * (size_t)model->looked_at;
    double *residuals = malloc(count * sizeof *residuals);
    if (!residuals)
        return weft_fail_memory(error, "residuals", count * sizeof *residuals);
    weft_fit_weave_residuals(model, parameters, residuals);
    *cost = 0;
    for (size_t i = 0; i < count; i++)
        *cost += residuals[i] * residuals[i] / 2;
    free(residuals);
    if (model->code != WEFT_OK && error)
        *error = model->error;
    return model->code;
}

/* ---- The result ---- */

static void apply_shapes(weft_fit_weave_model *model, const double *parameters)
{
    for (int i = 0; i < model->weave->yarn_count; i++) {
        weft_segment *segment = &model->weave->yarn[i].segment;
        int group = model->group_of[i];
        segment->alpha = parameters[WEFT_FIT_WEAVE_ALPHA];
        segment->beta = parameters[WEFT_FIT_WEAVE_BETA];
        if (group < 0)
            continue;
        int umax = weft_fit_weave_umax(model, group);
        segment->psi = model->group[group].staple ? parameters[umax - 1] : 0;
        segment->umax = parameters[umax];
        segment->kappa = parameters[umax + 1] - 1;
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
