/* What the kernels after a pass share: a vector of views, a view a lane. T(v) is eliminated, so that
 * r - T f = e + sum_j delta_j column_j with delta = T_pass x_pass - T x for linear parameters x = (rho, A_1, ...). */
#ifndef WEFT_COMPRESS_FIT_VIEW_LANES_H
#define WEFT_COMPRESS_FIT_VIEW_LANES_H

#include "base/lanes.h"
#include "compress/fit/kernels.h"

/* A function for a number of lobes that the compiler knows, so that its loops unroll. */
#define FOR_LOBES(count, function, ...)                                                                                \
    ((count) == 0   ? function(0, __VA_ARGS__)                                                                         \
     : (count) == 1 ? function(1, __VA_ARGS__)                                                                         \
     : (count) == 2 ? function(2, __VA_ARGS__)                                                                         \
                    : function(3, __VA_ARGS__))

#define UNROLL _Pragma("GCC unroll 16")

/* Linear parameters where a residual is asked for, and those of the pass. */
typedef struct linear_point {
    float x[WEFT_LINEAR_MAX], pass[WEFT_LINEAR_MAX];
    float negligible;
} linear_point;

WEFT_INLINE linear_point linear_point_of(const weft_trial *trial, const double *x)
{
    linear_point own = {.negligible = (float)trial->negligible};
    for (int j = 0; j <= trial->fit.lobe_count; j++) {
        own.x[j] = (float)x[j];
        own.pass[j] = (float)trial->at.x[j];
    }
    return own;
}

/* The linear rows of the views of one vector. */
typedef struct linear_lanes {
    lanes gram[WEFT_LINEAR_MAX][WEFT_LINEAR_MAX], error[WEFT_LINEAR_MAX], square, pass_table;
} linear_lanes;

WEFT_INLINE linear_lanes load_linear(const weft_trial *trial, int lobes, int stride, int view)
{
    int count = lobes + 1;
    linear_lanes own;
    for (int j = 0; j < count; j++) {
        own.error[j] = lanes_load(trial->linear + (WEFT_LINEAR_ERROR + j) * stride + view);
        for (int k = 0; k < count; k++)
            own.gram[j][k] = lanes_load(trial->linear + weft_linear_gram(j, k) * stride + view);
    }
    own.square = lanes_load(trial->linear + WEFT_LINEAR_SQUARE * stride + view);
    own.pass_table = lanes_load(trial->pass_table + view);
    return own;
}

/* What is known about the views at linear parameters x. */
typedef struct view_state {
    lanes t, ff, residual;
    lanes delta[WEFT_LINEAR_MAX];
    lanes eliminated; /* 1 where T follows f, 0 where it is fixed */
    lanes shrink;     /* 1 / <f|f> where T follows f, else 0 */
} view_state;

WEFT_INLINE view_state state_of(const linear_lanes *own, const linear_point *at, int lobes, bool with_table)
{
    int count = lobes + 1;
    view_state state = {.t = lanes_of(1)};
    lanes fr = {0};
    for (int j = 0; j < count; j++) {
        lanes f_of_x = {0}, f_of_pass = {0};
        for (int k = 0; k < count; k++) {
            f_of_x += at->x[k] * own->gram[j][k];
            f_of_pass += at->pass[k] * own->gram[j][k];
        }
        state.ff += at->x[j] * f_of_x;
        fr += at->x[j] * (own->pass_table * f_of_pass + own->error[j]);
    }
    if (with_table) {
        lane_bits seen = state.ff > at->negligible;
        state.shrink = lanes_where(seen, 1 / lanes_select(seen, state.ff, lanes_of(1)));
        state.t = lanes_select(seen, lanes_max(fr, lanes_of(0)) * state.shrink, lanes_of(1));
        state.eliminated = lanes_where(seen, lanes_of(1));
    }
    state.residual = own->square;
    for (int j = 0; j < count; j++)
        state.delta[j] = own->pass_table * at->pass[j] - state.t * at->x[j];
    for (int j = 0; j < count; j++) {
        lanes slope = 2 * own->error[j];
        for (int k = 0; k < count; k++)
            slope += state.delta[k] * own->gram[j][k];
        state.residual += state.delta[j] * slope;
    }
    state.residual = lanes_max(state.residual, lanes_of(0));
    return state;
}

#endif
