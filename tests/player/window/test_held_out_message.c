/* What the window says of the error of a material, and of which pictures of it that is true. */
#include "player/window/held_out_message.h"
#include "tests/support/expect_ok.h"

static weft_hold_out measured(weft_split_kind kind)
{
    weft_hold_out h = {.kind = kind};
    h.material.all = (weft_error_summary){.relative_rmse = 0.2024, .count = 100};
    h.photographs.all = (weft_error_summary){.relative_rmse = 0.336, .count = 100};
    h.fitted = (weft_error_summary){.relative_rmse = 0.161, .count = 100};
    return h;
}

static void expect_words(const weft_hold_out *held_out, const char *words)
{
    char line[WEFT_HOLD_OUT_LINE];
    weft_held_out_message(held_out, line);
    assert_string_equal(line, words);
}

static void the_line_names_what_was_not_fitted(void **state)
{
    (void)state;
    weft_hold_out h = measured(WEFT_SPLIT_DIRECTIONS);
    expect_words(&h,
                 "error on directions that were not fitted: compressed 20.2 %, the photographs interpolated 33.6 %");
    h = measured(WEFT_SPLIT_EACH);
    h.photographs.all.count = 0;
    expect_words(&h, "error on photographs that were not fitted: compressed 20.2 %");
}

static void fewer_components_are_not_what_was_measured(void **state)
{
    (void)state;
    weft_scene scene = weft_scene_default();
    assert_true(weft_draws_whole_material(&scene, 32, false));
    scene.lobe[0] = scene.view_table = false; /* components have neither */
    assert_true(weft_draws_whole_material(&scene, 32, false));
    scene.components = 28;
    assert_false(weft_draws_whole_material(&scene, 32, false));
    assert_true(weft_draws_whole_material(&scene, 28, false));
}

static void lobes_without_a_part_are_not_what_was_measured(void **state)
{
    (void)state;
    weft_scene scene = weft_scene_default();
    assert_true(weft_draws_whole_material(&scene, 0, false));
    scene.components = 0;
    assert_true(weft_draws_whole_material(&scene, 0, false));
    scene.lobe[WEFT_SCENE_MAX_LOBES - 1] = false;
    assert_false(weft_draws_whole_material(&scene, 0, false));
    scene = weft_scene_default();
    scene.view_table = false;
    assert_false(weft_draws_whole_material(&scene, 0, false));
    scene = weft_scene_default();
    scene.light_table = false;
    assert_false(weft_draws_whole_material(&scene, 0, false));
}

static void heights_that_are_left_out_are_not_what_was_measured(void **state)
{
    (void)state;
    weft_scene scene = weft_scene_default();
    assert_true(weft_draws_whole_material(&scene, 32, true));
    scene.relief = false;
    assert_false(weft_draws_whole_material(&scene, 32, true));
    assert_true(weft_draws_whole_material(&scene, 32, false));
}

int test_held_out_message(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_line_names_what_was_not_fitted),
        cmocka_unit_test(fewer_components_are_not_what_was_measured),
        cmocka_unit_test(lobes_without_a_part_are_not_what_was_measured),
        cmocka_unit_test(heights_that_are_left_out_are_not_what_was_measured),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
