#include "reflectance/woven/mirror.h"
#include "reflectance/woven/woven.h"

/* A twist below this is that of a filament: 1 / sin psi would leave the range of single precision. */
#define FILAMENT_PSI 1e-15

/* Where the power series of I0 hands over to the asymptotic one: there the smallest term is exp(-2 * 20). */
#define BESSEL_SWITCH 20

/* Decimal files round pi/2 up; the spine then ends at pi/2. */
#define UMAX_SLACK 1e-7

static bool within(weft_real x, weft_real low, weft_real high)
{
    return x >= low && x <= high;
}

bool weft_segment_admissible(const weft_segment *segment)
{
    const weft_real large = (weft_real)WEFT_SEGMENT_MAX_PARAMETER;
    return within(segment->alpha, 0, large) && isfinite(segment->beta) && within(segment->delta, 0, 1) &&
           fabs(segment->psi) < (weft_real)(WEFT_PI / 2) &&
           within(segment->umax, (weft_real)WEFT_SEGMENT_MIN_UMAX, (weft_real)(WEFT_PI / 2 + UMAX_SLACK)) &&
           segment->kappa > -1 && segment->kappa <= large && segment->width > 0 && segment->width <= large &&
           segment->length > 0 && segment->length <= large && segment->width * sin(segment->umax) < segment->length &&
           within(segment->highlight_width, (weft_real)WEFT_SEGMENT_MIN_HIGHLIGHT_WIDTH, 1);
}

/* exp(-b) I0(b), b >= 0 (Abramowitz and Stegun 1964, 9.6.12 and 9.7.1). All terms are positive, so nothing cancels. */
static weft_real scaled_bessel_i0(weft_real b)
{
    weft_real term = 1, sum = 1;
    if (b <= BESSEL_SWITCH) {
        for (int k = 1; term > sum * (weft_real)(WEFT_REAL_EPSILON / 4); k++) {
            weft_real factor = b / (2 * (weft_real)k);
            term *= factor * factor;
            sum += term;
        }
        return sum * exp(-b);
    }
    for (int k = 1; k <= BESSEL_SWITCH && term > sum * (weft_real)(WEFT_REAL_EPSILON / 4); k++) {
        weft_real odd = 2 * (weft_real)k - 1;
        term *= odd * odd / (8 * (weft_real)k) / b;
        sum += term;
    }
    return sum / (sqrt(2 * (weft_real)WEFT_PI) * sqrt(b));
}

static weft_real phase_scale(weft_real beta)
{
    return 1 / (2 * (weft_real)WEFT_PI * scaled_bessel_i0(fabs(beta)));
}

weft_real weft_phase_function(weft_real alpha, weft_real beta, weft_real x)
{
    return alpha + exp(beta * weft_clamp(x, -1, 1) - fabs(beta)) * phase_scale(beta);
}

/* e(umax); the hyperbola's form does not cancel as kappa approaches -1. */
static weft_real end_factor(weft_real kappa, weft_real shape, weft_real sin_umax, weft_real cos_umax)
{
    if (shape < 0)
        return (1 + kappa) * (cos_umax + sin_umax) * (cos_umax - shape * sin_umax);
    return cos_umax * cos_umax + shape * shape * sin_umax * sin_umax;
}

weft_spine weft_segment_spine(const weft_segment *segment, weft_real umax)
{
    umax = fmin(umax, (weft_real)(WEFT_PI / 2));
    weft_spine spine = {.umax = umax, .sin_umax = sin(umax), .cos_umax = fmax(cos(umax), 0)};
    spine.shape = (1 + segment->kappa) + segment->kappa * (spine.cos_umax / spine.sin_umax);
    weft_real half_length = fmax(segment->length - segment->width * spine.sin_umax, 0) / 2;
    weft_real end = end_factor(segment->kappa, spine.shape, spine.sin_umax, spine.cos_umax);
    spine.scale = half_length / spine.sin_umax * sqrt(end);
    return spine;
}

/* e(u) of a hyperbola, (cos u - |shape| sin|u|) (cos u + |shape| sin|u|). The first factor cancels near umax as kappa
 * approaches -1; written with sin(umax - |u|) it is a sum of positive terms. */
static weft_real hyperbola_factor(const weft_segment *segment, const weft_spine *spine, weft_real inside,
                                  weft_real sin_u, weft_real cos_u)
{
    weft_real sin_abs_u = fabs(sin_u), end = (1 + segment->kappa) * (spine->sin_umax + spine->cos_umax);
    return (sin(inside) + end * sin_abs_u) / spine->sin_umax * (cos_u - spine->shape * sin_abs_u);
}

weft_real weft_spine_radius_at(const weft_segment *segment, const weft_spine *spine, weft_real inside, weft_real sin_u,
                               weft_real cos_u)
{
    /* A u that is rounded beyond umax must not leave the spine: R has its pole just there. */
    cos_u = fmax(cos_u, spine->cos_umax);
    weft_real e = spine->shape < 0 ? hyperbola_factor(segment, spine, fmax(inside, 0), sin_u, cos_u)
                                   : cos_u * cos_u + spine->shape * spine->shape * sin_u * sin_u;
    return spine->scale / (e * sqrt(e));
}

weft_real weft_filament_radius(const weft_prepared_segment *prepared, const weft_spine *spine, weft_real u,
                               weft_real sin_u, weft_real cos_u)
{
    if (!(prepared->radius_share < 1))
        return weft_spine_radius_at(&prepared->segment, spine, spine->umax - fabs(u), sin_u, cos_u);
    weft_real end = fmax(spine->umax * prepared->radius_share, (weft_real)WEFT_SEGMENT_MIN_UMAX);
    weft_real at = fmin(fabs(u), end);
    weft_spine shorter = weft_segment_spine(&prepared->segment, end);
    return weft_spine_radius_at(&prepared->segment, &shorter, end - at, sin(at), cos(at));
}

weft_real weft_spine_radius(const weft_segment *segment, weft_real u)
{
    if (!weft_segment_admissible(segment) || !(fabs(u) <= segment->umax))
        return 0;
    weft_spine spine = weft_segment_spine(segment, segment->umax);
    return weft_spine_radius_at(segment, &spine, spine.umax - fabs(u), sin(u), cos(u));
}

weft_prepared_segment weft_segment_prepare(const weft_segment *segment)
{
    weft_prepared_segment prepared = {.segment = *segment};
    prepared.admissible = weft_segment_admissible(segment);
    if (!prepared.admissible)
        return prepared;
    prepared.filament = fabs(segment->psi) < (weft_real)FILAMENT_PSI;
    if (!prepared.filament) {
        prepared.cot_psi = cos(segment->psi) / sin(segment->psi);
        prepared.inverse_sin_psi = 1 / fabs(sin(segment->psi));
    } else if (segment->psi != 0) {
        prepared.segment.delta = 0;
    }
    prepared.phase_scale = phase_scale(segment->beta);
    prepared.radius_share = prepared.filament && segment->frozen_radius ? 1 - prepared.segment.delta : 1;
    prepared.spine = weft_segment_spine(segment, segment->umax);
    return prepared;
}
