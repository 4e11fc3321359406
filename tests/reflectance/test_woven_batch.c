/* Batches against the scalar functions, for ordinary and extreme segments and directions. */
#include "base/processor.h"
#include "btf/direction/direction.h"
#include "random.h"
#include "reflectance/weave/batch.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static double choice(uint64_t *state, const double *value, int count)
{
    return value[(int)random_between(state, 0, count - 1e-9)];
}

/* As they occur in weave files. */
static weft_segment ordinary_segment(uint64_t *state)
{
    weft_segment s = {.alpha = random_between(state, 0, 0.3),
                      .beta = random_between(state, 0.5, 8),
                      .delta = random_between(state, 0, 1),
                      .umax = random_between(state, 0.1, 1.2),
                      .kappa = random_between(state, -0.6, 2),
                      .width = random_between(state, 0.5, 1.5),
                      .highlight_width = random_between(state, 0.2, 1)};
    s.frozen_radius = random_between(state, 0, 1) < 0.3;
    s.psi = random_between(state, 0, 1) < 0.3 ? 0 : random_between(state, -0.9, 0.9);
    s.length = s.width * random_between(state, 1.05, 6);
    return s;
}

static weft_segment extreme_segment(uint64_t *state)
{
    static const double psi[] = {0, 1e-4, -1e-3, 0.02, -0.5, 1.5, 1.57};
    static const double umax[] = {1e-4, 1e-3, 0.05, 0.8, 1.5, WEFT_PI / 2};
    static const double kappa[] = {-0.9999, -0.99, -0.5, 0, 1, 100};
    static const double beta[] = {0, 0.01, 1, 30, 1000, -3};
    weft_segment s = ordinary_segment(state);
    s.psi = choice(state, psi, 7);
    s.umax = choice(state, umax, 6);
    s.kappa = random_between(state, 0, 1) < 0.2 ? -1 / (1 + 1 / tan(s.umax)) : choice(state, kappa, 6);
    s.beta = choice(state, beta, 6);
    s.highlight_width = choice(state, (const double[]){1e-3, 0.1, 1}, 3);
    return s;
}

static weft_vec3 direction(uint64_t *state, bool extreme)
{
    double theta = weft_rad_of_deg(75) * sqrt(random_between(state, 0, 1)), phi = random_between(state, 0, 2 * WEFT_PI);
    if (extreme && random_between(state, 0, 1) < 0.3)
        theta = choice(state, (const double[]){0, WEFT_PI / 2 - 1e-4, WEFT_PI / 2, 1.6}, 4);
    return weft_direction_of_angles((weft_angles){theta, phi});
}

typedef weft_segment make_segment(uint64_t *state);

/* A weave of these yarns, as far as its highlights go. */
static weft_weave make_weave(weft_yarn *yarn, int count, make_segment *make, uint64_t *state)
{
    for (int i = 0; i < count; i++) {
        weft_segment segment = make(state);
        yarn[i] = (weft_yarn){.segment = segment,
                              .warp = random_between(state, 0, 1) < 0.5,
                              .prepared = weft_segment_prepare(&segment),
                              .alike = i,
                              .cell_fraction = 1.0 / count,
                              .area_weight = random_between(state, 1, 3)};
        yarn[i].admissible = yarn[i].prepared.admissible;
    }
    return (weft_weave){.yarn_count = count, .yarn = yarn, .specular_scale = 1};
}

/* ---- Texture ---- */

typedef struct evaluation {
    weft_weave_point point;
    weft_vec3 light, view;
} evaluation;

static double nudge(uint64_t *state)
{
    return random_between(state, -3e-5, 3e-5);
}

/* The range of the scalar function a few float roundings round an evaluation: it jumps at the edges of a highlight. */
static void scalar_range(const weft_weave *weave, const evaluation *e, uint64_t *state, double *low, double *high)
{
    *low = *high = weft_weave_specular(weave, &e->point, e->light, e->view);
    for (int i = 0; i < 24; i++) {
        evaluation near = *e;
        near.point.x *= 1 + nudge(state);
        near.point.y *= 1 + nudge(state);
        near.light = weft_unit(weft_add(e->light, weft_vec3_of(nudge(state), nudge(state), nudge(state))));
        near.view = weft_unit(weft_add(e->view, weft_vec3_of(nudge(state), nudge(state), nudge(state))));
        double value = weft_weave_specular(weave, &near.point, near.light, near.view);
        *low = fmin(*low, value);
        *high = fmax(*high, value);
    }
}

static evaluation random_evaluation(const weft_weave *weave, bool extreme, uint64_t *state)
{
    evaluation e = {.point = {.yarn = (int)random_between(state, 0, weave->yarn_count - 1e-9)}};
    const weft_segment *segment = &weave->yarn[e.point.yarn].segment;
    e.point.x = random_between(state, -0.52, 0.52) * segment->width;
    e.point.y = random_between(state, -0.52, 0.52) * segment->length;
    e.point.intensity = random_between(state, 0.5, 2);
    e.point.umax_offset_rad = random_between(state, 0, 1) < 0.5 ? 0 : -random_between(state, 0, 0.3) * segment->umax;
    e.light = direction(state, extreme);
    e.view = direction(state, extreme);
    return e;
}

/* Evaluations out of `rounds` batches that are lit, and those outside the scalar range. */
static void count_textures(make_segment *make, bool extreme, int rounds, long *lit, long *outside)
{
    enum { YARNS = 13 };
    uint64_t state = 7;
    weft_yarn yarn[YARNS];
    evaluation e[WEFT_BATCH_SIZE];
    weft_error error = {0};
    for (int round = 0; round < rounds; round++) {
        weft_weave weave = make_weave(yarn, YARNS, make, &state);
        weft_woven_table *table;
        assert_int_equal(weft_woven_table_create(&weave, &table, &error), WEFT_OK);
        weft_weave_batch batch = {.count = 0};
        int count = 1 + round % WEFT_BATCH_SIZE;
        for (int i = 0; i < count; i++) {
            e[i] = random_evaluation(&weave, extreme, &state);
            weft_weave_batch_put(&batch, &e[i].point, e[i].light, e[i].view);
        }
        weft_weave_specular_batch(table, &batch);
        for (int i = 0; i < count; i++) {
            double low, high, value = (double)batch.specular[i];
            scalar_range(&weave, &e[i], &state, &low, &high);
            assert_true(isfinite(value) && value >= 0);
            *lit += value > 0;
            *outside += value < low - 1e-4 * low || value > high + 1e-4 * high;
        }
        weft_woven_table_free(table);
    }
}

static void textures_of_ordinary_cloth_are_those_of_the_scalar_function(void **state)
{
    (void)state;
    long lit = 0, outside = 0;
    count_textures(ordinary_segment, false, 300, &lit, &outside);
    assert_true(lit > 3000);
    assert_int_equal(outside, 0);
}

static void textures_at_the_extremes_are_those_of_the_scalar_function(void **state)
{
    (void)state;
    long lit = 0, outside = 0;
    count_textures(extreme_segment, true, 300, &lit, &outside);
    assert_true(lit > 1000);
    assert_int_equal(outside, 0);
}

/* ---- Reflectance ---- */

enum { PAIRS = 100 };

/* Values below a thousandth of the largest of their segment are measured against that. */
static double worst_error(make_segment *make, bool extreme, int segments)
{
    uint64_t state = 11;
    double worst = 0;
    for (int k = 0; k < segments; k++) {
        weft_segment segment = make(&state);
        weft_prepared_segment prepared = weft_segment_prepare(&segment);
        weft_vec3 light[PAIRS], view[PAIRS];
        double value[PAIRS], exact[PAIRS], largest = 0;
        for (int i = 0; i < PAIRS; i++) {
            light[i] = direction(&state, extreme);
            view[i] = direction(&state, extreme);
            exact[i] = weft_prepared_reflectance(&prepared, light[i], view[i]);
            largest = fmax(largest, exact[i]);
        }
        weft_prepared_reflectance_batch(&prepared, PAIRS, light, view, value);
        for (int i = 0; i < PAIRS; i++) {
            assert_true(isfinite(value[i]) && value[i] >= 0);
            worst = fmax(worst, fabs(value[i] - exact[i]) / fmax(exact[i], fmax(1e-3 * largest, 1e-300)));
        }
    }
    return worst;
}

static void reflectances_of_ordinary_cloth_are_within_a_ten_thousandth(void **state)
{
    (void)state;
    assert_true(worst_error(ordinary_segment, false, 300) < 1e-4);
}

static void reflectances_at_the_extremes_are_within_a_thousandth(void **state)
{
    (void)state;
    assert_true(worst_error(extreme_segment, true, 300) < 1e-3);
}

static void means_of_a_tile_are_within_a_thousandth(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    uint64_t random = 5;
    weft_vec3 light[PAIRS], view[PAIRS];
    double value[PAIRS];
    assert_int_equal(weft_weave_read(WEFT_ASSETS "/weaves/silk_charmeuse.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    for (int i = 0; i < PAIRS; i++) {
        light[i] = direction(&random, false);
        view[i] = direction(&random, false);
    }
    assert_int_equal(weft_weave_mean_specular_batch(&weave, PAIRS, light, view, value, &error), WEFT_OK);
    for (int i = 0; i < PAIRS; i++) {
        double exact = weft_weave_mean_specular(&weave, light[i], view[i]);
        assert_float_equal(value[i], exact, 1e-3 * exact + 1e-9);
    }
    weft_weave_free(&weave);
}

/* Every set of this processor: the tests above run with the one in use. */
static void every_instruction_set_gives_the_same_within_rounding(void **state)
{
    (void)state;
    uint64_t random = 3;
    weft_vec3 light[PAIRS], view[PAIRS];
    double value[WEFT_INSTRUCTION_SETS][PAIRS];
    weft_segment segment = ordinary_segment(&random);
    segment.psi = 0.4;
    weft_prepared_segment prepared = weft_segment_prepare(&segment);
    for (int i = 0; i < PAIRS; i++) {
        light[i] = direction(&random, false);
        view[i] = direction(&random, false);
    }
    for (int set = 0; set <= (int)weft_processor_best(); set++) {
        weft_processor_limit((weft_instruction_set)set);
        weft_prepared_reflectance_batch(&prepared, PAIRS, light, view, value[set]);
        for (int i = 0; i < PAIRS; i++)
            assert_float_equal(value[set][i], value[0][i], 1e-4 * value[0][i]);
    }
    weft_processor_limit(WEFT_INSTRUCTION_SETS);
}

static void a_scale_is_near_and_its_changes_are_nearer(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    weft_real before, after;
    assert_int_equal(weft_weave_read(WEFT_ASSETS "/weaves/cotton_denim.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    double exact = weave.specular_scale;
    assert_int_equal(weft_weave_specular_scale_batch(&weave, &before, &error), WEFT_OK);
    assert_true(fabs(before / exact - 1) < 0.02);
    for (int k = 0; k < weave.yarn_count; k++)
        weave.yarn[k].segment.umax *= 1.3;
    weft_weave_update_yarns(&weave);
    assert_true(weave.specular_scale == exact);
    weft_weave_update(&weave);
    assert_int_equal(weft_weave_specular_scale_batch(&weave, &after, &error), WEFT_OK);
    assert_true(fabs(weave.specular_scale / exact - 1) > 0.02);
    assert_true(fabs(after / before / (weave.specular_scale / exact) - 1) < 0.004);
    weft_weave_free(&weave);
}

int test_woven_batch(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(textures_of_ordinary_cloth_are_those_of_the_scalar_function),
        cmocka_unit_test(textures_at_the_extremes_are_those_of_the_scalar_function),
        cmocka_unit_test(reflectances_of_ordinary_cloth_are_within_a_ten_thousandth),
        cmocka_unit_test(reflectances_at_the_extremes_are_within_a_thousandth),
        cmocka_unit_test(means_of_a_tile_are_within_a_thousandth),
        cmocka_unit_test(a_scale_is_near_and_its_changes_are_nearer),
        cmocka_unit_test(every_instruction_set_gives_the_same_within_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
