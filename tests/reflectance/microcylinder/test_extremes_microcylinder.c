/* No microcylinder thread or cloth, however extreme, gives NaN, infinity, a negative value or one above its bound. The
 * number of cases is the argument. Built twice: in double, and in single precision. */
#include "reflectance/microcylinder/microcylinder.h"
#include "tests/reflectance/extremes.h"

static long cases;

static const double pi = (double)WEFT_PI;

static weft_real extreme_tilt(uint64_t *random)
{
    return random_bits(random) & 1 ? EXTREMES_PICK(random, 0, 1e-12, 1.5707963, -1.5707963, 1)
                                   : random_between(random, -1.57, 1.57);
}

static weft_thread_optics extreme_optics(uint64_t *random)
{
    return (weft_thread_optics){.eta = EXTREMES_PICK(random, 1e-4, 0.7, 1, 1.00001, 1.5, 9999),
                                .gamma_s = EXTREMES_PICK(random, 1.01e-4, 1e-3, 0.2, 10, 9999),
                                .gamma_v = EXTREMES_PICK(random, 1.01e-4, 1e-3, 0.2, 10, 9999),
                                .kd = EXTREMES_PICK(random, 0, 1, 0.3),
                                .albedo = {EXTREMES_PICK(random, 0, 1e-30, 1, 9999), EXTREMES_PICK(random, 0, 1), 1}};
}

static weft_vec3 along(const weft_thread_tangent *t)
{
    return t->axis == WEFT_AXIS_X ? weft_vec3_of(t->cos_tilt, 0, t->sin_tilt)
                                  : weft_vec3_of(0, t->cos_tilt, t->sin_tilt);
}

/* Also along the thread, or within rounding of that. */
static weft_vec3 thread_direction(uint64_t *random, const weft_thread_tangent *tangent, weft_vec3 other)
{
    if (random_bits(random) % 5 != 0)
        return extremes_direction(random, other);
    weft_vec3 off = weft_scale(random_direction(random), EXTREMES_PICK(random, 0, 1e-30, 1e-12, 1e-6, 1e-3));
    weft_vec3 thread = weft_scale(along(tangent), random_bits(random) & 1 ? 1 : -1);
    return weft_unit(weft_add(thread, off));
}

/* ---- Bounds, in double ---- */

static double theta_of(const weft_thread_tangent *t, weft_vec3 d)
{
    double c = t->cos_tilt, s = t->sin_tilt, x = t->axis == WEFT_AXIS_X ? d.x : d.y,
           y = t->axis == WEFT_AXIS_X ? d.y : d.x;
    return atan2(c * x + s * d.z, hypot(c * d.z - s * x, y));
}

/* cos((theta_i - theta_o) / 2) */
static double cos_theta_difference(const weft_thread_tangent *tangent, weft_vec3 light, weft_vec3 view)
{
    return cos((theta_of(tangent, light) - theta_of(tangent, view)) / 2);
}

/* f_s cos(theta_i) M P / P: reflectance, transmittances, cosines, M and P are at most 1, gn at most 1 / (sqrt(pi) s),
 * cos(theta_i) at most cos(theta_i) + cos(theta_o) = 2 cos(theta_h) cos(theta_d). The library ends the pole where
 * cos(theta_d) is 1e-6, and knows it to rounding only. */
static double tangent_bound(const weft_thread_optics *optics, double cosine)
{
    double albedo = fmax(optics->albedo.r, fmax(optics->albedo.g, optics->albedo.b));
    double lobe = (1 - optics->kd) / (sqrt(pi) * optics->gamma_v) + optics->kd;
    const double rounding = 32 * (double)WEFT_REAL_EPSILON;
    double least = fmax(cosine - rounding, 0.9999e-6);
    return (2 * fmin(fmax(cosine, 1e-6) + rounding, 1) / (sqrt(pi) * optics->gamma_s) + albedo * lobe) /
           (least * least);
}

static bool colour_within(weft_rgb value, double bound)
{
    return extremes_within(value.r, bound) && extremes_within(value.g, bound) && extremes_within(value.b, bound);
}

/* ---- One tangent ---- */

static bool angles_within(const weft_thread_angles *angles)
{
    const weft_real half_pi = (weft_real)(pi / 2 * EXTREMES_SLACK);
    return extremes_within(angles->phi_difference, pi) && extremes_within(angles->cos_theta_difference, 1) &&
           extremes_within(angles->cos_half_phi, 1) && fabs(angles->theta_half) <= half_pi;
}

static bool tangent_case(uint64_t *random, long *lit)
{
    weft_thread_axis axis = random_bits(random) & 1 ? WEFT_AXIS_X : WEFT_AXIS_Y;
    weft_thread_tangent tangent = weft_thread_tangent_of(axis, extreme_tilt(random));
    weft_thread_optics optics = extreme_optics(random);
    weft_vec3 light = thread_direction(random, &tangent, weft_vec3_of(0, 0, 1));
    weft_vec3 view = thread_direction(random, &tangent, light);
    weft_thread_angles angles = weft_thread_angles_of(&tangent, light, view);
    weft_rgb scattering = weft_thread_scattering(&optics, &angles);
    weft_rgb lambert = {scattering.r * angles.cos_theta_light, scattering.g * angles.cos_theta_light,
                        scattering.b * angles.cos_theta_light};
    weft_real sigma = EXTREMES_PICK(random, 1.01e-4, 0.3, 100);
    *lit += scattering.b > 0;
    return angles_within(&angles) && extremes_within(weft_fresnel_reflectance(angles.cos_half_phi, optics.eta), 1) &&
           extremes_within(weft_fresnel_transmittance(angles.cos_theta_light, optics.eta), 1) &&
           extremes_within(weft_thread_shadowing(&angles, sigma), 1) &&
           extremes_within(weft_thread_projection(axis, sigma, light, view), 1) &&
           colour_within(lambert, tangent_bound(&optics, cos_theta_difference(&tangent, light, view)));
}

static void no_tangent_leaves_its_bounds(void **state)
{
    (void)state;
    extremes_run(tangent_case, cases);
}

/* ---- Cloth ---- */

static weft_cloth_thread extreme_thread(uint64_t *random)
{
    weft_cloth_thread thread = {.axis = random_bits(random) & 1 ? WEFT_AXIS_X : WEFT_AXIS_Y,
                                .point_count = 2 + (int)(random_bits(random) % 3),
                                .sample_count = 1 + (int)(random_bits(random) % 3),
                                .optics = extreme_optics(random),
                                .area_share = EXTREMES_PICK(random, 0, 1e-30, 0.5, 0.2)};
    for (int i = 0; i < thread.point_count; i++) {
        thread.tilt_rad[i] = extreme_tilt(random);
        thread.piece_length[i] = i == 0 ? 1 : EXTREMES_PICK(random, 0, 1e-20, 1, 100);
    }
    return thread;
}

/* What cloth returns is a mean over its tangents, by shares that sum to at most 1; as printed, by a_j N_j. */
static double cloth_bound(const weft_prepared_cloth *cloth, weft_cloth_weighting weighting, weft_vec3 light,
                          weft_vec3 view)
{
    double largest = 0;
    for (int j = 0; j < WEFT_CLOTH_THREADS; j++) {
        const weft_cloth_thread *thread = &cloth->cloth.thread[j];
        double share = weighting == WEFT_CLOTH_AS_PRINTED ? (double)thread->area_share : 1;
        for (int i = 0; i < thread->sample_count; i++)
            largest = fmax(largest, share * tangent_bound(&thread->optics,
                                                          cos_theta_difference(&cloth->tangent[j][i], light, view)));
    }
    return largest;
}

static bool cloth_case(uint64_t *random, long *lit)
{
    weft_microcylinder_cloth cloth = {.thread = {extreme_thread(random), extreme_thread(random)},
                                      .sigma = EXTREMES_PICK(random, 1.01e-4, 0.3, 100)};
    weft_prepared_cloth prepared = weft_microcylinder_prepare(&cloth);
    weft_vec3 light = thread_direction(random, &prepared.tangent[0][0], weft_vec3_of(0, 0, 1));
    weft_vec3 view = thread_direction(random, &prepared.tangent[1][0], light);
    weft_cloth_weighting weighting = random_bits(random) & 1 ? WEFT_CLOTH_BY_AREA : WEFT_CLOTH_AS_PRINTED;
    weft_rgb k = weft_microcylinder_scattering(&prepared, weighting, light, view);
    weft_rgb brdf = weft_microcylinder_brdf(&prepared, weighting, light, view);
    double bound = cloth_bound(&prepared, weighting, light, view);
    *lit += k.b > 0;
    return prepared.admissible && colour_within(k, bound) && colour_within(brdf, bound / fmax(light.z, 1e-6));
}

static void no_cloth_leaves_its_bounds(void **state)
{
    (void)state;
    extremes_run(cloth_case, cases);
}

int test_extremes_microcylinder(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_tangent_leaves_its_bounds),
        cmocka_unit_test(no_cloth_leaves_its_bounds),
    };
    cases = extremes_count();
    return cmocka_run_group_tests_name("extremes of microcylinder cloth", tests, NULL, NULL);
}
