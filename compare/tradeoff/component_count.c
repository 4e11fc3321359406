#include "compare/tradeoff/component_count.h"

#include "base/integers.h"
#include "compare/tradeoff/prediction.h"

enum { GROUP = WEFT_COMPONENTS_GROUP, MOST = WEFT_COMPONENTS_MAX, STEPS = MOST / GROUP };

/* ---- For an error ---- */

typedef struct measuring {
    weft_dataset *dataset;
    const weft_compress_options *options;
    int split_count;
    const char *scratch_path;
    const weft_progress *progress;
    double wished;
} measuring;

static weft_code measure(const measuring *work, int count, weft_component_count *result, weft_error *error)
{
    weft_compress_options options = *work->options;
    options.component_count = count;
    *result = (weft_component_count){.count = count};
    WEFT_TRY(weft_hold_out_measure(work->dataset, &options, work->split_count, work->scratch_path, work->progress,
                                   &result->held_out, error));
    result->is_met = result->held_out.material.all.relative_rmse <= work->wished;
    return WEFT_OK;
}

static bool leaves_less(const weft_component_count *a, const weft_component_count *b)
{
    return b->count == 0 || a->held_out.material.all.relative_rmse < b->held_out.material.all.relative_rmse;
}

weft_code weft_components_for_error(weft_dataset *dataset, const weft_compress_options *options, double wished,
                                    int split_count, const char *scratch_path, const weft_progress *progress,
                                    weft_component_count *result, weft_error *error)
{
    const measuring work = {dataset, options, split_count, scratch_path, progress, wished};
    weft_component_count tried, best = {0};
    int few = 0, count = GROUP;
    for (; count <= MOST && !best.is_met; count *= 2) {
        WEFT_TRY(measure(&work, count, &tried, error));
        if (tried.is_met || leaves_less(&tried, &best))
            best = tried;
        if (!tried.is_met)
            few = count;
    }
    while (best.is_met && best.count - few > GROUP) {
        WEFT_TRY(measure(&work, few + (best.count - few) / (2 * GROUP) * GROUP, &tried, error));
        if (tried.is_met)
            best = tried;
        else
            few = tried.count;
    }
    *result = best;
    return WEFT_OK;
}

/* ---- For a size ---- */

static weft_code predict(weft_dataset *dataset, const weft_compress_options *given, int count, const char *scratch_path,
                         weft_component_count *result, weft_error *error)
{
    weft_compress_options options = *given;
    weft_prediction prediction = {0};
    options.component_count = count;
    options.checkpoint_path = NULL;
    WEFT_TRY(weft_prediction_find_costs(dataset, &options, scratch_path, NULL, &prediction, error));
    *result = (weft_component_count){.count = count, .bytes = prediction.bytes};
    return WEFT_OK;
}

weft_code weft_components_for_size(weft_dataset *dataset, const weft_compress_options *options, uint64_t bytes,
                                   const char *scratch_path, const weft_progress *progress,
                                   weft_component_count *result, weft_error *error)
{
    static const char step[] = "sizing components";
    int low = 1, high = STEPS, tried = 0; /* in groups */
    weft_progress_report(progress, step, 0, STEPS / 4 + 1);
    WEFT_TRY(predict(dataset, options, GROUP, scratch_path, result, error));
    result->is_met = result->bytes <= (double)bytes;
    while (result->is_met && low < high) {
        int middle = (low + high + 1) / 2;
        weft_component_count more;
        weft_progress_report(progress, step, ++tried, STEPS / 4 + 1);
        WEFT_TRY(predict(dataset, options, middle * GROUP, scratch_path, &more, error));
        more.is_met = more.bytes <= (double)bytes;
        if (more.is_met) {
            *result = more;
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return WEFT_OK;
}
