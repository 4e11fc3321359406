/* Standard errors of the parameters of a fitted weave. */
#include "compress/weave_fit/parametric_weave.h"

#include <math.h>
#include <stdlib.h>

/* Which light, view and photograph each residual is of. */
typedef struct clusters {
    int *light, *view, *image; /* [3 mean->count] channel, then image in the order */
    int light_count, view_count;
} clusters;

static bool same_direction(weft_vec3 a, weft_vec3 b)
{
    return weft_dot(a, b) > 1 - 1e-10;
}

/* Numbers directions that differ, in the order in which they come. */
static int number_directions(const weft_vec3 *direction, int count, int *number)
{
    int known = 0, *first = malloc((size_t)count * sizeof *first);
    for (int i = 0; first && i < count; i++) {
        int k = 0;
        while (k < known && !same_direction(direction[i], direction[first[k]]))
            k++;
        if (k == known)
            first[known++] = i;
        number[i] = k;
    }
    free(first);
    return known;
}

static weft_code make_clusters(const weft_fit_weave_model *model, clusters *of, weft_error *error)
{
    int count = model->mean->count;
    size_t size = 3 * (size_t)count * sizeof(int);
    *of = (clusters){.light = malloc(size), .view = malloc(size), .image = malloc(size)};
    if (!of->light || !of->view || !of->image)
        return weft_fail_memory(error, "lights and views", 3 * size);
    of->light_count = number_directions(model->light[0], count, of->light);
    of->view_count = number_directions(model->view[0], count, of->view);
    if (of->light_count == 0 || of->view_count == 0)
        return weft_fail_memory(error, "lights and views", size);
    for (int i = 0; i < 3 * count; i++) {
        of->light[i] = of->light[i % count];
        of->view[i] = of->view[i % count];
        of->image[i] = i % count;
    }
    return WEFT_OK;
}

static void free_clusters(clusters *of)
{
    free(of->light);
    free(of->view);
    free(of->image);
}

static weft_code combine(const weft_linearised *solution, const clusters *of, int images, double *deviation,
                         weft_error *error)
{
    double light[WEFT_FIT_WEAVE_PARAMETERS], view[WEFT_FIT_WEAVE_PARAMETERS], image[WEFT_FIT_WEAVE_PARAMETERS];
    WEFT_TRY(weft_jackknife_variance(solution, of->light, of->light_count, light, error));
    WEFT_TRY(weft_jackknife_variance(solution, of->view, of->view_count, view, error));
    WEFT_TRY(weft_jackknife_variance(solution, of->image, images, image, error));
    for (int i = 0; i < solution->columns; i++) {
        double largest = fmax(fmax(light[i], view[i]), image[i]), both = light[i] + view[i] - image[i];
        deviation[i] = isfinite(largest) ? sqrt(fmax(largest, both)) : INFINITY;
    }
    return WEFT_OK;
}

static void linearise(weft_fit_weave_model *model, const double *parameters, double *residuals,
                      weft_linearised *solution)
{
    weft_least_squares problem = weft_fit_weave_problem(model);
    double *jacobian = residuals + problem.residual_count;
    *solution = (weft_linearised){problem.residual_count, problem.parameter_count, residuals, jacobian};
    double *scratch = jacobian + (size_t)problem.residual_count * (size_t)problem.parameter_count;
    weft_least_squares_linearise(&problem, parameters, residuals, jacobian, scratch);
}

weft_code weft_fit_weave_deviation(weft_fit_weave_model *model, const double *parameters, double *deviation,
                                   weft_error *error)
{
    weft_fit_weave_look_at(model, model->mean->count);
    /* Residuals, their derivatives, and what it takes to find these. */
    size_t rows = 3 * (size_t)model->looked_at, columns = (size_t)model->parameter_count;
    size_t size = (rows * (columns + 1) + columns + rows) * sizeof(double);
    double *residuals = malloc(size);
    if (!residuals)
        return weft_fail_memory(error, "derivatives", size);
    clusters of;
    weft_linearised solution;
    weft_code code = make_clusters(model, &of, error);
    if (code == WEFT_OK) {
        linearise(model, parameters, residuals, &solution);
        code = combine(&solution, &of, model->mean->count, deviation, error);
    }
    free_clusters(&of);
    free(residuals);
    return code;
}
