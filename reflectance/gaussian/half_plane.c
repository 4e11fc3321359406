/* The share of a product of circular Gaussians on one side of a line, and the sigmoid that stands for it. */
#include "reflectance/gaussian/spherical_gaussian.h"
#include "reflectance/quadrature/quadrature.h"

#include <stdbool.h>

#define QUARTER_TURN (WEFT_PI / 2)
#define MIN_WIDTH 1e-6

/* A Gaussian is below 1e-17 at this many widths. */
#define REACH 6.3

/* Gauss-Legendre rule of 24 points on [-1, 1]: the positive half. */
enum { GAUSS_PAIRS = 12 };
static const weft_real gauss_node[GAUSS_PAIRS] = {
    0.99518721999702136018, 0.9747285559713094982,  0.93827455200273275852, 0.88641552700440103421,
    0.82000198597390292195, 0.74012419157855436424, 0.64809365193697556925, 0.54542147138883953566,
    0.43379350762604513849, 0.31504267969616337439, 0.19111886747361630916, 0.064056892862605626085};
static const weft_real gauss_weight[GAUSS_PAIRS] = {
    0.012341229799987199547, 0.028531388628933663181, 0.044277438817419806169, 0.059298584915436780746,
    0.073346481411080305734, 0.086190161531953275917, 0.09761865210411388827,  0.10744427011596563478,
    0.11550566805372560135,  0.1216704729278033912,   0.12583745634682829612,  0.12793819534675215697};

/* Integral of gc(x; 0, width) from 0 to `end`, 0 <= end <= pi/2. With t = 2 sin(x/2) the integrand is
 * exp(-t^2/width^2) / sqrt(1 - t^2/4), which one rule resolves over the whole reach of the Gaussian. */
static weft_real lobe_integral(weft_real end, weft_real width)
{
    weft_real radius = fmin(2 * sin(end / 2), (weft_real)REACH * width) / 2, sum = 0;
    for (int i = 0; i < 2 * GAUSS_PAIRS; i++) {
        weft_real node = i < GAUSS_PAIRS ? -gauss_node[i] : gauss_node[i - GAUSS_PAIRS];
        weft_real t = radius * (1 + node), scaled = t / width;
        sum += gauss_weight[i % GAUSS_PAIRS] * exp(-scaled * scaled) / sqrt(1 - t * t / 4);
    }
    return sum * radius;
}

/* The line cos(gamma) theta + sin(gamma) phi + distance = 0 in the box, by the coordinate that it crosses more steeply
 * (inner) and the other one (outer). Both lobes are even, so signs of the coefficients do not matter. */
typedef struct half_plane {
    weft_real outer_width, inner_width;
    weft_real slope, offset; /* inner = slope outer + offset, 0 <= slope <= 1 */
    weft_real inner_half;    /* integral of the inner lobe over 0..pi/2 */
} half_plane;

/* The outer lobe times what the line leaves of the inner lobe beyond its half, relative to that half: -1..1. */
static weft_real outer_integrand(const void *context, const weft_abscissa *at)
{
    const half_plane *plane = context;
    weft_real inner = plane->slope * at->x + plane->offset;
    weft_real part = lobe_integral(fmin(fabs(inner), (weft_real)QUARTER_TURN), plane->inner_width);
    return weft_circular_gaussian(at->x, 0, plane->outer_width) * copysign(part / plane->inner_half, inner);
}

/* Breaks where the line meets the middle and the two sides of the box, in increasing order. */
static weft_real integrate_outer(const half_plane *plane, weft_real reach)
{
    const weft_real quarter = (weft_real)QUARTER_TURN;
    const weft_real flank = fmin((weft_real)REACH / 2 * plane->inner_width, quarter);
    const weft_real level[] = {-quarter, -flank, 0, flank, quarter};
    weft_real low = -reach, sum = 0;
    for (int i = 0; i <= 5; i++) {
        weft_real cut = i < 5 && plane->slope > 0 ? (level[i] - plane->offset) / plane->slope : reach;
        weft_real high = weft_clamp(cut, low, reach);
        if (high > low)
            sum += weft_integrate(outer_integrand, plane, low, high);
        low = high;
    }
    return sum;
}

weft_real weft_gaussian_half_plane(weft_real theta_width, weft_real phi_width, weft_real distance, weft_real gamma)
{
    weft_real theta_part = fabs(cos(gamma)), phi_part = fabs(sin(gamma));
    bool inner_phi = phi_part >= theta_part;
    theta_width = fmax(theta_width, (weft_real)MIN_WIDTH);
    phi_width = fmax(phi_width, (weft_real)MIN_WIDTH);
    half_plane plane = {.outer_width = inner_phi ? theta_width : phi_width,
                        .inner_width = inner_phi ? phi_width : theta_width,
                        .slope = inner_phi ? theta_part / phi_part : phi_part / theta_part,
                        .offset = distance / fmax(theta_part, phi_part)};
    const weft_real quarter = (weft_real)QUARTER_TURN;
    plane.inner_half = lobe_integral(quarter, plane.inner_width);
    weft_real reach = 2 * asin(fmin((weft_real)REACH * plane.outer_width, sqrt((weft_real)2)) / 2);
    weft_real outer_half = lobe_integral(quarter, plane.outer_width);
    return weft_clamp((1 + integrate_outer(&plane, reach) / (2 * outer_half)) / 2, 0, 1);
}

/* Gauss-Newton on the gain; the start has the slope of the share at distance 0. The residual is odd in the distance, so
 * half of the distances is enough. */
static weft_real fitted_gain(const weft_real *distance, const weft_real *share, int count, weft_real gain)
{
    enum { ITERATIONS = 20 };
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        weft_real product = 0, square = 0;
        for (int i = 0; i < count; i++) {
            weft_real value = weft_sigmoid(gain, distance[i]);
            weft_real slope = distance[i] * value * weft_sigmoid(gain, -distance[i]);
            product += slope * (share[i] - value);
            square += slope * slope;
        }
        weft_real step = square > 0 ? product / square : 0;
        gain += weft_clamp(step, -gain / 2, gain);
    }
    return gain;
}

weft_sigmoid_fit weft_gaussian_half_plane_fit(weft_real theta_width, weft_real phi_width, weft_real gamma)
{
    enum { DISTANCES = 32 };
    weft_real distance[DISTANCES], share[DISTANCES];
    for (int i = 0; i < DISTANCES; i++) {
        distance[i] = (weft_real)QUARTER_TURN * (weft_real)(i + 1) / DISTANCES;
        share[i] = weft_gaussian_half_plane(theta_width, phi_width, distance[i], gamma);
    }
    weft_real theta_spread = cos(gamma) * fmin(theta_width, 1), phi_spread = sin(gamma) * fmin(phi_width, 1);
    weft_real spread = sqrt(theta_spread * theta_spread + phi_spread * phi_spread);
    weft_real start = 4 / (sqrt((weft_real)WEFT_PI) * fmax(spread, (weft_real)MIN_WIDTH));
    weft_sigmoid_fit fit = {.gain = fitted_gain(distance, share, DISTANCES, start)};
    for (int i = 0; i < DISTANCES; i++)
        fit.largest_error = fmax(fit.largest_error, fabs(weft_sigmoid(fit.gain, distance[i]) - share[i]));
    return fit;
}
