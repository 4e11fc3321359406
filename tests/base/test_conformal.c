/* Ranks, ties, too few scores; and that bounds cover what they say, of scores and of groups. */
#include "tests/support/cmocka_all.h"

#include "base/numeric/conformal.h"

#include <math.h>

static void the_rank_counts_the_score_that_is_not_seen(void **state)
{
    (void)state;
    assert_int_equal(weft_conformal_rank(19, 0.95), 19);
    assert_int_equal(weft_conformal_rank(18, 0.95), 0);
    assert_int_equal(weft_conformal_rank(20, 0.95), 20);
    assert_int_equal(weft_conformal_rank(39, 0.95), 38);
    assert_int_equal(weft_conformal_rank(1000, 0.95), 951);
    assert_int_equal(weft_conformal_rank(9, 0.9), 9);
    assert_int_equal(weft_conformal_rank(9, 0), 1);
    assert_int_equal(weft_conformal_rank(0, 0.5), 0);
}

/* Each score is a group of its own. */
static double quantile_of(const double *score, int count, double level)
{
    weft_grouped_score own[20];
    size_t groups;
    double quantile;
    for (int i = 0; i < count; i++)
        own[i] = (weft_grouped_score){(float)score[i], (uint32_t)i};
    assert_int_equal(weft_conformal_quantile_of_groups(own, (size_t)count, level, &quantile, &groups, NULL), WEFT_OK);
    assert_int_equal(groups, count);
    return quantile;
}

static void too_few_scores_bound_nothing(void **state)
{
    (void)state;
    double score[19];
    for (int i = 0; i < 19; i++)
        score[i] = (7 * i) % 19;
    assert_true(isinf(quantile_of(score, 18, 0.95)));
    assert_true(quantile_of(score, 19, 0.95) == 18);
    assert_true(quantile_of(score, 19, 0.5) == 9);
}

static void equal_scores_are_any_of_them(void **state)
{
    (void)state;
    double score[] = {2, 1, 2, 2, 1, 2, 3, 2, 2};
    assert_true(quantile_of(score, 9, 0.5) == 2);
    assert_true(quantile_of(score, 9, 0.2) == 1);
    assert_true(quantile_of(score, 9, 0.9) == 3);
}

/* Every group weighs the same, whatever it holds: 20 of 21 groups are 0, and the one with most scores is 1. */
static void a_large_group_weighs_as_a_small_one(void **state)
{
    (void)state;
    weft_grouped_score score[20 + 1000];
    size_t groups;
    double quantile;
    for (uint32_t i = 0; i < 20; i++)
        score[i] = (weft_grouped_score){0, i};
    for (size_t i = 20; i < 1020; i++)
        score[i] = (weft_grouped_score){1, 20};
    assert_int_equal(weft_conformal_quantile_of_groups(score, 1020, 0.9, &quantile, &groups, NULL), WEFT_OK);
    assert_int_equal(groups, 21);
    assert_true(quantile == 0);
    /* 0.93 of 21 groups and the one that is not seen is more than 20. */
    assert_int_equal(weft_conformal_quantile_of_groups(score, 1020, 0.93, &quantile, &groups, NULL), WEFT_OK);
    assert_true(quantile == 1);
}

static void too_few_groups_bound_nothing(void **state)
{
    (void)state;
    weft_grouped_score score[2000];
    size_t groups;
    double quantile;
    for (uint32_t i = 0; i < 2000; i++)
        score[i] = (weft_grouped_score){1, i % 18};
    assert_int_equal(weft_conformal_quantile_of_groups(score, 2000, 0.95, &quantile, &groups, NULL), WEFT_OK);
    assert_int_equal(groups, 18);
    assert_true(isinf(quantile));
    assert_int_equal(weft_conformal_quantile_of_groups(score, 2000, 0.9, &quantile, &groups, NULL), WEFT_OK);
    assert_true(quantile == 1);
    assert_int_equal(weft_conformal_quantile_of_groups(score, 0, 0.9, &quantile, &groups, NULL), WEFT_OK);
    assert_true(isinf(quantile));
}

/* ---- Coverage ---- */

static uint64_t random_state = 1;

/* Below 1. */
static double draw(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) * 0x1p-53;
}

/* Scores of a photograph go together: each is its own number times one of the photograph, which varies tenfold. */
static void put_group(uint32_t group, size_t count, weft_grouped_score *score)
{
    double own = exp(2.3 * draw());
    for (size_t i = 0; i < count; i++)
        score[i] = (weft_grouped_score){(float)(own * draw()), group};
}

enum { GROUPS = 24, EACH = 20, REPEATS = 4000 };

/* A score of a group that was not seen lies below the bound with a probability from 0.95 to 0.95 + 1 / 25, for what is
 * at infinity, and what one score weighs. */
static void a_score_of_an_unseen_group_is_covered(void **state)
{
    (void)state;
    double covered = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        weft_grouped_score score[(GROUPS + 1) * EACH];
        size_t groups;
        double quantile;
        for (uint32_t group = 0; group <= GROUPS; group++)
            put_group(group, EACH, score + (size_t)group * EACH);
        weft_grouped_score unseen[EACH];
        for (int i = 0; i < EACH; i++)
            unseen[i] = score[GROUPS * EACH + i];
        weft_conformal_quantile_of_groups(score, GROUPS * EACH, 0.95, &quantile, &groups, NULL);
        for (int i = 0; i < EACH; i++)
            covered += (double)unseen[i].score <= quantile;
    }
    covered /= (double)REPEATS * EACH;
    print_message("covered: %.4f\n", covered);
    assert_true(covered > 0.95 && covered < 0.9925);
}

/* Of n scores by themselves: (n + 1) 0.95 / (n + 1), exactly 0.95 with 19. */
static void a_score_that_is_not_seen_is_covered(void **state)
{
    (void)state;
    double covered = 0;
    for (int repeat = 0; repeat < 10 * REPEATS; repeat++) {
        double score[20];
        for (int i = 0; i < 20; i++)
            score[i] = -log(1 - draw());
        covered += (double)(float)score[19] <= quantile_of(score, 19, 0.95);
    }
    covered /= 10 * REPEATS;
    print_message("covered: %.4f\n", covered);
    assert_true(fabs(covered - 0.95) < 0.004);
}

int test_conformal(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rank_counts_the_score_that_is_not_seen),
        cmocka_unit_test(too_few_scores_bound_nothing),
        cmocka_unit_test(equal_scores_are_any_of_them),
        cmocka_unit_test(a_large_group_weighs_as_a_small_one),
        cmocka_unit_test(too_few_groups_bound_nothing),
        cmocka_unit_test(a_score_of_an_unseen_group_is_covered),
        cmocka_unit_test(a_score_that_is_not_seen_is_covered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
