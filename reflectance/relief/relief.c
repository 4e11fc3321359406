#include "reflectance/relief/relief.h"

#include "base/integers.h"

#include <stdlib.h>

/* A view that sees something so much above the point, as a share of the range of heights, counts half; and what hidden
 * views count at least, so that a point that none sees is blended as if all did. */
static const weft_real half_hidden = (weft_real)0.12, least_visibility = (weft_real)1e-3;

weft_height_field weft_height_field_of(const float *value, int width, int height, double width_mm, double height_mm)
{
    weft_height_field field = {width, height, value, value[0], value[0], width_mm, height_mm};
    for (int i = 1; i < width * height; i++) {
        field.low = fminf(field.low, value[i]);
        field.high = fmaxf(field.high, value[i]);
    }
    return field;
}

/* The two samples around a coordinate in [0, 1) that repeats, and the share of the second. */
static void around(weft_real coordinate, int count, int index[2], weft_real *share)
{
    weft_real place = (coordinate - floor(coordinate)) * count - (weft_real)0.5;
    weft_real whole = floor(place);
    *share = place - whole;
    int left = (int)whole; /* -1 at least */
    index[0] = left < 0 ? count - 1 : left;
    index[1] = index[0] + 1 < count ? index[0] + 1 : 0;
}

weft_real weft_height_at(const weft_height_field *field, weft_real u, weft_real v)
{
    int x[2], y[2];
    weft_real right, down;
    around(u, field->width, x, &right);
    around(-v, field->height, y, &down);
    const float *upper = field->value + (size_t)y[0] * (size_t)field->width;
    const float *lower = field->value + (size_t)y[1] * (size_t)field->width;
    weft_real above = upper[x[0]] + right * (weft_real)(upper[x[1]] - upper[x[0]]);
    weft_real below = lower[x[0]] + right * (weft_real)(lower[x[1]] - lower[x[0]]);
    return above + down * (below - above);
}

void weft_relief_slope(const weft_height_field *field, weft_vec3 view, weft_real slope[2])
{
    weft_real cosine = fmax(view.z, (weft_real)WEFT_RELIEF_LEAST_COSINE);
    slope[0] = view.x / (cosine * (weft_real)field->width_mm);
    slope[1] = view.y / (cosine * (weft_real)field->height_mm);
}

/* How far the sight line lies above the surface at a height. */
static weft_real clearance(const weft_height_field *field, weft_real u, weft_real v, const weft_real slope[2],
                           weft_real height)
{
    return height - weft_height_at(field, u + height * slope[0], v + height * slope[1]);
}

weft_real weft_relief_march(const weft_height_field *field, weft_real u, weft_real v, const weft_real slope[2])
{
    weft_real low = field->low, high = field->high, step = (high - low) / WEFT_RELIEF_STEPS;
    weft_real above = high, above_by = clearance(field, u, v, slope, high);
    if (!(above_by > 0) || !(step > 0))
        return high;
    weft_real below = above, below_by = above_by;
    for (int i = 1; i <= WEFT_RELIEF_STEPS && below_by > 0; i++) {
        above = below;
        above_by = below_by;
        below = high - i * step;
        below_by = clearance(field, u, v, slope, below);
    }
    if (below_by > 0)
        return low;
    for (int i = 0; i < WEFT_RELIEF_BISECTIONS; i++) {
        weft_real middle = (above + below) / 2, middle_by = clearance(field, u, v, slope, middle);
        if (middle_by > 0) {
            above = middle;
            above_by = middle_by;
        } else {
            below = middle;
            below_by = middle_by;
        }
    }
    return above + (below - above) * above_by / (above_by - below_by);
}

/* ---- What the stored views see ---- */

void weft_relief_see(const weft_height_field *field, weft_vec3 view, uint8_t *seen)
{
    weft_real slope[2], range = field->high - field->low, scale = range > 0 ? 255 / range : 0;
    weft_relief_slope(field, view, slope);
    for (int y = 0; y < field->height; y++) {
        weft_real v = 1 - (y + (weft_real)0.5) / field->height;
        for (int x = 0; x < field->width; x++) {
            weft_real height = weft_relief_march(field, (x + (weft_real)0.5) / field->width, v, slope);
            seen[(size_t)y * (size_t)field->width + (size_t)x] = (uint8_t)lround((height - field->low) * scale);
        }
    }
}

weft_code weft_relief_create(const weft_height_field *field, const weft_vec3 *view, int view_count, weft_relief *relief,
                             weft_error *error)
{
    size_t views = (size_t)view_count, texels = (size_t)field->width * (size_t)field->height;
    *relief = (weft_relief){.field = *field,
                            .view_count = view_count,
                            .slope = malloc(views * sizeof *relief->slope),
                            .seen = malloc(views * texels)};
    if (!relief->slope || !relief->seen) {
        weft_relief_free(relief);
        return weft_fail_memory(error, "heights that views see", views * texels);
    }
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < view_count; k++) {
        weft_relief_slope(field, view[k], relief->slope[k]);
        weft_relief_see(field, view[k], relief->seen + (size_t)k * texels);
    }
    return WEFT_OK;
}

void weft_relief_free(weft_relief *relief)
{
    free(relief->slope);
    free(relief->seen);
    *relief = (weft_relief){0};
}

/* ---- Blending ---- */

/* As a share of the range of heights, bilinear. */
static weft_real seen_at(const weft_relief *relief, int view, weft_real u, weft_real v)
{
    const weft_height_field *field = &relief->field;
    int x[2], y[2];
    weft_real right, down;
    around(u, field->width, x, &right);
    around(-v, field->height, y, &down);
    const uint8_t *seen = relief->seen + (size_t)view * (size_t)field->width * (size_t)field->height;
    const uint8_t *upper = seen + (size_t)y[0] * (size_t)field->width;
    const uint8_t *lower = seen + (size_t)y[1] * (size_t)field->width;
    weft_real above = upper[x[0]] + right * (upper[x[1]] - upper[x[0]]);
    weft_real below = lower[x[0]] + right * (lower[x[1]] - lower[x[0]]);
    return (above + down * (below - above)) / 255;
}

/* 1 where nothing lies above the point, 1/2 at half_hidden, then towards 0. */
static weft_real visibility(weft_real seen, weft_real point)
{
    weft_real above = fmax(seen - point, 0) / half_hidden;
    return fmax(1 / (1 + above * above), least_visibility);
}

void weft_relief_taps(const weft_relief *relief, weft_real share, weft_real u, weft_real v, weft_vec3 view,
                      const int index[3], const weft_real weight[3], weft_relief_tap tap[3])
{
    const weft_height_field *field = &relief->field;
    weft_real slope[2], range = field->high - field->low, sum = 0;
    weft_relief_slope(field, view, slope);
    slope[0] *= share;
    slope[1] *= share;
    weft_real height = weft_relief_march(field, u, v, slope);
    weft_real point = range > 0 ? (height - field->low) / range : 0;
    for (int i = 0; i < 3; i++) {
        tap[i] = (weft_relief_tap){u, v, 0};
        if (index[i] < 0 || !(weight[i] > 0))
            continue;
        const weft_real *other = relief->slope[index[i]];
        tap[i].u = u + height * (slope[0] - share * other[0]);
        tap[i].v = v + height * (slope[1] - share * other[1]);
        tap[i].weight = weight[i] * visibility(seen_at(relief, index[i], tap[i].u, tap[i].v), point);
        sum += tap[i].weight;
    }
    for (int i = 0; i < 3; i++)
        tap[i].weight = sum > 0 ? tap[i].weight / sum : 0;
}
