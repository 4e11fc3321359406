#include "registration/radiometry/vignetting.h"

#include <math.h>
#include <stddef.h>

/* Of the logarithm of the response at the reach: how large both terms may be, and how far a patch lies beside the model
 * for other reasons (its own reflectance, the place of the light). */
static const double prior[2] = {0.5, 0.05}, patch_deviation = 0.005;

/* Patches that differ by more, as a logarithm, are in shadow or stained. */
static const double largest_difference = 0.4;

static double radius_squared(const weft_camera *camera, const float undistorted[2])
{
    double x = (undistorted[0] - camera->cx) / camera->fx, y = (undistorted[1] - camera->cy) / camera->fy;
    return x * x + y * y;
}

/* Mean r^2 over the pixels of a patch. */
static double mean_radius_squared(const weft_sight *sight, const weft_reference_pixels *reference, int patch)
{
    double sum = 0;
    for (int i = 0; i < reference->count[patch]; i++)
        sum += radius_squared(&sight->camera, sight->undistorted[reference->pixel[patch][i]]);
    return sum / reference->count[patch];
}

void weft_vignetting_add(const weft_sight *sight, const weft_target *target, const weft_reference_pixels *reference,
                         const uint16_t *samples, const weft_exposure *exposure, weft_vignetting_sums *sums)
{
    weft_patch_level level[WEFT_TARGET_REFERENCE_COUNT];
    int count = weft_patch_levels(sight, target, reference, samples, exposure, level);
    double row[WEFT_TARGET_REFERENCE_COUNT][3], mean[3] = {0, 0, 0}, low = INFINITY, high = -INFINITY;
    for (int i = 0; i < count; i++) {
        double q = mean_radius_squared(sight, reference, level[i].patch);
        row[i][0] = q;
        row[i][1] = q * q;
        row[i][2] = log(level[i].level[0] + level[i].level[1] + level[i].level[2]);
        low = fmin(low, row[i][2]), high = fmax(high, row[i][2]);
        for (int k = 0; k < 3; k++)
            mean[k] += row[i][k] / count;
    }
    if (count < 2 || high - low > largest_difference)
        return;
    for (int i = 0; i < count; i++) {
        double q = row[i][0] - mean[0], q2 = row[i][1] - mean[1], value = row[i][2] - mean[2];
        sums->matrix[0][0] += q * q, sums->matrix[0][1] += q * q2, sums->matrix[1][1] += q2 * q2;
        sums->right[0] += q * value, sums->right[1] += q2 * value;
        sums->squares += value * value;
        sums->reach = fmax(sums->reach, row[i][0]);
    }
    sums->patches += count;
    sums->photographs++;
}

weft_vignetting weft_vignetting_solve(const weft_vignetting_sums *sums)
{
    double reach = sums->reach, scale[2] = {reach, reach * reach};
    weft_vignetting v = {.reach = reach, .photographs = sums->photographs};
    if (sums->photographs == 0 || !(reach > 0))
        return v;
    /* Unknowns are the terms at the reach. */
    double a = sums->matrix[0][0] / (scale[0] * scale[0]), b = sums->matrix[0][1] / (scale[0] * scale[1]);
    double d = sums->matrix[1][1] / (scale[1] * scale[1]), variance = patch_deviation * patch_deviation;
    a += variance / (prior[0] * prior[0]);
    d += variance / (prior[1] * prior[1]);
    double g = sums->right[0] / scale[0], h = sums->right[1] / scale[1], determinant = a * d - b * b;
    double e2 = (d * g - b * h) / determinant, e4 = (a * h - b * g) / determinant;
    double left = fmax(0, sums->squares - e2 * g - e4 * h) / fmax(1, sums->patches - sums->photographs - 2);
    v.r2 = e2 / scale[0];
    v.r4 = e4 / scale[1];
    v.standard_error = sqrt(fmax(left, variance) * (a + d - 2 * b) / determinant);
    return v;
}

void weft_vignetting_apply(const weft_vignetting *vignetting, weft_sight *sight)
{
    size_t pixels = (size_t)sight->camera.width * (size_t)sight->camera.height;
    for (size_t i = 0; i < pixels; i++) {
        double q = fmin(radius_squared(&sight->camera, sight->undistorted[i]), vignetting->reach);
        sight->inverse_vignetting[i] *= (float)exp(-(vignetting->r2 + vignetting->r4 * q) * q);
    }
}
