/* Reflectance of a segment: the integral of its highlight along (staple) or round (filament) the yarn. */
#include "reflectance/quadrature/quadrature.h"
#include "reflectance/woven/mirror.h"

typedef struct interval {
    weft_real low, high;
} interval;

/* The variable of integration is t = u - origin. Where the highlight is narrower than the yarn, the origin is its
 * middle u0, so that D does not cancel for small psi; else it is 0, so that u is exact for small umax. */
typedef struct staple_problem {
    const weft_prepared_segment *prepared;
    weft_vec3 light, view, half;
    weft_real u0, across; /* H_y = across sin u0, H_z = across cos u0 */
    bool from_u0;
    interval range; /* of t: the whole yarn */
} staple_problem;

/* The mirroring point of the yarn at t; false where there is none. */
static bool staple_at(const staple_problem *problem, weft_real t, weft_mirror *at)
{
    weft_real u = problem->from_u0 ? problem->u0 + t : t, x = problem->from_u0 ? t : t - problem->u0;
    at->sin_u = sin(u);
    at->cos_u = fmax(cos(u), 0);
    return staple_mirror(problem->prepared->cot_psi, problem->half.x, -problem->across * sin(x),
                         problem->across * cos(x), at);
}

/* One smooth part of a problem. */
typedef struct staple_piece {
    const staple_problem *problem;
    interval t;
} staple_piece;

/* Of u: below this its rounding shows in R. */
#define STEEP_COSINE 0.1

/* R at a point of the yarn. Where the yarn ends steeply R has its spike, as wide as cos(umax); the distance `inside`
 * from the end is known better than u. */
static weft_real radius_at(const weft_prepared_segment *prepared, weft_real inside, const weft_mirror *at)
{
    const weft_spine *spine = &prepared->spine;
    weft_real cos_u = at->cos_u;
    if (cos_u < (weft_real)STEEP_COSINE)
        cos_u = spine->cos_umax * cos(inside) + spine->sin_umax * sin(inside);
    return weft_spine_radius_at(&prepared->segment, spine, inside, at->sin_u, cos_u);
}

/* The integrand without its constant factors. */
static weft_real staple_integrand(const void *context, const weft_abscissa *where)
{
    const staple_piece *piece = context;
    const staple_problem *problem = piece->problem;
    const weft_prepared_segment *prepared = problem->prepared;
    weft_mirror at = {0};
    if (!staple_at(problem, where->x, &at) || !faces_both(&at, problem->light, problem->view))
        return 0;
    weft_real from_low = piece->t.low - problem->range.low + where->from_low;
    weft_real to_high = problem->range.high - piece->t.high + where->to_high;
    weft_real radius = radius_at(prepared, fmin(from_low, to_high), &at);
    return yarn_area(&prepared->segment, radius, at.cos_v) * (at.light_share * at.view_share);
}

/* Whether both directions are seen from the mirroring point, wherever v is. */
static bool staple_faces(const staple_problem *problem, weft_real t)
{
    weft_mirror at = {0};
    return staple_at(problem, t, &at) && faces_both(&at, problem->light, problem->view);
}

/* Where staple_faces changes between two places. */
static weft_real bisect_facing(const staple_problem *problem, weft_real faces, weft_real not )
{
    for (int i = 0; i < 60; i++) {
        weft_real middle = (faces + not ) / 2;
        *(staple_faces(problem, middle) ? &faces : &not ) = middle;
    }
    return faces;
}

static weft_real integrate_piece(const staple_problem *problem, weft_real low, weft_real high)
{
    staple_piece piece = {problem, {low, high}};
    return weft_integrate(staple_integrand, &piece, low, high);
}

/* Integral between two breaks, cut where the yarn turns away from one of the directions: there the integrand has a
 * kink. */
static weft_real integrate_between(const staple_problem *problem, weft_real low, weft_real high)
{
    enum { SAMPLES = 32 };
    weft_real sum = 0, start = low, before = low;
    bool faced = false;
    for (int i = 0; i < SAMPLES; i++) {
        weft_real theta = (weft_real)WEFT_PI * ((weft_real)i + (weft_real)0.5) / SAMPLES;
        weft_real t = weft_abscissa_at(low, high, theta).x;
        bool faces = staple_faces(problem, t);
        if (i > 0 && faces != faced) {
            weft_real cut = faces ? bisect_facing(problem, t, before) : bisect_facing(problem, before, t);
            sum += integrate_piece(problem, start, cut);
            start = cut;
        }
        before = t;
        faced = faces;
    }
    return sum + integrate_piece(problem, start, high);
}

enum { MAX_BREAKS = 16 };

static void insert(weft_real *breaks, int *count, weft_real t, interval range)
{
    if (!(t > range.low && t < range.high))
        return;
    int i = (*count)++;
    for (; i > 0 && breaks[i - 1] > t; i--)
        breaks[i] = breaks[i - 1];
    breaks[i] = t;
}

/* Where the staple integrand begins, ends, jumps or peaks, in increasing order with both ends of the yarn: |D| = 1
 * where |sin(u - u0)| = reach, |v| = pi/2 where u = u0 +- psi, both also half a turn away; the vertex of the spine, u =
 * 0. */
static int staple_breaks(const staple_problem *problem, weft_real reach, weft_real breaks[MAX_BREAKS])
{
    weft_real u0 = problem->from_u0 ? 0 : problem->u0;
    const weft_real edge[2] = {asin(fmin(reach, 1)), fabs(problem->prepared->segment.psi)};
    int count = 1;
    breaks[0] = problem->range.low;
    insert(breaks, &count, u0 - problem->u0, problem->range);
    for (int i = 0; i < 2; i++) {
        for (int turn = -1; turn <= 1; turn++) {
            insert(breaks, &count, u0 + edge[i] + (weft_real)turn * (weft_real)WEFT_PI, problem->range);
            insert(breaks, &count, u0 - edge[i] + (weft_real)turn * (weft_real)WEFT_PI, problem->range);
        }
    }
    breaks[count++] = problem->range.high;
    return count;
}

static weft_real staple_reflectance(const weft_prepared_segment *prepared, weft_vec3 half, weft_vec3 light,
                                    weft_vec3 view)
{
    staple_problem problem = {.prepared = prepared, .light = light, .view = view, .half = half};
    problem.u0 = atan2(half.y, half.z);
    problem.across = sqrt(half.y * half.y + half.z * half.z);
    weft_real umax = prepared->spine.umax;
    weft_real reach = sin(fabs(prepared->segment.psi)) * weft_length(half) / problem.across;
    problem.from_u0 = reach < prepared->spine.sin_umax;
    weft_real origin = problem.from_u0 ? problem.u0 : 0;
    problem.range = (interval){-umax - origin, umax - origin};
    weft_real breaks[MAX_BREAKS], sum = 0;
    int count = staple_breaks(&problem, reach, breaks);
    for (int i = 0; i + 1 < count; i++) {
        weft_real x = (breaks[i] + breaks[i + 1]) / 2 + (origin - problem.u0);
        if (fabs(sin(x)) < reach)
            sum += integrate_between(&problem, breaks[i], breaks[i + 1]);
    }
    return sum * prepared->inverse_sin_psi;
}

typedef struct filament_problem {
    weft_vec3 light, view;
    const weft_segment *segment;
    weft_real sin_u, cos_u, radius;
} filament_problem;

static weft_real filament_integrand(const void *context, const weft_abscissa *where)
{
    const filament_problem *problem = context;
    weft_real v = where->x;
    weft_mirror at = {.sin_u = problem->sin_u, .cos_u = problem->cos_u, .sin_v = sin(v), .cos_v = cos(v)};
    if (!faces_both(&at, problem->light, problem->view))
        return 0;
    return yarn_area(problem->segment, problem->radius, at.cos_v) * (at.light_share * at.view_share * at.cosine_sum);
}

/* Cuts to the v from which `direction` is seen: within pi/2 of its azimuth round the yarn. */
static interval cut_to_visible(interval range, const weft_mirror *at, weft_vec3 direction)
{
    weft_real azimuth = atan2(direction.x, direction.y * at->sin_u + direction.z * at->cos_u);
    const weft_real quarter = (weft_real)(WEFT_PI / 2);
    return (interval){fmax(range.low, azimuth - quarter), fmin(range.high, azimuth + quarter)};
}

static weft_real filament_reflectance(const weft_prepared_segment *prepared, weft_vec3 half, weft_vec3 light,
                                      weft_vec3 view)
{
    const weft_spine *spine = &prepared->spine;
    const weft_real quarter = (weft_real)(WEFT_PI / 2);
    weft_mirror at = {0};
    weft_real across = filament_mirror(half, &at), u = atan2(half.y, half.z);
    if (!(across > 0 && fabs(u) < spine->umax))
        return 0;
    filament_problem problem = {.light = light, .view = view, .segment = &prepared->segment, .sin_u = at.sin_u};
    problem.cos_u = at.cos_u;
    problem.radius = weft_filament_radius(prepared, spine, u, at.sin_u, at.cos_u);
    interval range = cut_to_visible(cut_to_visible((interval){-quarter, quarter}, &at, light), &at, view);
    if (!(range.low < range.high))
        return 0;
    return weft_integrate(filament_integrand, &problem, range.low, range.high) / across *
           filament_fade(prepared->segment.delta, spine->umax, u);
}

weft_real weft_prepared_reflectance(const weft_prepared_segment *prepared, weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half;
    if (!prepared->admissible || !half_vector(light, view, &half))
        return 0;
    weft_real integral = prepared->filament ? filament_reflectance(prepared, half, light, view)
                                            : staple_reflectance(prepared, half, light, view);
    return integral * prepared_phase(prepared, light, view);
}

weft_real weft_segment_reflectance(const weft_segment *segment, weft_vec3 light, weft_vec3 view)
{
    weft_prepared_segment prepared = weft_segment_prepare(segment);
    return weft_prepared_reflectance(&prepared, light, view);
}
