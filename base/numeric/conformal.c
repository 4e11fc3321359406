#include "base/numeric/conformal.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Whole ranks stay whole: (19 + 1) 0.95 is 19 and a rounding error. */
static const double rounding = 1e-9;

size_t weft_conformal_rank(size_t count, double level)
{
    double rank = fmax(1, ceil((double)(count + 1) * level - rounding));
    return rank > (double)count ? 0 : (size_t)rank;
}

static int compare_scores(const void *left, const void *right)
{
    const weft_grouped_score *a = left, *b = right;
    return (a->score > b->score) - (a->score < b->score);
}

/* Scores of every group: size [largest + 1]; returns how many groups have any. */
static size_t count_groups(const weft_grouped_score *score, size_t count, uint32_t *size)
{
    size_t groups = 0;
    for (size_t i = 0; i < count; i++)
        groups += size[score[i].group]++ == 0;
    return groups;
}

/* The smallest score up to which the groups weigh `wanted` in all, each 1. */
static double weighted_quantile(const weft_grouped_score *score, size_t count, const uint32_t *size, double wanted)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += 1.0 / size[score[i].group];
        if (sum >= wanted - rounding * wanted)
            return (double)score[i].score;
    }
    return INFINITY;
}

weft_code weft_conformal_quantile_of_groups(weft_grouped_score *score, size_t count, double level, double *quantile,
                                            size_t *group_count, weft_error *error)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = score[i].group > largest ? score[i].group : largest;
    uint32_t *size = calloc((size_t)largest + 1, sizeof *size);
    if (!size)
        return weft_fail_memory(error, "groups of scores", ((size_t)largest + 1) * sizeof *size);
    *group_count = count_groups(score, count, size);
    qsort(score, count, sizeof *score, compare_scores);
    double wanted = level * (double)(*group_count + 1);
    bool exists = weft_conformal_rank(*group_count, level) > 0;
    *quantile = exists ? weighted_quantile(score, count, size, wanted) : INFINITY;
    free(size);
    return WEFT_OK;
}
