/* Cloth of microcylinder threads (Sadeghi, Bisker, De Deken and Jensen 2013, in the form of Iwasaki, Mizutani,
 * Dobashi and Nishita 2014), with the corrections of docs/reference/models.md. Pure functions; directions are unit.
 * GLSL twin: reflectance/microcylinder/microcylinder.glsl.
 *
 * A thread runs along x (weft) or y (warp) of the cloth and is tilted out of its plane by tau: its tangent is
 * t = cos(tau) e + sin(tau) z. theta is the inclination of a direction to the plane across t, phi its azimuth in that
 * plane counted from m = unit(z - (z.t) t), psi its angle to z in the plane of e and z. Only |phi_i - phi_o| and
 * |psi_i - psi_o| matter. */
#ifndef WEFT_REFLECTANCE_MICROCYLINDER_MICROCYLINDER_H
#define WEFT_REFLECTANCE_MICROCYLINDER_MICROCYLINDER_H

#include "base/vector.h"

#include <stdbool.h>

/* ---- One tangent of a thread ---- */

typedef enum weft_thread_axis { WEFT_AXIS_X, WEFT_AXIS_Y } weft_thread_axis;

typedef struct weft_thread_tangent {
    weft_thread_axis axis;
    weft_real cos_tilt, sin_tilt;
} weft_thread_tangent;

/* Tilts beyond +-89.9 degrees are moved there: m is undefined for a thread along z. */
weft_thread_tangent weft_thread_tangent_of(weft_thread_axis axis, weft_real tilt_rad);

typedef struct weft_thread_optics {
    weft_real eta;     /* refractive index, 1.3..1.7 */
    weft_real gamma_s; /* width of the surface lobe, rad, > 0 */
    weft_real gamma_v; /* width of the volume lobe, rad, > 0 */
    weft_real kd;      /* isotropic share of volume scattering, 0..1 */
    weft_rgb albedo;   /* A >= 0 */
} weft_thread_optics;

/* Beyond these a thread or a cloth counts as inadmissible: they keep every value finite in single precision. */
#define WEFT_THREAD_MIN_WIDTH 1e-4 /* of gamma_s, gamma_v and sigma, rad */
#define WEFT_THREAD_MAX_PARAMETER 1e4

/* Whether the numbers are in range. Functions of one tangent expect that they are; a cloth checks its threads. */
bool weft_thread_optics_admissible(const weft_thread_optics *optics);

/* Where light and view lie round one tangent. A direction along the tangent has phi = 0. */
typedef struct weft_thread_angles {
    weft_real theta_light, theta_view, theta_half; /* theta_half = (theta_light + theta_view) / 2 */
    weft_real cos_theta_light, cos_theta_view;
    weft_real cos_theta_difference; /* cos((theta_light - theta_view) / 2) */
    weft_real phi_difference;       /* 0..pi */
    weft_real cos_phi_light, cos_phi_view;
    weft_real cos_half_phi; /* cos(phi_difference / 2) */
} weft_thread_angles;

weft_thread_angles weft_thread_angles_of(const weft_thread_tangent *tangent, weft_vec3 light, weft_vec3 view);

/* Unpolarised Fresnel reflectance of a dielectric of index eta for a cosine of incidence c, and 1 minus it without
 * cancellation at grazing incidence. */
weft_real weft_fresnel_reflectance(weft_real c, weft_real eta);
weft_real weft_fresnel_transmittance(weft_real c, weft_real eta);

/* f_rs: reflection by the surface of the thread. */
weft_real weft_thread_surface(const weft_thread_optics *optics, const weft_thread_angles *angles);

/* f_rv / A: scattering inside the thread; 0 where both directions run along it. */
weft_real weft_thread_volume(const weft_thread_optics *optics, const weft_thread_angles *angles);

/* f_s = (f_rs + f_rv) / cos^2 theta_d, 1/sr; symmetric in light and view. 0 for cos theta_d < 1e-6, where both run
 * along the thread in opposite ways and f_s has an integrable pole. */
weft_rgb weft_thread_scattering(const weft_thread_optics *optics, const weft_thread_angles *angles);

/* M: the share of light and view that neighbouring threads leave, correlated within `sigma` of each other (Sadeghi et
 * al. 2013, after Ashikhmin et al. 2000). */
weft_real weft_thread_shadowing(const weft_thread_angles *angles, weft_real sigma);

/* |psi_i - psi_o| in 0..pi, and P: how much of the threads along an axis light and view meet. P does not depend on the
 * tilt. */
weft_real weft_thread_psi_difference(weft_thread_axis axis, weft_vec3 light, weft_vec3 view);
weft_real weft_thread_projection(weft_thread_axis axis, weft_real sigma, weft_vec3 light, weft_vec3 view);

/* ---- Cloth ---- */

enum { WEFT_CLOTH_THREADS = 2, WEFT_THREAD_MAX_POINTS = 16, WEFT_THREAD_MAX_SAMPLES = 64 };

typedef struct weft_cloth_thread {
    weft_thread_axis axis;
    int point_count;                                /* 2..16 */
    weft_real tilt_rad[WEFT_THREAD_MAX_POINTS];     /* at the control points; linear between them */
    weft_real piece_length[WEFT_THREAD_MAX_POINTS]; /* [point_count - 1], >= 0, any unit */
    int sample_count;                               /* tangents: 1..64, at (i + 1/2) / count of the length */
    weft_thread_optics optics;
    weft_real area_share; /* a >= 0; those of both threads sum to at most 1 */
} weft_cloth_thread;

typedef struct weft_microcylinder_cloth {
    weft_cloth_thread thread[WEFT_CLOTH_THREADS];
    weft_real sigma; /* of M and P, rad */
} weft_microcylinder_cloth;

/* Whether such a cloth exists. Every function below gives 0 for one that does not. */
bool weft_microcylinder_admissible(const weft_microcylinder_cloth *cloth);

/* A cloth with its tangents. */
typedef struct weft_prepared_cloth {
    weft_microcylinder_cloth cloth;
    bool admissible;
    weft_thread_tangent tangent[WEFT_CLOTH_THREADS][WEFT_THREAD_MAX_SAMPLES];
} weft_prepared_cloth;

weft_prepared_cloth weft_microcylinder_prepare(const weft_microcylinder_cloth *cloth);

/* How threads share the cloth. */
typedef enum weft_cloth_weighting {
    WEFT_CLOTH_BY_AREA,   /* by area, whatever the numbers of samples; area without thread is black. The default */
    WEFT_CLOTH_AS_PRINTED /* Iwasaki et al. 2014, eq. 7: two equal threads lose a factor 2 */
} weft_cloth_weighting;

/* K: radiance leaving per radiance arriving and steradian; it holds the cosine of the thread, none of the surface.
 * Finite at grazing light. 0 where light or view is below the horizon. */
weft_rgb weft_microcylinder_scattering(const weft_prepared_cloth *prepared, weft_cloth_weighting weighting,
                                       weft_vec3 light, weft_vec3 view);

/* The equivalent BRDF K / light.z, 1/sr. It grows at grazing light; light.z counts as 1e-6 at least. */
weft_rgb weft_microcylinder_brdf(const weft_prepared_cloth *prepared, weft_cloth_weighting weighting, weft_vec3 light,
                                 weft_vec3 view);

/* The one-line table that microcylinder.glsl reads:
 *     0              1 = admissible, sigma, area without thread, 0
 *     1 + 67 j + 0   thread j: 0 = x or 1 = y, number of samples, area share, 0
 *              + 1   eta, gamma_s, gamma_v, kd
 *              + 2   albedo r, g, b; 0
 *              + 3.. tangents: cos tilt, sin tilt, 0, 0 */
enum { WEFT_MICROCYLINDER_TABLE_WIDTH = 1 + WEFT_CLOTH_THREADS * (3 + WEFT_THREAD_MAX_SAMPLES) };

/* Writes the table, RGBA, to rgba [WEFT_MICROCYLINDER_TABLE_WIDTH][4]. */
void weft_microcylinder_table(const weft_prepared_cloth *prepared, float (*rgba)[4]);

#endif
