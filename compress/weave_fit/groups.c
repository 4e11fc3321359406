/* Which yarns are fitted as one, what they may become, and where they begin. */
#include "compress/weave_fit/parametric_weave.h"

#include "btf/direction/direction.h"

#include <math.h>

/* Where a search may go: the model is finite far beyond, but cloth is not there. */
#define LEAST_ANGLE_DEG 1.0
#define LARGEST_PSI_DEG 80.0
#define LARGEST_UMAX_DEG 89.0
#define LARGEST_SINE 0.98 /* of length / width */
#define LEAST_KAPPA (-0.97)
#define LARGEST_KAPPA 8.0
#define LARGEST_ALPHA 2.0
#define LARGEST_BETA 60.0
#define LEAST_WIDTH 0.4
#define LARGEST_WIDTH 2.5
#define LARGEST_ASKEW_DEG 1.0
#define ASKEW_STEP_DEG 0.1

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

weft_code weft_fit_weave_group_yarns(weft_fit_weave_model *model, weft_error *error)
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
            model->group[model->group_count++] =
                (weft_fit_weave_fibres){.yarn = i, .staple = yarn->segment.psi != 0, .width = yarn->segment.width};
        model->group_of[i] = group;
    }
    if (model->group_count == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "the weave '%s' has no segment with a highlight", weave->name);
    return WEFT_OK;
}

/* ---- Parameters ---- */

int weft_fit_weave_index(int group, weft_fit_weave_own own)
{
    return WEFT_FIT_WEAVE_FIRST_GROUP + group * WEFT_FIT_WEAVE_OWN + (int)own;
}

static void set_bounds(weft_fit_weave_model *model, int index, double low, double high)
{
    model->low[index] = low;
    model->high[index] = high;
}

/* The largest umax that all segments of a group admit at a relative width. */
static double largest_umax(const weft_fit_weave_model *model, int group, double width)
{
    double largest = weft_rad_of_deg(LARGEST_UMAX_DEG);
    for (int i = 0; i < model->weave->yarn_count; i++) {
        const weft_segment *segment = &model->weave->yarn[i].segment;
        double sine = LARGEST_SINE * segment->length / (width * segment->width);
        if (model->group_of[i] == group && sine < 1)
            largest = fmin(largest, asin(sine));
    }
    return largest;
}

void weft_fit_weave_free_width(weft_fit_weave_model *model, int group)
{
    set_bounds(model, weft_fit_weave_index(group, WEFT_FIT_WEAVE_WIDTH), LEAST_WIDTH, LARGEST_WIDTH);
    set_bounds(model, weft_fit_weave_index(group, WEFT_FIT_WEAVE_UMAX), weft_rad_of_deg(LEAST_ANGLE_DEG),
               largest_umax(model, group, LEAST_WIDTH));
}

void weft_fit_weave_hold_width(weft_fit_weave_model *model, int group, double *parameters)
{
    int width = weft_fit_weave_index(group, WEFT_FIT_WEAVE_WIDTH),
        umax = weft_fit_weave_index(group, WEFT_FIT_WEAVE_UMAX);
    set_bounds(model, width, 1, 1);
    set_bounds(model, umax, weft_rad_of_deg(LEAST_ANGLE_DEG), largest_umax(model, group, 1));
    parameters[width] = 1;
    parameters[umax] = fmin(parameters[umax], model->high[umax]);
}

static void set_parameter(const weft_fit_weave_model *model, int index, double value, double *parameters)
{
    parameters[index] = fmin(fmax(value, model->low[index]), model->high[index]);
}

static void start_group(weft_fit_weave_model *model, int group, double *parameters)
{
    const weft_segment *segment = &model->weave->yarn[model->group[group].yarn].segment;
    double least = weft_rad_of_deg(LEAST_ANGLE_DEG), most = weft_rad_of_deg(LARGEST_PSI_DEG);
    int psi = weft_fit_weave_index(group, WEFT_FIT_WEAVE_PSI),
        curve = weft_fit_weave_index(group, WEFT_FIT_WEAVE_CURVE),
        umax = weft_fit_weave_index(group, WEFT_FIT_WEAVE_UMAX);
    if (segment->psi != 0)
        set_bounds(model, psi, segment->psi < 0 ? -most : least, segment->psi < 0 ? -least : most);
    set_bounds(model, curve, 1 + LEAST_KAPPA, 1 + LARGEST_KAPPA);
    parameters[umax] = segment->umax;
    weft_fit_weave_hold_width(model, group, parameters);
    set_parameter(model, umax, segment->umax, parameters);
    set_parameter(model, psi, segment->psi, parameters);
    set_parameter(model, curve, 1 + segment->kappa, parameters);
}

void weft_fit_weave_free_askew(weft_fit_weave_model *model)
{
    double largest = weft_rad_of_deg(LARGEST_ASKEW_DEG);
    for (int axis = 0; axis < 3; axis++)
        set_bounds(model, WEFT_FIT_WEAVE_ASKEW + axis, -largest, largest);
}

void weft_fit_weave_hold_askew(weft_fit_weave_model *model, double *parameters)
{
    for (int axis = 0; axis < 3; axis++) {
        int index = WEFT_FIT_WEAVE_ASKEW + axis;
        set_bounds(model, index, 0, 0);
        parameters[index] = 0;
        model->least_step[index] = weft_rad_of_deg(ASKEW_STEP_DEG);
    }
}

void weft_fit_weave_start(weft_fit_weave_model *model, double *parameters)
{
    const weft_segment *fibre = &model->weave->yarn[model->group[0].yarn].segment;
    weft_fit_weave_hold_askew(model, parameters);
    set_bounds(model, WEFT_FIT_WEAVE_ALPHA, 0, LARGEST_ALPHA);
    set_bounds(model, WEFT_FIT_WEAVE_BETA, 0, LARGEST_BETA);
    set_parameter(model, WEFT_FIT_WEAVE_ALPHA, fibre->alpha, parameters);
    set_parameter(model, WEFT_FIT_WEAVE_BETA, fibre->beta, parameters);
    model->parameter_count = weft_fit_weave_index(model->group_count, WEFT_FIT_WEAVE_PSI);
    for (int group = 0; group < model->group_count; group++)
        start_group(model, group, parameters);
}

weft_segment weft_fit_weave_segment(const weft_fit_weave_model *model, int yarn, const double own[WEFT_FIT_WEAVE_OWN])
{
    weft_segment segment = model->weave->yarn[yarn].segment;
    segment.psi = own[WEFT_FIT_WEAVE_PSI];
    segment.umax = own[WEFT_FIT_WEAVE_UMAX];
    segment.kappa = own[WEFT_FIT_WEAVE_CURVE] - 1;
    /* What the start has is admissible, if only just. */
    double widest = fmax(LARGEST_SINE * segment.length / sin(segment.umax), segment.width);
    segment.width = fmin(own[WEFT_FIT_WEAVE_WIDTH] * segment.width, widest);
    return segment;
}
