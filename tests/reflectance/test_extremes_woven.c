/* No segment of woven cloth, however extreme, gives NaN, infinity, a negative value or one above its bound. The number
 * of cases is the argument. Built twice: in double, and in single precision. */
#include "reflectance/woven/woven.h"
#include "tests/reflectance/extremes.h"

static long cases;

static weft_real extreme_umax(uint64_t *random)
{
    switch (random_bits(random) % 4) {
    case 0:
        return extremes_logarithmic(random, -7, 0);
    case 1:
        return (weft_real)(WEFT_PI / 2) - extremes_logarithmic(random, -12, 0);
    case 2:
        return EXTREMES_PICK(random, 0, 1e-9, 1e-7, 1.5707963, 1.57079633, 2);
    default:
        return random_between(random, 0.05, 1.55);
    }
}

/* To -1, at the parabola 1 + kappa (1 + cot umax) = 0 and next to it, at the circle, and anything. */
static weft_real extreme_kappa(uint64_t *random, weft_real umax)
{
    double parabola = -1 / (1 + 1 / tan((double)umax));
    switch (random_bits(random) % 5) {
    case 0:
        return -1 + extremes_logarithmic(random, -15, 0);
    case 1:
        return (weft_real)(parabola * (1 + (double)EXTREMES_PICK(random, 0, 1e-15, -1e-12, 1e-9, -1e-6, 1e-3)));
    case 2:
        return EXTREMES_PICK(random, -2, -1, 0, 1, 1e4, 1e6);
    default:
        return random_between(random, -1, 1);
    }
}

static weft_real extreme_psi(uint64_t *random)
{
    weft_real sign = random_bits(random) & 1 ? 1 : -1;
    switch (random_bits(random) % 5) {
    case 0:
        return 0;
    case 1:
        return sign * extremes_logarithmic(random, -20, 0);
    case 2:
        return sign * ((weft_real)(WEFT_PI / 2) - extremes_logarithmic(random, -7, 0));
    default:
        return random_between(random, -1.5, 1.5);
    }
}

static weft_segment extreme_segment(uint64_t *random)
{
    weft_segment segment = {.alpha = EXTREMES_PICK(random, 0, 0.02, 0.1, 1, 1e4),
                            .beta = random_bits(random) & 1
                                        ? EXTREMES_PICK(random, 0, 1e-9, 3, -5, 88, 700, 1e4, -1e4, 1e30)
                                        : extremes_logarithmic(random, -3, 4),
                            .delta = EXTREMES_PICK(random, 0, 1e-9, 0.5, 1),
                            .psi = extreme_psi(random),
                            .umax = extreme_umax(random),
                            .highlight_width = EXTREMES_PICK(random, 1e-4, 0.3, 0.5, 1),
                            .frozen_radius = random_bits(random) % 4 == 0};
    segment.kappa = extreme_kappa(random, segment.umax);
    segment.width = EXTREMES_PICK(random, 1e-3, 0.5, 1, 1, 2, 1e4);
    weft_real shortest = segment.width * sin(segment.umax);
    segment.length = random_bits(random) & 1 ? shortest * (1 + extremes_logarithmic(random, -7, 1))
                                             : EXTREMES_PICK(random, 1e-3, 1, 2, 9, 1e4);
    return segment;
}

/* ---- Bounds, in double and by other formulas than those of the library ---- */

/* The phase function is largest straight ahead; exp(-b) I0(b) > 1 / sqrt(2 pi (b + 1)), which is within a factor 2.6.
 */
static double largest_phase(const weft_segment *segment)
{
    const double two_pi = 2 * (double)WEFT_PI;
    return segment->alpha + sqrt(two_pi * (fabs((double)segment->beta) + 1)) / two_pi;
}

/* The spine is a convex arc over the chord 2c that rises h, so it is no longer than 2 (c + h). Of a conic that starts
 * with the slope tan umax, h = c tan(t/2) / s with tan t = s tan umax, and c tanh(t/2) / |s| with tanh t = |s| tan umax
 * for s < 0; never more than c tan umax. */
static double longest_spine(const weft_segment *segment)
{
    double umax = segment->umax, slope = sin(umax) / fmax(cos(umax), 1e-17);
    double shape = 1 + (double)segment->kappa * (1 + 1 / slope),
           c = ((double)segment->length - segment->width * sin(umax)) / 2;
    double rise = slope;
    if (shape > 1e-6)
        rise = tan(atan(shape * slope) / 2) / shape;
    return 2 * (c + c * fmin(rise, slope));
}

/* c1 c2 / (c1 + c2)^2 is at most 1/4, so what one place of a staple yarn returns is at most fc times a quarter of its
 * area a (R + a) over |sin psi|; all of the yarn has R du = its length. For a filament c1 + c2 = H_x sin v + q cos v
 * with q = hypot(H_y, H_z). */
static double places_factor(const weft_segment *segment, weft_vec3 light, weft_vec3 view)
{
    double phase = largest_phase(segment);
    if (fabs((double)segment->psi) >= 1e-15)
        return phase / (4 * fabs(sin((double)segment->psi)));
    double across = fmax(hypot((double)light.y + view.y, (double)light.z + view.z), 1e-30);
    return phase * (fabs((double)light.x + view.x) / across + 1) / 4;
}

typedef struct segment_bounds {
    double point, texture, reflectance;
} segment_bounds;

static segment_bounds bounds_of(const weft_segment *segment, weft_real radius, weft_vec3 light, weft_vec3 view)
{
    double a = segment->width / 2, factor = places_factor(segment, light, view);
    bool staple = fabs((double)segment->psi) >= 1e-15;
    double point = factor * a * (radius + a);
    /* The texture rounds its place along the yarn otherwise than the point does, which shows at a spike of R. e(u) is
     * monotone in |u|, so R is largest in the middle or at the end. */
    weft_real largest = fmax(weft_spine_radius(segment, 0), weft_spine_radius(segment, segment->umax));
    double extent = (staple ? 2 * (double)segment->umax : (double)WEFT_PI) / segment->highlight_width;
    double texture = factor * a * (fmax(largest, radius) + a) * extent;
    double range = staple ? a * (longest_spine(segment) + 2 * a * segment->umax) : (double)WEFT_PI * a * (radius + a);
    /* A spike of R that is narrower than the rounding of u is known to its order of magnitude only. */
    if (WEFT_REAL_EPSILON > 1e-9)
        texture *= 8;
    return (segment_bounds){point, texture, factor * range};
}

/* ---- Cases ---- */

static bool segment_case(uint64_t *random, long *lit)
{
    weft_segment segment = extreme_segment(random);
    weft_vec3 light = extremes_direction(random, weft_vec3_of(0, 0, 1)), view = extremes_direction(random, light);
    weft_prepared_segment prepared = weft_segment_prepare(&segment);
    weft_real share =
        random_bits(random) & 1 ? EXTREMES_PICK(random, -0.5, -0.499, 0, 1e-9, 0.5) : random_between(random, -0.5, 0.5);
    weft_real coordinate = (prepared.filament ? (weft_real)WEFT_PI : 2 * prepared.spine.umax) * share;
    weft_yarn_point point = weft_yarn_highlight(&segment, coordinate, light, view);
    weft_real x = segment.width * (prepared.filament ? share : random_between(random, -0.5, 0.5));
    weft_real y = segment.length * (prepared.filament ? random_between(random, -0.5, 0.5) : share);
    weft_real texture = weft_prepared_texture(&prepared, segment.umax, x, y, light, view);
    segment_bounds bound = bounds_of(&segment, point.radius, light, view);
    *lit += point.integrand > 0;
    if (!prepared.admissible)
        return point.integrand == 0 && texture == 0;
    return extremes_within(point.integrand, bound.point) && extremes_within(texture, bound.texture) &&
           isfinite(point.geometry) && isfinite(point.radius) && isfinite(point.phase) &&
           extremes_within(point.attenuation, 0.5);
}

static void no_point_or_texture_value_leaves_its_bounds(void **state)
{
    (void)state;
    extremes_run(segment_case, cases);
}

static bool reflectance_case(uint64_t *random, long *lit)
{
    weft_segment segment = extreme_segment(random);
    weft_vec3 light = extremes_direction(random, weft_vec3_of(0, 0, 1)), view = extremes_direction(random, light);
    weft_real value = weft_segment_reflectance(&segment, light, view);
    weft_real radius = weft_yarn_highlight(&segment, 0, light, view).radius;
    *lit += value > 0;
    if (!weft_segment_admissible(&segment))
        return value == 0;
    return extremes_within(value, bounds_of(&segment, radius, light, view).reflectance);
}

static void no_reflectance_leaves_its_bounds(void **state)
{
    (void)state;
    extremes_run(reflectance_case, cases);
}

int test_extremes_woven(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_or_texture_value_leaves_its_bounds),
        cmocka_unit_test(no_reflectance_leaves_its_bounds),
    };
    cases = extremes_count();
    return cmocka_run_group_tests_name("extremes of woven cloth", tests, NULL, NULL);
}
