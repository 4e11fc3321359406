#include "study/truth/picture_error.h"

#include "study/error/visible_error.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* RMS and 99.9th percentile of the values of the lit pixels. */
static weft_code describe(const weft_image *truth, const weft_surface_sample *surface, double *rms, double *peak,
                          weft_error *error)
{
    size_t pixels = (size_t)truth->width * (size_t)truth->height, count = 0;
    float *value = malloc(3 * pixels * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "lit pixels", 3 * pixels * sizeof *value);
    double squares = 0;
    for (size_t i = 0; i < 3 * pixels; i++) {
        if (!weft_surface_is_lit(&surface[i / 3]))
            continue;
        value[count++] = truth->pixels[i];
        squares += (double)truth->pixels[i] * (double)truth->pixels[i];
    }
    qsort(value, count, sizeof *value, ascending);
    *rms = count > 0 ? sqrt(squares / (double)count) : 0;
    *peak = count > 0 ? (double)value[(size_t)(0.999 * (double)(count - 1))] : 0;
    free(value);
    return WEFT_OK;
}

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
    double errors = 0, squares = 0;
    for (int top = 0; top + WEFT_TRUTH_BLOCK <= truth->height; top += WEFT_TRUTH_BLOCK) {
        for (int left = 0; left + WEFT_TRUTH_BLOCK <= truth->width; left += WEFT_TRUTH_BLOCK) {
            if (!block_is_lit(surface, truth->width, left, top))
                continue;
            for (int c = 0; c < 3; c++) {
                double expected = block_mean(truth, left, top, c), found = block_mean(picture, left, top, c);
                errors += (found - expected) * (found - expected);
                squares += expected * expected;
            }
        }
    }
    return squares > 0 ? sqrt(errors / squares) : 0;
}

weft_code weft_truth_error_of(const weft_image *truth, const weft_image *picture, const weft_surface_sample *surface,
                              weft_truth_error *result, weft_error *error)
{
    double rms, peak;
    *result = (weft_truth_error){0};
    WEFT_TRY(describe(truth, surface, &rms, &peak, error));
    WEFT_TRY(weft_visible_error_of(truth, picture, surface, &result->error, error));
    double rmse = result->error.relative_rmse * rms;
    result->psnr_db = rmse > 0 ? 20 * log10(peak / rmse) : INFINITY;
    result->block_relative_rmse = error_of_blocks(truth, picture, surface);
    return WEFT_OK;
}
