/* What follows from the sums of a pass, all views at once: a view a lane. T(v) is eliminated, so that
 * r - T f = e + sum_j delta_j column_j with delta = T_pass x_pass - T x for linear parameters x = (rho, A_1, ...). */
#include "compress/kernels.h"

#include "btf/lanes.h"

#include <math.h>
#include <string.h>

WEFT_DECLARE_FIT_KERNELS(WEFT_INSTRUCTION_SET);

#define LN2 0.69314718f

/* The parameters of a trial, as vectors want them. */
typedef struct parameters {
    int lobe_count;
    float x[WEFT_LINEAR_MAX], pass[WEFT_LINEAR_MAX];      /* rho and A where asked, and of the pass */
    float rows[3][3];                                     /* of the frame */
    float c[WEFT_GRAM_LOBES][3], factor[WEFT_GRAM_LOBES]; /* A N */
    int fixed[WEFT_GRAM_LOBES];
    float negligible;
} parameters;

static parameters parameters_of(const weft_trial *trial, const double *x)
{
    const weft_fit *fit = &trial->fit;
    parameters own = {.lobe_count = fit->lobe_count, .negligible = (float)trial->negligible};
    double rows[3][3];
    weft_frame_rows(&fit->frame, rows);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            own.rows[i][k] = (float)rows[i][k];
    }
    for (int j = 0; j <= fit->lobe_count; j++) {
        own.x[j] = (float)x[j];
        own.pass[j] = (float)trial->at.x[j];
    }
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        for (int k = 0; k < 3; k++)
            own.c[i][k] = (float)lobe->c[k];
        own.factor[i] = (float)(x[1 + i] * exp(lobe->log_exponent));
        own.fixed[i] = weft_lobe_fixed(lobe);
    }
    return own;
}

/* A function for a number of lobes that the compiler knows, so that its loops unroll. */
#define FOR_LOBES(count, function, ...)                                                                                \
    ((count) == 0   ? function(0, __VA_ARGS__)                                                                         \
     : (count) == 1 ? function(1, __VA_ARGS__)                                                                         \
     : (count) == 2 ? function(2, __VA_ARGS__)                                                                         \
                    : function(3, __VA_ARGS__))

#define UNROLL _Pragma("GCC unroll 16")

/* ---- Linear parameters ---- */

/* The linear rows of the views of one vector. */
typedef struct linear_lanes {
    lanes gram[WEFT_LINEAR_MAX][WEFT_LINEAR_MAX], error[WEFT_LINEAR_MAX], square, pass_table;
} linear_lanes;

/* What is known about the views at linear parameters x. */
typedef struct view_state {
    lanes t, ff, residual;
    lanes delta[WEFT_LINEAR_MAX];
    lanes eliminated; /* 1 where T follows f, 0 where it is fixed */
} view_state;

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

WEFT_INLINE lanes larger(lanes a, float b)
{
    return lanes_select(a > b, a, lanes_of(b));
}

WEFT_INLINE view_state state_of(const linear_lanes *own, const parameters *at, int lobes, bool with_table)
{
    int count = lobes + 1;
    view_state state = {.t = lanes_of(1)};
    lanes fr = {0};
    for (int j = 0; j < count; j++) {
        for (int k = 0; k < count; k++) {
            state.ff += at->x[j] * at->x[k] * own->gram[j][k];
            fr += at->x[j] * at->pass[k] * own->gram[j][k];
        }
    }
    fr *= own->pass_table;
    for (int j = 0; j < count; j++)
        fr += at->x[j] * own->error[j];
    if (with_table) {
        lane_bits seen = state.ff > at->negligible;
        state.t = lanes_select(seen, larger(fr, 0) / lanes_select(seen, state.ff, lanes_of(1)), lanes_of(1));
        state.eliminated = lanes_select(seen, lanes_of(1), lanes_of(0));
    }
    state.residual = own->square;
    for (int j = 0; j < count; j++) {
        state.delta[j] = own->pass_table * at->pass[j] - state.t * at->x[j];
        state.residual += 2 * state.delta[j] * own->error[j];
    }
    for (int j = 0; j < count; j++) {
        for (int k = 0; k < count; k++)
            state.residual += state.delta[j] * state.delta[k] * own->gram[j][k];
    }
    state.residual = larger(state.residual, 0);
    return state;
}

WEFT_INLINE double residual_of(int lobes, const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                               const weft_linear *linear, float *table)
{
    parameters at = parameters_of(trial, linear->x);
    double sum = 0;
    for (int view = 0; view < bundle->view_stride; view += LANES) {
        linear_lanes own = load_linear(trial, lobes, bundle->view_stride, view);
        view_state state = state_of(&own, &at, lobes, with_table);
        sum += (double)lanes_sum(state.residual);
        if (table)
            lanes_store(table + view, state.t);
    }
    return sum;
}

double WEFT_KERNEL(weft_views_residual)(const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                                        const weft_linear *linear, float *table)
{
    return FOR_LOBES(trial->fit.lobe_count, residual_of, bundle, trial, with_table, linear, table);
}

WEFT_INLINE void linear_normal_of(int lobes, const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                                  const weft_linear *linear, double *h, double *g)
{
    const int n = lobes + 1;
    const double *x = linear->x;
    parameters at = parameters_of(trial, x);
    lanes h_sum[WEFT_LINEAR_MAX][WEFT_LINEAR_MAX] = {{{0}}}, g_sum[WEFT_LINEAR_MAX] = {{0}}, scale = {0};
    for (int view = 0; view < bundle->view_stride; view += LANES) {
        linear_lanes own = load_linear(trial, lobes, bundle->view_stride, view);
        view_state state = state_of(&own, &at, lobes, with_table);
        lanes s[WEFT_LINEAR_MAX] = {{0}}, t2 = state.t * state.t;
        lanes shrink = state.eliminated / lanes_select(state.eliminated > 0, state.ff, lanes_of(1));
        UNROLL for (int j = 0; j < n; j++)
        {
            lanes error = own.error[j];
            UNROLL for (int k = 0; k < n; k++)
            {
                s[j] += own.gram[j][k] * at.x[k];
                error += own.gram[j][k] * state.delta[k];
            }
            g_sum[j] += state.t * error;
            UNROLL for (int k = 0; k <= j; k++) h_sum[j][k] += t2 * (own.gram[j][k] - s[j] * s[k] * shrink);
        }
        scale += state.eliminated * t2 * state.ff;
    }
    double length = 0, total = (double)lanes_sum(scale);
    for (int j = 0; j < n; j++)
        length += x[j] * x[j];
    for (int j = 0; j < n; j++) {
        g[j] = (double)lanes_sum(g_sum[j]);
        for (int k = 0; k <= j; k++)
            h[j * n + k] = h[k * n + j] =
                (double)lanes_sum(h_sum[j][k]) + (length > 0 ? total * x[j] * x[k] / (length * length) : 0);
    }
}

void WEFT_KERNEL(weft_views_linear_normal)(const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                                           const weft_linear *linear, double *h, double *g)
{
    FOR_LOBES(trial->fit.lobe_count, linear_normal_of, bundle, trial, with_table, linear, h, g);
}

/* ---- Directions of a vector of views ---- */

typedef struct view_lanes {
    lanes local[3];              /* v' = R v */
    lanes p[WEFT_GRAM_LOBES][3]; /* diag(c) v' */
    lanes m[WEFT_GRAM_LOBES][3]; /* R^T diag(c) v' */
} view_lanes;

WEFT_INLINE view_lanes lanes_of_views(const weft_bundle *bundle, const parameters *at, int lobes, int view)
{
    view_lanes own;
    lanes v[3];
    for (int k = 0; k < 3; k++)
        v[k] = lanes_load(bundle->view_xyz[k] + view);
    for (int k = 0; k < 3; k++)
        own.local[k] = at->rows[k][0] * v[0] + at->rows[k][1] * v[1] + at->rows[k][2] * v[2];
    for (int i = 0; i < lobes; i++) {
        for (int k = 0; k < 3; k++)
            own.p[i][k] = at->c[i][k] * own.local[k];
        for (int k = 0; k < 3; k++)
            own.m[i][k] = at->rows[0][k] * own.p[i][0] + at->rows[1][k] * own.p[i][1] + at->rows[2][k] * own.p[i][2];
    }
    return own;
}

/* The products of all columns. */
WEFT_INLINE void load_products(const float *sums, int columns, int stride, int view,
                               lanes product[WEFT_GRAM_COLUMNS][WEFT_GRAM_COLUMNS])
{
    for (int a = 0; a < columns; a++) {
        for (int b = a; b < columns; b++)
            product[a][b] = product[b][a] =
                lanes_load(sums + (size_t)weft_gram_product(a, b, columns) * (size_t)stride + view);
    }
}

/* ---- Digest ---- */

/* Linear column j as a combination of the columns of the pass. */
typedef struct combination {
    int count, column[3];
    lanes weight[3];
} combination;

WEFT_INLINE combination linear_column(int j, const view_lanes *own)
{
    if (j == 0)
        return (combination){1, {0}, {lanes_of(1)}};
    const lanes *m = own->m[j - 1];
    int first = 1 + 4 * (j - 1);
    return (combination){3, {first, first + 1, first + 2}, {m[0], m[1], m[2]}};
}

WEFT_INLINE double digest_of(int lobes, const weft_bundle *bundle, weft_trial *trial)
{
    const int n = lobes + 1, columns = weft_gram_columns(lobes), e = columns - 1;
    int stride = bundle->view_stride;
    lanes strength[WEFT_LINEAR_MAX] = {{0}}, energy = {0}, model_energy = {0};
    parameters at = parameters_of(trial, trial->at.x);
    for (int view = 0; view < stride; view += LANES) {
        lanes product[WEFT_GRAM_COLUMNS][WEFT_GRAM_COLUMNS];
        view_lanes own = lanes_of_views(bundle, &at, lobes, view);
        load_products(trial->sums, columns, stride, view, product);
        UNROLL for (int j = 0; j < n; j++)
        {
            combination a = linear_column(j, &own);
            lanes error = {0};
            UNROLL for (int i = 0; i < a.count; i++) error += a.weight[i] * product[a.column[i]][e];
            lanes_store(trial->linear + (WEFT_LINEAR_ERROR + j) * stride + view, error);
            UNROLL for (int k = 0; k <= j; k++)
            {
                combination b = linear_column(k, &own);
                lanes sum = {0};
                UNROLL for (int i = 0; i < a.count; i++)
                {
                    UNROLL for (int l = 0; l < b.count; l++) sum +=
                        a.weight[i] * b.weight[l] * product[a.column[i]][b.column[l]];
                }
                lanes_store(trial->linear + weft_linear_gram(j, k) * stride + view, sum);
                strength[j] += j == k ? sum : lanes_of(0);
                model_energy += (j == k ? 1.0f : 2.0f) * at.x[j] * at.x[k] * sum;
            }
        }
        lanes_store(trial->linear + WEFT_LINEAR_SQUARE * stride + view, product[e][e]);
        energy += product[e][e];
    }
    UNROLL for (int j = 0; j < n; j++) trial->strength[j] = (double)lanes_sum(strength[j]);
    trial->energy = (double)lanes_sum(energy);
    return (double)lanes_sum(model_energy);
}

double WEFT_KERNEL(weft_views_digest)(const weft_bundle *bundle, weft_trial *trial)
{
    return FOR_LOBES(trial->fit.lobe_count, digest_of, bundle, trial);
}

/* ---- All parameters ---- */

/* The derivative of f by one parameter. */
typedef struct derivative {
    int count, column[3 * WEFT_GRAM_LOBES];
    lanes weight[3 * WEFT_GRAM_LOBES];
} derivative;

WEFT_INLINE void lobe_derivatives(const parameters *at, int i, const view_lanes *own, derivative *by)
{
    int block = 1 + 4 * i, next = 1;
    by[0].count = 3;
    for (int axis = 0; axis < 3; axis++) {
        by[0].column[axis] = block + axis;
        by[0].weight[axis] = own->m[i][axis];
    }
    for (int k = 0; k < 3; k++) {
        if (k == at->fixed[i])
            continue;
        by[next].count = 3;
        for (int axis = 0; axis < 3; axis++) {
            by[next].column[axis] = block + axis;
            by[next].weight[axis] = at->factor[i] * at->rows[k][axis] * own->local[k];
        }
        next++;
    }
    by[3].count = 1;
    by[3].column[0] = block + 3;
    by[3].weight[0] = lanes_of(at->factor[i] * LN2);
}

WEFT_INLINE void cross_axis(const lanes *a, int k, lanes *result)
{
    int next = (k + 1) % 3, last = (k + 2) % 3;
    result[k] = lanes_of(0);
    result[next] = a[last];
    result[last] = -a[next];
}

/* A small rotation w turns l' into l' + w x l' and v' likewise: db = l' . (p x w + c o (w x v')). */
WEFT_INLINE void frame_derivatives(const parameters *at, int lobes, const view_lanes *own, derivative *by)
{
    for (int k = 0; k < 3; k++) {
        lanes moved[3];
        cross_axis(own->local, k, moved); /* v' x w, the negative of what is wanted */
        by[k].count = 3 * lobes;
        for (int i = 0; i < lobes; i++) {
            lanes turned[3];
            cross_axis(own->p[i], k, turned);
            for (int axis = 0; axis < 3; axis++) {
                lanes weight = {0};
                for (int row = 0; row < 3; row++)
                    weight += at->factor[i] * at->rows[row][axis] * (turned[row] - at->c[i][row] * moved[row]);
                by[k].column[3 * i + axis] = 1 + 4 * i + axis;
                by[k].weight[3 * i + axis] = weight;
            }
        }
    }
}

/* f and r - T f as combinations of the columns. */
WEFT_INLINE void expand_columns(const parameters *at, int lobes, const view_lanes *own, const view_state *state,
                                lanes *f, lanes *error)
{
    f[0] = lanes_of(at->x[0]);
    error[0] = state->delta[0];
    for (int i = 0; i < lobes; i++) {
        for (int k = 0; k < 3; k++) {
            f[1 + 4 * i + k] = at->x[1 + i] * own->m[i][k];
            error[1 + 4 * i + k] = state->delta[1 + i] * own->m[i][k];
        }
        f[4 + 4 * i] = error[4 + 4 * i] = lanes_of(0);
    }
    f[1 + 4 * lobes] = lanes_of(0);
    error[1 + 4 * lobes] = lanes_of(1);
}

/* Sums over the vectors of views. */
typedef struct normal_lanes {
    lanes h[WEFT_SOLVE_MAX][WEFT_SOLVE_MAX], g[WEFT_SOLVE_MAX];
} normal_lanes;

WEFT_INLINE void add_views(int n, const derivative *by, lanes product[WEFT_GRAM_COLUMNS][WEFT_GRAM_COLUMNS],
                           const lanes *f, const lanes *error, const view_state *state, int columns, normal_lanes *sums)
{
    lanes of[WEFT_SOLVE_MAX][WEFT_GRAM_COLUMNS], s[WEFT_SOLVE_MAX];
    lanes t2 = state->t * state->t;
    lanes shrink = state->eliminated / lanes_select(state->eliminated > 0, state->ff, lanes_of(1));
    for (int p = 0; p < n; p++) {
        lanes along = {0}, against = {0};
        UNROLL for (int c = 0; c < columns; c++)
        {
            lanes sum = {0};
            UNROLL for (int k = 0; k < by[p].count; k++) sum += by[p].weight[k] * product[by[p].column[k]][c];
            of[p][c] = sum;
            along += sum * f[c];
            against += sum * error[c];
        }
        s[p] = along;
        sums->g[p] += state->t * against;
        for (int q = 0; q <= p; q++) {
            lanes sum = -s[p] * s[q] * shrink;
            UNROLL for (int k = 0; k < by[q].count; k++) sum += of[p][by[q].column[k]] * by[q].weight[k];
            sums->h[p][q] += t2 * sum;
        }
    }
}

WEFT_INLINE double normal_of(int lobes, const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                             bool rotate, weft_normal *normal)
{
    const int columns = weft_gram_columns(lobes), n = 1 + 4 * lobes + (rotate ? 3 : 0);
    double x[WEFT_LINEAR_MAX] = {trial->fit.diffuse};
    lanes scale = {0};
    normal_lanes sums;
    memset(sums.h, 0, (size_t)n * sizeof sums.h[0]);
    memset(sums.g, 0, (size_t)n * sizeof sums.g[0]);
    for (int i = 0; i < lobes; i++)
        x[1 + i] = trial->fit.lobe[i].amplitude;
    parameters at = parameters_of(trial, x);
    for (int view = 0; view < bundle->view_stride; view += LANES) {
        lanes product[WEFT_GRAM_COLUMNS][WEFT_GRAM_COLUMNS], f[WEFT_GRAM_COLUMNS], error[WEFT_GRAM_COLUMNS];
        derivative by[WEFT_SOLVE_MAX] = {{.count = 1, .weight = {lanes_of(1)}}};
        linear_lanes linear = load_linear(trial, lobes, bundle->view_stride, view);
        view_state state = state_of(&linear, &at, lobes, with_table);
        view_lanes own = lanes_of_views(bundle, &at, lobes, view);
        load_products(trial->sums, columns, bundle->view_stride, view, product);
        for (int i = 0; i < lobes; i++)
            lobe_derivatives(&at, i, &own, by + 1 + 4 * i);
        if (rotate)
            frame_derivatives(&at, lobes, &own, by + 1 + 4 * lobes);
        expand_columns(&at, lobes, &own, &state, f, error);
        add_views(n, by, product, f, error, &state, columns, &sums);
        scale += state.eliminated * state.t * state.t * state.ff;
    }
    for (int p = 0; p < n; p++) {
        normal->g[p] = (double)lanes_sum(sums.g[p]);
        for (int q = 0; q <= p; q++)
            normal->h[p * n + q] = (double)lanes_sum(sums.h[p][q]);
    }
    return (double)lanes_sum(scale);
}

double WEFT_KERNEL(weft_views_normal)(const weft_bundle *bundle, const weft_trial *trial, bool with_table, bool rotate,
                                      weft_normal *normal)
{
    int lobes = trial->fit.lobe_count;
    return rotate && lobes ? FOR_LOBES(lobes, normal_of, bundle, trial, with_table, true, normal)
                           : FOR_LOBES(lobes, normal_of, bundle, trial, with_table, false, normal);
}
