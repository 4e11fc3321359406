#include "registration/radiometry/radiometry.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

enum { fewest_pixels = 6 };

static const double largest_disagreement = 0.1;

/* Raw values above black. */
static const double dimmest_level = 1;

/* A patch's pixels lie this far inside its outline, pixels: half of their own square, and as much again; the point
 * spread adds. */
static const double border_px = 1;

weft_exposure weft_exposure_of(const weft_session *session, int shot)
{
    weft_vec3 direction = weft_direction_of_angles(session->shot[shot].light_driven);
    return (weft_exposure){session->black_level, (1 << session->bits) - 1, session->record[shot].exposure_s,
                           weft_scale(direction, session->light_distance_mm)};
}

double weft_relative_irradiance(weft_vec3 light, const weft_bend *bend, double x_mm, double y_mm)
{
    weft_vec3 place = {x_mm, y_mm, weft_bend_height(bend, x_mm, y_mm)}, beam = weft_subtract(light, place);
    double squared = weft_dot(beam, beam);
    return weft_dot(beam, weft_bend_normal(bend, x_mm, y_mm)) * weft_dot(light, light) / (squared * sqrt(squared));
}

static bool inside(weft_rectangle r, weft_pixel plate)
{
    return plate.x > r.x0 && plate.x < r.x1 && plate.y > r.y0 && plate.y < r.y1;
}

/* Whether the pixel and all within `border` pixels of it lie on the patch. */
static bool well_inside(weft_rectangle r, const weft_plate_view *view, const float undistorted[2], double border)
{
    if (!inside(r, weft_plate_view_meet(view, undistorted[0], undistorted[1])))
        return false;
    for (int corner = 0; corner < 4; corner++) {
        double x = undistorted[0] + (corner % 2 ? border : -border);
        double y = undistorted[1] + (corner / 2 ? border : -border);
        if (!inside(r, weft_plate_view_meet(view, x, y)))
            return false;
    }
    return true;
}

/* The point spread at the middle of a patch, as a standard deviation, pixels. */
static double point_spread_deviation(const weft_plate_view *view, weft_point_spread point_spread, weft_rectangle r)
{
    double z = weft_plate_view_depth(view, (r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2);
    double variance = point_spread.constant + point_spread.depth * (1 - 1 / z) * (1 - 1 / z);
    return z > 0 && variance > 0 ? sqrt(variance) : 0;
}

/* Box of the photograph that holds a patch, with a margin for the distortion of the lens. */
static void box_of(const weft_camera *camera, const weft_plate_view *view, weft_rectangle r, int low[2], int end[2])
{
    double x0 = camera->width, y0 = camera->height, x1 = 0, y1 = 0;
    for (int corner = 0; corner < 4; corner++) {
        weft_pixel p = weft_plate_view_see(view, corner % 2 ? r.x1 : r.x0, corner / 2 ? r.y1 : r.y0);
        p = weft_camera_distort(camera, p);
        x0 = fmin(x0, p.x), x1 = fmax(x1, p.x);
        y0 = fmin(y0, p.y), y1 = fmax(y1, p.y);
    }
    const double margin = 2;
    low[0] = (int)weft_clamp(x0 - margin, 0, camera->width);
    low[1] = (int)weft_clamp(y0 - margin, 0, camera->height);
    end[0] = (int)weft_clamp(x1 + margin + 1, 0, camera->width);
    end[1] = (int)weft_clamp(y1 + margin + 1, 0, camera->height);
}

static weft_code find_patch(const weft_sight *sight, weft_rectangle r, const weft_plate_view *view,
                            weft_point_spread point_spread, weft_reference_pixels *reference, int patch,
                            weft_error *error)
{
    double border = border_px + 2 * point_spread_deviation(view, point_spread, r), sum_x = 0, sum_y = 0;
    int low[2], end[2], count = 0;
    box_of(&sight->camera, view, r, low, end);
    size_t box = end[0] > low[0] && end[1] > low[1] ? (size_t)(end[0] - low[0]) * (size_t)(end[1] - low[1]) : 0;
    int32_t *pixel = malloc((box + 1) * sizeof *pixel);
    if (!pixel)
        return weft_fail_memory(error, "reference pixels", box * sizeof *pixel);
    for (int y = low[1]; y < end[1]; y++) {
        for (int x = low[0]; x < end[0]; x++) {
            int32_t at = y * sight->camera.width + x;
            if (sight->inverse_vignetting[at] == 0 || !well_inside(r, view, sight->undistorted[at], border))
                continue;
            weft_pixel plate = weft_plate_view_meet(view, sight->undistorted[at][0], sight->undistorted[at][1]);
            sum_x += plate.x;
            sum_y += plate.y;
            pixel[count++] = at;
        }
    }
    reference->pixel[patch] = pixel;
    reference->count[patch] = count;
    reference->centre[patch] = (weft_pixel){count ? sum_x / count : 0, count ? sum_y / count : 0};
    return WEFT_OK;
}

weft_code weft_reference_pixels_find(const weft_sight *sight, const weft_target *target,
                                     const weft_homography *homography, weft_point_spread point_spread,
                                     weft_reference_pixels *reference, weft_error *error)
{
    const weft_plate_view view = weft_plate_view_of(&sight->camera, homography, &sight->bend);
    *reference = (weft_reference_pixels){0};
    for (int patch = 0; patch < WEFT_TARGET_REFERENCE_COUNT; patch++) {
        weft_code code =
            find_patch(sight, weft_target_reference(target, patch), &view, point_spread, reference, patch, error);
        if (code != WEFT_OK) {
            weft_reference_pixels_free(reference);
            return code;
        }
    }
    return WEFT_OK;
}

void weft_reference_pixels_free(weft_reference_pixels *reference)
{
    for (int patch = 0; patch < WEFT_TARGET_REFERENCE_COUNT; patch++)
        free(reference->pixel[patch]);
    *reference = (weft_reference_pixels){0};
}

/* Mean of a patch without vignetting, above black; false where a pixel is saturated, too few are seen, or a channel is
 * dark: nothing can be divided by it. */
static bool mean_of_patch(const weft_sight *sight, const weft_reference_pixels *reference, int patch,
                          const uint16_t *samples, const weft_exposure *exposure, double mean[3])
{
    double sum[3] = {0, 0, 0};
    if (reference->count[patch] < fewest_pixels)
        return false;
    for (int i = 0; i < reference->count[patch]; i++) {
        int32_t at = reference->pixel[patch][i];
        for (int c = 0; c < 3; c++) {
            int value = samples[3 * (size_t)at + (size_t)c];
            if (value >= exposure->full_scale)
                return false;
            sum[c] += (value - exposure->black_level) * (double)sight->inverse_vignetting[at];
        }
    }
    for (int c = 0; c < 3; c++) {
        mean[c] = sum[c] / reference->count[patch];
        if (!(mean[c] >= dimmest_level))
            return false;
    }
    return true;
}

static double total(const double rgb[3])
{
    return rgb[0] + rgb[1] + rgb[2];
}

/* Removes patches that disagree with the median of three or more. */
static int agreeing_patches(weft_patch_level *level, int count)
{
    double sorted[WEFT_TARGET_REFERENCE_COUNT];
    int kept = 0;
    if (count < 3)
        return count;
    for (int i = 0; i < count; i++)
        sorted[i] = total(level[i].level);
    double median = weft_quantile(sorted, count, 0.5);
    for (int i = 0; i < count; i++) {
        if (fabs(total(level[i].level) - median) <= largest_disagreement * median)
            level[kept++] = level[i];
    }
    return kept;
}

static weft_white mean_of_patches(const weft_patch_level *level, int count)
{
    weft_white white = {.patches = count};
    double weight = 0;
    for (int i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++)
            white.level[c] += level[i].pixels * level[i].level[c];
        weight += level[i].pixels;
    }
    for (int c = 0; c < 3 && weight > 0; c++)
        white.level[c] /= weight;
    for (int i = 0; i < count; i++)
        white.disagreement = fmax(white.disagreement, fabs(total(level[i].level) / total(white.level) - 1));
    return white;
}

int weft_patch_levels(const weft_sight *sight, const weft_target *target, const weft_reference_pixels *reference,
                      const uint16_t *samples, const weft_exposure *exposure,
                      weft_patch_level level[WEFT_TARGET_REFERENCE_COUNT])
{
    int count = 0;
    for (int patch = 0; patch < WEFT_TARGET_REFERENCE_COUNT; patch++) {
        if (!mean_of_patch(sight, reference, patch, samples, exposure, level[count].level))
            continue;
        double irradiance = weft_relative_irradiance(exposure->light, &sight->bend, reference->centre[patch].x,
                                                     reference->centre[patch].y);
        double scale = target->white_reflectance * irradiance * exposure->exposure_s;
        if (!(scale > 0))
            continue;
        for (int c = 0; c < 3; c++)
            level[count].level[c] /= scale;
        level[count].patch = patch;
        level[count++].pixels = reference->count[patch];
    }
    return count;
}

weft_white weft_white_measure(const weft_sight *sight, const weft_target *target,
                              const weft_reference_pixels *reference, const uint16_t *samples,
                              const weft_exposure *exposure)
{
    weft_patch_level level[WEFT_TARGET_REFERENCE_COUNT];
    int count = agreeing_patches(level, weft_patch_levels(sight, target, reference, samples, exposure, level));
    return mean_of_patches(level, count);
}

void weft_reflectance_of_raw(const weft_white *white, const weft_exposure *exposure, const weft_bend *bend,
                             double opening_mm, int width, int height, float *texel)
{
    double cosine = weft_unit(exposure->light).z;
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            double x_mm = ((x + 0.5) / width - 0.5) * opening_mm, y_mm = (0.5 - (y + 0.5) / height) * opening_mm;
            double scale =
                cosine / (weft_relative_irradiance(exposure->light, bend, x_mm, y_mm) * exposure->exposure_s);
            float *value = texel + 3 * ((long)y * width + x);
            for (int c = 0; c < 3; c++)
                value[c] = (float)(value[c] * scale / white->level[c]);
        }
    }
}

/* ---- Vignetting ---- */

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
