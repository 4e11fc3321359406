#include "import/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double largest_half = 65504;

weft_code weft_reduced_size(int source_width, int source_height, int asked, int *width, int *height, weft_error *error)
{
    *width = asked ? asked : source_width;
    if (*width < 1 || *width > source_width)
        return weft_fail(error, WEFT_BAD_USAGE, "%d texels asked for, but the photographs are %d pixels wide", *width,
                         source_width);
    *height = (int)((long)source_height * *width / source_width);
    if (*height < 1)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "photographs of %d x %d pixels cannot become %d texels wide: they would be %g texels high",
                         source_width, source_height, *width, (double)source_height * *width / source_width);
    return WEFT_OK;
}

void weft_divide_by_white(double white, weft_image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count && white != 1; i++)
        image->pixels[i] = (float)((double)image->pixels[i] / white);
}

bool weft_find_unstorable(const weft_image *image, size_t *index)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (*index = 0; *index < count; (*index)++) {
        if (!(fabs((double)image->pixels[*index]) <= largest_half))
            return true;
    }
    return false;
}

/* ---- Averages of areas ---- */

/* The part of an axis under one pixel of the result: pixels first..last with weights that are 1 inside. */
typedef struct span {
    int first, last;
    double first_weight, last_weight;
} span;

/* From `begin` to `end`, whole numbers of which `unit` are a pixel, so that equal ratios give exactly whole spans. */
static span span_of(long begin, long end, long unit)
{
    int first = (int)(begin / unit), last = (int)((end - 1) / unit);
    double first_end = fmin((double)end, (double)(first + 1) * (double)unit);
    double last_begin = fmax((double)begin, (double)last * (double)unit);
    return (span){first, last, (first_end - (double)begin) / (double)unit, ((double)end - last_begin) / (double)unit};
}

static double weight_in(const span *s, int index)
{
    return index == s->first ? s->first_weight : index == s->last ? s->last_weight : 1;
}

static void average(const weft_image *image, const span *sx, const span *sy, weft_half sample[3])
{
    double sum[3] = {0}, area = 0;
    for (int y = sy->first; y <= sy->last; y++) {
        for (int x = sx->first; x <= sx->last; x++) {
            const float *pixel = image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
            double weight = weight_in(sx, x) * weight_in(sy, y);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (double)pixel[c];
            area += weight;
        }
    }
    for (int c = 0; c < 3; c++)
        sample[c] = weft_half_of_float((float)(sum[c] / area));
}

static uint8_t any_in(const uint8_t *flagged, int source_width, const span *sx, const span *sy)
{
    uint8_t any = 0;
    for (int y = sy->first; y <= sy->last; y++)
        for (int x = sx->first; x <= sx->last; x++)
            any |= flagged[(size_t)y * (size_t)source_width + (size_t)x];
    return any;
}

/* What is not reduced is only rounded. */
static void copy(const weft_image *image, const uint8_t *flagged, weft_half *samples, uint8_t *touched)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < 3 * count; i++)
        samples[i] = weft_half_of_float(image->pixels[i]);
    if (flagged)
        memcpy(touched, flagged, count);
}

static void reduce(const weft_image *image, const uint8_t *flagged, int width, int height, const span *sx,
                   weft_half *samples, uint8_t *touched)
{
    /* Texels are square, and what is too high for whole ones is cut off above and below. */
    const long unit = 2L * width, side = 2L * image->width;
    const long above = (long)image->height * width - (long)height * image->width;
    for (int y = 0; y < height; y++) {
        span sy = span_of(above + y * side, above + (y + 1) * side, unit);
        for (int x = 0; x < width; x++) {
            size_t at = (size_t)y * (size_t)width + (size_t)x;
            average(image, &sx[x], &sy, samples + 3 * at);
            if (flagged)
                touched[at] = any_in(flagged, image->width, &sx[x], &sy);
        }
    }
}

weft_code weft_reduce(const weft_image *image, const uint8_t *flagged, int width, int height, weft_half *samples,
                      uint8_t *touched, weft_error *error)
{
    if (width == image->width && height == image->height) {
        copy(image, flagged, samples, touched);
        return WEFT_OK;
    }
    span *sx = malloc((size_t)width * sizeof *sx);
    if (!sx)
        return weft_fail_memory(error, "spans", (size_t)width * sizeof *sx);
    for (int x = 0; x < width; x++)
        sx[x] = span_of((long)x * image->width, (x + 1L) * image->width, width);
    reduce(image, flagged, width, height, sx, samples, touched);
    free(sx);
    return WEFT_OK;
}
