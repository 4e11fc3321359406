#include "bench/numerics/claims.h"

#include <stddef.h>

static const numerics_claim claims[NUMERICS_MODELS] = {
    [NUMERICS_LOBE_POWER] =
        {"Power of a lobe, a^N", 1e-12, 0.0001, 0, 0.001, 5, 5, 1,
         "N log a large: the rounding of log a, times N log a. a^N ends at 1e30, and below the least number at 0"},
    [NUMERICS_LAFORTUNE] =
        {"Lafortune lobes in the frame of a texel", 1e-10, 2.5, 0, 0, 10, 15, 1,
         "as the power; and where the three products of directions cancel, a is the small rest: with "
         "N < 1, a^N is steep there and keeps no digit in float. Below a = 0 the lobe is 0"},
    [NUMERICS_TABLE_FIT] = {"Fit of T (eq. 4)", 1e-14, 1e-06, 0, 0, 10, 5, 1,
                            "nowhere: sums of squares, in double in every build. 1 where all f are 0"},
    [NUMERICS_INTERPOLATION] =
        {"Interpolation between directions", 1e-11, 0.005, 0, 0, 10, 20, 1,
         "next to a corner, where a weight is a small difference; it is kept from going below 0. Weights sum to 1"},
    [NUMERICS_EXTRAPOLATION] =
        {"Beyond the last ring", 5e-12, 0.005, 0, 0, 10, 20, 1,
         "as interpolation, along the border: the foot of the view on its nearest arc, or the corner"},
    [NUMERICS_MIP] =
        {"Material: T, S, lobes, texels and levels", 2e-13, 0.0001, 0, 0, 10, 20, 4,
         "next to the horizon and to the edges of lobes; u and v are reduced to the tile before they lose digits"},
    [NUMERICS_BARD_IN_PLANE] = {"BARD, turned in the plane", 1e-13, 0.0001, 0, 0, 200, 200, 1,
                                "light near the horizon: the elevation is kept at 3 degrees, so that the gain ends at "
                                "365. Next to the seam of the table"},
    [NUMERICS_BARD_PRINTED] = {"BARD, as printed", 2e-13, 0.01, 0, 0, 500, 500, 1,
                               "light and view next to the normal, where the printed angles have no azimuth"},
    [NUMERICS_FRESNEL_REFLECTANCE] =
        {"Fresnel reflectance", 2e-12, 0.001, 0, 0.0002, 10, 20, 1,
         "eta next to 1, where c and the refracted cosine cancel: absolute digits. 1 for c = 0"},
    [NUMERICS_FRESNEL_TRANSMITTANCE] = {"Fresnel transmittance", 5e-15, 5e-06, 0, 5e-06, 10, 10, 1,
                                        "nowhere: only positive terms. 0 for c = 0"},
    [NUMERICS_THREAD_SCATTERING] =
        {"Microcylinder: f_s of a tangent", 2e-12, 0.005, 0, 0.005, 500, 1000, 1,
         "opposite azimuths (see above), narrow gamma. 0 where both run along the thread in opposite ways"},
    [NUMERICS_THREAD_SHADOWING] = {"Microcylinder: M", 5e-12, 0.005, 0, 0.001, 10, 10, 1,
                                   "narrow sigma: twice the exponent times the rounding of phi_d"},
    [NUMERICS_THREAD_PROJECTION] = {"Microcylinder: P", 1e-12, 0.0005, 0, 0.0002, 10, 10, 1, "as M, with psi_d"},
    [NUMERICS_CLOTH_BY_AREA] = {"Microcylinder cloth: K by area", 2e-10, 0.005, 0, 0, 10, 20, 3,
                                "narrow gamma and sigma; 0 where no thread is met"},
    [NUMERICS_CLOTH_PRINTED_BRDF] =
        {"Microcylinder cloth: BRDF as printed", 5e-11, 0.01, 0, 0, 20, 20, 3,
         "light at the horizon, where wi_z counts as 1e-6 at least, and P is the quotient of two small numbers"},
    [NUMERICS_SPINE_RADIUS] = {"Woven: radius of the spine", 5e-10, 0.1, 0, 0, 100, 10, 1,
                               "the shortest yarns (l - w sin umax cancels), and the spike at the end of a steep yarn, "
                               "which is as narrow as pi/2 - umax"},
    [NUMERICS_PHASE] =
        {"Woven: phase function", 1e-12, 0.0005, 0, 0, 20, 10, 1,
         "large beta: beta times the rounding of x. Both exp and I0 are scaled, so that no beta overflows"},
    [NUMERICS_STAPLE_POINT] =
        {"Woven: staple point", 2e-05, 0.1, 0, 0, 10, 10, 1,
         "R (shortest yarns, steep ends), and c1 or c2 next to 0; the edge of the highlight is a jump, or steep as a "
         "square root"},
    [NUMERICS_FILAMENT_POINT] =
        {"Woven: filament point", 2e-10, 0.1, 0, 0, 20, 20, 1,
         "as staple; and H across the yarn, where 1/hypot(H_y, H_z) has its pole. H shorter than 1e-6 gives 0"},
    [NUMERICS_STAPLE_TEXTURE] = {"Woven: staple texture", 2e-08, 4, 2, 0.002, 10, 10, 1,
                                 "as the point, at the end of the yarn for kappa next to -1, where R keeps no digit in "
                                 "float; the edges of the band are jumps"},
    [NUMERICS_FILAMENT_TEXTURE] = {"Woven: filament texture", 2e-09, 0.1, 0.1, 0.005, 10, 10, 1,
                                   "as the point; the edges of the band are jumps"},
    [NUMERICS_STAPLE_REFLECTANCE] =
        {"Woven: staple integral", 5e-09, 0.0002, 0.0002, 0, 0, 40, 60,
         "spines with a spike; the tolerance of the integral in double, at most 2000 halvings"},
    [NUMERICS_FILAMENT_REFLECTANCE] = {"Woven: filament integral", 2e-09, 0.0001, 0.0001, 0, 0, 10, 20,
                                       "both directions grazing along x; the tolerance of the integral in double"},
    [NUMERICS_WEAVE_BRDF] =
        {"Weave: BRDF with noise", 2e-11, 0.1, 0, 0, 20, 20, 1,
         "as the texture, weakened by the diffuse term; cells of noise and of the pattern are jumps"},
    [NUMERICS_WEAVE_MEAN] = {"Weave: mean over the tile", 3e-08, 1e-05, 0, 0, 0, 5, 100,
                             "as the integrals, weakened by the diffuse term"},
    [NUMERICS_STORED_HALF] = {"A number in half", 0.001, 0, 0, 0, 0, 0, 1, ""},
    [NUMERICS_STORED_8_BITS] = {"T or S in 8 bits", 0.2, 0, 0, 0, 0, 0, 1, ""},
    [NUMERICS_STORED_6_BITS] = {"T or S in 6 bits", 1, 0, 0, 0, 0, 0, 1, ""},
    [NUMERICS_STORED_4_BITS] = {"T or S in 4 bits", 5, 0, 0, 0, 0, 0, 1, ""},
    [NUMERICS_STORED_NORMAL] = {"n_z of a frame in 16 bits", 10, 0, 0, 0, 0, 0, 1, ""},
};

const numerics_claim *numerics_claim_of(numerics_id id)
{
    return &claims[id];
}

double numerics_bound(const numerics_set *set, numerics_id id, numerics_objective objective)
{
    const numerics_claim *claim = &claims[id];
    if (set == &numerics_lanes)
        return objective == NUMERICS_RELATIVE ? claim->in_lanes : 0;
    if (objective == NUMERICS_RELATIVE)
        return set->single ? claim->in_float : claim->in_double;
    if (objective == NUMERICS_GROWTH && id < NUMERICS_STORED_HALF)
        return set->single ? claim->growth_float : claim->growth_double;
    return 0;
}

#define WIDTHS 10, 1e-4
const numerics_regime numerics_regimes[] = {
    {NUMERICS_LOBE_POWER, "N", {"N"}, 0.1, 1, 1e-3, 1e4},
    {NUMERICS_THREAD_SCATTERING, "gamma_s, gamma_v, rad", {"gamma_s", "gamma_v"}, 1, 0, 10, 1e-3},
    {NUMERICS_CLOTH_BY_AREA, "gamma_s, gamma_v, sigma, rad", {"gamma_s", "gamma_v", "sigma"}, 1, 0, 10, 1e-3},
    {NUMERICS_SPINE_RADIUS, "pi/2 - umax", {"umax"}, 0.6, 0.8, 0.1, 1e-7},
    {NUMERICS_SPINE_RADIUS, "kappa + 1", {"kappa"}, 0.7, 0.9, 0.1, 1e-7},
    {NUMERICS_SPINE_RADIUS, "kappa, relative distance from the parabola", {"kappa"}, 0.55, 0.7, 0.1, 1e-9},
    {NUMERICS_SPINE_RADIUS, "l / (w sin umax) - 1", {"l"}, 0.6, 1, 0.1, 1e-5},
    {NUMERICS_PHASE, "beta", {"beta"}, 0.5, 1, 1e-3, 1e3},
    {NUMERICS_STAPLE_POINT, "psi, rad", {"psi"}, 0.6, 0.8, 0.1, 1e-8},
    {NUMERICS_STAPLE_POINT, "pi/2 - umax", {"umax"}, 0.6, 0.8, 0.1, 1e-7},
    {NUMERICS_STAPLE_POINT, "kappa, relative distance from the parabola", {"kappa"}, 0.55, 0.7, 0.1, 1e-9},
    {NUMERICS_FILAMENT_POINT, "kappa, relative distance from the parabola", {"kappa"}, 0.55, 0.7, 0.1, 1e-9},
    {NUMERICS_STAPLE_REFLECTANCE, "psi, rad", {"psi"}, 0.6, 0.8, 0.1, 1e-8},
    {NUMERICS_STAPLE_REFLECTANCE, "pi/2 - umax", {"umax"}, 0.6, 0.8, 0.1, 1e-7},
};
const int numerics_regime_count = sizeof numerics_regimes / sizeof *numerics_regimes;
