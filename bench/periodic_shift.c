#include "bench/periodic_shift.h"

#include "base/vector.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

/* The product of two spectra, [height][width]; the mean is left out. */
typedef struct cross_spectrum {
    int width, height;
    double complex *value;
    double energy; /* the correlation of equal images of these energies */
} cross_spectrum;

static double complex coefficient(const double *image, int width, int height, int u, int v)
{
    double complex sum = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            sum += image[y * width + x] * cexp(-2 * WEFT_PI * I * ((double)u * x / width + (double)v * y / height));
    return sum;
}

static void multiply_spectra(const double *image, const double *moved, cross_spectrum *cross)
{
    double of_image = 0, of_moved = 0;
    for (int v = 0; v < cross->height; v++) {
        for (int u = 0; u < cross->width; u++) {
            double complex a = 0, b = 0;
            if (u > 0 || v > 0) {
                a = coefficient(image, cross->width, cross->height, u, v);
                b = coefficient(moved, cross->width, cross->height, u, v);
            }
            cross->value[v * cross->width + u] = b * conj(a);
            of_image += creal(a * conj(a));
            of_moved += creal(b * conj(b));
        }
    }
    cross->energy = sqrt(of_image * of_moved);
}

/* Frequencies above the middle are negative ones. */
static double frequency(int index, int size)
{
    return (double)(2 * index > size ? index - size : index) / size;
}

static double correlation_at(const cross_spectrum *cross, double right, double up)
{
    double sum = 0;
    for (int v = 0; v < cross->height; v++) {
        for (int u = 0; u < cross->width; u++) {
            double phase = frequency(u, cross->width) * right - frequency(v, cross->height) * up;
            sum += creal(cross->value[v * cross->width + u] * cexp(2 * WEFT_PI * I * phase));
        }
    }
    return cross->energy > 0 ? sum / cross->energy : 0;
}

static void improve(const cross_spectrum *cross, double right, double up, periodic_shift *best)
{
    double correlation = correlation_at(cross, right, up);
    if (correlation > best->correlation)
        *best = (periodic_shift){right, up, correlation};
}

static void search(const cross_spectrum *cross, periodic_shift *best)
{
    *best = (periodic_shift){.correlation = -INFINITY};
    for (int up = -cross->height / 2; up < (cross->height + 1) / 2; up++)
        for (int right = -cross->width / 2; right < (cross->width + 1) / 2; right++)
            improve(cross, right, up, best);
    for (double step = 0.5; step > 1.0 / 128;) {
        periodic_shift from = *best;
        for (int i = 0; i < 9; i++)
            improve(cross, from.right + (i % 3 - 1) * step, from.up + (i / 3 - 1) * step, best);
        if (best->correlation == from.correlation)
            step /= 2;
    }
}

weft_code periodic_shift_find(const double *image, const double *moved, int width, int height, periodic_shift *shift,
                              weft_error *error)
{
    size_t bytes = (size_t)width * (size_t)height * sizeof(double complex);
    cross_spectrum cross = {width, height, malloc(bytes), 0};
    if (!cross.value)
        return weft_fail_memory(error, "spectra", bytes);
    multiply_spectra(image, moved, &cross);
    search(&cross, shift);
    free(cross.value);
    return WEFT_OK;
}
