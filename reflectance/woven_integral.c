/* Reflectance of a segment: the integral of its highlight along (staple) or round (filament) the yarn. */
#include "reflectance/quadrature.h"
#include "reflectance/woven_mirror.h"

typedef struct interval {
    weft_real low, high;
} interval;

typedef struct staple_problem {
    const weft_prepared_segment *prepared;
    weft_vec3 light, view, half;
    weft_real u0, across; /* H_y = across sin u0, H_z = across cos u0 */
} staple_problem;

/* The integrand at u = u0 + x without its constant factors. Measured from u0, D does not cancel for small psi:
 * H_y cos u - H_z sin u = -across sin x. */
static weft_real staple_integrand(const void *context, weft_real x)
{
    const staple_problem *problem = context;
    const weft_prepared_segment *prepared = problem->prepared;
    weft_real u = weft_clamp(problem->u0 + x, -prepared->spine.umax, prepared->spine.umax);
    mirror at = {.sin_u = sin(u), .cos_u = cos(u)};
    weft_real along = -problem->across * sin(x), across = problem->across * cos(x);
    if (!staple_mirror(prepared->cot_psi, problem->half.x, along, across, &at) ||
        !faces_both(&at, problem->light, problem->view))
        return 0;
    weft_real radius = spine_radius(&prepared->segment, &prepared->spine, u, at.sin_u, at.cos_u);
    return yarn_area(&prepared->segment, radius, at.cos_v) * (at.light_share * at.view_share);
}

enum { MAX_BREAKS = 16 };

static void insert(weft_real *breaks, int *count, weft_real x, interval range)
{
    if (!(x > range.low && x < range.high))
        return;
    int i = (*count)++;
    for (; i > 0 && breaks[i - 1] > x; i--)
        breaks[i] = breaks[i - 1];
    breaks[i] = x;
}

/* Where the staple integrand begins, ends or jumps, as x = u - u0 in increasing order with both ends of `range`: |D| =
 * 1 where |sin x| = reach, |v| = pi/2 where x = +-psi, both also opposite; and the nearest approach to |D| = 1 at
 * +-pi/2. */
static int staple_breaks(weft_real reach, weft_real psi, interval range, weft_real breaks[MAX_BREAKS])
{
    const weft_real pi = (weft_real)WEFT_PI;
    int count = 1;
    breaks[0] = range.low;
    const weft_real edge[2] = {asin(fmin(reach, 1)), psi};
    for (int i = 0; i < 2; i++) {
        for (int turn = -1; turn <= 1; turn++) {
            insert(breaks, &count, edge[i] + (weft_real)turn * pi, range);
            insert(breaks, &count, -edge[i] + (weft_real)turn * pi, range);
        }
    }
    breaks[count++] = range.high;
    return count;
}

static weft_real staple_reflectance(const weft_prepared_segment *prepared, weft_vec3 half, weft_vec3 light,
                                    weft_vec3 view)
{
    staple_problem problem = {.prepared = prepared, .light = light, .view = view, .half = half};
    problem.u0 = atan2(half.y, half.z);
    problem.across = sqrt(half.y * half.y + half.z * half.z);
    weft_real umax = prepared->spine.umax, psi = fabs(prepared->segment.psi);
    weft_real reach = sin(psi) * weft_length(half) / problem.across;
    weft_real breaks[MAX_BREAKS], sum = 0;
    int count = staple_breaks(reach, psi, (interval){-umax - problem.u0, umax - problem.u0}, breaks);
    for (int i = 0; i + 1 < count; i++)
        if (fabs(sin((breaks[i] + breaks[i + 1]) / 2)) < reach)
            sum += integrate(staple_integrand, &problem, breaks[i], breaks[i + 1]);
    return sum * prepared->inverse_sin_psi;
}

typedef struct filament_problem {
    weft_vec3 light, view;
    const weft_segment *segment;
    weft_real sin_u, cos_u, radius;
} filament_problem;

static weft_real filament_integrand(const void *context, weft_real v)
{
    const filament_problem *problem = context;
    mirror at = {.sin_u = problem->sin_u, .cos_u = problem->cos_u, .sin_v = sin(v), .cos_v = cos(v)};
    if (!faces_both(&at, problem->light, problem->view))
        return 0;
    return yarn_area(problem->segment, problem->radius, at.cos_v) * (at.light_share * at.view_share * at.cosine_sum);
}

/* Cuts to the v from which `direction` is seen: within pi/2 of its azimuth round the yarn. */
static interval cut_to_visible(interval range, const mirror *at, weft_vec3 direction)
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
    mirror at;
    weft_real across = filament_mirror(half, &at), u = atan2(half.y, half.z);
    if (!(across > 0 && fabs(u) < spine->umax))
        return 0;
    filament_problem problem = {.light = light, .view = view, .segment = &prepared->segment, .sin_u = at.sin_u};
    problem.cos_u = at.cos_u;
    problem.radius = spine_radius(&prepared->segment, spine, u, at.sin_u, at.cos_u);
    interval range = cut_to_visible(cut_to_visible((interval){-quarter, quarter}, &at, light), &at, view);
    if (!(range.low < range.high))
        return 0;
    return integrate(filament_integrand, &problem, range.low, range.high) / across *
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
