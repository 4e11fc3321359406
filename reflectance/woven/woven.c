#include "reflectance/woven/woven.h"
#include "reflectance/woven/mirror.h"

/* Where the fibres at inclination u of a staple mirror, given its sine and cosine in `at`. */
static inline bool staple_mirrors(const weft_prepared_segment *prepared, weft_vec3 half, weft_mirror *at)
{
    weft_real along = half.y * at->cos_u - half.z * at->sin_u;
    weft_real across = half.y * at->sin_u + half.z * at->cos_u;
    return staple_mirror(prepared->cot_psi, half.x, along, across, at);
}

/* G fc A of a yarn of this radius; of a filament without its fade. */
static weft_real staple_integrand(const weft_prepared_segment *prepared, const weft_mirror *at, weft_real radius,
                                  weft_real phase)
{
    weft_real area = yarn_area(&prepared->segment, radius, at->cos_v) * prepared->inverse_sin_psi;
    return area * phase * (at->light_share * at->view_share);
}

static weft_real filament_integrand(const weft_prepared_segment *prepared, const weft_mirror *at, weft_real across,
                                    weft_real radius, weft_real phase)
{
    weft_real attenuation = at->light_share * at->view_share * at->cosine_sum;
    return yarn_area(&prepared->segment, radius, at->cos_v) / across * phase * attenuation;
}

/* The point at inclination u as far as it does not depend on the highlight; beyond umax the spine ends. */
static weft_yarn_point dark_point(const weft_prepared_segment *prepared, weft_real u, weft_real phase)
{
    const weft_spine *spine = &prepared->spine;
    weft_real on_spine = weft_clamp(u, -spine->umax, spine->umax);
    weft_real radius = weft_filament_radius(prepared, spine, on_spine, sin(on_spine), cos(on_spine));
    return (weft_yarn_point){.radius = radius, .phase = phase};
}

static void light_up(weft_yarn_point *point, const weft_mirror *at)
{
    point->active = true;
    point->normal = weft_vec3_of(at->sin_v, at->sin_u * at->cos_v, at->cos_u * at->cos_v);
    point->attenuation = at->light_share * at->view_share * at->cosine_sum;
}

static weft_yarn_point staple_point(const weft_prepared_segment *prepared, weft_real u, weft_vec3 light, weft_vec3 view)
{
    weft_mirror at = {.sin_u = sin(u), .cos_u = cos(u)};
    weft_vec3 half = weft_add(light, view);
    if (!(fabs(u) <= prepared->spine.umax))
        return (weft_yarn_point){0};
    bool mirrors = staple_mirrors(prepared, half, &at);
    weft_yarn_point point = dark_point(prepared, u, prepared_phase(prepared, light, view));
    if (!mirrors || !faces_both(&at, light, view))
        return point;
    light_up(&point, &at);
    point.solved = atan2(at.sin_v, at.cos_v);
    point.geometry = yarn_area(&prepared->segment, point.radius, at.cos_v) * prepared->inverse_sin_psi / at.cosine_sum;
    point.integrand = staple_integrand(prepared, &at, point.radius, point.phase);
    return point;
}

static weft_yarn_point filament_point(const weft_prepared_segment *prepared, weft_real v, weft_vec3 light,
                                      weft_vec3 view)
{
    weft_real umax = prepared->spine.umax;
    weft_mirror at = {0};
    weft_vec3 half = weft_add(light, view);
    weft_real across = filament_mirror(half, &at), u = atan2(half.y, half.z);
    if (!(across > 0))
        return (weft_yarn_point){0};
    at.sin_v = sin(v);
    at.cos_v = cos(v);
    weft_yarn_point point = dark_point(prepared, u, prepared_phase(prepared, light, view));
    if (!(fabs(u) < umax && faces_both(&at, light, view)))
        return point;
    light_up(&point, &at);
    point.solved = u;
    point.geometry = yarn_area(&prepared->segment, point.radius, at.cos_v) / across;
    weft_real fade = filament_fade(prepared->segment.delta, umax, u);
    point.attenuation *= fade;
    point.integrand = filament_integrand(prepared, &at, across, point.radius, point.phase) * fade;
    return point;
}

weft_yarn_point weft_yarn_highlight(const weft_segment *segment, weft_real coordinate, weft_vec3 light, weft_vec3 view)
{
    weft_prepared_segment prepared = weft_segment_prepare(segment);
    weft_vec3 half;
    if (!prepared.admissible || !half_vector(light, view, &half))
        return (weft_yarn_point){0};
    if (prepared.filament)
        return filament_point(&prepared, coordinate, light, view);
    return staple_point(&prepared, coordinate, light, view);
}

/* What is dark comes first: it needs no radius and no phase. */
static weft_real staple_integrand_at(const weft_prepared_segment *prepared, weft_angle u, weft_vec3 half,
                                     weft_vec3 light, weft_vec3 view)
{
    const weft_spine *spine = &prepared->spine;
    weft_mirror at = {.sin_u = u.sine, .cos_u = u.cosine};
    if (!(fabs(u.radians) <= spine->umax) || !staple_mirrors(prepared, half, &at) || !faces_both(&at, light, view))
        return 0;
    weft_real radius = weft_filament_radius(prepared, spine, u.radians, u.sine, u.cosine);
    return staple_integrand(prepared, &at, radius, prepared_phase(prepared, light, view));
}

static weft_real filament_integrand_at(const weft_prepared_segment *prepared, weft_angle v, weft_vec3 half,
                                       weft_vec3 light, weft_vec3 view)
{
    const weft_spine *spine = &prepared->spine;
    weft_mirror at = {.sin_v = v.sine, .cos_v = v.cosine};
    weft_real across = filament_mirror(half, &at);
    bool inside = fabs(at.sin_u) * spine->cos_umax < at.cos_u * spine->sin_umax; /* |u| < umax */
    if (!(across > 0 && inside && faces_both(&at, light, view)))
        return 0;
    weft_real u = atan2(half.y, half.z), radius = weft_filament_radius(prepared, spine, u, at.sin_u, at.cos_u);
    weft_real fade = filament_fade(prepared->segment.delta, spine->umax, u);
    return filament_integrand(prepared, &at, across, radius, prepared_phase(prepared, light, view)) * fade;
}

weft_real weft_prepared_integrand(const weft_prepared_segment *prepared, weft_angle coordinate, weft_vec3 light,
                                  weft_vec3 view)
{
    weft_vec3 half;
    if (!prepared->admissible || !half_vector(light, view, &half))
        return 0;
    if (prepared->filament)
        return filament_integrand_at(prepared, coordinate, half, light, view);
    return staple_integrand_at(prepared, coordinate, half, light, view);
}

/* Whether `x` lies in the band of `width` that shows the highlight at `centre`, kept whole within the rectangle. */
static bool inside_band(weft_real x, weft_real centre, weft_real width, weft_real rectangle)
{
    weft_real limit = (rectangle - width) / 2;
    return fabs(x - weft_clamp(centre, -limit, limit)) < width / 2;
}

static weft_spine spine_for(const weft_prepared_segment *prepared, weft_real umax)
{
    return umax == prepared->spine.umax ? prepared->spine : weft_segment_spine(&prepared->segment, umax);
}

/* T = 2 w umax (G fc A) / dx with dx = highlight_width w (eq. 13). The cheap tests come first: most points are dark. */
static weft_real staple_texture(const weft_prepared_segment *prepared, weft_real umax, weft_real x, weft_real y,
                                weft_vec3 half, weft_vec3 light, weft_vec3 view)
{
    const weft_segment *segment = &prepared->segment;
    weft_real u = 2 * umax * y / segment->length;
    weft_mirror at = {.sin_u = sin(u), .cos_u = cos(u)};
    if (!staple_mirrors(prepared, half, &at) || !faces_both(&at, light, view))
        return 0;
    weft_real centre = segment->width * (atan2(at.sin_v, at.cos_v) / (weft_real)WEFT_PI);
    if (!inside_band(x, centre, segment->highlight_width * segment->width, segment->width))
        return 0;
    weft_spine spine = spine_for(prepared, umax);
    weft_real radius = weft_spine_radius_at(segment, &spine, umax - fabs(u), at.sin_u, at.cos_u);
    weft_real integrand = staple_integrand(prepared, &at, radius, prepared_phase(prepared, light, view));
    return 2 * umax * integrand / segment->highlight_width;
}

/* T = pi l (G fc A) / dy with dy = highlight_width l (eq. 14). */
static weft_real filament_texture(const weft_prepared_segment *prepared, weft_real umax, weft_real x, weft_real y,
                                  weft_vec3 half, weft_vec3 light, weft_vec3 view)
{
    const weft_segment *segment = &prepared->segment;
    weft_mirror at = {0};
    weft_real across = filament_mirror(half, &at);
    weft_real u = atan2(half.y, half.z);
    if (!(across > 0 && fabs(u) < umax))
        return 0;
    weft_real centre = segment->length * (u / (2 * umax));
    if (!inside_band(y, centre, segment->highlight_width * segment->length, segment->length))
        return 0;
    weft_real v = (weft_real)WEFT_PI * (x / segment->width);
    at.sin_v = sin(v);
    at.cos_v = cos(v);
    if (!faces_both(&at, light, view))
        return 0;
    weft_spine spine = spine_for(prepared, umax);
    weft_real radius = weft_filament_radius(prepared, &spine, u, at.sin_u, at.cos_u);
    weft_real phase = prepared_phase(prepared, light, view), fade = filament_fade(segment->delta, umax, u);
    weft_real integrand = filament_integrand(prepared, &at, across, radius, phase) * fade;
    return (weft_real)WEFT_PI * integrand / segment->highlight_width;
}

weft_real weft_prepared_texture(const weft_prepared_segment *prepared, weft_real umax, weft_real x, weft_real y,
                                weft_vec3 light, weft_vec3 view)
{
    const weft_segment *segment = &prepared->segment;
    weft_vec3 half;
    bool inside = prepared->admissible && fabs(x) <= segment->width / 2 && fabs(y) <= segment->length / 2;
    if (!inside || !half_vector(light, view, &half))
        return 0;
    umax = fmin(umax, (weft_real)(WEFT_PI / 2));
    if (prepared->filament)
        return filament_texture(prepared, umax, x, y, half, light, view);
    return staple_texture(prepared, umax, x, y, half, light, view);
}

weft_real weft_segment_texture(const weft_segment *segment, weft_real x, weft_real y, weft_vec3 light, weft_vec3 view)
{
    weft_prepared_segment prepared = weft_segment_prepare(segment);
    return weft_prepared_texture(&prepared, segment->umax, x, y, light, view);
}
