#include "bench/fit/problem.h"

#include <math.h>

double problem_update_table(problem *given, double *table)
{
    double energy = 0, change = 0;
    given->passes++;
    for (int i = 0; i < given->sample_count; i++)
        energy += given->model[i] * given->model[i];
    for (int view = 0; view < given->view_count; view++) {
        double fr = 0, ff = 0;
        for (int i = given->first[view]; i < given->first[view + 1]; i++) {
            fr += given->model[i] * given->value[i];
            ff += given->model[i] * given->model[i];
        }
        double t = ff > 1e-9 * energy / given->view_count ? fmax(0, fr / ff) : 1;
        change += fabs(t - table[view]);
        table[view] = t;
    }
    return change / given->view_count;
}

void problem_start(problem *given, int index, solution *result)
{
    static const double mirror[3] = {-0.95, -0.9, 8}, broad[3] = {-0.1, -0.15, 1.5}, retro[3] = {0.9, 0.95, 8};
    const double *const order[2][PROBLEM_LOBES] = {{mirror, broad, retro}, {retro, broad, mirror}};
    double energy = 0, cosine = 0;
    for (int i = 0; i < given->sample_count; i++) {
        energy += given->value[i] * given->value[i];
        cosine += given->cosine[i] * given->cosine[i];
    }
    double grey = cosine > 0 ? sqrt(energy / cosine) : 0;
    result->x[0] = 0.7 * grey;
    for (int lobe = 0; lobe < given->lobe_count; lobe++) {
        double *own = result->x + 1 + 4 * lobe;
        const double *shape = order[index][lobe];
        own[0] = 0.3 * grey;
        own[1] = shape[0];
        own[2] = shape[1];
        own[3] = log(shape[2]);
    }
    for (int view = 0; view < given->view_count; view++)
        result->table[view] = 1;
}

double problem_residual(problem *given, const solution *found)
{
    double sum = 0;
    given->code->evaluate(given, found->x, 0, given->sample_count);
    for (int view = 0; view < given->view_count; view++) {
        for (int i = given->first[view]; i < given->first[view + 1]; i++) {
            double difference = given->value[i] - found->table[view] * given->model[i];
            sum += difference * difference;
        }
    }
    return sum;
}
