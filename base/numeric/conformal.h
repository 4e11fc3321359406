/* Conformal quantiles: a bound that a score not yet seen keeps with a stated probability, found from scores that were
 * seen and are exchangeable with it (Vovk, Gammerman and Shafer 2005; Lei et al. 2018). */
#ifndef WEFT_BASE_NUMERIC_CONFORMAL_H
#define WEFT_BASE_NUMERIC_CONFORMAL_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* The rank ceil((count + 1) level), from 1, of the score that bounds a new one with probability `level` or more, level
 * from 0 to below 1; 0 where it is above count: so many scores bound nothing at this level. Pure. */
size_t weft_conformal_rank(size_t count, double level);

/* A score, and the group that it belongs to. */
typedef struct weft_grouped_score {
    float score;
    uint32_t group; /* 0 .. 2^24 - 1 */
} weft_grouped_score;

/* For scores that are not exchangeable by themselves but in groups, as the pixels of one photograph: the bound of a
 * score drawn from a group not yet seen (hierarchical conformal prediction, Lee, Barber and Willett 2023). Of K
 * groups each weighs 1 / (K + 1), shared evenly by its scores; the rest of the weight is at infinity. The smallest
 * score up to which the weights come to `level`; infinite where K is too small for that (below 19 for 0.95) or where
 * there is none. With one score in each group it is the score of weft_conformal_rank. It reorders score [count];
 * *group_count receives K. Errors: WEFT_SYSTEM for memory. */
weft_code weft_conformal_quantile_of_groups(weft_grouped_score *score, size_t count, double level, double *quantile,
                                            size_t *group_count, weft_error *error);

#endif
