/* The texture for the shader holds what the evaluator in C uses. */
#include "btf/direction/direction.h"
#include "reflectance/weave/shader_table.h"
#include "tests/reflectance/weave_text.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

static void table_holds_header_yarns_and_pattern(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    int width = 0, height = 0;
    assert_int_equal(weft_weave_parse(WEAVE_TEXT, "plain.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    weft_weave_table(&weave, NULL, &width, &height);
    assert_int_equal(width, WEFT_WEAVE_TABLE_WIDTH);
    assert_int_equal(height, 1);
    float(*texel)[4] = calloc((size_t)width * (size_t)height, sizeof *texel);
    assert_non_null(texel);
    weft_weave_table(&weave, texel[0], &width, &height);
    const float header[3][4] = {{2, 2, 4, 0}, {3, 50, 0, 0}, {(float)(8 * WEFT_PI / 180), 0, 0, 0}};
    for (int i = 0; i < 12; i++)
        assert_true(fabs((double)texel[i / 4][i % 4] - (double)header[i / 4][i % 4]) < 1e-7);
    const float(*third)[4] = (const float(*)[4])texel + WEFT_WEAVE_TABLE_HEADER + 2 * WEFT_WEAVE_TABLE_YARN;
    const weft_yarn *yarn = &weave.yarn[2];
    assert_true(third[0][1] == (float)yarn->segment.beta && third[0][3] == (float)yarn->prepared.phase_scale);
    assert_true(third[1][1] == 0 && third[1][2] == (float)yarn->segment.umax);
    assert_true(third[2][3] == (float)yarn->area_weight && third[3][2] == 0);
    assert_true(third[4][1] == (float)yarn->kd.g && third[4][3] == (float)yarn->max_umax);
    assert_true(fabs((double)(third[5][0] - (float)(yarn->ks.r * weave.specular_scale))) < 1e-4);
    const float *pattern = texel[WEFT_WEAVE_TABLE_HEADER + 4 * WEFT_WEAVE_TABLE_YARN];
    assert_true(pattern[0] == 0 && pattern[1] == 2 && pattern[2] == 3 && pattern[3] == 1);
    free(texel);
    weft_weave_free(&weave);
}

int test_weave_table(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(table_holds_header_yarns_and_pattern)};
    return cmocka_run_group_tests_name("weave table", tests, NULL, NULL);
}
