/* The mean BRDF of a weave as a function of the parameters that a fit moves:
 *     f(l, v) = d / pi + sum_g a_g fc(-l . v) sum_s F_s aw_s G_s(l, v)
 * over the groups g of yarns that share their fibres and the segments s in them. G, the reflectance of a segment with
 * fc = 1, depends on the shape of its group alone and is kept until that changes; alpha and beta only enter fc; d and
 * a_g >= 0 are solved for. Private to the room. */
#ifndef WEFT_COMPRESS_WEAVE_FIT_PARAMETRIC_WEAVE_H
#define WEFT_COMPRESS_WEAVE_FIT_PARAMETRIC_WEAVE_H

#include "compress/weave_fit/fit_weave.h"
#include "compress/weave_fit/least_squares.h"

enum {
    WEFT_FIT_WEAVE_ALPHA,
    WEFT_FIT_WEAVE_BETA,
    WEFT_FIT_WEAVE_ASKEW, /* x, y, z: the turn of the sample in the frame of lights and views, rad */
    WEFT_FIT_WEAVE_FIRST_GROUP = WEFT_FIT_WEAVE_ASKEW + 3,
    WEFT_FIT_WEAVE_COLUMNS = 1 + WEFT_FIT_WEAVE_GROUPS,
    WEFT_FIT_WEAVE_REMEMBERED = 5 /* shapes of a group whose G is kept */
};

/* What a group has of its own, in this order. */
typedef enum weft_fit_weave_own {
    WEFT_FIT_WEAVE_PSI,
    WEFT_FIT_WEAVE_UMAX,
    WEFT_FIT_WEAVE_CURVE, /* kappa + 1 */
    WEFT_FIT_WEAVE_WIDTH, /* of its segments, relative to those of the start */
    WEFT_FIT_WEAVE_OWN
} weft_fit_weave_own;

enum { WEFT_FIT_WEAVE_PARAMETERS = WEFT_FIT_WEAVE_FIRST_GROUP + WEFT_FIT_WEAVE_OWN * WEFT_FIT_WEAVE_GROUPS };

/* G of a group at one shape. */
typedef struct weft_fit_weave_shape {
    double own[WEFT_FIT_WEAVE_OWN], askew[3];
    int looked_at; /* for so many images; 0: empty */
    long used;     /* when last */
    double *value; /* [mean->count] */
} weft_fit_weave_shape;

typedef struct weft_fit_weave_fibres {
    int yarn; /* the first of the group, index */
    bool staple;
    double width; /* of that yarn at the start, cells */
    weft_fit_weave_shape shape[WEFT_FIT_WEAVE_REMEMBERED];
} weft_fit_weave_fibres;

/* Owned by the caller; `mean` and `weave` must outlive it. */
typedef struct weft_fit_weave_model {
    const weft_mean_brdf *mean;
    weft_weave *weave; /* as at the start until the result is put into it */
    int *group_of;     /* [yarn_count], -1: no highlight */
    int group_count, parameter_count;
    weft_fit_weave_fibres group[WEFT_FIT_WEAVE_GROUPS];
    double low[WEFT_FIT_WEAVE_PARAMETERS], high[WEFT_FIT_WEAVE_PARAMETERS]; /* equal: held */
    int *order;                    /* [mean->count] images, any first of them spread evenly */
    int looked_at;                 /* so many of them */
    weft_vec3 *light[2], *view[2]; /* [mean->count] in the order, in the frames of warp and weft of the sample */
    double askew[3];               /* as it lies now, rad */
    double least_step[WEFT_FIT_WEAVE_PARAMETERS];
    double *weight;                                /* [mean->count] in the order */
    double *rows;                                  /* [mean->count][WEFT_FIT_WEAVE_COLUMNS] */
    double *target;                                /* [3][mean->count] */
    double *part;                                  /* [mean->count] reflectance of one segment */
    double coefficient[3][WEFT_FIT_WEAVE_COLUMNS]; /* d, a_g of each channel, as solved for last */
    long clock;
    weft_code code; /* of the first failure in a callback */
    weft_error error;
} weft_fit_weave_model;

/* Groups the yarns, sets bounds, and gives the parameters of the weave as it is; widths are held. Errors: see
 * weft_fit_weave. Free it also on failure. */
weft_code weft_fit_weave_model_create(const weft_mean_brdf *mean, weft_weave *weave, weft_fit_weave_model *model,
                                      double *parameters, weft_error *error);
void weft_fit_weave_model_free(weft_fit_weave_model *model);

/* Part of the creation: the groups, and the parameters with their bounds. Errors: WEFT_BAD_INPUT. */
weft_code weft_fit_weave_group_yarns(weft_fit_weave_model *model, weft_error *error);
void weft_fit_weave_start(weft_fit_weave_model *model, double *parameters);

/* Index of a parameter of a group. Pure. */
int weft_fit_weave_index(int group, weft_fit_weave_own own);

/* Lets the widths of a group go, between 0.4 and 2.5 times what they were at the start, or puts them back there and
 * holds them. umax follows: width sin umax < length. */
void weft_fit_weave_free_width(weft_fit_weave_model *model, int group);
void weft_fit_weave_hold_width(weft_fit_weave_model *model, int group, double *parameters);

/* Lets the sample lie askew by up to a degree about each axis, or holds it straight. */
void weft_fit_weave_free_askew(weft_fit_weave_model *model);
void weft_fit_weave_hold_askew(weft_fit_weave_model *model, double *parameters);

/* A segment of the start with the shape of its group at these parameters; a width that such an inclination does not
 * leave room for is the largest it does. Pure. */
weft_segment weft_fit_weave_segment(const weft_fit_weave_model *model, int yarn, const double own[WEFT_FIT_WEAVE_OWN]);

/* G of a group at these parameters for the images looked at, in the order: remembered or computed. */
const double *weft_fit_weave_reflectance(weft_fit_weave_model *model, int group, const double *parameters);

/* From here on only the first `images` of the order count. */
void weft_fit_weave_look_at(weft_fit_weave_model *model, int images);

/* The problem that the model poses over the images looked at: residuals (model - data) / (data + a twentieth of the
 * mean) for channel, then image in the order. */
weft_least_squares weft_fit_weave_problem(weft_fit_weave_model *model);

/* Half the sum of their squares. Errors: those of the solver. */
weft_code weft_fit_weave_cost(weft_fit_weave_model *model, const double *parameters, double *cost, weft_error *error);

/* Standard errors of the parameters at a solution, over all images; 0 for what is held, INFINITY for what the data do
 * not determine. Residuals of images with the same light, or with the same view, are taken as correlated: for both,
 * and for both together (Cameron, Gelbach and Miller 2011), by leaving out one light, view or image at a time; the
 * largest counts. Errors: WEFT_SYSTEM. */
weft_code weft_fit_weave_deviation(weft_fit_weave_model *model, const double *parameters, double *deviation,
                                   weft_error *error);

/* Puts parameters and colours into the weave. Errors: those of the solver. */
weft_code weft_fit_weave_model_apply(weft_fit_weave_model *model, const double *parameters, weft_error *error);

#endif
