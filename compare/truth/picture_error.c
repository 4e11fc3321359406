#include "compare/truth/comparison.h"

#include "compare/pictures/scene_error.h"

static bool block_is_lit(const weft_surface_sample *surface, int width, int left, int top)
{
    for (int y = top; y < top + WEFT_TRUTH_BLOCK; y++)
        for (int x = left; x < left + WEFT_TRUTH_BLOCK; x++)
            if (!weft_surface_is_lit(&surface[(size_t)y * (size_t)width + (size_t)x]))
                return false;
    return true;
}

static double block_mean(const weft_image *image, int left, int top, int channel)
{
    double sum = 0;
    for (int y = top; y < top + WEFT_TRUTH_BLOCK; y++)
        for (int x = left; x < left + WEFT_TRUTH_BLOCK; x++)
            sum += (double)image->pixels[3 * ((size_t)y * (size_t)image->width + (size_t)x) + (size_t)channel];
    return sum / (WEFT_TRUTH_BLOCK * WEFT_TRUTH_BLOCK);
}

static double error_of_blocks(const weft_image *truth, const weft_image *picture, const weft_surface_sample *surface)
{
    weft_error_sums sums = {0};
    for (int top = 0; top + WEFT_TRUTH_BLOCK <= truth->height; top += WEFT_TRUTH_BLOCK) {
        for (int left = 0; left + WEFT_TRUTH_BLOCK <= truth->width; left += WEFT_TRUTH_BLOCK) {
            if (!block_is_lit(surface, truth->width, left, top))
                continue;
            for (int c = 0; c < 3; c++)
                weft_error_sums_add_value(&sums, block_mean(truth, left, top, c), block_mean(picture, left, top, c));
        }
    }
    return weft_error_sums_relative_rmse(&sums);
}

weft_code weft_truth_error_of(const weft_image *truth, const weft_image *picture, const weft_surface_sample *surface,
                              weft_truth_error *result, weft_error *error)
{
    *result = (weft_truth_error){0};
    WEFT_TRY(weft_visible_error_of(truth, picture, surface, &result->error, error));
    result->block_relative_rmse = error_of_blocks(truth, picture, surface);
    return WEFT_OK;
}
