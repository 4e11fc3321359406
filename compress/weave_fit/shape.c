/* The reflectance of the segments of a group, in batches, kept for the shapes that were asked for last: a derivative
 * changes the shape of one group at a time. */
#include "compress/weave_fit/parametric_weave.h"

#include "reflectance/weave/batch.h"

#include <string.h>

/* With this alpha and beta = 0 the phase function is 1. */
static weft_prepared_segment without_phase(weft_segment segment)
{
    segment.alpha = 1 - 1 / (2 * WEFT_PI);
    segment.beta = 0;
    return weft_segment_prepare(&segment);
}

/* Adds share times G of one segment to the images looked at. */
static void add_segment(const weft_fit_weave_model *model, const weft_prepared_segment *prepared, bool warp,
                        double share, double *value)
{
    enum { TOGETHER = 128 };
    const weft_vec3 *light = model->light[!warp], *view = model->view[!warp];
    for (int first = 0; first < model->looked_at; first += TOGETHER) {
        int count = model->looked_at - first < TOGETHER ? model->looked_at - first : TOGETHER;
        double *part = model->part + first;
        weft_prepared_reflectance_batch(prepared, count, light + first, view + first, part);
        for (int i = 0; i < count; i++)
            value[first + i] += share * part[i];
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
        weft_prepared_segment prepared = without_phase(weft_fit_weave_segment(model, i, shape->own));
        add_segment(model, &prepared, model->weave->yarn[i].warp, share, shape->value);
    }
    shape->looked_at = model->looked_at;
}

static bool same_values(const double *a, const double *b, int count)
{
    for (int i = 0; i < count; i++)
        if (a[i] != b[i])
            return false;
    return true;
}

static bool is_known(const weft_fit_weave_model *model, const weft_fit_weave_shape *shape, const double *own)
{
    return shape->looked_at == model->looked_at && same_values(shape->own, own, WEFT_FIT_WEAVE_OWN) &&
           same_values(shape->askew, model->askew, 3);
}

const double *weft_fit_weave_reflectance(weft_fit_weave_model *model, int group, const double *parameters)
{
    weft_fit_weave_shape *shapes = model->group[group].shape, *oldest = &shapes[0];
    const double *own = parameters + weft_fit_weave_index(group, WEFT_FIT_WEAVE_PSI);
    model->clock++;
    for (int i = 0; i < WEFT_FIT_WEAVE_REMEMBERED; i++) {
        if (is_known(model, &shapes[i], own)) {
            shapes[i].used = model->clock;
            return shapes[i].value;
        }
        oldest = shapes[i].used < oldest->used ? &shapes[i] : oldest;
    }
    memcpy(oldest->own, own, sizeof oldest->own);
    memcpy(oldest->askew, model->askew, sizeof oldest->askew);
    oldest->used = model->clock;
    compute_shape(model, group, oldest);
    return oldest->value;
}
