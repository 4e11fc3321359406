/* What must hold for any yarn segment. Built twice: in double, and in single precision. */
#include "reflectance/woven/woven.h"
#include "tests/reflectance/random.h"
#include "tests/support/cmocka_all.h"

/* Rounding of the integral, relative to the value. */
static const double same = (WEFT_REAL_EPSILON < 1e-9) ? 1e-12 : 2e-5;

static weft_segment random_segment(uint64_t *state, bool staple)
{
    weft_segment s = {.alpha = random_between(state, 0, 0.1),
                      .beta = random_between(state, 0, 6),
                      .delta = random_between(state, 0, 1),
                      .umax = random_between(state, 0.1, 1.3),
                      .kappa = random_between(state, -0.9, 1),
                      .width = 1,
                      .length = random_between(state, 1.05, 6),
                      .highlight_width = random_between(state, 0.1, 1)};
    s.psi = staple ? random_between(state, 0.1, 1.2) * (random_bits(state) & 1 ? 1 : -1) : 0;
    return s;
}

static weft_vec3 mirrored(weft_vec3 d)
{
    return weft_vec3_of(-d.x, d.y, d.z);
}

/* Single precision moves the ends of the highlight by rounding; its absolute error is then that of a typical value. */
static void assert_same(weft_real a, weft_real b)
{
    double floor_value = WEFT_REAL_EPSILON < 1e-9 ? 1e-30 : 1e-6;
    assert_true(fabs((double)a - (double)b) <= same * fmax(fabs((double)a), fabs((double)b)) + floor_value);
}

static void reflectance_is_reciprocal(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int i = 0; i < 4000; i++) {
        weft_segment s = random_segment(&random, i % 2);
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        assert_same(weft_segment_reflectance(&s, light, view), weft_segment_reflectance(&s, view, light));
    }
}

static void reflectance_keeps_mirror_symmetry(void **state)
{
    (void)state;
    uint64_t random = 2;
    for (int i = 0; i < 4000; i++) {
        weft_segment s = random_segment(&random, i % 2), other = s;
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        other.psi = -s.psi;
        assert_same(weft_segment_reflectance(&s, light, view),
                    weft_segment_reflectance(&other, mirrored(light), mirrored(view)));
    }
}

static void texture_keeps_mirror_symmetry(void **state)
{
    (void)state;
    uint64_t random = 3;
    int lit = 0;
    for (int i = 0; i < 20000; i++) {
        weft_segment s = random_segment(&random, i % 2), other = s;
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        weft_real x = random_between(&random, -0.5, 0.5), y = random_between(&random, -0.5, 0.5) * s.length;
        other.psi = -s.psi;
        weft_real a = weft_segment_texture(&s, x, y, light, view);
        weft_real b = weft_segment_texture(&other, -x, y, mirrored(light), mirrored(view));
        lit += a > 0;
        /* Within rounding of the edge of the band either side is right. */
        if (a > 0 && b > 0)
            assert_true(fabs((double)a - (double)b) <= 1e3 * (double)WEFT_REAL_EPSILON * (double)a * 100);
        else if (WEFT_REAL_EPSILON < 1e-9)
            assert_true(a == b);
    }
    assert_true(lit > 1000);
}

static weft_real centred(int index, int count)
{
    return ((weft_real)index + (weft_real)0.5) / (weft_real)count - (weft_real)0.5;
}

/* Midpoint rule with many steps along the highlight and few across. Across there is a band of constant value, of which
 * the rule counts points: its width is a whole number of steps, so the count does not depend on where the band lies. */
static double texture_mean(const weft_segment *s, weft_vec3 light, weft_vec3 view)
{
    enum { ALONG = 32768, ACROSS = 12 };
    double sum = 0;
    for (int i = 0; i < ALONG; i++) {
        for (int j = 0; j < ACROSS; j++) {
            weft_real along = centred(i, ALONG), across = centred(j, ACROSS);
            weft_real x = s->width * (s->psi != 0 ? across : along), y = s->length * (s->psi != 0 ? along : across);
            sum += weft_segment_texture(s, x, y, light, view);
        }
    }
    return sum / ALONG / ACROSS;
}

static void mean_of_the_texture_is_the_reflectance(void **state)
{
    (void)state;
    const weft_real width[] = {(weft_real)0.25, (weft_real)0.5, 1};
    const weft_vec3 light = weft_unit(weft_vec3_of((weft_real)0.1, (weft_real)-0.2, 1));
    uint64_t random = 5;
    double worst = 0;
    for (int i = 0, used = 0; used < 24; i++) {
        weft_segment s = random_segment(&random, i % 2);
        weft_vec3 view = random_direction(&random);
        s.highlight_width = width[i % 3];
        double expected = weft_segment_reflectance(&s, light, view);
        if (!(expected > 1e-4))
            continue;
        worst = fmax(worst, fabs(texture_mean(&s, light, view) / expected - 1));
        used++;
    }
    print_message("texture mean against reflectance: worst %.2g\n", worst);
    assert_true(worst < 5e-4);
}

static void small_twist_tends_to_the_filament(void **state)
{
    (void)state;
    const weft_vec3 light = weft_unit(weft_vec3_of((weft_real)0.2, (weft_real)0.1, 1));
    const weft_vec3 view = weft_unit(weft_vec3_of((weft_real)-0.3, (weft_real)0.25, 1));
    weft_segment s = {.alpha = (weft_real)0.02,
                      .beta = 3,
                      .umax = (weft_real)0.7,
                      .kappa = (weft_real)-0.3,
                      .width = 1,
                      .length = 3,
                      .highlight_width = 1};
    double filament = weft_segment_reflectance(&s, light, view);
    for (double psi = 1e-2; psi > 1e-16; psi /= 10) {
        s.psi = (weft_real)psi;
        assert_true(fabs(weft_segment_reflectance(&s, light, view) / filament - 1) < 2 * psi + same * 10);
    }
}

/* R of the spine that ends at (1 - delta) umax, and its last value beyond; off, and for staple, R of the yarn. */
static void frozen_radius_is_that_of_the_shorter_spine(void **state)
{
    (void)state;
    uint64_t random = 6;
    int beyond = 0;
    for (int i = 0; i < 20000; i++) {
        weft_segment s = random_segment(&random, i % 4 == 0), shorter = s;
        weft_vec3 light = random_direction(&random), view = random_direction(&random);
        weft_yarn_point plain = weft_yarn_highlight(&s, 0, light, view);
        s.frozen_radius = true;
        weft_yarn_point frozen = weft_yarn_highlight(&s, 0, light, view);
        shorter.umax *= 1 - s.delta;
        weft_real u = s.psi != 0 ? 0 : weft_clamp(atan2(light.y + view.y, light.z + view.z), -s.umax, s.umax);
        weft_real at = weft_clamp(u, -shorter.umax, shorter.umax);
        double expected = s.psi != 0 ? plain.radius : weft_spine_radius(&shorter, at);
        assert_true(fabs((double)frozen.radius / expected - 1) < 1e4 * same);
        beyond += fabs(u) > shorter.umax && s.psi == 0;
    }
    assert_true(beyond > 1000);
}

/* Down to the flattest yarns, whose cosines are all 1: the ends of a yarn of 1e-6 are where those of its point are. */
static void the_integrand_of_a_prepared_yarn_is_that_of_its_point(void **state)
{
    (void)state;
    uint64_t random = 9;
    int lit = 0, dark = 0;
    for (int i = 0; i < 20000; i++) {
        weft_segment s = random_segment(&random, i % 2 == 0);
        s.umax = exp(random_between(&random, log((weft_real)1e-6), log((weft_real)1.3)));
        weft_real tilt = random_between(&random, (weft_real)0.01, (weft_real)0.99) * s.umax;
        tilt += i % 4 < 2 ? 0 : s.umax; /* within, and beyond the end */
        weft_vec3 light = weft_unit(weft_vec3_of(random_between(&random, -1, 1), sin(tilt), cos(tilt)));
        weft_real limit = s.psi != 0 ? s.umax : (weft_real)1.5, at = random_between(&random, -limit, limit);
        weft_prepared_segment prepared = weft_segment_prepare(&s);
        double got = (double)weft_prepared_integrand(&prepared, (weft_angle){at, sin(at), cos(at)}, light, light);
        double expected = (double)weft_yarn_highlight(&s, at, light, light).integrand;
        assert_true(fabs(got - expected) <= 1e3 * (double)WEFT_REAL_EPSILON * expected);
        lit += s.psi == 0 && s.umax < (weft_real)1e-4 && expected > 0;
        dark += s.psi == 0 && s.umax < (weft_real)1e-4 && expected == 0;
    }
    assert_true(lit > 500 && dark > 500);
}

/* Eq. 9 by the distance to the end, from double: s^2 (3 - 2 s). There the printed 1 - c^2 (3 - 2 c) is all rounding in
 * single precision. */
static void fade_keeps_its_digits_to_the_end_of_the_yarn(void **state)
{
    (void)state;
    const weft_real tilt[] = {(weft_real)0.3, (weft_real)0.39, (weft_real)0.399, (weft_real)0.3999};
    weft_segment faded = {.alpha = 1, .beta = 2, .delta = 1, .umax = (weft_real)0.4, .width = 1, .length = 3};
    faded.highlight_width = 1;
    weft_segment plain = faded;
    plain.delta = 0;
    for (int i = 0; i < 4; i++) {
        weft_vec3 light = weft_unit(weft_vec3_of((weft_real)0.1, sin(tilt[i]), cos(tilt[i])));
        double u = atan2((double)light.y, (double)light.z), inside = ((double)faded.umax - u) / (double)faded.umax;
        double ratio = (double)weft_yarn_highlight(&faded, 0, light, light).integrand /
                       (double)weft_yarn_highlight(&plain, 0, light, light).integrand;
        double expected = inside * inside * (3 - 2 * inside);
        assert_float_equal(ratio, expected, expected * 8 * (double)WEFT_REAL_EPSILON / inside);
    }
}

static void mean_of_a_texture_with_frozen_radius_is_the_reflectance(void **state)
{
    (void)state;
    const weft_vec3 light = weft_unit(weft_vec3_of((weft_real)0.1, (weft_real)-0.2, 1));
    const weft_vec3 view = weft_unit(weft_vec3_of((weft_real)-0.2, (weft_real)0.9, 1));
    weft_segment s = {.alpha = (weft_real)0.02,
                      .beta = 3,
                      .delta = (weft_real)0.5,
                      .umax = (weft_real)0.7,
                      .kappa = (weft_real)-0.3,
                      .width = 1,
                      .length = 3,
                      .highlight_width = (weft_real)0.25};
    double plain = weft_segment_reflectance(&s, light, view);
    s.frozen_radius = true;
    double frozen = weft_segment_reflectance(&s, light, view);
    assert_true(fabs(frozen / plain - 1) > 0.1);
    assert_true(fabs(texture_mean(&s, light, view) / frozen - 1) < 5e-4);
}

static void directions_that_are_no_directions_give_no_light(void **state)
{
    (void)state;
    weft_segment s = {.psi = (weft_real)0.4, .umax = (weft_real)0.5, .width = 1, .length = 2, .highlight_width = 1};
    const weft_real bad[] = {(weft_real)NAN, (weft_real)INFINITY, (weft_real)-INFINITY};
    const weft_vec3 up = {0, 0, 1};
    for (int i = 0; i < 3; i++) {
        const weft_vec3 odd[] = {{bad[i], 0, 1}, {0, bad[i], 1}, {0, 0, bad[i]}};
        for (int k = 0; k < 3; k++) {
            assert_true(!(weft_segment_texture(&s, 0, 0, odd[k], up) > 0));
            assert_true(!(weft_segment_texture(&s, 0, 0, up, odd[k]) > 0));
        }
    }
}

static void inadmissible_segments_reflect_nothing(void **state)
{
    (void)state;
    const weft_segment good = {.umax = (weft_real)0.5, .width = 1, .length = 2, .highlight_width = 1};
    const weft_vec3 up = {0, 0, 1};
    weft_segment bad[8];
    for (int i = 0; i < 8; i++)
        bad[i] = good;
    bad[0].umax = 0;
    bad[1].umax = 2;
    bad[2].kappa = -1;
    bad[3].width = 5;
    bad[4].psi = (weft_real)1.6;
    bad[5].delta = (weft_real)1.5;
    bad[6].highlight_width = 0;
    bad[7].beta = (weft_real)NAN;
    assert_true(weft_segment_admissible(&good) && weft_segment_reflectance(&good, up, up) > 0);
    for (int i = 0; i < 8; i++) {
        assert_false(weft_segment_admissible(&bad[i]));
        assert_true(weft_segment_reflectance(&bad[i], up, up) == 0);
        assert_true(weft_segment_texture(&bad[i], 0, 0, up, up) == 0);
    }
}

static void phase_function_integrates_over_a_circle_to_one_plus_alpha(void **state)
{
    (void)state;
    const weft_real betas[] = {0, 2, -4, 19, 21, 200};
    for (int i = 0; i < 6; i++) {
        double sum = 0;
        for (int k = 0; k < 4096; k++)
            sum += weft_phase_function((weft_real)0.05, betas[i], cos(2 * (weft_real)WEFT_PI * (weft_real)k / 4096));
        assert_true(fabs(sum * 2 * (double)WEFT_PI / 4096 - (1 + 0.05 * 2 * (double)WEFT_PI)) < 1e5 * same);
    }
}

/* Length of a flat half ellipse over the chord 2c that ends with the slope tan umax, from its own parameter t: the
 * spike of R at the ends is smooth there. The root has a kink at t = 0, where the rule begins. */
static double ellipse_length(double chord, double umax, double shape)
{
    enum { STEPS = 200000 };
    double end = atan(shape * sin(umax) / cos(umax)), across = chord / 2 / sin(end), up = across / shape, sum = 0;
    for (int i = 0; i < STEPS; i++) {
        double t = end * (i + 0.5) / STEPS;
        sum += hypot(across * cos(t), up * sin(t));
    }
    return 2 * sum * end / STEPS;
}

/* Fibres that run round the yarn, lit and seen from above, mirror all along it with c1 c2 / (c1 + c2)^2 = 1/4: what is
 * left is the area of the yarn. Its ends are steep, so that half of it lies in the last 1e-5 of u. */
static void a_spine_that_ends_in_a_spike_keeps_its_length(void **state)
{
    (void)state;
    const weft_vec3 up = {0, 0, 1};
    const weft_real inside[] = {(weft_real)1e-3, (weft_real)1e-4, (weft_real)1e-5, (weft_real)4e-6};
    for (int i = 0; i < 4; i++) {
        weft_segment s = {.alpha = 1,
                          .psi = (weft_real)1.570796,
                          .umax = (weft_real)(WEFT_PI / 2) - inside[i],
                          .kappa = 2 * inside[i] - 1,
                          .width = (weft_real)1e-3,
                          .length = 1,
                          .highlight_width = 1};
        double umax = s.umax, radius = (double)s.width / 2;
        double shape = 1 + (double)s.kappa * (1 + cos(umax) / sin(umax));
        double length = ellipse_length((double)s.length - (double)s.width * sin(umax), umax, shape);
        double area = radius * (length + 2 * radius * umax);
        double expected = weft_phase_function(s.alpha, s.beta, -1) * area / 4;
        double off = weft_segment_reflectance(&s, up, up) / expected - 1;
        print_message("umax = pi/2 - %g: %.2g off\n", (double)inside[i], off);
        assert_true(fabs(off) < 2e-5);
    }
}

int test_woven_physics(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reflectance_is_reciprocal),
        cmocka_unit_test(reflectance_keeps_mirror_symmetry),
        cmocka_unit_test(texture_keeps_mirror_symmetry),
        cmocka_unit_test(mean_of_the_texture_is_the_reflectance),
        cmocka_unit_test(small_twist_tends_to_the_filament),
        cmocka_unit_test(frozen_radius_is_that_of_the_shorter_spine),
        cmocka_unit_test(the_integrand_of_a_prepared_yarn_is_that_of_its_point),
        cmocka_unit_test(fade_keeps_its_digits_to_the_end_of_the_yarn),
        cmocka_unit_test(mean_of_a_texture_with_frozen_radius_is_the_reflectance),
        cmocka_unit_test(a_spine_that_ends_in_a_spike_keeps_its_length),
        cmocka_unit_test(directions_that_are_no_directions_give_no_light),
        cmocka_unit_test(inadmissible_segments_reflect_nothing),
        cmocka_unit_test(phase_function_integrates_over_a_circle_to_one_plus_alpha),
    };
    return cmocka_run_group_tests_name("woven physics", tests, NULL, NULL);
}
