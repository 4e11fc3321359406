#include "registration/lamp/evidence.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

const double weft_pin_head_radius_mm = 1.5;

static const double reach_mm = 70, texel_mm = 0.3, margin_mm = 1;

weft_pin_area weft_pin_area_of(const weft_target *target, double height_mm)
{
    weft_pin_area area = {.height_mm = height_mm, .step_mm = texel_mm};
    weft_rectangle sheet = weft_target_sheet(target);
    weft_target_pin(target, area.foot);
    area.x0 = fmax(sheet.x0 + margin_mm, area.foot[0] - reach_mm);
    area.y0 = fmax(sheet.y0 + margin_mm, area.foot[1] - reach_mm);
    area.columns = (int)((fmin(sheet.x1 - margin_mm, area.foot[0] + reach_mm) - area.x0) / texel_mm) + 1;
    area.rows = (int)((fmin(sheet.y1 - margin_mm, area.foot[1] + reach_mm) - area.y0) / texel_mm) + 1;
    return area;
}

/* ---- The light of the area ---- */

static float light_at(const weft_light_values *values, weft_pixel at)
{
    if (!(at.x >= 0 && at.y >= 0 && at.x < values->width - 1 && at.y < values->height - 1))
        return NAN;
    int x = (int)at.x, y = (int)at.y;
    float u = (float)at.x - (float)x, v = (float)at.y - (float)y;
    const float *top = values->grey + (long)y * values->width + x, *low = top + values->width;
    return (1 - v) * ((1 - u) * top[0] + u * top[1]) + v * ((1 - u) * low[0] + u * low[1]);
}

weft_code weft_pin_patch(const weft_pin_area *area, const weft_camera *camera, const weft_plate_view *view,
                         const weft_light_values *values, float **patch, weft_error *error)
{
    size_t texels = (size_t)area->columns * (size_t)area->rows;
    *patch = malloc(texels * sizeof **patch);
    if (!*patch)
        return weft_fail_memory(error, "the surroundings of the pin", texels * sizeof **patch);
    for (size_t i = 0; i < texels; i++) {
        double x = area->x0 + area->step_mm * (double)(i % (size_t)area->columns);
        double y = area->y0 + area->step_mm * (double)(i / (size_t)area->columns);
        (*patch)[i] = light_at(values, weft_camera_distort(camera, weft_plate_view_see(view, x, y)));
    }
    return WEFT_OK;
}

/* ---- What is there in all photographs ---- */

/* Half the side of the square whose mean is the light around a texel. */
static const double surroundings_mm = 8;

static bool *find_paper(const weft_pin_area *area, const weft_target *target)
{
    bool *paper = calloc((size_t)area->columns * (size_t)area->rows, sizeof *paper);
    for (int i = 0; paper && i < area->columns * area->rows; i++) {
        double x = area->x0 + area->step_mm * (i % area->columns), y = area->y0 + area->step_mm * (i / area->columns);
        paper[i] = true;
        for (int k = 0; k < 4; k++)
            paper[i] = paper[i] &&
                       weft_target_sheet_reflectance(target, x + (k & 1 ? 0.6 : -0.6), y + (k & 2 ? 0.6 : -0.6)) > 0.5;
    }
    return paper;
}

/* Sums over all texels above and to the left of each corner; `what` 0: of light, 1: of texels. */
static void sum_area(const weft_pin_area *area, const bool *paper, const float *light, int what, double *sum)
{
    int across = area->columns + 1;
    for (int i = 0; i < across; i++)
        sum[i] = 0;
    for (int y = 0; y < area->rows; y++) {
        double row = 0;
        sum[(y + 1) * across] = 0;
        for (int x = 0; x < area->columns; x++) {
            int at = y * area->columns + x;
            if (paper[at] && isfinite(light[at]))
                row += what ? 1 : (double)light[at];
            sum[(y + 1) * across + x + 1] = sum[y * across + x + 1] + row;
        }
    }
}

static double in_square(const weft_pin_area *area, const double *sum, int x, int y)
{
    int reach = (int)(surroundings_mm / area->step_mm), across = area->columns + 1;
    int x0 = x > reach ? x - reach : 0, x1 = x + reach < area->columns ? x + reach : area->columns;
    int y0 = y > reach ? y - reach : 0, y1 = y + reach < area->rows ? y + reach : area->rows;
    return sum[y1 * across + x1] - sum[y0 * across + x1] - sum[y1 * across + x0] + sum[y0 * across + x0];
}

/* Divides the light of each texel by the mean of the bare paper around it. */
static void divide_by_surroundings(const weft_pin_area *area, const bool *paper, double *sum, float *patch)
{
    const double fewest = 100;
    double *light = sum, *count = sum + (area->columns + 1) * (area->rows + 1);
    sum_area(area, paper, patch, 0, light);
    sum_area(area, paper, patch, 1, count);
    for (int i = 0; i < area->columns * area->rows; i++) {
        double texels = in_square(area, count, i % area->columns, i / area->columns);
        double mean = in_square(area, light, i % area->columns, i / area->columns) / fmax(texels, 1);
        patch[i] = texels >= fewest && mean > 0 ? patch[i] / (float)mean : NAN;
    }
}

/* From light over its surroundings to the part that is missing against the median photograph. */
static void take_shadows(const weft_pin_area *area, float *const *patch, int count, float *scratch)
{
    const float darkest_print = 0.3f;
    for (int i = 0; i < area->columns * area->rows; i++) {
        size_t seen = 0;
        for (int k = 0; k < count; k++) {
            if (patch[k] && isfinite(patch[k][i]))
                scratch[seen++] = patch[k][i];
        }
        float usual = seen ? weft_quantile_of_floats(scratch, seen, 0.5) : 0;
        for (int k = 0; k < count; k++) {
            if (patch[k])
                patch[k][i] = usual > darkest_print ? 1 - patch[k][i] / usual : NAN;
        }
    }
}

/* ---- The pin itself ---- */

static double distance_to_segment(const double a[2], const double b[2], double x, double y)
{
    double ux = b[0] - a[0], uy = b[1] - a[1], squared = ux * ux + uy * uy;
    double t = squared > 0 ? ((x - a[0]) * ux + (y - a[1]) * uy) / squared : 0;
    t = fmin(fmax(t, 0), 1);
    return hypot(x - a[0] - t * ux, y - a[1] - t * uy);
}

/* Unknown is what the pin hides; it may stand some millimetre beside its place. */
static void hide_pin(const weft_pin_area *area, weft_vec3 eye, float *darkness)
{
    const double body_mm = 1.3, head_mm = weft_pin_head_radius_mm + 1.2;
    double stretch = eye.z / (eye.z - area->height_mm);
    double top[2] = {eye.x + (area->foot[0] - eye.x) * stretch, eye.y + (area->foot[1] - eye.y) * stretch};
    double before = 1 - 2 * weft_pin_head_radius_mm / area->height_mm;
    double neck[2] = {area->foot[0] + before * (top[0] - area->foot[0]),
                      area->foot[1] + before * (top[1] - area->foot[1])};
    for (int i = 0; i < area->columns * area->rows; i++) {
        double x = area->x0 + area->step_mm * (i % area->columns), y = area->y0 + area->step_mm * (i / area->columns);
        if (distance_to_segment(area->foot, top, x, y) < body_mm || distance_to_segment(neck, top, x, y) < head_mm)
            darkness[i] = NAN;
    }
}

/* ---- The first guess ---- */

/* What a line and a head of middling darkness would show; a guess explains the squares of these. */
static const double line_darkness = 0.4, head_darkness = 0.6, beside_line_mm = 2.2, beside_head_mm = 3.6;
static const double first_mm = 1.5, nearest_mm = 3, shortest_open_mm = 7, least_head = 0.2;
enum { AZIMUTHS = 360 };

static double darkness_at(const weft_pin_area *area, const float *darkness, double x, double y)
{
    double column = (x - area->x0) / area->step_mm, row = (y - area->y0) / area->step_mm;
    if (!(column >= 0 && row >= 0 && column < area->columns - 1 && row < area->rows - 1))
        return NAN;
    int i = (int)column, j = (int)row;
    double u = column - i, v = row - j;
    const float *at = darkness + (long)j * area->columns + i;
    double low = (1 - u) * (double)at[0] + u * (double)at[1];
    return (1 - v) * low + v * ((1 - u) * (double)at[area->columns] + u * (double)at[area->columns + 1]);
}

/* The direction of a line from the foot. */
typedef struct heading {
    double x, y;
} heading;

static double beside(const weft_pin_area *area, const float *darkness, heading h, double along, double across)
{
    return darkness_at(area, darkness, area->foot[0] + along * h.x - across * h.y,
                       area->foot[1] + along * h.y + across * h.x);
}

/* Not a number where one of them is none. */
static double larger(double a, double b)
{
    return a >= b || isnan(a) ? a : b;
}

/* How much darker the middle is than both sides; 0 where something is not seen. */
static double line_contrast(const weft_pin_area *area, const float *darkness, heading h, double along)
{
    double middle = beside(area, darkness, h, along, 0);
    double sides =
        larger(beside(area, darkness, h, along, beside_line_mm), beside(area, darkness, h, along, -beside_line_mm));
    double contrast = middle - sides;
    return isfinite(contrast) ? fmin(fmax(contrast, -0.5), 1) : 0;
}

static double head_contrast(const weft_pin_area *area, const float *darkness, heading h, double along)
{
    const double part = 0.6 * weft_pin_head_radius_mm;
    double middle = beside(area, darkness, h, along, 0);
    for (int k = 0; k < 4; k++)
        middle += beside(area, darkness, h, along + (k < 2 ? part * (2 * k - 1) : 0), k < 2 ? 0 : part * (2 * k - 5));
    double sides =
        larger(beside(area, darkness, h, along, beside_head_mm), beside(area, darkness, h, along, -beside_head_mm));
    double length = along / area->height_mm, lean = sqrt(1 + length * length);
    double past = along + 2.2 * weft_pin_head_radius_mm * lean;
    for (int k = -2; k <= 2; k++) /* a shadow that goes on has no end here */
        sides = larger(sides, beside(area, darkness, h, past, k * part));
    double contrast = middle / 5 - sides;
    return isfinite(contrast) ? fmin(fmax(contrast, -0.5), 1) : -0.5;
}

static double explained(double contrast, double expected)
{
    return 2 * expected * contrast - expected * expected;
}

/* The best length of a shadow along a heading, by how much it explains: to its head, or, `open`, to where it leaves
 * the sheet. */
static double try_heading(const weft_pin_area *area, const float *darkness, heading h, bool open, double *length)
{
    const double samples_of_head = 4 * weft_pin_head_radius_mm / area->step_mm;
    double line = 0, best = -INFINITY;
    for (int step = 0; first_mm + step * area->step_mm < reach_mm; step++) {
        double along = first_mm + step * area->step_mm;
        double here = beside(area, darkness, h, along, 0);
        if (open && along >= shortest_open_mm && line > best && isfinite(here))
            best = line, *length = along;
        if (!open && along >= nearest_mm) {
            double head = head_contrast(area, darkness, h, along);
            double all = line + samples_of_head * explained(head, head_darkness);
            if (head > least_head && all > best)
                best = all, *length = along;
        }
        double behind = along - weft_pin_head_radius_mm;
        if (behind >= first_mm)
            line += explained(line_contrast(area, darkness, h, behind), line_darkness);
    }
    return best;
}

/* Whether a place lies at the edge of the sheet that is looked at. */
static bool leaves(const weft_pin_area *area, const double place[2])
{
    const double edge_mm = 2;
    double right = area->x0 + area->step_mm * (area->columns - 1), top = area->y0 + area->step_mm * (area->rows - 1);
    return place[0] > right - edge_mm || place[1] > top - edge_mm || place[0] < area->x0 + edge_mm ||
           place[1] < area->y0 + edge_mm;
}

/* The shadow that explains most, if none in another direction explains half as much. */
static bool guess(const weft_pin_area *area, const float *darkness, weft_pin_shadow *shadow)
{
    const bool open = !isfinite(shadow->along_mm);
    double score[AZIMUTHS], length[AZIMUTHS], rival = 0;
    int best = 0;
    for (int i = 0; i < AZIMUTHS; i++) {
        heading h = {cos(2 * WEFT_PI * i / AZIMUTHS), sin(2 * WEFT_PI * i / AZIMUTHS)};
        score[i] = try_heading(area, darkness, h, open, &length[i]);
        if (score[i] > score[best])
            best = i;
    }
    for (int i = 0; i < AZIMUTHS; i++) {
        int apart = abs(i - best);
        if (fmin(apart, AZIMUTHS - apart) * length[best] * 2 * WEFT_PI / AZIMUTHS > 4 * weft_pin_head_radius_mm)
            rival = fmax(rival, score[i]);
    }
    shadow->place[0] = area->foot[0] + length[best] * cos(2 * WEFT_PI * best / AZIMUTHS);
    shadow->place[1] = area->foot[1] + length[best] * sin(2 * WEFT_PI * best / AZIMUTHS);
    return score[best] > 0 && score[best] > 2 * rival && (!open || leaves(area, shadow->place));
}

static bool has_end(const weft_pin_area *area, const float *darkness, const weft_pin_shadow *shadow)
{
    double x = shadow->place[0] - area->foot[0], y = shadow->place[1] - area->foot[1], length = hypot(x, y);
    return length > 0 && head_contrast(area, darkness, (heading){x / length, y / length}, length) > least_head;
}

static weft_code find_one(const weft_pin_area *area, weft_vec3 eye, float *darkness, weft_pin_shadow *shadow,
                          weft_error *error)
{
    if (eye.z > 2 * area->height_mm) {
        hide_pin(area, eye, darkness);
        shadow->found = guess(area, darkness, shadow);
    }
    if (shadow->found)
        WEFT_TRY(weft_pin_refine(area, darkness, shadow, error));
    shadow->found = shadow->found && has_end(area, darkness, shadow);
    if (shadow->found || !(eye.z > 2 * area->height_mm))
        return WEFT_OK;
    shadow->along_mm = INFINITY;
    shadow->found = guess(area, darkness, shadow);
    return shadow->found ? weft_pin_refine(area, darkness, shadow, error) : WEFT_OK;
}

weft_code weft_pin_find(const weft_pin_area *area, const weft_target *target, const weft_vec3 *eye, float *const *patch,
                        int count, weft_pin_shadow *shadow, weft_error *error)
{
    bool *paper = find_paper(area, target);
    size_t corners = 2 * (size_t)(area->columns + 1) * (size_t)(area->rows + 1);
    double *sum = malloc(corners * sizeof *sum);
    float *scratch = malloc(((size_t)count + 1) * sizeof *scratch);
    weft_code result = WEFT_OK;
    if (!paper || !sum || !scratch)
        result = weft_fail_memory(error, "the shadow of the pin", corners * sizeof *sum);
    for (int i = 0; i < count; i++)
        shadow[i] = (weft_pin_shadow){0};
    for (int i = 0; result == WEFT_OK && i < count; i++) {
        if (patch[i])
            divide_by_surroundings(area, paper, sum, patch[i]);
    }
    if (result == WEFT_OK)
        take_shadows(area, patch, count, scratch);
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < count; i++) {
        weft_error own = {0};
        weft_code code = result == WEFT_OK && patch[i] ? find_one(area, eye[i], patch[i], &shadow[i], &own) : WEFT_OK;
#pragma omp critical(weft_pin)
        if (code != WEFT_OK && result == WEFT_OK) {
            result = code;
            if (error)
                *error = own;
        }
    }
    free(scratch);
    free(sum);
    free(paper);
    return result;
}
