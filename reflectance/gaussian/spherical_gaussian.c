#include "reflectance/gaussian/spherical_gaussian.h"

#define MIN_WIDTH 1e-9
#define QUARTER_TURN (WEFT_PI / 2)

static weft_real admissible_width(weft_real width)
{
    return fmax(width, (weft_real)MIN_WIDTH);
}

/* exp(-x^2 / width^2) */
static weft_real gaussian(weft_real x, weft_real width)
{
    weft_real scaled = x / admissible_width(width);
    return exp(-scaled * scaled);
}

weft_real weft_spherical_gaussian(weft_vec3 direction, weft_vec3 centre, weft_real width)
{
    return gaussian(weft_length(weft_subtract(direction, centre)), width);
}

weft_real weft_circular_gaussian(weft_real x, weft_real mean, weft_real width)
{
    return gaussian(2 * sin((x - mean) / 2), width);
}

/* Into -pi..pi. */
static weft_real wrapped(weft_real angle)
{
    const weft_real turn = (weft_real)(2 * WEFT_PI);
    return angle - turn * round(angle / turn);
}

/* With l = 2 / width^2: l exp(i mean) = l1 exp(i mean1) + l2 exp(i mean2) and scale = exp(l - l1 - l2). The narrower
 * lobe comes first and everything is divided by l1, so that nothing overflows; ratio = l2 / l1 <= 1. */
static weft_circular_lobe narrow_first(weft_real mean1, weft_real width1, weft_real mean2, weft_real width2)
{
    weft_real quotient = isinf(width2) ? 0 : width1 / width2, ratio = quotient * quotient;
    weft_real sine = sin((mean2 - mean1) / 2), cosine = cos((mean2 - mean1) / 2);
    weft_real excess = (1 - quotient) * (1 + quotient);
    weft_real total = sqrt(excess * excess + 4 * ratio * cosine * cosine);
    if (!(total > 0))
        return (weft_circular_lobe){0, INFINITY, gaussian(2, width1)};
    weft_real turn = atan2(2 * ratio * sine * cosine, excess + 2 * ratio * cosine * cosine);
    weft_real distance = 2 * sine * quotient * sqrt(2 / (total + 1 + ratio));
    return (weft_circular_lobe){wrapped(mean1 + turn), width1 / sqrt(total), gaussian(distance, width1)};
}

weft_circular_lobe weft_circular_product(weft_real mean1, weft_real width1, weft_real mean2, weft_real width2)
{
    width1 = admissible_width(width1);
    width2 = admissible_width(width2);
    if (isinf(width1) && isinf(width2))
        return (weft_circular_lobe){0, INFINITY, 1};
    return width1 <= width2 ? narrow_first(mean1, width1, mean2, width2) : narrow_first(mean2, width2, mean1, width1);
}

weft_gaussian_split weft_spherical_gaussian_split(weft_vec3 direction, weft_vec3 centre, weft_real width)
{
    weft_real cosine = sqrt(direction.y * direction.y + direction.z * direction.z);
    weft_real centre_cosine = sqrt(centre.y * centre.y + centre.z * centre.z);
    weft_real both = sqrt(cosine) * sqrt(centre_cosine);
    return (weft_gaussian_split){.theta = atan2(direction.x, cosine),
                                 .theta_centre = atan2(centre.x, centre_cosine),
                                 .phi = atan2(direction.z, direction.y),
                                 .phi_centre = atan2(centre.z, centre.y),
                                 .phi_width = both > 0 ? width / both : (weft_real)INFINITY};
}

/* erf(b) - erf(a), a <= b, from the tails where both are on one side. */
static weft_real erf_between(weft_real a, weft_real b)
{
    if (a > 0)
        return erfc(a) - erfc(b);
    if (b < 0)
        return erfc(-b) - erfc(-a);
    return erf(b) - erf(a);
}

/* Integral of exp(-(x - mean)^2 / width^2) over +-pi/2. */
static weft_real gaussian_over_half_turn(weft_real mean, weft_real width)
{
    const weft_real quarter = (weft_real)QUARTER_TURN;
    width = admissible_width(width);
    if (isinf(width))
        return 2 * quarter;
    return sqrt((weft_real)WEFT_PI) / 2 * width * erf_between((-quarter - mean) / width, (quarter - mean) / width);
}

weft_real weft_gaussian_box(weft_real theta_mean, weft_real theta_width, weft_real phi_mean, weft_real phi_width)
{
    return gaussian_over_half_turn(theta_mean, theta_width) * gaussian_over_half_turn(phi_mean, phi_width);
}

weft_real weft_sigmoid(weft_real gain, weft_real distance)
{
    weft_real x = gain * distance, e = exp(-fabs(x));
    return x >= 0 ? 1 / (1 + e) : e / (1 + e);
}
