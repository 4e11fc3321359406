#include "compress/hold_out/scattered.h"

#include <math.h>

/* Its steps are the powers of 1 / 1.32472, the plastic number. */
double weft_scattered_number(int axis, double number)
{
    static const double step[2] = {0.7548776662466927, 0.5698402909980532};
    return fmod(step[axis] * number, 1);
}

/* A place in the cell `index` of `count` that `texels` are cut into; `at` from 0 to below 1. */
static int place_in_cell(int index, int count, int texels, double at)
{
    int from = (int)((long)texels * index / count), to = (int)((long)texels * (index + 1) / count);
    return from + (int)(at * (to - from));
}

void weft_scattered_texel(int columns, int rows, int width, int height, int i, int j, int *x, int *y)
{
    double number = (double)j * columns + i + 1;
    *x = place_in_cell(i, columns, width, weft_scattered_number(0, number));
    *y = place_in_cell(j, rows, height, weft_scattered_number(1, number));
}
