/* Woven cloth: a segment, and a weave of two yarns. */
#include "bench/numerics/take.h"
#include "reflectance/weave/weave.h"

numerics_value numerics_spine_radius(const double *a)
{
    weft_segment segment = {.highlight_width = 1, .umax = take(&a)};
    segment.kappa = take(&a);
    segment.width = take(&a);
    segment.length = take(&a);
    return plain_value(weft_spine_radius(&segment, take(&a)));
}

numerics_value numerics_phase(const double *a)
{
    weft_real alpha = take(&a), beta = take(&a), x = take(&a);
    return plain_value(weft_phase_function(alpha, beta, x));
}

/* The columns of the reference vectors. */
static weft_segment segment_of(const double **a)
{
    weft_segment segment = {.alpha = take(a), .highlight_width = 1};
    segment.beta = take(a);
    segment.delta = take(a);
    segment.psi = take(a);
    segment.umax = take(a);
    segment.kappa = take(a);
    segment.width = take(a);
    segment.length = take(a);
    return segment;
}

/* What one place of the yarn returns at most (docs/notes/numerics.md, bounds). */
static weft_real largest_point(const weft_segment *segment, const weft_yarn_point *point, weft_vec3 light,
                               weft_vec3 view)
{
    weft_real a = segment->width / 2, area = a * (point->radius + a) * point->phase / 4;
    weft_vec3 half = weft_add(light, view);
    if (segment->psi != 0)
        return area / fabs(sin(segment->psi));
    return area * (fabs(half.x) / sqrt(half.y * half.y + half.z * half.z) + 1);
}

numerics_value numerics_point(const double *a)
{
    weft_segment segment = segment_of(&a);
    weft_real coordinate = take(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    weft_yarn_point point = weft_yarn_highlight(&segment, coordinate, light, view);
    return scaled_value(point.integrand, largest_point(&segment, &point, light, view));
}

numerics_value numerics_texture(const double *a)
{
    weft_segment segment = segment_of(&a);
    segment.highlight_width = take(&a);
    weft_real x = take(&a), y = take(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    bool filament = segment.psi == 0;
    weft_real coordinate = filament ? (weft_real)WEFT_PI * x / segment.width : 2 * segment.umax * y / segment.length;
    weft_yarn_point point = weft_yarn_highlight(&segment, coordinate, light, view);
    weft_real extent = (filament ? (weft_real)WEFT_PI : 2 * segment.umax) / segment.highlight_width;
    return scaled_value(weft_segment_texture(&segment, x, y, light, view),
                        largest_point(&segment, &point, light, view) * extent);
}

numerics_value numerics_reflectance(const double *a)
{
    weft_segment segment = segment_of(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    weft_yarn_point point = weft_yarn_highlight(&segment, 0, light, view);
    weft_real extent = segment.psi == 0 ? (weft_real)WEFT_PI : 2 * segment.umax;
    return scaled_value(weft_segment_reflectance(&segment, light, view),
                        largest_point(&segment, &point, light, view) * extent);
}

/* ---- Weaves ---- */

enum { TILE = 2, YARNS = 2 };

/* A plain weave of one warp and one weft yarn, which differ in their twist alone. */
typedef struct plain_weave {
    weft_weave weave;
    weft_yarn yarn[YARNS];
    int pattern[TILE * TILE];
} plain_weave;

static void weave_of(const double **a, plain_weave *plain)
{
    weft_segment segment = segment_of(a);
    segment.highlight_width = (weft_real)0.5;
    *plain = (plain_weave){.pattern = {0, 1, 1, 0}};
    plain->weave = (weft_weave){.tile_width = TILE,
                                .tile_height = TILE,
                                .warp_area = 2,
                                .weft_area = 2,
                                .fineness = 3,
                                .period = 8,
                                .inclination_noise_deg = {4, 4, 4, 4},
                                .yarn_count = YARNS,
                                .specular_scale = 4};
    for (int i = 0; i < YARNS; i++) {
        plain->yarn[i] = (weft_yarn){.segment = segment,
                                     .warp = i == 0,
                                     .center_u = (weft_real)0.25,
                                     .center_v = (weft_real)0.75,
                                     .kd = {(weft_real)0.25, 0, 0},
                                     .ks = {1, 1, 1}};
        plain->yarn[i].segment.psi *= i == 0 ? 1 : -1;
    }
    plain->weave.pattern = plain->pattern;
    plain->weave.yarn = plain->yarn;
    weft_weave_update_yarns(&plain->weave);
}

numerics_value numerics_weave_brdf(const double *a)
{
    enum { SEED = 7 };
    plain_weave plain;
    weave_of(&a, &plain);
    weft_real U = take(&a), V = take(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    weft_weave_point point = weft_weave_locate(&plain.weave, U, V, SEED);
    return plain_value(weft_weave_brdf(&plain.weave, &point, light, view).r);
}

numerics_value numerics_weave_mean(const double *a)
{
    plain_weave plain;
    weave_of(&a, &plain);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    return plain_value(weft_weave_mean_brdf(&plain.weave, light, view).r);
}
