/* One tangent of a microcylinder thread: angles, scattering, shadowing. */
#include "reflectance/microcylinder/microcylinder.h"

#define MAX_TILT (89.9 * WEFT_PI / 180)
#define MIN_COS_THETA_DIFFERENCE 1e-6
#define MIN_PLANE_SQUARED 1e-36
#define INVERSE_SQRT_PI 0.56418958354775628695

weft_thread_tangent weft_thread_tangent_of(weft_thread_axis axis, weft_real tilt_rad)
{
    weft_real tilt = weft_clamp(tilt_rad, (weft_real)-MAX_TILT, (weft_real)MAX_TILT);
    return (weft_thread_tangent){axis, cos(tilt), sin(tilt)};
}

static bool in_range(weft_real x, double low)
{
    return x >= (weft_real)low && x <= (weft_real)WEFT_THREAD_MAX_PARAMETER;
}

bool weft_thread_optics_admissible(const weft_thread_optics *optics)
{
    return in_range(optics->eta, WEFT_THREAD_MIN_WIDTH) && in_range(optics->gamma_s, WEFT_THREAD_MIN_WIDTH) &&
           in_range(optics->gamma_v, WEFT_THREAD_MIN_WIDTH) && in_range(optics->kd, 0) && optics->kd <= 1 &&
           in_range(optics->albedo.r, 0) && in_range(optics->albedo.g, 0) && in_range(optics->albedo.b, 0);
}

/* An angle in a plane by its cosine and sine, so that differences of angles need no wrapping. */
typedef struct plane_angle {
    weft_real cosine, sine;
} plane_angle;

/* Angle of (x, y), 0 for one whose square has no digits left in single precision; *length is that of (x, y). */
static plane_angle plane_angle_of(weft_real x, weft_real y, weft_real *length)
{
    weft_real square = x * x + y * y;
    *length = sqrt(square);
    return square > (weft_real)MIN_PLANE_SQUARED ? (plane_angle){x / *length, y / *length} : (plane_angle){1, 0};
}

static weft_real absolute_difference(plane_angle a, plane_angle b)
{
    return atan2(fabs(a.cosine * b.sine - a.sine * b.cosine), a.cosine * b.cosine + a.sine * b.sine);
}

/* A direction seen from a thread. */
typedef struct thread_direction {
    weft_real sin_theta, cos_theta;
    plane_angle phi;
} thread_direction;

static thread_direction thread_direction_of(const weft_thread_tangent *tangent, weft_vec3 d)
{
    weft_real along = tangent->axis == WEFT_AXIS_X ? d.x : d.y, across = tangent->axis == WEFT_AXIS_X ? d.y : -d.x;
    thread_direction seen;
    seen.sin_theta = tangent->cos_tilt * along + tangent->sin_tilt * d.z;
    seen.phi = plane_angle_of(tangent->cos_tilt * d.z - tangent->sin_tilt * along, across, &seen.cos_theta);
    return seen;
}

/* exp(i theta_light) + exp(i theta_view) has the length 2 cos(theta_difference), which cancels nowhere; likewise
 * phi. */
weft_thread_angles weft_thread_angles_of(const weft_thread_tangent *tangent, weft_vec3 light, weft_vec3 view)
{
    thread_direction in = thread_direction_of(tangent, light), out = thread_direction_of(tangent, view);
    weft_thread_angles angles = {.theta_light = atan2(in.sin_theta, in.cos_theta),
                                 .theta_view = atan2(out.sin_theta, out.cos_theta),
                                 .cos_theta_light = in.cos_theta,
                                 .cos_theta_view = out.cos_theta,
                                 .phi_difference = absolute_difference(in.phi, out.phi),
                                 .cos_phi_light = in.phi.cosine,
                                 .cos_phi_view = out.phi.cosine};
    weft_real half_length;
    angles.theta_half = (angles.theta_light + angles.theta_view) / 2;
    plane_angle_of(in.cos_theta + out.cos_theta, in.sin_theta + out.sin_theta, &half_length);
    angles.cos_theta_difference = fmin(half_length / 2, 1);
    plane_angle_of(in.phi.cosine + out.phi.cosine, in.phi.sine + out.phi.sine, &half_length);
    angles.cos_half_phi = fmin(half_length / 2, 1);
    return angles;
}

/* eta times the cosine of refraction; negative under total reflection. */
static weft_real refracted_cosine(weft_real c, weft_real eta)
{
    weft_real square = (eta - 1) * (eta + 1) + c * c;
    return square > 0 ? sqrt(square) : -1;
}

weft_real weft_fresnel_reflectance(weft_real c, weft_real eta)
{
    weft_real refracted = refracted_cosine(c, eta);
    if (!(c > 0 && refracted > 0))
        return 1;
    weft_real across = (c - refracted) / (c + refracted);
    weft_real along = (eta * eta * c - refracted) / (eta * eta * c + refracted);
    return (across * across + along * along) / 2;
}

weft_real weft_fresnel_transmittance(weft_real c, weft_real eta)
{
    weft_real refracted = refracted_cosine(c, eta);
    if (!(c > 0 && refracted > 0))
        return 0;
    weft_real across = c + refracted, along = eta * c + refracted / eta;
    return 2 * c * refracted * (1 / (across * across) + 1 / (along * along));
}

/* exp(-x^2 / width^2) */
static weft_real gaussian(weft_real x, weft_real width)
{
    weft_real scaled = x / width;
    return exp(-scaled * scaled);
}

static weft_real normalised_gaussian(weft_real x, weft_real width)
{
    return gaussian(x, width) * ((weft_real)INVERSE_SQRT_PI / width);
}

weft_real weft_thread_surface(const weft_thread_optics *optics, const weft_thread_angles *angles)
{
    weft_real incidence = angles->cos_theta_difference * angles->cos_half_phi;
    return weft_fresnel_reflectance(incidence, optics->eta) * angles->cos_half_phi *
           normalised_gaussian(angles->theta_half, optics->gamma_s);
}

weft_real weft_thread_volume(const weft_thread_optics *optics, const weft_thread_angles *angles)
{
    weft_real cosines = angles->cos_theta_light + angles->cos_theta_view;
    if (!(cosines > 0))
        return 0;
    weft_real transmitted = weft_fresnel_transmittance(angles->cos_theta_light, optics->eta) *
                            weft_fresnel_transmittance(angles->cos_theta_view, optics->eta);
    weft_real lobe = (1 - optics->kd) * normalised_gaussian(angles->theta_half, optics->gamma_v) + optics->kd;
    return transmitted * lobe / cosines;
}

weft_rgb weft_thread_scattering(const weft_thread_optics *optics, const weft_thread_angles *angles)
{
    weft_real cosine = angles->cos_theta_difference;
    if (!(cosine >= (weft_real)MIN_COS_THETA_DIFFERENCE))
        return (weft_rgb){0};
    weft_real surface = weft_thread_surface(optics, angles) / (cosine * cosine);
    weft_real volume = weft_thread_volume(optics, angles) / (cosine * cosine);
    return (weft_rgb){surface + volume * optics->albedo.r, surface + volume * optics->albedo.g,
                      surface + volume * optics->albedo.b};
}

/* Independent visibilities where `correlation` is 0, the smaller one where it is 1. */
static weft_real joint_visibility(weft_real correlation, weft_real light, weft_real view)
{
    weft_real y = fmax(light, 0), z = fmax(view, 0);
    return (1 - correlation) * y * z + correlation * fmin(y, z);
}

weft_real weft_thread_shadowing(const weft_thread_angles *angles, weft_real sigma)
{
    return joint_visibility(gaussian(angles->phi_difference, sigma), angles->cos_phi_light, angles->cos_phi_view);
}

static plane_angle psi_of(weft_thread_axis axis, weft_vec3 d)
{
    weft_real length;
    return plane_angle_of(d.z, axis == WEFT_AXIS_X ? d.x : d.y, &length);
}

weft_real weft_thread_psi_difference(weft_thread_axis axis, weft_vec3 light, weft_vec3 view)
{
    return absolute_difference(psi_of(axis, light), psi_of(axis, view));
}

weft_real weft_thread_projection(weft_thread_axis axis, weft_real sigma, weft_vec3 light, weft_vec3 view)
{
    plane_angle in = psi_of(axis, light), out = psi_of(axis, view);
    return joint_visibility(gaussian(absolute_difference(in, out), sigma), in.cosine, out.cosine);
}
