#include "aliasing.h"
#include "stage.h"

#include <stdio.h>

static void mip_levels_lower_the_aliasing_of_a_far_checkerboard_tenfold(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_material checker;
    aliasing a;
    stage_checker(32, &checker);
    expect_ok(weft_player_set_material(s->player, &checker, &error), &error);
    expect_ok(aliasing_measure(s->player, aliasing_scene(150), 200, 150, 12, &a, &error), &error);
    printf("aliasing energy %.3g without mip levels, %.3g with them: %.0f times lower over %ld pixels\n",
           a.energy_without, a.energy_with, a.energy_without / a.energy_with, a.pixels);
    assert_true(a.pixels > 2000);
    assert_true(a.energy_with * 10 <= a.energy_without);
    aliasing_free(&a);
    weft_material_free(&checker);
}

int test_aliasing(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mip_levels_lower_the_aliasing_of_a_far_checkerboard_tenfold),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}
