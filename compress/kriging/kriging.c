#include "compress/kriging/kriging.h"

#include <lapacke.h>
#include <stdlib.h>

/* Of the mean variance: keeps samples of the same directions apart where there is no noise. */
static const double least_noise = 1e-9;

void weft_kriging_free(weft_kriging *kriging)
{
    free(kriging->root);
    *kriging = (weft_kriging){0};
}

/* The lower triangle of C + N. */
static void fill(const weft_covariance *covariance, const weft_kriging_places *places, double *matrix)
{
    weft_covariance_terms terms = weft_covariance_terms_of(covariance);
    size_t count = (size_t)places->count;
    double mean = 0;
    for (size_t column = 0; column < count; column++)
        for (size_t row = column; row < count; row++)
            matrix[column * count + row] = weft_covariance_between(&terms, &places->pair[row], &places->pair[column]);
    for (size_t i = 0; i < count; i++)
        mean += matrix[i * count + i] / (double)count;
    for (size_t i = 0; i < count; i++)
        matrix[i * count + i] += mean * (least_noise + exp2(covariance->number[WEFT_NOISE]) / places->weight[i]);
}

weft_code weft_kriging_create(const weft_covariance *covariance, const weft_kriging_places *places,
                              weft_kriging *kriging, weft_error *error)
{
    size_t count = (size_t)places->count;
    *kriging = (weft_kriging){.count = places->count, .root = calloc(count * count, sizeof *kriging->root)};
    if (!kriging->root)
        return weft_fail_memory(error, "covariances", count * count * sizeof *kriging->root);
    fill(covariance, places, kriging->root);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', places->count, kriging->root, places->count) == 0)
        return WEFT_OK;
    weft_kriging_free(kriging);
    return weft_fail(error, WEFT_BAD_INPUT, "directions that are no numbers have no covariance");
}

void weft_kriging_solve(const weft_kriging *kriging, double *sample, int series_count)
{
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', kriging->count, series_count, kriging->root, kriging->count, sample,
                        kriging->count);
}

void weft_kriging_invert(weft_kriging *kriging)
{
    size_t count = (size_t)kriging->count;
    LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', kriging->count, kriging->root, kriging->count);
    for (size_t column = 0; column < count; column++)
        for (size_t row = column + 1; row < count; row++)
            kriging->root[row * count + column] = kriging->root[column * count + row];
}

void weft_kriging_row(const weft_covariance_terms *terms, const weft_kriging_places *places,
                      const weft_direction_pair *at, float *row)
{
    for (int i = 0; i < places->count; i++)
        row[i] = (float)weft_covariance_between(terms, at, &places->pair[i]);
}
