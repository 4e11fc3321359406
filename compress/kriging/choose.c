#include "compress/kriging/kriging.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- Leaving one out ---- */

/* A set with at most as many series as images: these have the same products, so that all errors are the same. */
typedef struct reduced {
    weft_kriging_samples set;
    double *sample;
    double energy; /* weighted sum of squares */
} reduced;

/* S = sum of y y' over the series, both triangles. */
static void products(const weft_kriging_samples *set, double *matrix)
{
    size_t count = (size_t)set->places.count;
    memset(matrix, 0, count * count * sizeof *matrix);
    for (int series = 0; series < set->series_count; series++) {
        const double *y = set->sample + (size_t)series * count;
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j <= i; j++)
                matrix[i * count + j] += y[i] * y[j];
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++)
            matrix[j * count + i] = matrix[i * count + j];
}

/* The columns of a pivoted Cholesky factor of S: outer products of as many series as its rank. */
static int factor(double *matrix, size_t count, double *series)
{
    double trace = 0;
    int rank = 0;
    for (size_t i = 0; i < count; i++)
        trace += matrix[i * count + i];
    for (size_t step = 0; step < count; step++) {
        size_t pivot = 0;
        for (size_t i = 1; i < count; i++)
            pivot = matrix[i * count + i] > matrix[pivot * count + pivot] ? i : pivot;
        double most = matrix[pivot * count + pivot];
        if (!(most > 1e-9 * trace))
            break;
        double *own = series + (size_t)rank++ * count;
        for (size_t i = 0; i < count; i++)
            own[i] = matrix[pivot * count + i] / sqrt(most);
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j < count; j++)
                matrix[i * count + j] -= own[i] * own[j];
    }
    return rank;
}

static weft_code reduce(const weft_kriging_samples *set, reduced *result, weft_error *error)
{
    size_t count = (size_t)set->places.count;
    *result = (reduced){.set = *set};
    for (size_t i = 0; i < count * (size_t)set->series_count; i++)
        result->energy += set->places.weight[i % count] * set->sample[i] * set->sample[i];
    if (set->series_count <= set->places.count)
        return WEFT_OK;
    double *matrix = malloc(count * count * sizeof *matrix);
    result->sample = malloc(count * count * sizeof *result->sample);
    if (!matrix || !result->sample) {
        free(matrix);
        free(result->sample);
        return weft_fail_memory(error, "products of samples", 2 * count * count * sizeof *matrix);
    }
    products(set, matrix);
    result->set.series_count = factor(matrix, count, result->sample);
    result->set.sample = result->sample;
    free(matrix);
    return WEFT_OK;
}

/* Weighted sum of the squares of e. */
static double square_error(const weft_kriging *inverse, const weft_kriging_samples *set)
{
    size_t count = (size_t)set->places.count;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double *row = inverse->root + i * count;
        double square = 0;
        for (int series = 0; series < set->series_count; series++) {
            const double *y = set->sample + (size_t)series * count;
            double e = 0;
            for (size_t j = 0; j < count; j++)
                e += row[j] * y[j];
            square += e * e;
        }
        sum += set->places.weight[i] * square / (row[i] * row[i]);
    }
    return sum;
}

static weft_code leave_out(const reduced *part, const weft_covariance *covariance, double *square, weft_error *error)
{
    weft_kriging kriging;
    WEFT_TRY(weft_kriging_create(covariance, &part->set.places, &kriging, error));
    weft_kriging_invert(&kriging);
    *square = square_error(&kriging, &part->set);
    weft_kriging_free(&kriging);
    return WEFT_OK;
}

/* ---- The search ---- */

/* Covariances that are tried at once. */
enum { MOST_TRIED = 2, MOST_ROUNDS = 2 };

/* Beyond these a number means the same as at them. */
static const double most_number = 12;

/* A step must lower the squared error by so much. */
static const double least_gain = 1e-3;

typedef struct search {
    reduced *part;
    int count;
    bool is_searched[WEFT_COVARIANCE_NUMBERS];
    weft_covariance usual; /* where it begins */
    double caution;        /* the share of the squared error that a step away from there must gain, with one image */
    double energy;
    double *square; /* [MOST_TRIED][count] */
} search;

static void search_free(search *s)
{
    for (int i = 0; i < s->count && s->part; i++)
        free(s->part[i].sample);
    free(s->part);
    free(s->square);
}

static weft_code search_create(const weft_kriging_samples *set, int set_count, search *s, weft_error *error)
{
    size_t count = (size_t)set_count;
    *s = (search){.part = calloc(count, sizeof *s->part), .square = calloc(MOST_TRIED * count, sizeof *s->square)};
    if (!s->part || !s->square)
        return weft_fail_memory(error, "sets of samples", count * sizeof *s->part);
    for (; s->count < set_count; s->count++) {
        WEFT_TRY(reduce(&set[s->count], &s->part[s->count], error));
        s->energy += s->part[s->count].energy;
    }
    return WEFT_OK;
}

/* Squared errors of some covariances, as shares of the energy. */
static weft_code try_each(const search *s, const weft_covariance *covariance, int tried, double *share,
                          weft_error *error)
{
    weft_code result = WEFT_OK;
#pragma omp parallel for schedule(dynamic) collapse(2) if (tried * s->count > 1)
    for (int t = 0; t < tried; t++)
        for (int i = 0; i < s->count; i++) {
            weft_error own = {0};
            weft_code code = leave_out(&s->part[i], &covariance[t], &s->square[t * s->count + i], &own);
            if (code != WEFT_OK) {
#pragma omp critical(weft_kriging_try)
                {
                    result = code;
                    if (error)
                        *error = own;
                }
            }
        }
    for (int t = 0; t < tried; t++) {
        share[t] = 0;
        for (int i = 0; i < s->count; i++)
            share[t] += s->energy > 0 ? s->square[t * s->count + i] / s->energy : 0;
    }
    return result;
}

/* What a covariance is compared by: its share of the energy, raised by how far its numbers are from the usual ones. */
static double judged(const search *s, const weft_covariance *covariance, double share)
{
    double distance = 0;
    for (int k = 0; k < WEFT_COVARIANCE_NUMBERS; k++)
        distance += (covariance->number[k] - s->usual.number[k]) * (covariance->number[k] - s->usual.number[k]);
    return share * (1 + s->caution * distance / s->part[0].set.places.count);
}

/* Moves one number both ways and goes on the better way while that helps. */
static weft_code move(const search *s, int number, double step, weft_covariance *best, double *least, bool *moved,
                      weft_error *error)
{
    double way[MOST_TRIED] = {step, -step}, share[MOST_TRIED];
    for (int tried = MOST_TRIED;; tried = 1) {
        weft_covariance covariance[MOST_TRIED] = {*best, *best};
        for (int t = 0; t < tried; t++)
            covariance[t].number[number] = fmin(fmax(best->number[number] + way[t], -most_number), most_number);
        WEFT_TRY(try_each(s, covariance, tried, share, error));
        for (int t = 0; t < tried; t++)
            share[t] = judged(s, &covariance[t], share[t]);
        int better = tried > 1 && share[1] < share[0];
        if (!(share[better] < *least * (1 - least_gain)))
            return WEFT_OK;
        *least = share[better];
        *best = covariance[better];
        way[0] = way[better];
        *moved = true;
    }
}

/* Variances and lengths are always searched, symmetries where there is a mean. */
static void search_begin(search *s, const weft_covariance *usual, double caution, bool powers)
{
    s->usual = *usual;
    s->caution = caution;
    for (int k = 0; k < WEFT_COVARIANCE_NUMBERS; k++)
        s->is_searched[k] = k < WEFT_INCIDENCE_POWER || (k < WEFT_RECIPROCITY ? powers : usual->is_of_mean);
}

static weft_code search_run(const search *s, const weft_progress *progress, weft_covariance *best, double *least,
                            weft_error *error)
{
    static const double step[] = {2, 1, 0.5};
    enum { STEPS = sizeof step / sizeof *step };
    *best = s->usual;
    WEFT_TRY(try_each(s, best, 1, least, error));
    for (int i = 0; i < STEPS; i++) {
        bool moved = true;
        for (int round = 0; round < MOST_ROUNDS && moved; round++) {
            moved = false;
            for (int number = 0; number < WEFT_COVARIANCE_NUMBERS; number++) {
                if (s->is_searched[number])
                    WEFT_TRY(move(s, number, step[i], best, least, &moved, error));
            }
        }
        weft_progress_report(progress, "leaving images out", i + 1, STEPS);
    }
    return try_each(s, best, 1, least, error);
}

static weft_code search_all(const weft_kriging_samples *set, int set_count, const weft_covariance *usual,
                            double caution, bool powers, const weft_progress *progress, weft_covariance *covariance,
                            double *error_of, weft_error *error)
{
    search s;
    double least = 0;
    weft_code code = search_create(set, set_count, &s, error);
    search_begin(&s, usual, caution, powers);
    if (code == WEFT_OK)
        code = search_run(&s, progress, covariance, &least, error);
    *error_of = sqrt(least);
    search_free(&s);
    return code;
}

weft_code weft_kriging_leave_out(const weft_kriging_samples *set, int set_count, const weft_covariance *covariance,
                                 double *error_of, weft_error *error)
{
    search s;
    double share = 0;
    weft_code code = search_create(set, set_count, &s, error);
    if (code == WEFT_OK)
        code = try_each(&s, covariance, 1, &share, error);
    *error_of = sqrt(share);
    search_free(&s);
    return code;
}

weft_code weft_kriging_choose(const weft_kriging_samples *set, int set_count, const weft_progress *progress,
                              weft_covariance *covariance, double *error_of, weft_error *error)
{
    static const double caution = 0.03;
    weft_covariance usual = weft_covariance_usual();
    int images = 0;
    for (int i = 0; i < set_count; i++)
        images = set[i].places.count > images ? set[i].places.count : images;
    *covariance = weft_covariance_diffuse();
    return images < WEFT_KRIGING_LEAST_IMAGES
               ? weft_kriging_leave_out(set, set_count, covariance, error_of, error)
               : search_all(set, set_count, &usual, caution, images >= WEFT_KRIGING_LEAST_FOR_POWERS, progress,
                            covariance, error_of, error);
}

weft_code weft_kriging_choose_mean(const weft_kriging_samples *set, const weft_progress *progress,
                                   weft_covariance *covariance, double *error_of, weft_error *error)
{
    static const double caution = 1;
    weft_covariance usual = weft_covariance_usual_of_mean();
    *covariance = weft_covariance_diffuse();
    return set->places.count < WEFT_KRIGING_LEAST_IMAGES
               ? weft_kriging_leave_out(set, 1, covariance, error_of, error)
               : search_all(set, 1, &usual, caution, false, progress, covariance, error_of, error);
}
