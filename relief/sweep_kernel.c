/* The inner loop of relief/sweep.h, for every instruction set. */
#include "relief/sweep.h"

#include "relief/eight.h"

WEFT_DECLARE_SWEEP_KERNEL(WEFT_INSTRUCTION_SET);

/* Texels around a place along the row; false where one of them is outside. */
WEFT_INLINE bool columns_around(const weft_features *features, float x, int column[2], float *right)
{
    int width = features->width, left = (int)floorf(x);
    *right = x - (float)left;
    if (features->repeats) {
        left = left < 0 ? left + width : left >= width ? left - width : left;
        column[0] = left;
        column[1] = left + 1 < width ? left + 1 : 0;
        return true;
    }
    column[0] = left;
    column[1] = left + 1;
    return left >= 0 && left + 1 < width;
}

WEFT_INLINE bool all_known(const weft_features *features, int view, const int column[2], const int y[2])
{
    if (!features->known)
        return true;
    const uint8_t *known = features->known + (size_t)view * (size_t)features->height * (size_t)features->width;
    const uint8_t *upper = known + (size_t)y[0] * (size_t)features->width;
    const uint8_t *lower = known + (size_t)y[1] * (size_t)features->width;
    return upper[column[0]] && upper[column[1]] && lower[column[0]] && lower[column[1]];
}

/* Features of all views that see the point; returns how many do. */
WEFT_INLINE int gather(const weft_sweep_row *row, float shift, eight *found)
{
    const weft_features *features = row->features;
    int count = 0;
    for (int i = 0; i < row->view_count; i++) {
        int column[2];
        float right, down = row->down[i];
        const int *y = row->y[i];
        if (y[0] < 0 || !columns_around(features, row->x[i] + shift, column, &right) ||
            !all_known(features, row->view[i], column, y))
            continue;
        const float *upper = weft_feature_at(features, row->view[i], 0, y[0]);
        const float *lower = weft_feature_at(features, row->view[i], 0, y[1]);
        eight above = (1 - right) * eight_load(upper + WEFT_FEATURES * column[0]) +
                      right * eight_load(upper + WEFT_FEATURES * column[1]);
        eight below = (1 - right) * eight_load(lower + WEFT_FEATURES * column[0]) +
                      right * eight_load(lower + WEFT_FEATURES * column[1]);
        found[count++] = (1 - down) * above + down * below;
    }
    return count;
}

WEFT_INLINE float mean_energy(const eight *found, int count)
{
    eight sum = {0};
    for (int i = 0; i < count; i++)
        sum += found[i] * found[i];
    return eight_sum(sum) / (float)count;
}

WEFT_INLINE float robust_cost(const eight *found, int count, float least_energy)
{
    float scale = 1 / (mean_energy(found, count) + least_energy), cost = 0;
    eight mean = {0};
    for (int i = 0; i < count; i++)
        mean += found[i];
    mean /= (float)count;
    for (int round = 0; round <= WEFT_SWEEP_ROUNDS; round++) {
        eight sum = {0};
        float weights = 0;
        cost = 0;
        for (int i = 0; i < count; i++) {
            eight apart = found[i] - mean;
            float rho = eight_sum(apart * apart) * scale, part = 1 / (WEFT_SWEEP_SIGMA_SQUARED + rho);
            float weight = part * part;
            cost += rho * part;
            weights += weight;
            sum += weight * found[i];
        }
        mean = sum / weights;
    }
    return cost / (float)count;
}

void WEFT_KERNEL(weft_sweep_row)(const weft_sweep_row *row, float *cost)
{
    eight found[WEFT_SWEEP_MOST_VIEWS];
    float step = 1 / (float)row->scale;
    for (int x = 0; x < row->features->width * row->scale; x++) {
        int count = gather(row, (float)x * step, found);
        cost[x] = 2 * count >= row->view_count && count > 1 ? robust_cost(found, count, row->least_energy) : 1;
    }
}
