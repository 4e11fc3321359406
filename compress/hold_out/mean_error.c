#include "compress/hold_out/mean_error.h"

#include <math.h>

static weft_code summarise_group(const weft_asked_samples *compared, int flags, weft_error_summary *result,
                                 weft_error *error)
{
    return weft_error_summary_of_group(compared->value, compared->group, compared->count, flags, result, error);
}

weft_code weft_hold_out_summarise(const weft_asked_samples *compared, weft_hold_out_error *result, weft_error *error)
{
    WEFT_TRY(weft_error_summary_of(compared->value, compared->count, &result->all, error));
    WEFT_TRY(summarise_group(compared, WEFT_HELD_VIEW, &result->view, error));
    WEFT_TRY(summarise_group(compared, WEFT_HELD_LIGHT, &result->light, error));
    return summarise_group(compared, WEFT_HELD_VIEW | WEFT_HELD_LIGHT, &result->both, error);
}

void weft_summary_take(const weft_error_summary *one, int *taken, weft_error_summary *mean)
{
    if (one->count == 0)
        return;
    double share = 1.0 / ++*taken;
    mean->median_relative += share * (one->median_relative - mean->median_relative);
    mean->percentile80_relative += share * (one->percentile80_relative - mean->percentile80_relative);
    mean->rmse += share * (one->rmse - mean->rmse);
    mean->relative_rmse += share * (one->relative_rmse - mean->relative_rmse);
    mean->psnr_db =
        isinf(one->psnr_db) || isinf(mean->psnr_db) ? INFINITY : mean->psnr_db + share * (one->psnr_db - mean->psnr_db);
    mean->count += one->count;
}

void weft_hold_out_take(const weft_hold_out_error *one, weft_means_taken *taken, weft_hold_out_error *mean)
{
    weft_summary_take(&one->all, &taken->all, &mean->all);
    weft_summary_take(&one->view, &taken->view, &mean->view);
    weft_summary_take(&one->light, &taken->light, &mean->light);
    weft_summary_take(&one->both, &taken->both, &mean->both);
}
