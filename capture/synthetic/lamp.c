#include "capture/synthetic/scene.h"

double weft_synthetic_lamp_toward(const weft_synthetic_lamp *lamp, weft_vec3 point)
{
    if (!lamp->is_disc)
        return lamp->intensity_cd;
    double cosine = weft_dot(lamp->axis, weft_unit(weft_subtract(point, lamp->at)));
    return lamp->intensity_cd * fmax(cosine, 0);
}

double weft_synthetic_lamp_illuminance(const weft_synthetic_lamp *lamp, weft_vec3 point)
{
    weft_vec3 d = weft_subtract(lamp->at, point);
    double squared_mm = weft_dot(d, d);
    if (!(d.z > 0))
        return 0;
    return weft_synthetic_lamp_toward(lamp, point) * d.z / sqrt(squared_mm) / (squared_mm * 1e-6);
}

/* Two unit vectors across a unit vector. */
static void span(weft_vec3 axis, weft_vec3 *first, weft_vec3 *second)
{
    weft_vec3 other = fabs(axis.x) < 0.7 ? weft_vec3_of(1, 0, 0) : weft_vec3_of(0, 1, 0);
    *first = weft_unit(weft_cross(axis, other));
    *second = weft_cross(axis, *first);
}

weft_vec3 weft_synthetic_lamp_place(const weft_synthetic_lamp *lamp, weft_vec3 point, const double disc[2])
{
    weft_vec3 across, along;
    span(lamp->is_disc ? lamp->axis : weft_unit(weft_subtract(point, lamp->at)), &across, &along);
    weft_vec3 offset = weft_add(weft_scale(across, disc[0]), weft_scale(along, disc[1]));
    return weft_add(lamp->at, weft_scale(offset, lamp->radius_mm));
}

static double meet_disc(const weft_synthetic_lamp *lamp, weft_vec3 from, weft_vec3 along)
{
    double toward = weft_dot(along, lamp->axis);
    if (!(toward < 0))
        return -1;
    double t = weft_dot(weft_subtract(lamp->at, from), lamp->axis) / toward;
    weft_vec3 miss = weft_subtract(weft_add(from, weft_scale(along, t)), lamp->at);
    return weft_dot(miss, miss) <= lamp->radius_mm * lamp->radius_mm ? t : -1;
}

double weft_synthetic_lamp_meet(const weft_synthetic_lamp *lamp, weft_vec3 from, weft_vec3 along)
{
    if (lamp->is_disc)
        return meet_disc(lamp, from, along);
    double t = weft_dot(weft_subtract(lamp->at, from), along);
    weft_vec3 miss = weft_subtract(weft_add(from, weft_scale(along, t)), lamp->at);
    return weft_dot(miss, miss) <= lamp->radius_mm * lamp->radius_mm ? t : -1;
}

double weft_synthetic_lamp_luminance(const weft_synthetic_lamp *lamp)
{
    double radius_m = lamp->radius_mm * 1e-3;
    return lamp->intensity_cd / (WEFT_PI * radius_m * radius_m);
}
