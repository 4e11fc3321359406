#include "registration/lamp/evidence.h"

#include <math.h>
#include <stdlib.h>

/* In 32nds of the opening's side, as the target is drawn: how far apart places lie, how far around one nothing else may
 * lie, and half the side of the square that is averaged. */
static const double unit_count = 32, spacing = 2, clearance = 1.1, reach = 0.5, least_reach = 0.15, keep_away = 20,
                    printed_beyond = 57;

/* Bilinear samples along a side of the square, and how many pixels its margin must be wide for the point spread. */
enum { samples_across = 5 };
static const double least_margin_px = 1.5;

/* Whether a ball or the pin stands on, or leans over, a place, or words and rulers may be printed there. */
static bool is_occupied(const weft_target *target, double x, double y)
{
    double limit = printed_beyond * target->opening_mm / unit_count;
    if (fabs(x) > limit || fabs(y) > limit)
        return true;
    double room = keep_away * target->opening_mm / unit_count, place[2];
    for (int thing = 0; thing <= WEFT_TARGET_BALL_COUNT; thing++) {
        if (thing < WEFT_TARGET_BALL_COUNT)
            weft_target_ball(target, thing, place);
        else
            weft_target_pin(target, place);
        if (hypot(x - place[0], y - place[1]) < room)
            return true;
    }
    return false;
}

/* Whether all within `margin` of a place has one reflectance; the edge of the opening ends it. */
static bool is_uniform(const weft_target *target, double x, double y, double margin, double *reflectance)
{
    enum { probes = 9 };
    *reflectance = weft_target_sheet_reflectance(target, x, y);
    for (int i = 0; i < probes * probes; i++) {
        double px = x + margin * (2.0 * (i % probes) / (probes - 1) - 1);
        double py = y + margin * (2.0 * (i / probes) / (probes - 1) - 1);
        if (weft_target_region_at(target, px, py) == WEFT_TARGET_OPENING ||
            weft_target_sheet_reflectance(target, px, py) != *reflectance)
            return false;
    }
    return true;
}

weft_code weft_paper_places_create(const weft_target *target, weft_paper_places *places, weft_error *error)
{
    double unit = target->opening_mm / unit_count;
    weft_rectangle sheet = weft_target_sheet(target);
    int columns = (int)((sheet.x1 - sheet.x0) / (spacing * unit)),
        rows = (int)((sheet.y1 - sheet.y0) / (spacing * unit));
    size_t limit = (size_t)columns * (size_t)rows;
    *places = (weft_paper_places){0, malloc(limit * sizeof *places->place), malloc(limit), reach * unit};
    if (!places->place || !places->is_ink) {
        weft_paper_places_free(places);
        return weft_fail_memory(error, "places of the paper", limit * sizeof *places->place);
    }
    for (int i = 0; i < columns * rows; i++) {
        double x = sheet.x0 + (i % columns + 0.5) * spacing * unit, y = sheet.y0 + (i / columns + 0.5) * spacing * unit;
        double reflectance;
        if (is_occupied(target, x, y) || !is_uniform(target, x, y, clearance * unit, &reflectance))
            continue;
        places->place[places->count][0] = x;
        places->place[places->count][1] = y;
        places->is_ink[places->count++] = reflectance < 0.5 * target->paper_reflectance;
    }
    return WEFT_OK;
}

void weft_paper_places_free(weft_paper_places *places)
{
    free(places->place);
    free(places->is_ink);
    *places = (weft_paper_places){0};
}

/* Adds the bilinear value at a pixel. */
static weft_paper_fate add_value(const weft_light_values *values, weft_pixel at, double sum[3])
{
    if (!(at.x >= 0 && at.y >= 0 && at.x < values->width - 1 && at.y < values->height - 1))
        return WEFT_PAPER_OUTSIDE;
    int x = (int)at.x, y = (int)at.y;
    double u = at.x - x, v = at.y - y;
    const uint16_t *top = values->samples + 3 * ((long)y * values->width + x), *low = top + 3 * (long)values->width;
    for (int c = 0; c < 3; c++) {
        if (top[c] == WEFT_PHOTOGRAPHS_FULL_SCALE || top[c + 3] == WEFT_PHOTOGRAPHS_FULL_SCALE ||
            low[c] == WEFT_PHOTOGRAPHS_FULL_SCALE || low[c + 3] == WEFT_PHOTOGRAPHS_FULL_SCALE)
            return WEFT_PAPER_CLIPPED;
        sum[c] += (1 - v) * ((1 - u) * top[c] + u * top[c + 3]) + v * ((1 - u) * low[c] + u * low[c + 3]);
    }
    return WEFT_PAPER_SEEN;
}

/* The shortest side, in pixels, of a square millimetre seen at a place. */
static double least_pixels_per_mm(const weft_plate_view *view, double x, double y)
{
    const double step = 0.05;
    weft_pixel at = weft_plate_view_see(view, x, y), right = weft_plate_view_see(view, x + step, y);
    weft_pixel up = weft_plate_view_see(view, x, y + step);
    double a = (right.x - at.x) / step, b = (up.x - at.x) / step, c = (right.y - at.y) / step, d = (up.y - at.y) / step;
    double squares = a * a + b * b + c * c + d * d, determinant = a * d - b * c;
    /* The smaller singular value of the 2 x 2 derivative. */
    return sqrt(fmax(0, (squares - sqrt(fmax(0, squares * squares - 4 * determinant * determinant))) / 2));
}

static weft_paper_fate sample_place(const weft_paper_places *places, int place, const weft_camera *camera,
                                    const weft_plate_view *view, const weft_light_values *values,
                                    weft_paper_sample *sample)
{
    const double *middle = places->place[place];
    double sum[3] = {0, 0, 0}, unit_mm = places->reach_mm / reach;
    double margin_mm = least_margin_px / least_pixels_per_mm(view, middle[0], middle[1]);
    double reach_mm = fmin(places->reach_mm, clearance * unit_mm - margin_mm);
    if (!(reach_mm >= least_reach * unit_mm))
        return WEFT_PAPER_SMALL;
    for (int i = 0; i < samples_across * samples_across; i++) {
        double x = middle[0] + reach_mm * (2.0 * (i % samples_across) / (samples_across - 1) - 1);
        double y = middle[1] + reach_mm * (2.0 * (i / samples_across) / (samples_across - 1) - 1);
        weft_pixel at = weft_camera_distort(camera, weft_plate_view_see(view, x, y));
        weft_paper_fate fate = add_value(values, at, sum);
        if (fate != WEFT_PAPER_SEEN)
            return fate;
    }
    weft_pixel ideal = weft_plate_view_see(view, middle[0], middle[1]);
    double x = (ideal.x - camera->cx) / camera->fx, y = (ideal.y - camera->cy) / camera->fy;
    *sample = (weft_paper_sample){.place = place, .radius_squared = (float)(x * x + y * y)};
    for (int c = 0; c < 3; c++) {
        sample->light[c] = (float)(sum[c] / (WEFT_PHOTOGRAPHS_FULL_SCALE * (double)(samples_across * samples_across)));
        if (sample->light[c] < values->dark)
            return WEFT_PAPER_DARK;
    }
    return WEFT_PAPER_SEEN;
}

weft_code weft_paper_sample_all(const weft_paper_places *places, const weft_camera *camera, const weft_plate_view *view,
                                const weft_light_values *values, weft_paper_samples *samples, weft_error *error)
{
    *samples = (weft_paper_samples){0, malloc((size_t)places->count * sizeof *samples->sample), {0}};
    if (!samples->sample)
        return weft_fail_memory(error, "samples of the paper", (size_t)places->count * sizeof *samples->sample);
    for (int place = 0; place < places->count; place++)
        samples->fate[sample_place(places, place, camera, view, values, &samples->sample[samples->fate[0]])]++;
    samples->count = samples->fate[WEFT_PAPER_SEEN];
    return WEFT_OK;
}
