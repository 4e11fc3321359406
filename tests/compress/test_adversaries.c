/* Data sets that lead a fit astray. Whatever they hold, no value of the material exceeds the stated multiple of the
 * brightest sample anywhere on the hemisphere. */
#include "compress/compress.h"
#include "tests/support/adversaries.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"
#include "tests/support/synthetic_dataset.h"

#include <math.h>
#include <stdio.h>

/* Directions tried; the second with an argument. */
enum { TRIALS = 3000, MORE_TRIALS = 30000 };

/* A ceiling is rounded up to a half float. */
#define ROUNDING 1.001

static adversary_limits limits;

static double error_of(weft_dataset *dataset, const weft_compress_options *options, double *share)
{
    weft_material material;
    weft_error error = {0};
    weft_compress_report report;
    if (weft_compress(dataset, options, NULL, &material, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(
        adversary_largest_share(&material, &limits, 1, suite_argument ? MORE_TRIALS : TRIALS, share, &error), WEFT_OK);
    double left = material.level[0].error.relative_rmse;
    weft_material_free(&material);
    return left;
}

static void check(const adversary *one)
{
    assert_int_equal(adversary_write(one, "adversary.btf.h5", &limits), WEFT_OK);
    weft_dataset *dataset = synthetic_dataset_open("adversary.btf.h5");
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.levels = false;
    for (options.lobe_count = 1; options.lobe_count <= 3; options.lobe_count++) {
        double share, left = error_of(dataset, &options, &share);
        printf("%s, %d lobes: error %.4f, %.2f of the limit\n", one->name, options.lobe_count, left, share);
        assert_true(share <= ROUNDING);
    }
    weft_dataset_close(dataset);
    remove("adversary.btf.h5");
}

static void no_value_exceeds_the_limit(void **state)
{
    check(*state);
}

int test_adversaries(void)
{
    struct CMUnitTest tests[ADVERSARIES];
    for (int i = 0; i < ADVERSARIES; i++)
        tests[i] = (struct CMUnitTest){.name = adversaries[i].name,
                                       .test_func = no_value_exceeds_the_limit,
                                       .initial_state = (void *)&adversaries[i]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
