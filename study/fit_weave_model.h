/* The mean BRDF of a weave as a function of the parameters that a fit moves:
 *     f(l, v) = d / pi + sum_g a_g fc(-l . v) sum_s F_s aw_s G_s(l, v)
 * over the groups g of yarns that share their fibres and the segments s in them. G, the reflectance of a segment with
 * fc = 1, depends on psi, umax and kappa of its group alone and is kept until they change; alpha and beta only enter
 * fc; d and a_g >= 0 are solved for. */
#ifndef WEFT_STUDY_FIT_WEAVE_MODEL_H
#define WEFT_STUDY_FIT_WEAVE_MODEL_H

#include "study/fit_weave.h"

enum {
    WEFT_FIT_WEAVE_ALPHA,
    WEFT_FIT_WEAVE_BETA,
    WEFT_FIT_WEAVE_FIRST_GROUP,
    WEFT_FIT_WEAVE_PARAMETERS = WEFT_FIT_WEAVE_FIRST_GROUP + 3 * WEFT_FIT_WEAVE_GROUPS,
    WEFT_FIT_WEAVE_COLUMNS = 1 + WEFT_FIT_WEAVE_GROUPS,
    WEFT_FIT_WEAVE_REMEMBERED = 3 /* shapes of a group whose G is kept */
};

/* G of a group at one shape. */
typedef struct weft_fit_weave_shape {
    double psi, umax, kappa;
    int looked_at; /* for so many images; 0: empty */
    long used;     /* when last */
    double *value; /* [mean->count] */
} weft_fit_weave_shape;

typedef struct weft_fit_weave_fibres {
    int yarn;            /* the first of the group, index */
    int first_parameter; /* umax and kappa + 1 of the group, and psi before them where it is staple */
    bool staple;
    weft_fit_weave_shape shape[WEFT_FIT_WEAVE_REMEMBERED];
} weft_fit_weave_fibres;

/* Owned by the caller; `mean` and `weave` must outlive it. */
typedef struct weft_fit_weave_model {
    const weft_mean_brdf *mean;
    weft_weave *weave;
    int *group_of; /* [yarn_count], -1: no highlight */
    int group_count, parameter_count;
    weft_fit_weave_fibres group[WEFT_FIT_WEAVE_GROUPS];
    double low[WEFT_FIT_WEAVE_PARAMETERS], high[WEFT_FIT_WEAVE_PARAMETERS];
    int *order;                                    /* [mean->count] images, any first of them spread evenly */
    int looked_at;                                 /* so many of them */
    double *weight;                                /* [mean->count] by place in the order */
    double *rows;                                  /* [mean->count][WEFT_FIT_WEAVE_COLUMNS] */
    double *target;                                /* [3][mean->count] */
    double coefficient[3][WEFT_FIT_WEAVE_COLUMNS]; /* d, a_g of each channel, as solved for last */
    long clock;
    weft_code code; /* of the first failure in a callback */
    weft_error error;
} weft_fit_weave_model;

/* Groups the yarns, sets bounds, and gives the parameters of the weave as it is. Errors: see weft_fit_weave. Free it
 * also on failure. */
weft_code weft_fit_weave_model_create(const weft_mean_brdf *mean, weft_weave *weave, weft_fit_weave_model *model,
                                      double *parameters, weft_error *error);
void weft_fit_weave_model_free(weft_fit_weave_model *model);

/* Index of a parameter of a group; psi of filament: -1. kappa + 1 follows umax. Pure. */
int weft_fit_weave_psi(const weft_fit_weave_model *model, int group);
int weft_fit_weave_umax(const weft_fit_weave_model *model, int group);

/* From here on only the first `images` of the order count. */
void weft_fit_weave_look_at(weft_fit_weave_model *model, int images);

/* A weft_residual_function: (model - data) / (data + a twentieth of the mean) for channel, then image. */
void weft_fit_weave_residuals(void *model, const double *parameters, double *residuals);

/* Half the sum of their squares. Errors: those of the solver. */
weft_code weft_fit_weave_cost(weft_fit_weave_model *model, const double *parameters, double *cost, weft_error *error);

/* Puts parameters and colours into the weave. Errors: those of the solver. */
weft_code weft_fit_weave_model_apply(weft_fit_weave_model *model, const double *parameters, weft_error *error);

#endif
