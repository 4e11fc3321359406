#include "bench/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void bench_stop_on(const char *program, weft_code code, const weft_error *error)
{
    if (code == WEFT_OK)
        return;
    fprintf(stderr, "%s: %s\n", program, error->message);
    exit((int)code);
}

double bench_now_ms(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

double bench_relative_rmse(const weft_image *image, const weft_image *reference, const weft_image *background)
{
    double square = 0, norm = 0;
    for (size_t i = 0; i < 3 * (size_t)reference->width * (size_t)reference->height; i++) {
        if (reference->pixels[i] == background->pixels[i])
            continue;
        square += pow((double)(image->pixels[i] - reference->pixels[i]), 2);
        norm += pow((double)reference->pixels[i], 2);
    }
    return sqrt(square / norm);
}
