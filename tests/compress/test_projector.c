/* Coefficients of texels that lack samples or have clipped ones. */
#include "tests/support/cmocka_all.h"

#include "compress/components/factorisation.h"
#include "tests/support/expect_ok.h"
#include <math.h>
#include <stdlib.h>

enum { COUNT = 4, IMAGES = 3, LENGTH = 16, RED = WEFT_SAMPLE_CLIPPED, GREEN = WEFT_SAMPLE_CLIPPED << 1 };

static const float truth[COUNT] = {1.5f, -0.75f, 0.5f, 2};

typedef struct problem {
    float factor[COUNT * LENGTH] __attribute__((aligned(64)));
    float vector[LENGTH] __attribute__((aligned(64)));
    uint8_t known[IMAGES];
    float found[COUNT];
} problem;

/* Factors without any order, and the samples that the coefficients of `truth` give. */
static problem problem_of(void)
{
    problem p = {.known = {WEFT_SAMPLE_VALID, WEFT_SAMPLE_VALID, WEFT_SAMPLE_VALID}};
    for (size_t k = 0; k < COUNT; k++)
        for (size_t i = 0; i < 3 * IMAGES; i++) {
            p.factor[k * LENGTH + i] = (float)fmod(0.37 + 0.7548776662466927 * (double)(k * 17 + i * 5 + k * i), 1);
            p.vector[i] += truth[k] * p.factor[k * LENGTH + i];
        }
    return p;
}

static void solve(problem *p)
{
    double variance[COUNT] = {1, 1, 1, 1};
    weft_factorisation prior = {.count = COUNT, .length = LENGTH, .vector = p->factor, .variance = variance};
    weft_projector projector;
    weft_error error = {0};
    const float *vector = p->vector;
    const uint8_t *known = p->known;
    prior.noise = 1e-9;
    expect_ok(weft_projector_create(&prior, p->factor, IMAGES, &projector, &error), &error);
    expect_ok(weft_projector_solve(&projector, &vector, &known, 1, p->found, &error), &error);
    weft_projector_free(&projector);
}

static double distance_from_truth(const problem *p)
{
    double most = 0;
    for (int k = 0; k < COUNT; k++)
        most = fmax(most, fabs((double)(p->found[k] - truth[k])));
    return most;
}

/* Five channels that did not clip are enough for four coefficients, wherever they stand. */
static void what_did_not_clip_decides(void **state)
{
    (void)state;
    problem p = problem_of();
    p.known[1] = RED;
    p.known[2] = RED | GREEN;
    p.known[0] = 0;
    p.vector[0] = p.vector[1] = p.vector[2] = 0;
    p.vector[3] -= 0.25f;
    p.vector[6] -= 0.5f;
    p.vector[7] -= 0.125f;
    solve(&p);
    assert_true(distance_from_truth(&p) > 1e-3); /* three are not */
    p = problem_of();
    p.known[1] = RED;
    p.known[2] = RED | GREEN;
    p.vector[3] -= 0.25f;
    p.vector[6] -= 0.5f;
    p.vector[7] -= 0.125f;
    solve(&p);
    assert_true(distance_from_truth(&p) < 1e-3);
}

/* One that is said to be brighter than all others allow is as wrong as any sample would be. */
static void nothing_is_said_to_be_darker_than_it_looks_for_free(void **state)
{
    (void)state;
    problem clipped = problem_of(), valid = problem_of();
    clipped.vector[3] += 0.25f;
    valid.vector[3] += 0.25f;
    clipped.known[1] = RED;
    solve(&clipped);
    solve(&valid);
    for (int k = 0; k < COUNT; k++)
        assert_float_equal(clipped.found[k], valid.found[k], 1e-5);
    assert_true(distance_from_truth(&clipped) > 1e-3);
}

/* What the components of many texels say of clipped samples. */
static void factors_go_on_where_samples_clip(void **state)
{
    (void)state;
    enum { TEXELS = 64, VIEWS_OF_A_PEAK = 12 };
    weft_training training;
    weft_factorisation found;
    weft_error error = {0};
    expect_ok(weft_training_allocate(TEXELS, 48, VIEWS_OF_A_PEAK, &training, &error), &error);
    float peak = 0;
    for (size_t texel = 0; texel < TEXELS; texel++)
        for (size_t i = 0; i < VIEWS_OF_A_PEAK; i++) {
            double from_peak = (double)i - 5, shine = exp(-0.3 * from_peak * from_peak);
            double value = 0.1 + (0.05 * (double)(texel % 8) + 0.1 * (double)(texel / 8)) * shine;
            float *sample = training.vector + texel * training.length + 3 * i;
            bool clips = value > 0.6 && texel % 8 < 5;
            peak = fmaxf(peak, clips ? (float)value : 0);
            sample[0] = sample[1] = sample[2] = clips ? 0.6f : (float)value;
            training.known[texel * VIEWS_OF_A_PEAK + i] = clips ? RED | GREEN | WEFT_SAMPLE_CLIPPED << 2 : 1;
        }
    expect_ok(weft_factorisation_find(&training, 3, &found, &error), &error);
    print_message("noise %.2g, brightest %.2f\n", found.noise, (double)peak);
    assert_true(peak > 0.85f);
    assert_true(found.noise < 2e-5); /* clipped samples that count as they look leave 2e-4 */
    weft_factorisation_free(&found);
    weft_training_free(&training);
}

int test_projector(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_did_not_clip_decides),
        cmocka_unit_test(nothing_is_said_to_be_darker_than_it_looks_for_free),
        cmocka_unit_test(factors_go_on_where_samples_clip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
