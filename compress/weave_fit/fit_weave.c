#include "compress/weave_fit/fit_weave.h"

#include "base/clock.h"
#include "btf/direction/direction.h"
#include "compress/weave_fit/parametric_weave.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Directions looked at by the coarse grid and by the search that follows; the last steps look at all. */
enum { GRID_IMAGES = 250, SEARCH_IMAGES = 500, GRID_STEPS = 5, GRID_SWEEPS = 2, STAGES = 4 };

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
    int umax = weft_fit_weave_index(group, WEFT_FIT_WEAVE_UMAX), psi = weft_fit_weave_index(group, WEFT_FIT_WEAVE_PSI);
    bool staple = model->group[group].staple;
    memcpy(point, best->parameters, sizeof point);
    for (int i = 0; i < GRID_STEPS; i++) {
        point[umax] = model->low[umax] + (model->high[umax] - model->low[umax]) * (i + 0.5) / GRID_STEPS;
        for (int j = 0; j < (staple ? GRID_STEPS : 1); j++) {
            if (staple)
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

/* A width with a larger standard error, relative to that of the start, may be told better by the start; it is taken
 * from there unless that makes the sum of squares larger by more than this factor. */
static const double vague_width = 0.25, least_rise = 1.01;

/* A width, relative to that of the start, narrow enough to leave room for any inclination the start admits. */
static const double beside_edge = 0.75;

static weft_code solve(weft_fit_weave_model *model, int images, double *parameters, double *cost, weft_error *error)
{
    weft_fit_weave_look_at(model, images);
    weft_least_squares problem = weft_fit_weave_problem(model);
    WEFT_TRY(weft_least_squares_solve(&problem, parameters, error));
    return weft_fit_weave_cost(model, parameters, cost, error);
}

/* From the start that was given and from the best of the grid, with the widths of the start: the better end. */
static weft_code search(weft_fit_weave_model *model, const weft_progress *progress, double *parameters,
                        weft_error *error)
{
    double other[WEFT_FIT_WEAVE_PARAMETERS], cost, other_cost;
    memcpy(other, parameters, sizeof other);
    WEFT_TRY(search_grid(model, other, error));
    weft_progress_report(progress, "fitting", 1, STAGES);
    WEFT_TRY(solve(model, SEARCH_IMAGES, parameters, &cost, error));
    weft_progress_report(progress, "fitting", 2, STAGES);
    WEFT_TRY(solve(model, SEARCH_IMAGES, other, &other_cost, error));
    weft_progress_report(progress, "fitting", 3, STAGES);
    if (other_cost < cost)
        memcpy(parameters, other, sizeof other);
    return WEFT_OK;
}

/* Takes the width of a group back to the start where the data do as well with that. */
static weft_code try_start_width(weft_fit_weave_model *model, int group, double *parameters, double *cost,
                                 weft_error *error)
{
    double other[WEFT_FIT_WEAVE_PARAMETERS], other_cost;
    memcpy(other, parameters, sizeof other);
    weft_fit_weave_hold_width(model, group, other);
    WEFT_TRY(solve(model, model->mean->count, other, &other_cost, error));
    if (other_cost > least_rise * *cost) {
        weft_fit_weave_free_width(model, group);
        return WEFT_OK;
    }
    memcpy(parameters, other, sizeof other);
    *cost = other_cost;
    return WEFT_OK;
}

static weft_code try_start_widths(weft_fit_weave_model *model, double *parameters, double *deviation, double *cost,
                                  weft_error *error)
{
    for (int group = 0; group < model->group_count; group++) {
        if (deviation[weft_fit_weave_index(group, WEFT_FIT_WEAVE_WIDTH)] < vague_width)
            continue;
        WEFT_TRY(try_start_width(model, group, parameters, cost, error));
        WEFT_TRY(weft_fit_weave_deviation(model, parameters, deviation, error));
    }
    return WEFT_OK;
}

/* A width that is larger than its inclination leaves room for has no effect, and the search no way back: it begins once
 * more beside that edge, and the better end counts. */
static weft_code leave_edge(weft_fit_weave_model *model, int group, double *parameters, double *deviation, double *cost,
                            weft_error *error)
{
    int width = weft_fit_weave_index(group, WEFT_FIT_WEAVE_WIDTH);
    double other[WEFT_FIT_WEAVE_PARAMETERS], other_cost;
    if (isfinite(deviation[width]))
        return WEFT_OK;
    memcpy(other, parameters, sizeof other);
    other[width] = beside_edge;
    WEFT_TRY(solve(model, model->mean->count, other, &other_cost, error));
    if (!(other_cost < *cost))
        return WEFT_OK;
    memcpy(parameters, other, sizeof other);
    *cost = other_cost;
    return weft_fit_weave_deviation(model, parameters, deviation, error);
}

/* Where the inclination is as large as the width of the start allows, a narrower one may be true, and the way there is
 * along the edge: begin beside it. */
static void release_width(weft_fit_weave_model *model, int group, double *parameters)
{
    int umax = weft_fit_weave_index(group, WEFT_FIT_WEAVE_UMAX);
    bool at_edge = parameters[umax] > 0.95 * model->high[umax];
    weft_fit_weave_free_width(model, group);
    if (at_edge)
        parameters[weft_fit_weave_index(group, WEFT_FIT_WEAVE_WIDTH)] = beside_edge;
}

/* What the data tell less of than rigs are known to is vague. Rigs do not err by the bound: something else is amiss
 * there, which makes the standard errors large, too. */
static weft_fit_weave_turn judge_turn(const weft_fit_weave_model *model, const double *parameters,
                                      const double *deviation)
{
    const double vague_rad = weft_rad_of_deg(0.2), unlikely = 0.95;
    weft_fit_weave_turn turn = WEFT_TURN_FITTED;
    for (int i = WEFT_FIT_WEAVE_ASKEW; i < WEFT_FIT_WEAVE_ASKEW + 3; i++) {
        if (fabs(parameters[i]) > unlikely * model->high[i])
            return WEFT_TURN_AT_BOUND;
        if (!(deviation[i] < vague_rad))
            turn = WEFT_TURN_VAGUE;
    }
    return turn;
}

/* A sample that lies askew shows in twist and width if it is held straight. */
static weft_code try_straight(weft_fit_weave_model *model, double *parameters, double *deviation, double *cost,
                              weft_fit_weave_turn *turn, weft_error *error)
{
    *turn = judge_turn(model, parameters, deviation);
    if (*turn == WEFT_TURN_FITTED)
        return WEFT_OK;
    weft_fit_weave_hold_askew(model, parameters);
    WEFT_TRY(solve(model, model->mean->count, parameters, cost, error));
    return weft_fit_weave_deviation(model, parameters, deviation, error);
}

/* On all images, with the widths that the data tell. */
static weft_code refine(weft_fit_weave_model *model, const weft_progress *progress, double *parameters,
                        double *deviation, weft_fit_weave_turn *turn, weft_error *error)
{
    double cost;
    for (int group = 0; group < model->group_count; group++)
        release_width(model, group, parameters);
    weft_fit_weave_free_askew(model);
    WEFT_TRY(solve(model, SEARCH_IMAGES, parameters, &cost, error));
    WEFT_TRY(solve(model, model->mean->count, parameters, &cost, error));
    WEFT_TRY(weft_fit_weave_deviation(model, parameters, deviation, error));
    for (int group = 0; group < model->group_count; group++)
        WEFT_TRY(leave_edge(model, group, parameters, deviation, &cost, error));
    WEFT_TRY(try_straight(model, parameters, deviation, &cost, turn, error));
    WEFT_TRY(try_start_widths(model, parameters, deviation, &cost, error));
    weft_progress_report(progress, "fitting", STAGES, STAGES);
    return WEFT_OK;
}

/* ---- The report ---- */

static void describe_group(const weft_fit_weave_model *model, int index, const double *deviation,
                           weft_fit_weave_group *group)
{
    const weft_fit_weave_fibres *fibres = &model->group[index];
    const weft_yarn *yarn = &model->weave->yarn[fibres->yarn];
    const double *own = deviation + weft_fit_weave_index(index, WEFT_FIT_WEAVE_PSI);
    int width = weft_fit_weave_index(index, WEFT_FIT_WEAVE_WIDTH);
    *group = (weft_fit_weave_group){.warp = yarn->warp,
                                    .staple = fibres->staple,
                                    .yarn = fibres->yarn,
                                    .width_fitted = model->low[width] < model->high[width],
                                    .psi_deg = weft_deg_of_rad(yarn->segment.psi),
                                    .umax_deg = weft_deg_of_rad(yarn->segment.umax),
                                    .kappa = yarn->segment.kappa,
                                    .width = yarn->segment.width,
                                    .psi_deviation = weft_deg_of_rad(own[WEFT_FIT_WEAVE_PSI]),
                                    .umax_deviation = weft_deg_of_rad(own[WEFT_FIT_WEAVE_UMAX]),
                                    .kappa_deviation = own[WEFT_FIT_WEAVE_CURVE],
                                    .width_deviation = own[WEFT_FIT_WEAVE_WIDTH] * fibres->width};
}

static void describe(const weft_fit_weave_model *model, const double *parameters, const double *deviation,
                     weft_fit_weave_report *report)
{
    for (int axis = 0; axis < 3; axis++) {
        report->askew_deg[axis] = weft_deg_of_rad(parameters[WEFT_FIT_WEAVE_ASKEW + axis]);
        report->askew_deviation[axis] = weft_deg_of_rad(deviation[WEFT_FIT_WEAVE_ASKEW + axis]);
    }
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

weft_code weft_fit_weave(const weft_mean_brdf *mean, weft_weave *weave, const weft_progress *progress,
                         weft_fit_weave_report *report, weft_error *error)
{
    double began = weft_now_s(), parameters[WEFT_FIT_WEAVE_PARAMETERS] = {0};
    double deviation[WEFT_FIT_WEAVE_PARAMETERS] = {0};
    weft_fit_weave_model model;
    *report = (weft_fit_weave_report){0};
    WEFT_TRY(weft_fit_weave_measure(mean, weave, &report->before, error));
    weft_code code = weft_fit_weave_model_create(mean, weave, &model, parameters, error);
    if (code == WEFT_OK)
        code = search(&model, progress, parameters, error);
    if (code == WEFT_OK)
        code = refine(&model, progress, parameters, deviation, &report->turn, error);
    if (code == WEFT_OK)
        code = weft_fit_weave_model_apply(&model, parameters, error);
    if (code == WEFT_OK) {
        describe(&model, parameters, deviation, report);
        code = weft_fit_weave_measure(mean, weave, &report->after, error);
    }
    weft_fit_weave_model_free(&model);
    report->seconds = weft_now_s() - began;
    return code;
}
