#include "cli/compress_held_out.h"

#include <stdio.h>

/* Components that leave more have missed what the material is; lobes are suggested that leave at most this share. */
static const double components_fail = 0.5, clearly_less = 0.75;

weft_code weft_held_out_splits(const weft_held_out_job *job, const weft_dataset *dataset, int *count, weft_error *error)
{
    *count = job->split_count;
    if (job->split_count != WEFT_ENOUGH_SPLITS)
        return WEFT_OK;
    return weft_hold_out_enough_splits(weft_dataset_get_layout(dataset), count, error);
}

static weft_code measure(const weft_held_out_job *job, weft_dataset *dataset, const weft_compress_options *options,
                         weft_hold_out *result, weft_error *error)
{
    int splits;
    WEFT_TRY(weft_held_out_splits(job, dataset, &splits, error));
    return weft_hold_out_measure(dataset, options, splits, job->scratch_path, job->progress, result, error);
}

weft_code weft_measure_held_out(const weft_held_out_job *job, weft_dataset *dataset,
                                const weft_compress_options *options, weft_hold_out *result, weft_error *error)
{
    weft_error own = {0};
    *result = (weft_hold_out){0};
    if (job->split_count == 0)
        return WEFT_OK;
    weft_code code = measure(job, dataset, options, result, &own);
    if (code == WEFT_BAD_USAGE || code == WEFT_BAD_INPUT) {
        weft_command_say(job->common, "error on directions that were not fitted: not measured: %s", own.message);
        *result = (weft_hold_out){0};
        return WEFT_OK;
    }
    if (code != WEFT_OK)
        *error = own;
    return code;
}

void weft_suggest_lobes(const weft_held_out_job *job, weft_dataset *dataset, const weft_compress_options *options,
                        const weft_hold_out *of_components)
{
    weft_compress_options one_lobe = *options;
    weft_hold_out of_lobe = {0};
    weft_error own = {0};
    double components_error = of_components->material.all.relative_rmse;
    one_lobe.component_count = 0;
    one_lobe.lobe_count = 1;
    if (of_components->split_count == 0 || !(components_error > components_fail) ||
        measure(job, dataset, &one_lobe, &of_lobe, &own) != WEFT_OK)
        return;
    double lobe_error = of_lobe.material.all.relative_rmse;
    if (lobe_error < clearly_less * components_error)
        weft_command_say(job->common,
                         "components leave %.1f %% %s, one lobe %.1f %%: try --lobes 1, 2 or 3, or --preset best",
                         100 * components_error, weft_hold_out_about(of_components), 100 * lobe_error);
}
