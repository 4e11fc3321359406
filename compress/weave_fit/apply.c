/* What was found, put into the weave. */
#include "compress/weave_fit/parametric_weave.h"

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
