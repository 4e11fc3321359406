/* What a material says of its error on what it was not fitted to comes back, and is told in words. */
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"

#include "btf/material/held_out.h"

#include <string.h>

static void the_record_of_a_material_comes_back(void **state)
{
    (void)state;
    weft_hold_out result = {.kind = WEFT_SPLIT_DIRECTIONS,
                            .split_count = 2,
                            .view_count = 81,
                            .view_held_count = 8,
                            .light_count = 80,
                            .light_held_count = 7,
                            .image_count = 6480,
                            .image_held_count = 1200,
                            .texel_count = 144,
                            .dataset_texel_count = 4096};
    result.material.all = (weft_error_summary){0.1, 0.2, 0.3, 0.412, 30, 100};
    result.material.light = (weft_error_summary){0.1, 0.2, 0.3, 0.5, 30, 50};
    result.photographs.all = (weft_error_summary){0.1, 0.2, 0.3, 0.336, 30, 90};
    result.fitted = (weft_error_summary){0.1, 0.2, 0.3, 0.391, 30, 80};
    weft_material material;
    weft_hold_out back;
    assert_int_equal(weft_material_create(1, 1, 0, 0, 0, 0, &material, NULL), WEFT_OK);
    bool found = true;
    assert_int_equal(weft_hold_out_read(material.metadata, &found, &back, NULL), WEFT_OK);
    assert_false(found);
    assert_int_equal(weft_hold_out_store(&result, &material, NULL), WEFT_OK);
    assert_int_equal(weft_hold_out_read(material.metadata, &found, &back, NULL), WEFT_OK);
    assert_true(found);
    assert_memory_equal(&back, &result, sizeof back);
    char line[WEFT_HOLD_OUT_LINE];
    weft_hold_out_headline(&back, line);
    assert_string_equal(line, "on directions that were not fitted: relative RMSE 41.2 % (the photographs themselves, "
                              "interpolated: 33.6 %); on those that were: 39.1 %");
    weft_hold_out_explain(&back, line);
    assert_non_null(strstr(line, "8 of 81 views and 7 of 80 lights left out"));
    assert_non_null(strstr(line, "on 144 of 4096 texels"));
    weft_material_free(&material);
}

int test_held_out(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_record_of_a_material_comes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
