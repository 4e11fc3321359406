/* Kriging against what it is said to be: its covariance written down again, and images that really are left out. */
#include "tests/support/cmocka_all.h"

#include "compress/kriging/kriging.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <stdlib.h>

enum { COUNT = 40, SERIES = 5 };

static weft_vec3 any_direction(uint64_t *seed)
{
    double theta = 1.3 * sqrt(synthetic_uniform(seed)), phi = 2 * WEFT_PI * synthetic_uniform(seed);
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

/* The chord between two unit vectors at an angle a is 2 sin(a / 2). */
static double chord(weft_vec3 a, weft_vec3 b)
{
    return 2 * sin(acos(fmin(1, fmax(-1, weft_dot(a, b)))) / 2);
}

static double matern(double distance)
{
    return exp(-sqrt(3) * distance) + sqrt(3) * distance * exp(-sqrt(3) * distance);
}

static void the_covariance_is_the_sum_that_is_documented(void **state)
{
    (void)state;
    uint64_t seed = 11;
    const weft_covariance covariance = {.number = {-3, 0.7, -0.4, 0.9, 1.3, -1.6, 0.2, -0.8, -2.1, -1.4, 2.2, -0.6}};
    weft_covariance_terms terms = weft_covariance_terms_of(&covariance);
    for (int i = 0; i < 200; i++) {
        weft_vec3 l = any_direction(&seed), v = any_direction(&seed), m = any_direction(&seed),
                  w = any_direction(&seed);
        weft_vec3 h = weft_unit(weft_add(l, v)), k = weft_unit(weft_add(m, w));
        /* l.h is the cosine of half the angle between light and view. */
        double incidence = cos(acos(weft_dot(l, v)) / 2) * cos(acos(weft_dot(m, w)) / 2);
        double growth = pow(incidence, -0.7) * pow(l.z * m.z, 1.1) * pow(v.z * w.z, -0.3);
        double expected = pow(2, 0.7) * l.z * m.z +
                          matern(hypot(chord(l, m) / pow(2, -0.4), chord(v, w) / pow(2, 0.9))) +
                          pow(2, 1.3) * matern(hypot(chord(h, k) / pow(2, -1.6), chord(v, w) / pow(2, 0.2))) * growth +
                          pow(2, -0.8) * matern(chord(h, k) / pow(2, -2.1)) * growth;
        weft_direction_pair a = weft_direction_pair_of(l, v), b = weft_direction_pair_of(m, w);
        assert_float_equal(weft_covariance_between(&terms, &a, &b), expected, 1e-6 * expected);
        assert_float_equal(weft_covariance_between(&terms, &b, &a), expected, 1e-6 * expected);
    }
}

static weft_vec3 half_turned(weft_vec3 a)
{
    return weft_vec3_of(-a.x, -a.y, a.z);
}

/* c(x, x') of the light l and the view v, and the light m and the view w. */
static double reciprocal_part(const weft_covariance_terms *terms, double r, weft_vec3 l, weft_vec3 v, weft_vec3 m,
                              weft_vec3 w)
{
    weft_direction_pair a = weft_direction_pair_of(l, v), b = weft_direction_pair_of(m, w),
                        c = weft_direction_pair_of(v, l), d = weft_direction_pair_of(w, m);
    double both[2] = {1, l.z / v.z}, others[2] = {1, m.z / w.z}, sum = 0;
    const weft_direction_pair *first[2] = {&a, &c}, *second[2] = {&b, &d};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            sum += both[i] * others[j] * weft_covariance_between(terms, first[i], second[j]);
    return (1 - r) * weft_covariance_between(terms, &a, &b) + r / 2 * sum;
}

static void the_covariance_of_a_mean_is_the_sum_that_is_documented(void **state)
{
    (void)state;
    uint64_t seed = 12;
    weft_covariance covariance = {.number = {-3, 0.7, -0.4, 0.9, 1.3, -1.6, 0.2, -0.8, -2.1, -1.4, 2.2, -0.6, 1, -0.5}};
    weft_covariance_terms of_texels = weft_covariance_terms_of(&covariance);
    covariance.is_of_mean = true;
    weft_covariance_terms of_mean = weft_covariance_terms_of(&covariance);
    double r = 2.0 / 3, t = sqrt(0.5) / (1 + sqrt(0.5));
    for (int i = 0; i < 200; i++) {
        weft_vec3 l = any_direction(&seed), v = any_direction(&seed), m = any_direction(&seed),
                  w = any_direction(&seed);
        double expected = reciprocal_part(&of_texels, r, l, v, m, w) +
                          t * reciprocal_part(&of_texels, r, l, v, half_turned(m), half_turned(w));
        weft_direction_pair a = weft_direction_pair_of(l, v), b = weft_direction_pair_of(m, w);
        assert_float_equal(weft_covariance_between(&of_mean, &a, &b), expected, 1e-5 * expected);
        assert_float_equal(weft_covariance_between(&of_mean, &b, &a), expected, 1e-5 * expected);
    }
}

/* ---- Samples: a soft highlight over a diffuse ground, another one for each series, noise on all ---- */

typedef struct samples {
    weft_direction_pair pair[COUNT];
    double weight[COUNT], sample[SERIES * COUNT];
} samples;

static samples make(uint64_t seed, double noise)
{
    samples s;
    for (int i = 0; i < COUNT; i++) {
        weft_vec3 l = any_direction(&seed), v = any_direction(&seed), h = weft_unit(weft_add(l, v));
        s.pair[i] = weft_direction_pair_of(l, v);
        s.weight[i] = i % 3 == 0 ? 0.5 : 1.25;
        for (int k = 0; k < SERIES; k++)
            s.sample[k * COUNT + i] = l.z * (0.2 + 0.1 * k + pow(fmax(0, h.z + 0.1 * h.x), 8 + 4 * k)) +
                                      noise * (synthetic_uniform(&seed) - 0.5);
    }
    return s;
}

static weft_kriging_places places_of(const samples *s, int count)
{
    return (weft_kriging_places){count, s->pair, s->weight};
}

static void without_noise_every_sample_is_met(void **state)
{
    (void)state;
    samples s = make(5, 0);
    weft_covariance covariance = weft_covariance_usual();
    covariance.number[WEFT_NOISE] = -40;
    weft_covariance_terms terms = weft_covariance_terms_of(&covariance);
    weft_kriging_places places = places_of(&s, COUNT);
    weft_kriging kriging;
    double weight[COUNT];
    float row[COUNT];
    for (int i = 0; i < COUNT; i++)
        weight[i] = s.sample[i];
    assert_int_equal(weft_kriging_create(&covariance, &places, &kriging, NULL), WEFT_OK);
    weft_kriging_solve(&kriging, weight, 1);
    for (int i = 0; i < COUNT; i++) {
        double sum = 0;
        weft_kriging_row(&terms, &places, &s.pair[i], row);
        for (int j = 0; j < COUNT; j++)
            sum += (double)row[j] * weight[j];
        assert_float_equal(sum, s.sample[i], 1e-3);
    }
    weft_kriging_free(&kriging);
}

/* What all samples but one say of that one. The noise is a share of the mean variance of what is left. */
static double predict_without(const samples *s, const weft_covariance *covariance, int out, int series)
{
    samples rest = *s;
    weft_covariance_terms terms = weft_covariance_terms_of(covariance);
    double weight[COUNT], sum = 0;
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        if (i == out)
            continue;
        rest.pair[count] = s->pair[i];
        rest.weight[count] = s->weight[i];
        weight[count++] = s->sample[series * COUNT + i];
    }
    weft_kriging_places places = places_of(&rest, count);
    weft_kriging kriging;
    assert_int_equal(weft_kriging_create(covariance, &places, &kriging, NULL), WEFT_OK);
    weft_kriging_solve(&kriging, weight, 1);
    for (int j = 0; j < count; j++)
        sum += weft_covariance_between(&terms, &s->pair[out], &rest.pair[j]) * weight[j];
    weft_kriging_free(&kriging);
    return sum;
}

static double leave_each_out(const samples *s, const weft_covariance *covariance, int series_count)
{
    double square = 0, energy = 0;
    for (int k = 0; k < series_count; k++)
        for (int i = 0; i < COUNT; i++) {
            double sample = s->sample[k * COUNT + i], e = predict_without(s, covariance, i, k) - sample;
            square += s->weight[i] * e * e;
            energy += s->weight[i] * sample * sample;
        }
    return sqrt(square / energy);
}

static void the_error_is_that_of_images_really_left_out(void **state)
{
    (void)state;
    samples s = make(3, 0.05);
    double error_of;
    weft_covariance covariance;
    weft_kriging_samples set = {places_of(&s, COUNT), SERIES, s.sample};
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &covariance, &error_of, NULL), WEFT_OK);
    assert_float_equal(error_of, leave_each_out(&s, &covariance, SERIES), 0.02 * error_of);
    weft_covariance usual = weft_covariance_usual();
    assert_true(error_of < 0.95 * leave_each_out(&s, &usual, SERIES));
}

/* More series than images are replaced by as many as there are images: nothing may change. */
static void many_texels_decide_as_their_products_do(void **state)
{
    (void)state;
    enum { COPIES = 20 };
    samples s = make(3, 0.05);
    double *sample = malloc(COPIES * sizeof s.sample), few_error, many_error;
    weft_covariance few, many;
    for (int i = 0; i < COPIES * SERIES * COUNT; i++)
        sample[i] = s.sample[i % (SERIES * COUNT)];
    weft_kriging_samples set = {places_of(&s, COUNT), SERIES, s.sample};
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &few, &few_error, NULL), WEFT_OK);
    set = (weft_kriging_samples){places_of(&s, COUNT), COPIES * SERIES, sample};
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &many, &many_error, NULL), WEFT_OK);
    assert_float_equal(few_error, many_error, 1e-4 * few_error);
    for (int k = 0; k < WEFT_COVARIANCE_NUMBERS; k++)
        assert_float_equal(few.number[k], many.number[k], 1e-9);
    free(sample);
}

static void three_images_are_diffuse(void **state)
{
    (void)state;
    samples s = make(8, 0);
    double three[3] = {s.sample[0], s.sample[1], s.sample[2]}, error_of;
    weft_covariance covariance;
    weft_kriging_samples set = {places_of(&s, 3), 1, three};
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &covariance, &error_of, NULL), WEFT_OK);
    assert_true(covariance.number[WEFT_DIFFUSE_VARIANCE] > covariance.number[WEFT_HIGHLIGHT_VARIANCE] + 10);
    const double dark[3] = {0};
    set.sample = dark;
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &covariance, &error_of, NULL), WEFT_OK);
    assert_true(error_of == 0);
}

/* A highlight that is alike at all half vectors, and brighter near the horizon. */
static void nineteen_images_decide_no_powers_and_forty_do(void **state)
{
    (void)state;
    samples s = make(9, 0);
    double error_of, sample[COUNT];
    weft_covariance covariance, usual = weft_covariance_usual();
    for (int i = 0; i < COUNT; i++)
        sample[i] = 1 / (s.pair[i].light[2] * pow(s.pair[i].view[2], 2));
    weft_kriging_samples set = {places_of(&s, COUNT), 1, sample};
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &covariance, &error_of, NULL), WEFT_OK);
    weft_covariance_terms terms = weft_covariance_terms_of(&covariance);
    assert_float_equal(terms.incidence_power, 0, 0.3);
    assert_float_equal(terms.light_power, -1, 0.3);
    assert_float_equal(terms.view_power, -2, 0.3);
    assert_true(error_of < 0.01);
    set.places.count = 19;
    assert_int_equal(weft_kriging_choose(&set, 1, NULL, &covariance, &error_of, NULL), WEFT_OK);
    for (int k = WEFT_INCIDENCE_POWER; k < WEFT_COVARIANCE_NUMBERS; k++)
        assert_true(covariance.number[k] == usual.number[k]);
}

/* Tilted highlights: without symmetries, and with both. */
static double tilted(weft_vec3 l, weft_vec3 v, bool symmetric)
{
    weft_vec3 h = weft_unit(weft_add(l, v));
    double along = symmetric ? fabs(h.x) : h.x, seen = symmetric ? 1 : 0.3 + v.z * v.z;
    return l.z * seen * (0.2 + pow(fmax(0, 0.89 * h.z + 0.45 * along), 12));
}

static void a_mean_has_the_symmetries_that_its_samples_have(void **state)
{
    (void)state;
    double odds[2][2], errors[2][2];
    for (int symmetric = 0; symmetric < 2; symmetric++) {
        samples s = make(21, 0);
        weft_covariance covariance, usual = weft_covariance_usual_of_mean();
        for (int i = 0; i < COUNT; i++) {
            const double *l = s.pair[i].light, *v = s.pair[i].view;
            s.sample[i] = tilted(weft_vec3_of(l[0], l[1], l[2]), weft_vec3_of(v[0], v[1], v[2]), symmetric == 1);
        }
        weft_kriging_samples set = {places_of(&s, COUNT), 1, s.sample};
        assert_int_equal(weft_kriging_choose_mean(&set, NULL, &covariance, &errors[symmetric][0], NULL), WEFT_OK);
        assert_true(covariance.is_of_mean);
        assert_int_equal(weft_kriging_leave_out(&set, 1, &usual, &errors[symmetric][1], NULL), WEFT_OK);
        assert_true(errors[symmetric][0] < errors[symmetric][1]);
        for (int k = 0; k < 2; k++)
            odds[symmetric][k] = covariance.number[WEFT_RECIPROCITY + k];
        for (int k = WEFT_INCIDENCE_POWER; k < WEFT_RECIPROCITY; k++)
            assert_true(covariance.number[k] == usual.number[k]);
        set.places.count = WEFT_KRIGING_LEAST_IMAGES - 1;
        assert_int_equal(weft_kriging_choose_mean(&set, NULL, &covariance, &errors[symmetric][1], NULL), WEFT_OK);
        assert_false(covariance.is_of_mean);
    }
    print_message("odds of reciprocity and half turn: 2^%.1f 2^%.1f; without: 2^%.1f 2^%.1f; errors %.3f %.3f\n",
                  odds[1][0], odds[1][1], odds[0][0], odds[0][1], errors[1][0], errors[0][0]);
    for (int k = 0; k < 2; k++)
        assert_true(odds[1][k] > odds[0][k] + 1);
    assert_true(errors[1][0] < errors[0][0]);
}

int test_kriging(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_covariance_is_the_sum_that_is_documented),
        cmocka_unit_test(without_noise_every_sample_is_met),
        cmocka_unit_test(the_error_is_that_of_images_really_left_out),
        cmocka_unit_test(many_texels_decide_as_their_products_do),
        cmocka_unit_test(three_images_are_diffuse),
        cmocka_unit_test(nineteen_images_decide_no_powers_and_forty_do),
        cmocka_unit_test(the_covariance_of_a_mean_is_the_sum_that_is_documented),
        cmocka_unit_test(a_mean_has_the_symmetries_that_its_samples_have),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
