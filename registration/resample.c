#include "registration/resample.h"

#include "btf/dataset.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Taps that weigh less than this fraction of the largest are rounding errors. */
static const double negligible = 1e-9;

static const double pixel_variance = 1.0 / 12;

/* Weights around one texel: a window of the photograph. */
typedef struct window {
    int x0, y0, width, height;
    double *weight, *scratch; /* [height][width] */
    size_t capacity;
} window;

typedef struct texel_square {
    const weft_camera *camera;
    const weft_homography *homography;
    double left, top, width, height; /* mm */
} texel_square;

static weft_pixel seen_at(const texel_square *square, double u, double v)
{
    weft_pixel undistorted =
        weft_homography_apply(square->homography, square->left + u * square->width, square->top - v * square->height);
    return weft_camera_distort(square->camera, undistorted);
}

static weft_code reserve_window(window *w, weft_error *error)
{
    size_t needed = (size_t)w->width * (size_t)w->height;
    if (needed > w->capacity) {
        double *weight = realloc(w->weight, needed * sizeof *weight);
        if (weight)
            w->weight = weight;
        double *scratch = realloc(w->scratch, needed * sizeof *scratch);
        if (scratch)
            w->scratch = scratch;
        if (!weight || !scratch)
            return weft_fail_memory(error, "resampling weights", needed * 2 * sizeof(double));
        w->capacity = needed;
    }
    memset(w->weight, 0, needed * sizeof *w->weight);
    return WEFT_OK;
}

/* The window that holds the square with the reach of the kernel. False where that leaves the photograph. `extent` is
 * the longer of the two sides of the square's bounding box, pixels. */
static bool place_window(const texel_square *square, window *w, double *extent)
{
    double low_x = 1e9, low_y = 1e9, high_x = -1e9, high_y = -1e9;
    for (int i = 0; i < 9; i++) {
        weft_pixel p = seen_at(square, (i % 3) / 2.0, (i / 3) / 2.0);
        low_x = fmin(low_x, p.x), high_x = fmax(high_x, p.x);
        low_y = fmin(low_y, p.y), high_y = fmax(high_y, p.y);
    }
    const int reach = 3; /* 2 of the cubic, 1 of the laplacian */
    if (!(low_x >= reach && low_y >= reach && high_x < square->camera->width - reach - 1 &&
          high_y < square->camera->height - reach - 1))
        return false;
    w->x0 = (int)low_x - reach;
    w->y0 = (int)low_y - reach;
    w->width = (int)high_x + reach + 2 - w->x0;
    w->height = (int)high_y + reach + 2 - w->y0;
    *extent = fmax(high_x - low_x, high_y - low_y);
    return true;
}

/* Catmull & Rom 1974: weights of the pixels floor(x) - 1 .. floor(x) + 2. */
static void cubic_weights(double t, double weight[4])
{
    weight[0] = t * (-0.5 + t * (1 - 0.5 * t));
    weight[1] = 1 + t * t * (-2.5 + 1.5 * t);
    weight[2] = t * (0.5 + t * (2 - 1.5 * t));
    weight[3] = t * t * (-0.5 + 0.5 * t);
}

static void add_point(window *w, weft_pixel at, double share)
{
    int x = (int)at.x, y = (int)at.y;
    double wx[4], wy[4];
    cubic_weights(at.x - x, wx);
    cubic_weights(at.y - y, wy);
    double *corner = w->weight + (long)(y - 1 - w->y0) * w->width + (x - 1 - w->x0);
    for (int j = 0; j < 4; j++) {
        for (int i = 0; i < 4; i++)
            corner[(long)j * w->width + i] += share * wy[j] * wx[i];
    }
}

/* weight <- weight - variance / 2 laplacian(weight): the transpose of the same on the photograph. The rim of the window
 * is zero. */
static void sharpen(window *w, double variance)
{
    size_t bytes = (size_t)w->width * (size_t)w->height * sizeof *w->weight;
    memcpy(w->scratch, w->weight, bytes);
    for (int y = 1; y + 1 < w->height; y++) {
        for (int x = 1; x + 1 < w->width; x++) {
            const double *s = w->scratch + (long)y * w->width + x;
            w->weight[(long)y * w->width + x] -=
                0.5 * variance * (s[1] + s[-1] + s[w->width] + s[-w->width] - 4 * s[0]);
        }
    }
}

static void weigh_texel(const texel_square *square, double extent, double variance, window *w)
{
    int side = extent > 3 ? (int)ceil(extent) : 3;
    double share = 1.0 / ((double)side * side);
    for (int j = 0; j < side; j++) {
        for (int i = 0; i < side; i++)
            add_point(w, seen_at(square, (i + 0.5) / side, (j + 0.5) / side), share);
    }
    sharpen(w, variance);
}

/* Grows the arrays of taps to hold `count` more beyond `used`. */
static weft_code reserve_taps(weft_resampler *r, long used, long count, long *capacity, weft_error *error)
{
    if (used + count <= *capacity)
        return WEFT_OK;
    long wanted = (used + count) * 2;
    int32_t *pixel = realloc(r->pixel, (size_t)wanted * sizeof *pixel);
    if (pixel)
        r->pixel = pixel;
    float *weight = realloc(r->weight, (size_t)wanted * sizeof *weight);
    if (weight)
        r->weight = weight;
    if (!pixel || !weight)
        return weft_fail_memory(error, "resampling weights", (size_t)wanted * 8);
    *capacity = wanted;
    return WEFT_OK;
}

/* Appends the window's weights with the vignetting divided out. */
static long append_taps(weft_resampler *r, const weft_camera *camera, const float *inverse_vignetting, const window *w,
                        long used, float *sum)
{
    double largest = 0, total = 0;
    long cells = (long)w->width * w->height;
    for (long i = 0; i < cells; i++)
        largest = fmax(largest, fabs(w->weight[i]));
    for (long i = 0; i < cells; i++) {
        if (!(fabs(w->weight[i]) > negligible * largest))
            continue;
        int x = w->x0 + (int)(i % w->width), y = w->y0 + (int)(i / w->width);
        int pixel = y * camera->width + x;
        r->pixel[used] = pixel;
        r->weight[used] = (float)w->weight[i] * (inverse_vignetting ? inverse_vignetting[pixel] : 1);
        total += r->weight[used++];
    }
    *sum = (float)total;
    return used;
}

static weft_code fill(const weft_camera *camera, const float *inverse_vignetting, const weft_homography *homography,
                      double opening_mm, double variance, window *w, weft_resampler *r, weft_error *error)
{
    long used = 0, capacity = 0, texel = 0;
    texel_square square = {camera, homography, 0, 0, opening_mm / r->width, opening_mm / r->height};
    for (int y = 0; y < r->height; y++) {
        for (int x = 0; x < r->width; x++, texel++) {
            double extent;
            square.left = x * square.width - opening_mm / 2;
            square.top = opening_mm / 2 - y * square.height;
            r->first[texel] = used;
            if (!place_window(&square, w, &extent))
                continue;
            WEFT_TRY(reserve_window(w, error));
            weigh_texel(&square, extent, variance, w);
            WEFT_TRY(reserve_taps(r, used, (long)w->width * w->height, &capacity, error));
            used = append_taps(r, camera, inverse_vignetting, w, used, &r->sum[texel]);
        }
    }
    r->first[texel] = used;
    return WEFT_OK;
}

weft_code weft_resampler_create(const weft_camera *camera, const float *inverse_vignetting,
                                const weft_homography *homography, double opening_mm, int width, int height,
                                double extra_variance, weft_resampler *resampler, weft_error *error)
{
    *resampler = (weft_resampler){.width = width, .height = height};
    if (width < 1 || height < 1 || !(opening_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "an opening of %g mm cannot be resampled to %d x %d texels", opening_mm,
                         width, height);
    size_t texels = (size_t)width * (size_t)height;
    window w = {0};
    resampler->first = malloc((texels + 1) * sizeof *resampler->first);
    resampler->sum = calloc(texels, sizeof *resampler->sum);
    weft_code code = resampler->first && resampler->sum ? fill(camera, inverse_vignetting, homography, opening_mm,
                                                               pixel_variance + extra_variance, &w, resampler, error)
                                                        : weft_fail_memory(error, "a resampler", texels * 12);
    free(w.weight);
    free(w.scratch);
    if (code != WEFT_OK)
        weft_resampler_free(resampler);
    return code;
}

void weft_resampler_free(weft_resampler *resampler)
{
    free(resampler->first);
    free(resampler->pixel);
    free(resampler->weight);
    free(resampler->sum);
    *resampler = (weft_resampler){0};
}

void weft_resampler_apply(const weft_resampler *resampler, const uint16_t *samples, int black_level, int full_scale,
                          float *texel, uint8_t *mask)
{
    long texels = (long)resampler->width * resampler->height;
    for (long i = 0; i < texels; i++) {
        double sum[3] = {0, 0, 0};
        uint16_t largest = 0;
        for (long tap = resampler->first[i]; tap < resampler->first[i + 1]; tap++) {
            const uint16_t *s = samples + 3 * (size_t)resampler->pixel[tap];
            for (int c = 0; c < 3; c++) {
                sum[c] += (double)resampler->weight[tap] * s[c];
                largest = s[c] > largest ? s[c] : largest;
            }
        }
        mask[i] = resampler->first[i] == resampler->first[i + 1] ? WEFT_MASK_MISSING
                  : largest >= full_scale                        ? WEFT_MASK_SATURATED
                                                                 : 0;
        for (int c = 0; c < 3; c++)
            texel[3 * i + c] = (float)(sum[c] - (double)resampler->sum[i] * black_level);
    }
}
