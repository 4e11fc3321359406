/* Least squares with unknowns that all groups of observations share, and some of each group's own. What calibration of
 * axes asks of Ceres. */
#ifndef WEFT_REGISTRATION_AXES_ADJUSTMENT_H
#define WEFT_REGISTRATION_AXES_ADJUSTMENT_H

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_OWN_UNKNOWNS = 6 };

/* Every unknown is in units of its standard deviation beforehand, about 0. Residuals are in units of theirs. */
typedef struct weft_adjustment {
    int shared;    /* unknowns */
    int groups;    /* each has WEFT_OWN_UNKNOWNS more */
    int residuals; /* of each group */
    void *context;
    /* The residuals of a group. Pure. */
    void (*residual)(const void *context, int group, const double *shared, const double *own, double *residual);
} weft_adjustment;

/* All allocated by the caller. */
typedef struct weft_adjusted {
    double *shared;                            /* [shared]; in: the start */
    double (*own)[WEFT_OWN_UNKNOWNS];          /* [groups]; in: the start */
    double *covariance;                        /* [shared][shared] */
    double (*own_variance)[WEFT_OWN_UNKNOWNS]; /* [groups] */
    double squares; /* of the residuals and of the unknowns: minus twice the logarithm of the probability, of unknowns
                       of groups that are the best for the shared ones */
} weft_adjusted;

/* Minimises the sum of squares of residuals and unknowns (Levenberg and Marquardt; derivatives by differences), by
 * Ceres. Covariances are those at the minimum. Errors: WEFT_BAD_INPUT where it does not settle; WEFT_SYSTEM. */
weft_code weft_adjust(const weft_adjustment *adjustment, weft_adjusted *adjusted, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
