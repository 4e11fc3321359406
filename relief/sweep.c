#include "relief/sweep.h"

#include "base/processor.h"

#include <math.h>

/* Into [0, count). */
static double wrapped(double x, int count)
{
    double rest = x - floor(x / count) * count;
    return rest < count ? rest : 0;
}

static void place_row(const weft_features *features, double y, float *down, int row[2])
{
    int height = features->height;
    if (features->repeats)
        y = wrapped(y, height);
    int upper = (int)floor(y);
    *down = (float)(y - upper);
    row[0] = upper;
    row[1] = features->repeats ? (upper + 1) % height : upper + 1;
    if (upper < 0 || row[1] >= height)
        row[0] = -1;
}

/* Row `y` of the grid at a height. */
static void place_views(const weft_sweep *sweep, int y, double height, weft_sweep_row *row)
{
    const weft_features *features = sweep->features;
    for (int i = 0; i < sweep->view_count; i++) {
        weft_vec3 view = features->direction[sweep->view[i]];
        double shift_x = height * view.x / view.z * features->width / features->width_mm;
        double shift_y = height * view.y / view.z * features->height / features->height_mm;
        double x = 0.5 / sweep->scale - 0.5 - shift_x;
        row->x[i] = (float)(features->repeats ? wrapped(x, features->width) : x);
        place_row(features, (y + 0.5) / sweep->scale - 0.5 + shift_y, &row->down[i], row->y[i]);
    }
}

void weft_sweep_run(const weft_sweep *sweep, float *cost)
{
    const weft_features *features = sweep->features;
    weft_sweep_kernel *kernel = WEFT_DISPATCH(weft_sweep_row);
    size_t width = (size_t)features->width * (size_t)sweep->scale;
    int height = features->height * sweep->scale;
#pragma omp parallel for schedule(dynamic)
    for (int y = 0; y < height; y++) {
        weft_sweep_row row = {.features = features,
                              .view = sweep->view,
                              .view_count = sweep->view_count,
                              .scale = sweep->scale,
                              .least_energy = sweep->least_energy};
        for (int step = 0; step < sweep->step_count; step++) {
            double share = sweep->step_count > 1 ? (double)step / (sweep->step_count - 1) : 0;
            place_views(sweep, y, sweep->low + share * (sweep->high - sweep->low), &row);
            kernel(&row, cost + ((size_t)step * (size_t)height + (size_t)y) * width);
        }
    }
}
