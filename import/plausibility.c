#include "import/plausibility.h"

#include "btf/direction/direction.h"

#include <math.h>

enum { FEWEST = 8 };

weft_photograph_light weft_photograph_light_of(const weft_half *samples, const uint8_t *mask, int width, int height)
{
    double sum[4] = {0}, all = 0;
    size_t count[4] = {0}, seen = 0;
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            size_t at = (size_t)y * (size_t)width + (size_t)x;
            if (mask[at])
                continue;
            double value = 0;
            for (int c = 0; c < 3; c++)
                value += (double)weft_float_of_half(samples[3 * at + (size_t)c]) / 3;
            /* Right, left, upper, lower; the middle of an odd side counts for none. */
            const int half[2] = {2 * x + 1 > width   ? 0
                                 : 2 * x + 1 < width ? 1
                                                     : -1,
                                 2 * y + 1 < height   ? 2
                                 : 2 * y + 1 > height ? 3
                                                      : -1};
            for (int i = 0; i < 2; i++) {
                if (half[i] >= 0)
                    sum[half[i]] += value, count[half[i]]++;
            }
            all += value, seen++;
        }
    }
    weft_photograph_light light = {.mean = 0};
    for (int i = 0; i < 4; i++) {
        if (count[i] == 0 || !(sum[i] > 0))
            return light;
        sum[i] /= (double)count[i];
    }
    light.mean = all / (double)seen;
    light.slope[0] = log(sum[0] / sum[1]);
    light.slope[1] = log(sum[2] / sum[3]);
    return light;
}

/* Sums of a straight line through points. */
typedef struct line_sums {
    double count, x, y, xx, xy, yy;
} line_sums;

static void add_point(line_sums *s, double x, double y)
{
    s->count++;
    s->x += x, s->y += y;
    s->xx += x * x, s->xy += x * y, s->yy += y * y;
}

static double variance_of_x(const line_sums *s)
{
    return s->xx / s->count - s->x / s->count * (s->x / s->count);
}

static double variance_of_y(const line_sums *s)
{
    return s->yy / s->count - s->y / s->count * (s->y / s->count);
}

static double slope_of(const line_sums *s)
{
    return (s->xy / s->count - s->x / s->count * (s->y / s->count)) / variance_of_x(s);
}

/* The share of the variance of y that the line explains. */
static double explained(const line_sums *s)
{
    double slope = slope_of(s);
    return slope * slope * variance_of_x(s) / variance_of_y(s);
}

/* The power of a cosine that the brightness follows: 1 for a matt surface and the cosine of its lamps. False where the
 * cosines are too much alike: lamps from 0 to 53 degrees are enough. */
static bool find_power(const weft_collection *collection, bool of_views, const weft_photograph_light *light,
                       double *power)
{
    const double least_spread = 0.15;
    line_sums s = {0};
    for (int i = 0; i < collection->count; i++) {
        const weft_photograph *photograph = &collection->photograph[i];
        if (light[i].mean > 0)
            add_point(&s, log((double)(of_views ? photograph->view.z : photograph->light.z)), log(light[i].mean));
    }
    if (s.count < FEWEST || sqrt(variance_of_x(&s)) < least_spread)
        return false;
    *power = slope_of(&s);
    return true;
}

static weft_code check_cosine(const weft_collection *collection, weft_values values, const weft_photograph_light *light,
                              weft_lines *notes, weft_error *error)
{
    const double none = 0.25, all = 0.75;
    double power, of_views;
    if (!find_power(collection, false, light, &power))
        return WEFT_OK;
    if (values == WEFT_REFLECTANCE && power > all)
        return weft_lines_add(notes, error,
                              "the photographs darken with the cosine of their lamps (to the power %.2f), which "
                              "reflectance does not: is it still in their values? Then leave out --values reflectance",
                              power);
    if (values != WEFT_REFLECTANCE_COSINE || power > none)
        return WEFT_OK;
    if (find_power(collection, true, light, &of_views) && of_views > all)
        return weft_lines_add(notes, error,
                              "the photographs darken with the cosine of their views (to the power %.2f) and not of "
                              "their lamps: are light and view exchanged?",
                              of_views);
    return weft_lines_add(notes, error,
                          "low lamps leave the photographs as bright as high ones (cosine to the power %.2f): if their "
                          "values were divided by the cosine, pass --values reflectance",
                          power);
}

/* Who takes the normal of a ball at its highlight for the lamp lists half of each angle. */
static weft_code check_halved_angles(const weft_collection *collection, weft_values values,
                                     const weft_photograph_light *light, weft_lines *notes, weft_error *error)
{
    const double largest_half_rad = weft_rad_of_deg(44), noticeable = 0.05;
    double largest_rad = 0;
    line_sums as_listed = {0}, doubled = {0};
    for (int i = 0; i < collection->count; i++) {
        if (!(light[i].mean > 0))
            continue;
        double angle_rad = acos(fmin(1, (double)collection->photograph[i].light.z));
        largest_rad = fmax(largest_rad, angle_rad);
        if (largest_rad > largest_half_rad)
            return WEFT_OK;
        double cosine = values == WEFT_REFLECTANCE ? 1 : cos(angle_rad);
        add_point(&as_listed, 0, log(light[i].mean / cosine));
        add_point(&doubled, 0, log(light[i].mean / (values == WEFT_REFLECTANCE ? 1 : cos(2 * angle_rad))));
    }
    if (as_listed.count < FEWEST || sqrt(variance_of_y(&as_listed)) < noticeable ||
        variance_of_y(&doubled) > variance_of_y(&as_listed) / 4)
        return WEFT_OK;
    return weft_lines_add(notes, error,
                          "all lamps are listed within %.0f degrees of the normal, but the photographs darken as from "
                          "twice these angles: does the list hold the normals of a ball?",
                          weft_deg_of_rad(largest_rad));
}

/* At the distance d the light on a plane changes by 3 sin(theta) / d; halves of a picture are half its width apart. A
 * surface that bulges does so with the tangent. */
static weft_code check_distance(const weft_collection *collection, const weft_photograph_light *light,
                                weft_lines *notes, weft_error *error)
{
    const double least_share = 0.7, least_slope = 0.15;
    line_sums near = {0}, bulging = {0};
    for (int i = 0; i < collection->count; i++) {
        weft_vec3 l = collection->photograph[i].light;
        if (!(light[i].mean > 0))
            continue;
        add_point(&near, (double)l.x, light[i].slope[0]);
        add_point(&bulging, (double)(l.x / l.z), light[i].slope[0]);
    }
    if (near.count < FEWEST || variance_of_x(&near) < 0.01)
        return WEFT_OK;
    double slope = slope_of(&near);
    if (slope < least_slope || explained(&near) < least_share || explained(&bulging) > explained(&near))
        return WEFT_OK;
    return weft_lines_add(notes, error,
                          "the side of the picture that is nearer to the lamp is brighter, as from lamps at %.2g times "
                          "the width of the picture (unless its surface bulges); they are taken as far, so texels "
                          "are up to %.0f %% too bright or too dark",
                          1.5 / slope, 100 * (exp(slope) - 1));
}

weft_code weft_check_plausibility(const weft_collection *collection, weft_values values,
                                  const weft_photograph_light *light, weft_lines *notes, weft_error *error)
{
    if (collection->distance != WEFT_FAR)
        return WEFT_OK;
    WEFT_TRY(check_cosine(collection, values, light, notes, error));
    WEFT_TRY(check_halved_angles(collection, values, light, notes, error));
    return check_distance(collection, light, notes, error);
}
