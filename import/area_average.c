#include "import/area_average.h"

#include <math.h>
#include <stdlib.h>

/* The part of an axis under one pixel of the result: pixels first..last with weights that are 1 inside. */
typedef struct span {
    int first, last;
    double first_weight, last_weight;
} span;

static span span_of(int index, int source_count, int result_count)
{
    /* Bounds as whole numbers over result_count, so that equal ratios give exactly whole spans. */
    long begin = (long)index * source_count, end = begin + source_count;
    int first = (int)(begin / result_count), last = (int)((end - 1) / result_count);
    double first_end = fmin((double)end, (double)(first + 1) * result_count);
    double last_begin = fmax((double)begin, (double)last * result_count);
    return (span){first, last, (first_end - (double)begin) / result_count, ((double)end - last_begin) / result_count};
}

static double weight_in(const span *s, int index)
{
    return index == s->first ? s->first_weight : index == s->last ? s->last_weight : 1;
}

static void average_pixel(const weft_image *image, const uint8_t *flagged, const span *sx, const span *sy, float *pixel,
                          uint8_t *touched)
{
    double sum[3] = {0}, area = 0;
    *touched = 0;
    for (int y = sy->first; y <= sy->last; y++) {
        for (int x = sx->first; x <= sx->last; x++) {
            size_t at = (size_t)y * (size_t)image->width + (size_t)x;
            double weight = weight_in(sx, x) * weight_in(sy, y);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (double)image->pixels[3 * at + (size_t)c];
            area += weight;
            *touched |= flagged[at];
        }
    }
    for (int c = 0; c < 3; c++)
        pixel[c] = (float)(sum[c] / area);
}

weft_code weft_area_average(const weft_image *image, const uint8_t *flagged, weft_image *result, uint8_t *touched,
                            weft_error *error)
{
    span *sx = malloc((size_t)result->width * sizeof *sx);
    if (!sx)
        return weft_fail_memory(error, "spans", (size_t)result->width * sizeof *sx);
    for (int x = 0; x < result->width; x++)
        sx[x] = span_of(x, image->width, result->width);
    for (int y = 0; y < result->height; y++) {
        span sy = span_of(y, image->height, result->height);
        for (int x = 0; x < result->width; x++) {
            size_t at = (size_t)y * (size_t)result->width + (size_t)x;
            average_pixel(image, flagged, &sx[x], &sy, result->pixels + 3 * at, touched + at);
        }
    }
    free(sx);
    return WEFT_OK;
}
