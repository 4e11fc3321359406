#include "relief/height_map.h"
#include "relief/relief.h"
#include "relief/sweep.h"

#include <jansson.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAST_SIDE = 4,
    LEAST_COMPARED = 4,
    FOLDS = 3,
    STEPS = 64,
    PLACES = 2,              /* along each side of a texel */
    PROBED_TEXELS = 1 << 10, /* for the plane */
    JUDGED_TEXELS = 1 << 14
};

/* Borders that differ less than this many times as much as neighbouring texels fit. */
static const double fitting_seam = 2.5;

/* An estimate under way. */
typedef struct estimate {
    weft_relief_report *report;
    const weft_progress *progress;
    weft_features features;
    weft_left_out *compared; /* [compared_count] views that can be left out, those of a fold together */
    int compared_count;
    int first_of_fold[FOLDS + 1];
    weft_height_map fold[FOLDS]; /* made without the views of the fold */
    weft_held_out *result;       /* [compared_count] scratch */
} estimate;

static void report_step(const estimate *e, int done)
{
    weft_progress_report(e->progress, "looking for heights", done, FOLDS + 4);
}

static double pooled_error(const weft_held_out *result, int count)
{
    weft_held_out sum = {0};
    for (int i = 0; i < count; i++) {
        sum.residual += result[i].residual;
        sum.energy += result[i].energy;
    }
    return weft_held_out_error(&sum);
}

/* ---- The plane ---- */

static weft_code predict_through_plane(estimate *e, const weft_features *features, double plane_mm, long most_texels,
                                       weft_error *error)
{
    float height = (float)plane_mm;
    return weft_held_out_predict(features, &height, 1, 1, e->compared, e->compared_count, most_texels, e->result,
                                 error);
}

/* The best of evenly spaced planes, and then of finer ones around it. */
static weft_code find_plane(estimate *e, double low, double high, double *plane_mm, weft_error *error)
{
    enum { PLANES = 17, ROUNDS = 4 };
    double from = low, to = high;
    for (int round = 0; round < ROUNDS; round++) {
        double step = (to - from) / (PLANES - 1), best = INFINITY;
        for (int i = 0; i < PLANES; i++) {
            double at = from + i * step;
            WEFT_TRY(predict_through_plane(e, &e->features, at, PROBED_TEXELS, error));
            double found = pooled_error(e->result, e->compared_count);
            if (found < best) {
                best = found;
                *plane_mm = at;
            }
        }
        from = fmax(*plane_mm - step, low);
        to = fmin(*plane_mm + step, high);
    }
    return WEFT_OK;
}

/* ---- Heights ---- */

static bool is_in_fold(const estimate *e, int view, int fold)
{
    for (int i = e->first_of_fold[fold]; i < e->first_of_fold[fold + 1]; i++)
        if (e->compared[i].view == view)
            return true;
    return false;
}

/* The views of a search: those up to 62 degrees without those of a fold (-1: all). */
static int searched_views(const estimate *e, int without, int *view)
{
    int count = 0;
    for (int k = 0; k < e->features.view_count && count < WEFT_SWEEP_MOST_VIEWS; k++)
        if (e->features.direction[k].z >= WEFT_HELD_OUT_STEEPEST_COSINE && (without < 0 || !is_in_fold(e, k, without)))
            view[count++] = k;
    return count;
}

static weft_code search(const estimate *e, int without, weft_height_map *map, weft_error *error)
{
    int view[WEFT_SWEEP_MOST_VIEWS];
    int count = searched_views(e, without, view);
    const weft_height_search request = {&e->features,      view, count, STEPS, PLACES, e->report->low_mm,
                                        e->report->high_mm};
    return weft_height_map_find(&request, map, error);
}

static weft_code find_range(estimate *e, weft_error *error)
{
    int view[WEFT_SWEEP_MOST_VIEWS];
    int count = searched_views(e, -1, view);
    return weft_height_range_find(&e->features, view, count, &e->report->low_mm, &e->report->high_mm, error);
}

static weft_code search_folds(estimate *e, weft_error *error)
{
    for (int fold = 0; fold < FOLDS; fold++) {
        WEFT_TRY(search(e, fold, &e->fold[fold], error));
        report_step(e, 2 + fold);
    }
    return WEFT_OK;
}

/* ---- What they are worth ---- */

/* Every view through the heights of the fold that it had no part in. */
static weft_code predict_through_folds(estimate *e, const weft_features *features, const weft_height_map *fold,
                                       weft_error *error)
{
    for (int i = 0; i < FOLDS; i++) {
        int first = e->first_of_fold[i];
        WEFT_TRY(weft_held_out_predict(features, fold[i].value, fold[i].width, fold[i].height, e->compared + first,
                                       e->first_of_fold[i + 1] - first, JUDGED_TEXELS, e->result + first, error));
    }
    return WEFT_OK;
}

/* Moves the errors of the views into the report. */
static void note_views(estimate *e, size_t member)
{
    for (int i = 0; i < e->compared_count; i++) {
        char *at = (char *)&e->report->view[i].error + member;
        *(double *)(void *)at = weft_held_out_error(&e->result[i]);
    }
}

/* The errors of one level, and of its views where they are the finest. */
static weft_code judge_level(estimate *e, const weft_features *features, const weft_height_map *fold, int level,
                             weft_error *error)
{
    weft_relief_errors *errors = &e->report->level_error[level];
    WEFT_TRY(predict_through_plane(e, features, 0, JUDGED_TEXELS, error));
    errors->flat = pooled_error(e->result, e->compared_count);
    if (level == 0)
        note_views(e, offsetof(weft_relief_errors, flat));
    WEFT_TRY(predict_through_plane(e, features, e->report->plane_mm, JUDGED_TEXELS, error));
    errors->plane = pooled_error(e->result, e->compared_count);
    if (level == 0)
        note_views(e, offsetof(weft_relief_errors, plane));
    WEFT_TRY(predict_through_folds(e, features, fold, error));
    errors->heights = pooled_error(e->result, e->compared_count);
    if (level == 0)
        note_views(e, offsetof(weft_relief_errors, heights));
    return WEFT_OK;
}

static weft_code halve_folds(const weft_height_map *fold, weft_height_map *half, weft_error *error)
{
    for (int i = 0; i < FOLDS; i++)
        WEFT_TRY(weft_height_map_halve(&fold[i], &half[i], error));
    return WEFT_OK;
}

static void free_folds(weft_height_map *fold)
{
    for (int i = 0; i < FOLDS; i++)
        weft_height_map_free(&fold[i]);
}

static weft_code judge_from(estimate *e, const weft_features *features, const weft_height_map *fold, int level,
                            weft_error *error)
{
    WEFT_TRY(judge_level(e, features, fold, level, error));
    e->report->level_count = level + 1;
    if (level + 1 == WEFT_RELIEF_LEVELS || features->width < 2 * LEAST_SIDE || features->height < 2 * LEAST_SIDE)
        return WEFT_OK;
    weft_features half;
    weft_height_map half_fold[FOLDS] = {0};
    WEFT_TRY(weft_features_halve(features, &half, error));
    weft_code code = halve_folds(fold, half_fold, error);
    if (code == WEFT_OK)
        code = judge_from(e, &half, half_fold, level + 1, error);
    free_folds(half_fold);
    weft_features_free(&half);
    return code;
}

/* Whether what was decided for the finest level is better than nothing on another one. */
static bool helps(const weft_relief_report *report, int level)
{
    const weft_relief_errors *errors = &report->level_error[level];
    return (report->verdict == WEFT_RELIEF_HEIGHTS && errors->heights < errors->flat) ||
           (report->verdict == WEFT_RELIEF_PLANE && errors->plane < errors->flat);
}

static void decide(weft_relief_report *report)
{
    report->error = report->level_error[0];
    double against_flat = report->on_its_plane ? WEFT_RELIEF_GAIN : WEFT_RELIEF_PLANE_GAIN;
    if (report->error.heights <= WEFT_RELIEF_GAIN * report->error.plane &&
        report->error.heights <= against_flat * report->error.flat)
        report->verdict = WEFT_RELIEF_HEIGHTS;
    else if (report->error.plane <= WEFT_RELIEF_PLANE_GAIN * report->error.flat)
        report->verdict = WEFT_RELIEF_PLANE;
    while (report->levels_used < report->level_count && helps(report, report->levels_used))
        report->levels_used++;
}

/* ---- All of it ---- */

/* Every FOLDS-th view that can be left out makes a fold. */
static weft_code find_compared(estimate *e, const char *path, weft_error *error)
{
    size_t bytes = (size_t)e->features.view_count * sizeof(weft_left_out);
    weft_left_out *found = malloc(bytes);
    if (!found)
        return weft_fail_memory(error, "views", bytes);
    weft_code code = weft_left_out_find(&e->features, found, &e->compared_count, error);
    int at = 0;
    for (int fold = 0; code == WEFT_OK && fold < FOLDS; fold++) {
        for (int i = fold; i < e->compared_count; i += FOLDS)
            e->compared[at++] = found[i];
        e->first_of_fold[fold + 1] = at;
    }
    free(found);
    if (code == WEFT_OK && e->compared_count < LEAST_COMPARED)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': %d views up to 62 degrees have neighbours on all sides; heights need %d", path,
                         e->compared_count, LEAST_COMPARED);
    return code;
}

static weft_code allocate(estimate *e, weft_error *error)
{
    size_t views = (size_t)e->features.view_count;
    e->compared = malloc(views * sizeof *e->compared);
    e->result = malloc(views * sizeof *e->result);
    e->report->view = calloc(views, sizeof *e->report->view);
    return e->compared && e->result && e->report->view
               ? WEFT_OK
               : weft_fail_memory(error, "views", views * sizeof *e->report->view);
}

static void note_features(estimate *e, const weft_relief_views *views, const weft_relief_options *options)
{
    weft_relief_report *report = e->report;
    weft_features *features = &e->features;
    report->width_mm = features->width_mm;
    report->height_mm = features->height_mm;
    report->view_count = features->view_count;
    report->light_count = views->light_count;
    report->seam = weft_features_seam(features);
    features->repeats = options->repeat == WEFT_RELIEF_REPEAT_ON ||
                        (options->repeat == WEFT_RELIEF_REPEAT_AUTO && report->seam < fitting_seam);
    report->repeats = features->repeats;
}

static void name_views(estimate *e)
{
    e->report->compared_count = e->compared_count;
    for (int i = 0; i < e->compared_count; i++)
        e->report->view[i].direction = e->features.direction[e->compared[i].view];
}

static weft_code find(estimate *e, const weft_relief_options *options, weft_error *error)
{
    weft_relief_report *report = e->report;
    double reach;
    report_step(e, 0);
    WEFT_TRY(weft_relief_reach(&e->features, &reach, error));
    WEFT_TRY(find_plane(e, -reach, reach, &report->plane_mm, error));
    report->low_mm = options->low_mm;
    report->high_mm = options->high_mm;
    if (!(report->low_mm < report->high_mm)) {
        report->low_mm = -reach;
        report->high_mm = reach;
        WEFT_TRY(find_range(e, error));
    }
    report_step(e, 1);
    WEFT_TRY(search_folds(e, error));
    weft_height_map map;
    WEFT_TRY(search(e, -1, &map, error));
    report->width = map.width;
    report->height = map.height;
    report->height_mm_of = map.value;
    report->confidence = map.confidence;
    report_step(e, FOLDS + 3);
    WEFT_TRY(judge_from(e, &e->features, e->fold, 0, error));
    report_step(e, FOLDS + 4);
    decide(report);
    return WEFT_OK;
}

/* Whether the texels were put where the views agree, by a simulation or by `weft relief --move`. */
static weft_code note_plane(const weft_dataset_layout *layout, weft_relief_report *report, weft_error *error)
{
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    if (!provenance)
        return weft_fail_memory(error, "provenance", strlen(layout->provenance));
    const json_t *moved = json_object_get(json_object_get(provenance, "relief"), "moved_mm");
    report->moved_mm = json_number_value(moved);
    report->on_its_plane = moved || json_number_value(json_object_get(provenance, "plane_below_top_mm")) > 0;
    json_decref(provenance);
    return WEFT_OK;
}

static weft_code estimate_with(weft_dataset *dataset, const weft_relief_views *views,
                               const weft_relief_options *options, estimate *e, weft_error *error)
{
    WEFT_TRY(weft_features_read(dataset, views, e->progress, &e->features, error));
    WEFT_TRY(allocate(e, error));
    note_features(e, views, options);
    WEFT_TRY(note_plane(weft_dataset_get_layout(dataset), e->report, error));
    WEFT_TRY(find_compared(e, weft_dataset_path(dataset), error));
    name_views(e);
    return find(e, options, error);
}

weft_code weft_relief_estimate(weft_dataset *dataset, const weft_relief_options *options, const weft_progress *progress,
                               weft_relief_report *report, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    const char *path = weft_dataset_path(dataset);
    weft_relief_views views;
    *report = (weft_relief_report){0};
    estimate e = {.report = report, .progress = progress};
    if (layout->width < LEAST_SIDE || layout->height < LEAST_SIDE)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d x %d texels, too few for heights: %d x %d are wanted",
                         path, layout->width, layout->height, LEAST_SIDE, LEAST_SIDE);
    WEFT_TRY(weft_relief_views_find(layout, path, &views, error));
    weft_code code = estimate_with(dataset, &views, options, &e, error);
    free_folds(e.fold);
    free(e.compared);
    free(e.result);
    weft_features_free(&e.features);
    weft_relief_views_free(&views);
    if (code != WEFT_OK)
        weft_relief_report_free(report);
    return code;
}

void weft_relief_report_free(weft_relief_report *report)
{
    free(report->height_mm_of);
    free(report->confidence);
    free(report->view);
    *report = (weft_relief_report){0};
}
