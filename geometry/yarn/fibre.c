#include "geometry/yarn/fibre.h"

#include "reflectance/microcylinder/microcylinder.h"

/* Inclinations further apart than this many widths leave no highlight: exp(-16). */
#define REACH_IN_WIDTHS 4
#define MIN_COSINE_SQUARED 1e-6

weft_fibre_view weft_fibre_seen_from(const weft_fibre *fibre, weft_vec3 tangent, weft_vec3 normal, weft_vec3 view)
{
    weft_fibre_view seen = {.fibre = fibre, .along = tangent};
    seen.out = weft_unit(weft_subtract(normal, weft_scale(tangent, weft_dot(normal, tangent))));
    seen.across = weft_cross(seen.out, tangent);
    seen.view = weft_vec3_of(weft_dot(view, seen.along), weft_dot(view, seen.across), weft_dot(view, seen.out));
    return seen;
}

/* The highlight for specular = 1. */
static weft_real highlight(const weft_fibre_view *seen, weft_vec3 light)
{
    static const weft_thread_tangent along_x = {WEFT_AXIS_X, 1, 0};
    const weft_fibre *fibre = seen->fibre;
    weft_real sine = weft_dot(light, seen->along);
    /* sin a + sin b = 2 sin((a + b) / 2) cos((a - b) / 2): far from the highlight without any angle. */
    if (fabs(sine + seen->view.x) > 2 * sin(fmin(REACH_IN_WIDTHS * fibre->highlight_rad, (weft_real)WEFT_PI / 2)))
        return 0;
    weft_vec3 local = weft_vec3_of(sine, weft_dot(light, seen->across), weft_dot(light, seen->out));
    weft_thread_angles angles = weft_thread_angles_of(&along_x, local, seen->view);
    weft_thread_optics optics = {.eta = fibre->refractive_index, .gamma_s = fibre->highlight_rad, .gamma_v = 1};
    weft_real cosine = fmax(angles.cos_theta_light, angles.cos_theta_view);
    return weft_thread_surface(&optics, &angles) / (4 * fmax(cosine * cosine, MIN_COSINE_SQUARED));
}

weft_rgb weft_fibre_brdf(const weft_fibre_view *seen, weft_vec3 light)
{
    const weft_rgb *diffuse = &seen->fibre->diffuse, *specular = &seen->fibre->specular;
    weft_real shine = specular->r > 0 || specular->g > 0 || specular->b > 0 ? highlight(seen, light) : 0;
    weft_real albedo = 1 / (weft_real)WEFT_PI;
    return (weft_rgb){diffuse->r * albedo + specular->r * shine, diffuse->g * albedo + specular->g * shine,
                      diffuse->b * albedo + specular->b * shine};
}
