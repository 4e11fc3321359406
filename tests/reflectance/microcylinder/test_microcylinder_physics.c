/* What must hold for any microcylinder cloth. Built twice: in double, and in single precision. */
#include "reflectance/microcylinder/microcylinder.h"
#include "tests/reflectance/random.h"
#include "tests/support/cmocka_all.h"

static const double same = (WEFT_REAL_EPSILON < 1e-9) ? 1e-12 : 2e-5;

static weft_real one_of(uint64_t *random, const weft_real *values, int count)
{
    return values[random_bits(random) % (uint64_t)count];
}

static weft_thread_tangent random_tangent(uint64_t *random)
{
    const weft_real tilts[] = {0, (weft_real)1e-12, (weft_real)(WEFT_PI / 2), (weft_real)(-WEFT_PI / 2), 1};
    bool extreme = random_bits(random) & 1;
    weft_real tilt_rad = extreme ? one_of(random, tilts, 5) : random_between(random, -1.57, 1.57);
    return weft_thread_tangent_of(random_bits(random) & 1 ? WEFT_AXIS_X : WEFT_AXIS_Y, tilt_rad);
}

static weft_thread_optics random_optics(uint64_t *random)
{
    const weft_real widths[] = {(weft_real)1.01e-4, (weft_real)1e-3, (weft_real)0.2, 10, 9999};
    const weft_real indices[] = {(weft_real)1e-4, (weft_real)0.7, 1, (weft_real)1.00001, (weft_real)1.5, 9999};
    const weft_real shares[] = {0, 1, (weft_real)0.3};
    const weft_real albedos[] = {0, (weft_real)1e-30, 1, 9999};
    return (weft_thread_optics){.eta = one_of(random, indices, 6),
                                .gamma_s = one_of(random, widths, 5),
                                .gamma_v = one_of(random, widths, 5),
                                .kd = one_of(random, shares, 3),
                                .albedo = {one_of(random, albedos, 4), one_of(random, albedos, 4), 1}};
}

static weft_cloth_thread random_thread(uint64_t *random, weft_real area_share)
{
    weft_cloth_thread thread = {.axis = random_bits(random) & 1 ? WEFT_AXIS_X : WEFT_AXIS_Y,
                                .point_count = 2 + (int)(random_bits(random) % (WEFT_THREAD_MAX_POINTS - 1)),
                                .sample_count = 1 + (int)(random_bits(random) % 4),
                                .optics = random_optics(random),
                                .area_share = area_share};
    const weft_real lengths[] = {0, (weft_real)1e-20, 1, 100};
    for (int i = 0; i < thread.point_count; i++) {
        thread.tilt_rad[i] = random_between(random, -1.57, 1.57);
        thread.piece_length[i] = i == 0 ? 1 : one_of(random, lengths, 4);
    }
    return thread;
}

static weft_prepared_cloth random_cloth(uint64_t *random)
{
    const weft_real shares[] = {0, (weft_real)1e-30, (weft_real)0.5, (weft_real)0.2};
    const weft_real sigmas[] = {(weft_real)1.01e-4, (weft_real)0.3, 100};
    weft_microcylinder_cloth cloth = {
        .thread = {random_thread(random, one_of(random, shares, 4)), random_thread(random, one_of(random, shares, 4))},
        .sigma = one_of(random, sigmas, 3)};
    return weft_microcylinder_prepare(&cloth);
}

static void scattering_is_symmetric(void **state)
{
    (void)state;
    uint64_t random = 23;
    for (int i = 0; i < 200000; i++) {
        weft_thread_tangent tangent = random_tangent(&random);
        weft_thread_optics optics = random_optics(&random);
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        weft_thread_angles there = weft_thread_angles_of(&tangent, light, view);
        weft_thread_angles back = weft_thread_angles_of(&tangent, view, light);
        double a = weft_thread_scattering(&optics, &there).r, b = weft_thread_scattering(&optics, &back).r;
        assert_true(fabs(a - b) <= same * fmax(a, b));
        a = weft_thread_shadowing(&there, (weft_real)0.3);
        b = weft_thread_shadowing(&back, (weft_real)0.3);
        assert_true(fabs(a - b) <= same);
    }
}

static void parameters_out_of_range_give_zero(void **state)
{
    (void)state;
    uint64_t random = 24;
    const weft_vec3 up = {0, 0, 1};
    weft_microcylinder_cloth good = random_cloth(&random).cloth;
    for (int i = 0; i < 7; i++) {
        weft_microcylinder_cloth bad = good;
        weft_real *const damaged[] = {&bad.sigma,
                                      &bad.thread[0].optics.eta,
                                      &bad.thread[0].optics.gamma_s,
                                      &bad.thread[1].optics.albedo.g,
                                      &bad.thread[1].area_share,
                                      &bad.thread[0].tilt_rad[1],
                                      &bad.thread[0].piece_length[0]};
        *damaged[i] = i % 2 == 0 ? (weft_real)NAN : (weft_real)1e5;
        weft_prepared_cloth prepared = weft_microcylinder_prepare(&bad);
        assert_false(prepared.admissible);
        assert_true(weft_microcylinder_scattering(&prepared, WEFT_CLOTH_BY_AREA, up, up).r == 0);
    }
}

/* Splitting a thread in more samples, or a cloth in two equal threads, changes nothing but with the printed weights. */
static void area_weighting_does_not_depend_on_the_number_of_samples(void **state)
{
    (void)state;
    const weft_vec3 light = weft_unit(weft_vec3_of(0.3, 0.2, 1)), view = weft_unit(weft_vec3_of(-0.2, 0.4, 1));
    weft_cloth_thread thread = {.point_count = 2, .piece_length = {1}, .sample_count = 1, .area_share = 0.5};
    thread.optics = (weft_thread_optics){(weft_real)1.5, (weft_real)0.2, (weft_real)0.4, (weft_real)0.3, {1, 1, 1}};
    weft_microcylinder_cloth cloth = {.thread = {thread, thread}, .sigma = (weft_real)0.3};
    weft_prepared_cloth one = weft_microcylinder_prepare(&cloth);
    cloth.thread[0].sample_count = 8;
    weft_prepared_cloth eight = weft_microcylinder_prepare(&cloth);
    weft_real a = weft_microcylinder_scattering(&one, WEFT_CLOTH_BY_AREA, light, view).r;
    assert_true(fabs(a - weft_microcylinder_scattering(&eight, WEFT_CLOTH_BY_AREA, light, view).r) <= 1e-6 * a);
    weft_real printed = weft_microcylinder_scattering(&one, WEFT_CLOTH_AS_PRINTED, light, view).r;
    assert_true(fabs(a - 2 * printed) <= 1e-6 * a);
}

int test_microcylinder_physics(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scattering_is_symmetric),
        cmocka_unit_test(parameters_out_of_range_give_zero),
        cmocka_unit_test(area_weighting_does_not_depend_on_the_number_of_samples),
    };
    return cmocka_run_group_tests_name("microcylinder physics", tests, NULL, NULL);
}
