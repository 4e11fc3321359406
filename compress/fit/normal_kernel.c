/* The normal equations of all parameters from the sums of a pass, T(v) eliminated in every view. */
#include "compress/fit/view_lanes.h"

#include <math.h>
#include <string.h>

#define LN2 0.693147180559945309

/* The columns of a pass, with the light turned into the frame of the texel, l' = R l:
 *     k | h_i l'_x, h_i l'_y, h_i l'_z, q_i for every lobe | e
 * so that df/dc_ik = A_i N_i v'_k times one column, df/d ln N_i = A_i N_i ln 2 times another. */
typedef struct local_gram {
    lanes of[WEFT_GRAM_COLUMNS][WEFT_GRAM_COLUMNS]; /* the products of columns a <= b */
} local_gram;

/* What belongs to the frame and the shapes. */
typedef struct shapes {
    float rows[3][3];
    float c[WEFT_GRAM_LOBES][3], factor[WEFT_GRAM_LOBES]; /* A N */
} shapes;

static shapes shapes_of(const weft_fit *fit)
{
    shapes own;
    double rows[3][3];
    weft_frame_rows(&fit->frame, rows);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            own.rows[i][k] = (float)rows[i][k];
    }
    for (int i = 0; i < fit->lobe_count; i++) {
        for (int k = 0; k < 3; k++)
            own.c[i][k] = (float)fit->lobe[i].c[k];
        own.factor[i] = (float)(fit->lobe[i].amplitude * exp(fit->lobe[i].log_exponent));
    }
    return own;
}

WEFT_INLINE void load_gram(const float *sums, int columns, int stride, int view, local_gram *gram)
{
    UNROLL
    for (int a = 0; a < columns; a++) {
        UNROLL
        for (int b = a; b < columns; b++)
            gram->of[a][b] = lanes_load(sums + (size_t)weft_gram_product(a, b, columns) * (size_t)stride + view);
    }
}

WEFT_INLINE lanes product(const local_gram *gram, int a, int b)
{
    return a <= b ? gram->of[a][b] : gram->of[b][a];
}

WEFT_INLINE void turn(const float rows[3][3], lanes *x, lanes *y, lanes *z)
{
    const lanes own[3] = {*x, *y, *z};
    *x = rows[0][0] * own[0] + rows[0][1] * own[1] + rows[0][2] * own[2];
    *y = rows[1][0] * own[0] + rows[1][1] * own[1] + rows[1][2] * own[2];
    *z = rows[2][0] * own[0] + rows[2][1] * own[1] + rows[2][2] * own[2];
}

/* Turns the three columns of a lobe from l to l' = R l in their products with all others, and with each other. */
WEFT_INLINE void turn_lobe(const float rows[3][3], int first, int columns, local_gram *gram)
{
    UNROLL
    for (int c = 0; c < first; c++)
        turn(rows, &gram->of[c][first], &gram->of[c][first + 1], &gram->of[c][first + 2]);
    UNROLL
    for (int c = first + 3; c < columns; c++)
        turn(rows, &gram->of[first][c], &gram->of[first + 1][c], &gram->of[first + 2][c]);
    lanes own[3][3];
    UNROLL
    for (int i = 0; i < 3; i++) {
        UNROLL
        for (int k = 0; k < 3; k++)
            own[i][k] = product(gram, first + i, first + k);
        turn(rows, &own[i][0], &own[i][1], &own[i][2]);
    }
    UNROLL
    for (int k = 0; k < 3; k++) {
        turn(rows, &own[0][k], &own[1][k], &own[2][k]);
        UNROLL
        for (int i = 0; i <= k; i++)
            gram->of[first + i][first + k] = own[i][k];
    }
}

/* f and r - T f as combinations of the columns; v' by column of a lobe. */
typedef struct expansion {
    lanes local[3];
    lanes f[WEFT_GRAM_COLUMNS], error[WEFT_GRAM_COLUMNS];
} expansion;

WEFT_INLINE expansion expand(const weft_bundle *bundle, const shapes *at, const linear_point *linear,
                             const view_state *state, int lobes, int view)
{
    expansion own;
    UNROLL
    for (int k = 0; k < 3; k++) {
        own.local[k] = lanes_of(0);
        UNROLL
        for (int i = 0; i < 3; i++)
            own.local[k] += at->rows[k][i] * lanes_load(bundle->view_xyz[i] + view);
    }
    own.f[0] = lanes_of(linear->x[0]);
    own.error[0] = state->delta[0];
    UNROLL
    for (int i = 0; i < lobes; i++) {
        UNROLL
        for (int k = 0; k < 3; k++) {
            lanes p = at->c[i][k] * own.local[k];
            own.f[1 + 4 * i + k] = linear->x[1 + i] * p;
            own.error[1 + 4 * i + k] = state->delta[1 + i] * p;
        }
    }
    return own;
}

WEFT_INLINE void cross_axis(const lanes *a, int k, lanes *result)
{
    int next = (k + 1) % 3, last = (k + 2) % 3;
    result[k] = lanes_of(0);
    result[next] = a[last];
    result[last] = -a[next];
}

/* A small rotation w turns l' into l' + w x l' and v' likewise: db = l' . (p x w + c o (w x v')), p = c o v'. The
 * derivative of f by the rotation about axis k is `weight` times the columns of the lobes. */
WEFT_INLINE void rotation_weights(const shapes *at, const expansion *own, int lobes, int k, lanes *weight)
{
    lanes moved[3];
    cross_axis(own->local, k, moved); /* v' x w, the negative of what is wanted */
    UNROLL
    for (int i = 0; i < lobes; i++) {
        lanes p[3], turned[3];
        UNROLL
        for (int a = 0; a < 3; a++)
            p[a] = at->c[i][a] * own->local[a];
        cross_axis(p, k, turned);
        UNROLL
        for (int a = 0; a < 3; a++)
            weight[3 * i + a] = at->factor[i] * (turned[a] - at->c[i][a] * moved[a]);
    }
}

/* Sums over the views for the columns themselves, the three of a lobe times v', and for the rotations after them. */
typedef struct normal_lanes {
    lanes h[WEFT_NORMAL_MAX][WEFT_NORMAL_MAX], g[WEFT_NORMAL_MAX], scale;
} normal_lanes;

/* A column of the normal equations is T times one of the pass, times v'_k where that is the k-th of a lobe: the weight
 * of number k, 3 for T alone. */
typedef struct column_weights {
    lanes of[4], product[4][4];
} column_weights;

WEFT_INLINE int weight_of(int column)
{
    return column == 0 ? 3 : (column - 1) % 4;
}

WEFT_INLINE column_weights weights_at(const expansion *own, const view_state *state)
{
    column_weights weights;
    WEFT_EACH (3)
        weights.of[i] = state->t * own->local[i];
    weights.of[3] = state->t;
    UNROLL
    for (int i = 0; i < 4; i++) {
        UNROLL
        for (int k = 0; k < 4; k++)
            weights.product[i][k] = weights.of[i] * weights.of[k];
    }
    return weights;
}

/* <c|f> and <c|r - T f> of a column c from its products with those of the pass. f has no share of q and e. */
WEFT_INLINE void expand_product(int lobes, const lanes *row, const expansion *own, lanes *along, lanes *against)
{
    *along = row[0] * own->f[0];
    *against = row[1 + 4 * lobes] + row[0] * own->error[0];
    UNROLL
    for (int i = 0; i < 3 * lobes; i++) {
        int c = 1 + i / 3 * 4 + i % 3;
        *along += row[c] * own->f[c];
        *against += row[c] * own->error[c];
    }
}

WEFT_INLINE void add_columns(int lobes, const local_gram *gram, const expansion *own, const view_state *state,
                             const column_weights *weights, lanes s[WEFT_NORMAL_MAX], normal_lanes *sums)
{
    const int n = 1 + 4 * lobes;
    UNROLL
    for (int p = 0; p < n; p++) {
        lanes row[WEFT_GRAM_COLUMNS], along, against;
        UNROLL
        for (int c = 0; c <= n; c++)
            row[c] = product(gram, p, c);
        expand_product(lobes, row, own, &along, &against);
        s[p] = weights->of[weight_of(p)] * along;
        lanes shrunk = s[p] * state->shrink;
        sums->g[p] += weights->of[weight_of(p)] * against;
        UNROLL
        for (int q = 0; q <= p; q++)
            sums->h[p][q] += weights->product[weight_of(p)][weight_of(q)] * row[q] - shrunk * s[q];
    }
}

WEFT_INLINE void add_rotations(int lobes, const shapes *at, const local_gram *gram, const expansion *own,
                               const view_state *state, const column_weights *weights, lanes s[WEFT_NORMAL_MAX],
                               normal_lanes *sums)
{
    const int n = 1 + 4 * lobes;
    lanes weight[3][3 * WEFT_GRAM_LOBES];
    for (int k = 0; k < 3; k++) {
        lanes row[WEFT_GRAM_COLUMNS], against;
        rotation_weights(at, own, lobes, k, weight[k]);
        UNROLL
        for (int i = 0; i < 3 * lobes; i++)
            weight[k][i] *= state->t;
        UNROLL
        for (int c = 0; c <= n; c++) {
            row[c] = lanes_of(0);
            UNROLL
            for (int i = 0; i < 3 * lobes; i++)
                row[c] += weight[k][i] * product(gram, 1 + i / 3 * 4 + i % 3, c);
        }
        expand_product(lobes, row, own, &s[n + k], &against);
        lanes shrunk = s[n + k] * state->shrink;
        sums->g[n + k] += against;
        UNROLL
        for (int q = 0; q < n; q++)
            sums->h[n + k][q] += weights->of[weight_of(q)] * row[q] - shrunk * s[q];
        for (int q = 0; q <= k; q++) {
            lanes sum = -shrunk * s[n + q];
            UNROLL
            for (int i = 0; i < 3 * lobes; i++)
                sum += weight[q][i] * row[1 + i / 3 * 4 + i % 3];
            sums->h[n + k][n + q] += sum;
        }
    }
}

WEFT_INLINE void sum_views(int lobes, bool rotate, const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                           normal_lanes *sums)
{
    const int columns = weft_gram_columns(lobes);
    double x[WEFT_LINEAR_MAX] = {trial->fit.diffuse};
    for (int i = 0; i < lobes; i++)
        x[1 + i] = trial->fit.lobe[i].amplitude;
    const linear_point linear = linear_point_of(trial, x);
    const shapes at = shapes_of(&trial->fit);
    for (int view = 0; view < bundle->view_count; view += LANES) {
        local_gram gram;
        lanes s[WEFT_NORMAL_MAX];
        linear_lanes rows = load_linear(trial, lobes, bundle->view_stride, view);
        view_state state = state_of(&rows, &linear, lobes, with_table);
        expansion own = expand(bundle, &at, &linear, &state, lobes, view);
        load_gram(trial->sums, columns, bundle->view_stride, view, &gram);
        UNROLL
        for (int i = 0; i < lobes; i++)
            turn_lobe(at.rows, 1 + 4 * i, columns, &gram);
        const column_weights weights = weights_at(&own, &state);
        add_columns(lobes, &gram, &own, &state, &weights, s, sums);
        if (rotate)
            add_rotations(lobes, &at, &gram, &own, &state, &weights, s, sums);
        sums->scale += state.eliminated * state.t * state.t * state.ff;
    }
}

/* From columns to parameters, a combination of at most three each: rho; A = sum_k c_k (column k); the two free c;
 * ln N; rotations. */
typedef struct parameter {
    int count, column[3];
    double weight[3];
} parameter;

static int list_parameters(const weft_fit *fit, bool rotate, parameter *all)
{
    int n = 0;
    all[n++] = (parameter){1, {0}, {1}};
    for (int i = 0; i < fit->lobe_count; i++) {
        const weft_fit_lobe *lobe = &fit->lobe[i];
        int first = 1 + 4 * i;
        double factor = lobe->amplitude * exp(lobe->log_exponent);
        all[n++] = (parameter){3, {first, first + 1, first + 2}, {lobe->c[0], lobe->c[1], lobe->c[2]}};
        for (int k = 0; k < 3; k++) {
            if (k != weft_lobe_fixed(lobe))
                all[n++] = (parameter){1, {first + k}, {factor}};
        }
        all[n++] = (parameter){1, {first + 3}, {LN2 * factor}};
    }
    for (int k = 0; rotate && k < 3; k++)
        all[n++] = (parameter){1, {1 + 4 * fit->lobe_count + k}, {1}};
    return n;
}

static double combine(const parameter *a, const parameter *b, double h[WEFT_NORMAL_MAX][WEFT_NORMAL_MAX])
{
    double sum = 0;
    for (int i = 0; i < a->count; i++) {
        for (int k = 0; k < b->count; k++)
            sum += a->weight[i] * b->weight[k] * h[a->column[i]][b->column[k]];
    }
    return sum;
}

static void to_parameters(const weft_fit *fit, bool rotate, const normal_lanes *sums, weft_normal *normal)
{
    parameter all[WEFT_NORMAL_MAX];
    double h[WEFT_NORMAL_MAX][WEFT_NORMAL_MAX], g[WEFT_NORMAL_MAX];
    int n = list_parameters(fit, rotate, all);
    for (int p = 0; p < n; p++) {
        g[p] = (double)lanes_sum(sums->g[p]);
        for (int q = 0; q <= p; q++)
            h[p][q] = h[q][p] = (double)lanes_sum(sums->h[p][q]);
    }
    for (int p = 0; p < n; p++) {
        normal->g[p] = 0;
        for (int i = 0; i < all[p].count; i++)
            normal->g[p] += all[p].weight[i] * g[all[p].column[i]];
        for (int q = 0; q <= p; q++)
            normal->h[p * n + q] = normal->h[q * n + p] = combine(&all[p], &all[q], h);
    }
}

WEFT_INLINE double normal_of(int lobes, bool rotate, const weft_bundle *bundle, const weft_trial *trial,
                             bool with_table, weft_normal *normal)
{
    const int n = 1 + 4 * lobes + (rotate ? 3 : 0);
    normal_lanes sums = {.scale = {0}};
    memset(sums.g, 0, (size_t)n * sizeof sums.g[0]);
    memset(sums.h, 0, (size_t)n * sizeof sums.h[0]);
    sum_views(lobes, rotate, bundle, trial, with_table, &sums);
    to_parameters(&trial->fit, rotate, &sums, normal);
    return (double)lanes_sum(sums.scale);
}

double WEFT_KERNEL(weft_fit_normal)(const weft_bundle *bundle, const weft_trial *trial, bool with_table, bool rotate,
                                    weft_normal *normal)
{
    int lobes = trial->fit.lobe_count;
    return rotate && lobes ? FOR_LOBES(lobes, normal_of, true, bundle, trial, with_table, normal)
                           : FOR_LOBES(lobes, normal_of, false, bundle, trial, with_table, normal);
}
