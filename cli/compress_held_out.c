#include "cli/compress_held_out.h"

#include <limits.h>
#include <stdio.h>

/* Components that leave more have missed what the material is; and lobes are worth a word that leave at most this
 * share. */
static const double components_fail = 0.5, clearly_less = 0.75;

static weft_code measure(const weft_held_out_job *job, weft_dataset *dataset, const weft_compress_options *options,
                         weft_hold_out *result, weft_error *error)
{
    char scratch_path[PATH_MAX];
    int splits = job->split_count;
    snprintf(scratch_path, sizeof scratch_path, "%s.held-out.btf.h5", job->output);
    if (splits == WEFT_ENOUGH_SPLITS)
        WEFT_TRY(weft_hold_out_enough_splits(weft_dataset_get_layout(dataset), &splits, error));
    return weft_hold_out_measure(dataset, options, splits, scratch_path, job->progress, result, error);
}

weft_code weft_measure_held_out(const weft_held_out_job *job, weft_dataset *dataset, weft_compress_options *options,
                                weft_hold_out *result, weft_error *error)
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
    if (code == WEFT_OK && result->heights.asked)
        options->heights = result->heights.used;
    if (code == WEFT_OK)
        code = weft_hold_out_bytes(result, &options->added_bytes, &own);
    if (code != WEFT_OK)
        *error = own;
    return code;
}

void weft_ask_lobes(const weft_held_out_job *job, weft_dataset *dataset, const weft_compress_options *lobes,
                    const weft_hold_out *of_components)
{
    weft_hold_out of_lobes = {0};
    weft_error own = {0};
    double components_error = of_components->material.all.relative_rmse;
    if (of_components->split_count == 0 || !(components_error > components_fail))
        return;
    if (measure(job, dataset, lobes, &of_lobes, &own) != WEFT_OK)
        return;
    double lobes_error = of_lobes.material.all.relative_rmse;
    if (lobes_error < clearly_less * components_error)
        weft_command_say(job->common,
                         "components leave %.1f %% %s, one lobe %.1f %%: try --lobes 1, 2 or 3, or --preset best",
                         100 * components_error, weft_hold_out_about(of_components), 100 * lobes_error);
}
