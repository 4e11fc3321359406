/* What follows from the sums of a pass for the linear parameters x = (rho, A_1, ...), all views at once. */
#include "compress/fit/view_lanes.h"

/* A linear column as a combination of the columns of the pass. */
typedef struct combination {
    int count, column[3];
    lanes weight[3];
} combination;

/* k itself; and k b_i^N_i, which is M_i v times the first three columns of lobe i. */
WEFT_INLINE combination linear_column(const weft_bundle *bundle, const weft_gram_point *point, int j, int view)
{
    if (j == 0)
        return (combination){1, {0}, {lanes_of(1)}};
    combination own = {.count = 3};
    for (int row = 0; row < 3; row++) {
        own.column[row] = 1 + 4 * (j - 1) + row;
        own.weight[row] = lanes_of(0);
        for (int k = 0; k < 3; k++)
            own.weight[row] += point->shape[j - 1][row][k] * lanes_load(bundle->view_xyz[k] + view);
    }
    return own;
}

WEFT_INLINE lanes product(const weft_trial *trial, int columns, int stride, int view, int a, int b)
{
    int at = weft_gram_product(a < b ? a : b, a < b ? b : a, columns);
    return lanes_load(trial->sums + (size_t)at * (size_t)stride + view);
}

WEFT_INLINE double digest_of(int lobes, const weft_bundle *bundle, weft_trial *trial)
{
    const int n = lobes + 1, columns = weft_gram_columns(lobes), e = columns - 1;
    int stride = bundle->view_stride;
    lanes strength[WEFT_LINEAR_MAX] = {{0}}, energy = {0}, model_energy = {0};
    const linear_point at = linear_point_of(trial, trial->at.x);
    for (int view = 0; view < bundle->view_count; view += LANES) {
        combination column[WEFT_LINEAR_MAX];
        UNROLL
        for (int j = 0; j < n; j++)
            column[j] = linear_column(bundle, &trial->point, j, view);
        UNROLL
        for (int j = 0; j < n; j++) {
            const combination a = column[j];
            lanes error = {0};
            UNROLL
            for (int i = 0; i < a.count; i++)
                error += a.weight[i] * product(trial, columns, stride, view, a.column[i], e);
            lanes_store(trial->linear + (WEFT_LINEAR_ERROR + j) * stride + view, error);
            UNROLL
            for (int k = 0; k <= j; k++) {
                const combination b = column[k];
                lanes sum = {0};
                UNROLL
                for (int i = 0; i < a.count; i++) {
                    lanes row = {0};
                    UNROLL
                    for (int l = 0; l < b.count; l++)
                        row += b.weight[l] * product(trial, columns, stride, view, a.column[i], b.column[l]);
                    sum += a.weight[i] * row;
                }
                lanes_store(trial->linear + weft_linear_gram(j, k) * stride + view, sum);
                strength[j] += j == k ? sum : lanes_of(0);
                model_energy += (j == k ? 1.0f : 2.0f) * at.x[j] * at.x[k] * sum;
            }
        }
        lanes square = product(trial, columns, stride, view, e, e);
        lanes_store(trial->linear + WEFT_LINEAR_SQUARE * stride + view, square);
        energy += square;
    }
    UNROLL
    for (int j = 0; j < n; j++)
        trial->strength[j] = (double)lanes_sum(strength[j]);
    trial->energy = (double)lanes_sum(energy);
    return (double)lanes_sum(model_energy);
}

double WEFT_KERNEL(weft_linear_digest)(const weft_bundle *bundle, weft_trial *trial)
{
    return FOR_LOBES(trial->point.lobe_count, digest_of, bundle, trial);
}

WEFT_INLINE double residual_of(int lobes, const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                               const weft_linear *linear, float *table)
{
    const linear_point at = linear_point_of(trial, linear->x);
    lanes sum = {0};
    for (int view = 0; view < bundle->view_count; view += LANES) {
        linear_lanes own = load_linear(trial, lobes, bundle->view_stride, view);
        view_state state = state_of(&own, &at, lobes, with_table);
        sum += state.residual;
        lanes_store(table + view, state.t);
    }
    return (double)lanes_sum(sum);
}

double WEFT_KERNEL(weft_linear_residual)(const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                                         const weft_linear *linear, float *table)
{
    return FOR_LOBES(trial->fit.lobe_count, residual_of, bundle, trial, with_table, linear, table);
}

WEFT_INLINE double normal_of(int lobes, const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                             const weft_linear *linear, double *h, double *g)
{
    const int n = lobes + 1;
    const double *x = linear->x;
    const linear_point at = linear_point_of(trial, x);
    lanes h_sum[WEFT_LINEAR_MAX][WEFT_LINEAR_MAX] = {{{0}}}, g_sum[WEFT_LINEAR_MAX] = {{0}};
    lanes scale = {0}, residual = {0};
    for (int view = 0; view < bundle->view_count; view += LANES) {
        linear_lanes own = load_linear(trial, lobes, bundle->view_stride, view);
        view_state state = state_of(&own, &at, lobes, with_table);
        lanes s[WEFT_LINEAR_MAX] = {{0}}, t2 = state.t * state.t;
        UNROLL
        for (int j = 0; j < n; j++) {
            lanes error = own.error[j];
            UNROLL
            for (int k = 0; k < n; k++) {
                s[j] += own.gram[j][k] * at.x[k];
                error += own.gram[j][k] * state.delta[k];
            }
            g_sum[j] += state.t * error;
            UNROLL
            for (int k = 0; k <= j; k++)
                h_sum[j][k] += t2 * (own.gram[j][k] - s[j] * s[k] * state.shrink);
        }
        scale += state.eliminated * t2 * state.ff;
        residual += state.residual;
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
    return (double)lanes_sum(residual);
}

double WEFT_KERNEL(weft_linear_normal)(const weft_bundle *bundle, const weft_trial *trial, bool with_table,
                                       const weft_linear *linear, double *h, double *g)
{
    return FOR_LOBES(trial->fit.lobe_count, normal_of, bundle, trial, with_table, linear, h, g);
}
