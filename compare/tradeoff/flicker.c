#include "compare/tradeoff/tradeoff.h"

#include "btf/direction/direction.h"

#include <math.h>

enum { PLACES = 4 /* along a side */, VIEWS = 4, LIGHTS = 53 };

static const double view_deg = 30, outermost_deg = 65;

void weft_flicker_add(const double *value, int count, weft_flicker *flicker)
{
    double largest = -INFINITY;
    for (int i = 0; i < count; i++) {
        largest = fmax(largest, value[i]);
        flicker->moved += i > 0 ? fabs(value[i] - value[i - 1]) : 0;
    }
    if (count > 0)
        flicker->needed += 2 * largest - value[0] - value[count - 1];
}

double weft_flicker_excess(const weft_flicker *flicker)
{
    return flicker->needed > 0 ? fmax(flicker->moved / flicker->needed - 1, 0) : 0; /* rounding */
}

/* Light number i of a sweep in the plane of azimuth phi. */
static weft_vec3 light_of_sweep(int i, double phi)
{
    double theta = weft_rad_of_deg(outermost_deg * (1 - 2.0 * i / (LIGHTS - 1)));
    return (weft_vec3){sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}

static weft_code sweep(weft_model *model, double u, double v, double phi, weft_flicker *flicker, weft_error *error)
{
    double value[LIGHTS];
    int count = 0;
    weft_angles view = {weft_rad_of_deg(view_deg), phi};
    for (int i = 0; i < LIGHTS; i++) {
        weft_rgb brdf;
        weft_query query = {
            .light = light_of_sweep(i, phi), .view = weft_direction_of_angles(view), .has_place = true, .u = u, .v = v};
        WEFT_TRY(weft_model_brdf(model, &query, &brdf, error));
        double mean = (double)(brdf.r + brdf.g + brdf.b) / 3 * (double)query.light.z;
        if (!isnan(mean))
            value[count++] = mean;
    }
    weft_flicker_add(value, count, flicker);
    return WEFT_OK;
}

weft_code weft_flicker_measure(weft_model *model, double *excess, weft_error *error)
{
    weft_flicker flicker = {0};
    for (int i = 0; i < PLACES * PLACES * VIEWS; i++) {
        int place = i / VIEWS;
        double u = (place % PLACES + 0.37) / PLACES, v = (place / PLACES + 0.61) / PLACES;
        WEFT_TRY(sweep(model, u, v, 2 * WEFT_PI * (i % VIEWS) / VIEWS, &flicker, error));
    }
    *excess = weft_flicker_excess(&flicker);
    return WEFT_OK;
}
