#include "capture/synthetic/scene.h"

static double meet_ball(weft_vec3 centre, double radius, weft_vec3 from, weft_vec3 along)
{
    weft_vec3 d = weft_subtract(from, centre);
    double half = weft_dot(d, along), rest = half * half - weft_dot(d, d) + radius * radius;
    return rest > 0 ? -half - sqrt(rest) : -1;
}

/* The side of the capsule: a tube without ends. */
static double meet_tube(const weft_synthetic_solid *s, weft_vec3 from, weft_vec3 along)
{
    weft_vec3 axis = weft_subtract(s->b, s->a), d = weft_subtract(from, s->a);
    double length2 = weft_dot(axis, axis), slope = weft_dot(axis, along), start = weft_dot(axis, d);
    double a = length2 - slope * slope, half = length2 * weft_dot(d, along) - start * slope;
    double rest = half * half - a * (length2 * (weft_dot(d, d) - s->radius_mm * s->radius_mm) - start * start);
    if (!(length2 > 0 && a > 0 && rest > 0))
        return -1;
    double t = (-half - sqrt(rest)) / a, at = start + t * slope;
    return at > 0 && at < length2 ? t : -1;
}

double weft_synthetic_solid_meet(const weft_synthetic_solid *s, weft_vec3 from, weft_vec3 along, weft_vec3 *normal)
{
    double candidate[3] = {meet_ball(s->a, s->radius_mm, from, along), meet_ball(s->b, s->radius_mm, from, along),
                           meet_tube(s, from, along)};
    double t = -1;
    for (int i = 0; i < 3; i++) {
        if (candidate[i] > 0 && (t < 0 || candidate[i] < t))
            t = candidate[i];
    }
    if (t < 0)
        return t;
    weft_vec3 at = weft_add(from, weft_scale(along, t)), axis = weft_subtract(s->b, s->a);
    double length2 = weft_dot(axis, axis);
    double part = length2 > 0 ? weft_clamp(weft_dot(weft_subtract(at, s->a), axis) / length2, 0, 1) : 0;
    *normal = weft_unit(weft_subtract(at, weft_add(s->a, weft_scale(axis, part))));
    return t;
}

double weft_synthetic_solid_distance(const weft_synthetic_solid *solid, weft_vec3 p, weft_vec3 q)
{
    weft_vec3 d1 = weft_subtract(q, p), d2 = weft_subtract(solid->b, solid->a), r = weft_subtract(p, solid->a);
    double a = weft_dot(d1, d1), e = weft_dot(d2, d2), f = weft_dot(d2, r), c = weft_dot(d1, r);
    double b = weft_dot(d1, d2), crossed = a * e - b * b;
    double s = e > 0 && crossed > 0 ? weft_clamp((b * f - c * e) / crossed, 0, 1) : weft_clamp(-c / a, 0, 1);
    double t = e > 0 ? (b * s + f) / e : 0;
    if (t < 0 || t > 1) {
        t = weft_clamp(t, 0, 1);
        s = weft_clamp((b * t - c) / a, 0, 1);
    }
    weft_vec3 apart = weft_subtract(weft_add(p, weft_scale(d1, s)), weft_add(solid->a, weft_scale(d2, t)));
    return weft_length(apart);
}
