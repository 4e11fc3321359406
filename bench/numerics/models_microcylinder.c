/* Microcylinder cloth: one tangent, and cloth of two threads with two control points each. */
#include "bench/numerics/take.h"
#include "reflectance/microcylinder/microcylinder.h"

numerics_value numerics_fresnel_reflectance(const double *a)
{
    weft_real c = take(&a), eta = take(&a);
    return plain_value(weft_fresnel_reflectance(c, eta));
}

numerics_value numerics_fresnel_transmittance(const double *a)
{
    weft_real c = take(&a), eta = take(&a);
    return plain_value(weft_fresnel_transmittance(c, eta));
}

/* The columns of microcylinder_thread.csv. */
typedef struct thread_case {
    weft_thread_tangent tangent;
    weft_thread_optics optics;
    weft_real sigma;
    weft_vec3 light, view;
} thread_case;

static thread_case thread_of(const double *a)
{
    thread_case t;
    weft_thread_axis axis = take(&a) > (weft_real)0.5 ? WEFT_AXIS_Y : WEFT_AXIS_X;
    t.tangent = weft_thread_tangent_of(axis, take(&a) * ((weft_real)WEFT_PI / 180));
    t.optics.eta = take(&a);
    t.optics.gamma_s = take(&a);
    t.optics.gamma_v = take(&a);
    t.optics.kd = take(&a);
    weft_real albedo = take(&a);
    t.optics.albedo = (weft_rgb){albedo, albedo, albedo};
    t.sigma = take(&a);
    t.light = take_direction(&a);
    t.view = take_direction(&a);
    return t;
}

numerics_value numerics_thread_scattering(const double *a)
{
    thread_case t = thread_of(a);
    weft_thread_angles angles = weft_thread_angles_of(&t.tangent, t.light, t.view);
    weft_real cosine = angles.cos_theta_difference, scale = 1 / (sqrt((weft_real)WEFT_PI) * t.optics.gamma_s);
    return scaled_value(weft_thread_scattering(&t.optics, &angles).r, scale / (cosine * cosine));
}

numerics_value numerics_thread_shadowing(const double *a)
{
    thread_case t = thread_of(a);
    weft_thread_angles angles = weft_thread_angles_of(&t.tangent, t.light, t.view);
    return scaled_value(weft_thread_shadowing(&angles, t.sigma), 1);
}

numerics_value numerics_thread_projection(const double *a)
{
    thread_case t = thread_of(a);
    return scaled_value(weft_thread_projection(t.tangent.axis, t.sigma, t.light, t.view), 1);
}

/* Both threads are of the same fibre and differ in their tilts and shares. */
static weft_prepared_cloth cloth_of(const double **a)
{
    weft_microcylinder_cloth cloth = {.sigma = take(a)};
    weft_thread_optics optics = {.eta = take(a)};
    optics.gamma_s = take(a);
    optics.gamma_v = take(a);
    optics.kd = take(a);
    optics.albedo.r = optics.albedo.g = optics.albedo.b = take(a);
    for (int j = 0; j < WEFT_CLOTH_THREADS; j++) {
        weft_cloth_thread *thread = &cloth.thread[j];
        *thread = (weft_cloth_thread){.axis = j ? WEFT_AXIS_Y : WEFT_AXIS_X, .point_count = 2, .sample_count = 3};
        thread->tilt_rad[0] = take(a);
        thread->tilt_rad[1] = take(a);
        thread->piece_length[0] = 1;
        thread->optics = optics;
        thread->area_share = take(a);
    }
    return weft_microcylinder_prepare(&cloth);
}

numerics_value numerics_cloth_by_area(const double *a)
{
    weft_prepared_cloth cloth = cloth_of(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    return plain_value(weft_microcylinder_scattering(&cloth, WEFT_CLOTH_BY_AREA, light, view).r);
}

numerics_value numerics_cloth_printed_brdf(const double *a)
{
    weft_prepared_cloth cloth = cloth_of(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    return plain_value(weft_microcylinder_brdf(&cloth, WEFT_CLOTH_AS_PRINTED, light, view).r);
}
