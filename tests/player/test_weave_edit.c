/* Changing the weave on the cloth. */
#include "base/clock.h"
#include "player/window/weave_edit.h"
#include "stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const char *const cloth = WEFT_ASSETS "/weaves/cotton_twill.wv";

static const weft_weave_parameter_range *range_of(const char *name)
{
    const weft_weave_parameter_range *range = weft_weave_ranges;
    while (strcmp(range->name, name) != 0)
        range++;
    return range;
}

static const weft_weave_layout layout = {3, 2, 0.25, 0.5};

static weft_weave_edit edit_of(weft_player *player, const char *path)
{
    weft_weave_edit edit = {0};
    weft_weave weave;
    weft_error error = {0};
    expect_ok(weft_weave_read(cloth, NULL, 0, &weave, NULL, &error), &error);
    expect_ok(weft_player_set_weave(player, &weave, &layout, &error), &error);
    weft_weave_free(&weave);
    expect_ok(weft_weave_edit_follow(&edit, player, path, &error), &error);
    return edit;
}

static void a_value_reaches_the_yarns_that_were_alike_and_no_others(void **state)
{
    weft_weave_edit edit = edit_of(((stage *)*state)->player, cloth);
    const weft_yarn *yarn = edit.weave.yarn;
    int changed = 0, kept = 0;
    edit.yarn = 1;
    weft_weave_edit_set(&edit, range_of("Incline"), 0.3);
    assert_true(fabs(weft_weave_edit_get(&edit, range_of("Incline")) - 0.3) < 1e-6);
    for (int i = 0; i < edit.weave.yarn_count; i++) {
        bool is_alike = yarn[i].alike == yarn[1].alike;
        assert_int_equal(fabs((double)yarn[i].segment.umax - 0.3) < 1e-6, is_alike);
        changed += is_alike;
        kept += !is_alike;
    }
    assert_true(changed > 1 && kept > 0);
    edit.alike = false;
    weft_weave_edit_set_colours(&edit, (weft_rgb){0.5, 0.25, 0.125}, yarn[1].ks);
    for (int i = 0; i < edit.weave.yarn_count; i++)
        assert_int_equal(yarn[i].kd.r == (weft_real)0.5, i == 1);
    weft_weave_edit_free(&edit);
}

/* Until what follows from the last change is shown to its last digits; the number of times something was. */
static int wait_for(weft_weave_edit *edit, weft_player *player)
{
    weft_error error = {0};
    int count = 0;
    for (int ms = 0; edit->is_pending && ms < 60000; ms++) {
        bool shown;
        expect_ok(weft_weave_edit_poll(edit, player, &shown, &error), &error);
        count += shown;
        usleep(1000);
    }
    assert_false(edit->is_pending);
    return count;
}

static double mean_of(weft_player *player)
{
    weft_scene scene = weft_scene_default();
    weft_image image;
    weft_error error = {0};
    double sum = 0;
    scene.pane[0] = WEFT_MODE_ANALYTIC;
    expect_ok(weft_player_picture(player, &scene, 80, 60, 1, NULL, &image, &error), &error);
    for (int i = 0; i < 3 * 80 * 60; i++)
        sum += (double)image.pixels[i];
    weft_image_free(&image);
    return sum / (3 * 80 * 60);
}

static void the_player_shows_a_changed_weave_laid_as_before(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_weave_edit edit = edit_of(player, cloth);
    weft_error error = {0};
    double before = mean_of(player);
    for (edit.yarn = 0; edit.yarn < edit.weave.yarn_count; edit.yarn++)
        weft_weave_edit_set_colours(&edit, (weft_rgb){0.6, 0.6, 0.6}, (weft_rgb){0});
    edit.yarn = 0;
    expect_ok(weft_weave_edit_ask(&edit, &error), &error);
    wait_for(&edit, player);
    assert_true(mean_of(player) > before + 0.02);
    weft_weave_layout now = weft_player_weave_layout(player);
    assert_memory_equal(&now, &layout, sizeof now);
    expect_ok(weft_weave_edit_follow(&edit, player, cloth, &error), &error);
    assert_true(edit.is_changed && edit.weave.yarn[0].kd.g == (weft_real)0.6);
    weft_weave_edit_free(&edit);
}

static void only_the_latest_of_many_changes_is_followed_to_the_end(void **state)
{
    enum { STEPS = 60 };
    weft_player *player = ((stage *)*state)->player;
    weft_weave_edit edit = edit_of(player, cloth);
    weft_error error = {0};
    for (int step = 1; step <= STEPS; step++) {
        weft_weave_edit_set(&edit, range_of("Incline"), 0.2 + 0.01 * step);
        expect_ok(weft_weave_edit_ask(&edit, &error), &error);
    }
    assert_true(wait_for(&edit, player) < STEPS / 2);
    double followed = mean_of(player);
    weft_weave_update(&edit.weave);
    expect_ok(weft_player_set_weave(player, &edit.weave, &layout, &error), &error);
    assert_true(fabs(mean_of(player) / followed - 1) < 1e-6);
    weft_weave_edit_free(&edit);
}

/* By wall clock, as the worker waits. */
static double exact_scale_takes_us(const weft_weave *weave)
{
    double start_s = weft_now_s();
    assert_true(weft_weave_specular_scale(weave) > 0);
    return 1e6 * (weft_now_s() - start_s);
}

static void a_change_during_the_exact_step_of_the_one_before_is_followed_to_the_end(void **state)
{
    enum { REST_US = 150000 }; /* of the worker, before that step */
    weft_player *player = ((stage *)*state)->player;
    weft_weave_edit edit = edit_of(player, cloth);
    weft_error error = {0};
    bool shown = false;
    double half_us = 0.5 * exact_scale_takes_us(&edit.weave);
    weft_weave_edit_set(&edit, range_of("Incline"), 0.3);
    expect_ok(weft_weave_edit_ask(&edit, &error), &error);
    while (!shown)
        expect_ok(weft_weave_edit_poll(&edit, player, &shown, &error), &error);
    usleep((useconds_t)(REST_US + half_us));
    weft_weave_edit_set(&edit, range_of("Incline"), 0.8);
    expect_ok(weft_weave_edit_ask(&edit, &error), &error);
    wait_for(&edit, player);
    double followed = mean_of(player);
    weft_weave_update(&edit.weave);
    expect_ok(weft_player_set_weave(player, &edit.weave, &layout, &error), &error);
    assert_true(fabs(mean_of(player) / followed - 1) < 1e-6);
    weft_weave_edit_free(&edit);
}

static void a_change_that_comes_too_late_does_not_replace_another_weave(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_weave_edit edit = edit_of(player, cloth);
    weft_error error = {0};
    bool shown;
    expect_ok(weft_weave_edit_ask(&edit, &error), &error);
    weft_weave_edit again = edit_of(player, cloth);
    usleep(400000);
    expect_ok(weft_weave_edit_poll(&edit, player, &shown, &error), &error);
    assert_false(shown);
    weft_weave_edit_free(&again);
    weft_weave_edit_free(&edit);
}

static void another_weave_takes_the_place_of_a_changed_one(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_weave_edit edit = edit_of(player, cloth);
    weft_error error = {0};
    weft_weave_edit_set(&edit, range_of("Forward"), 7);
    weft_weave_edit again = edit_of(player, cloth);
    expect_ok(weft_weave_edit_follow(&edit, player, cloth, &error), &error);
    assert_false(edit.is_changed);
    assert_true(weft_weave_edit_get(&edit, range_of("Forward")) == weft_weave_edit_get(&again, range_of("Forward")));
    weft_weave_edit_free(&again);
    weft_weave_edit_free(&edit);
}

static void what_cannot_be_read_is_told_once_and_leaves_nothing(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_weave_edit edit = edit_of(player, NULL);
    weft_error error = {0};
    edit.revision = 0;
    assert_int_equal(weft_class_of(weft_weave_edit_follow(&edit, player, "no-such.wv", &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no-such.wv"));
    expect_ok(weft_weave_edit_follow(&edit, player, "no-such.wv", &error), &error);
    assert_int_equal(edit.weave.yarn_count, 0);
    weft_weave_edit_free(&edit);
}

static void a_saved_weave_reads_back_to_what_was_changed(void **state)
{
    weft_weave_edit edit = edit_of(((stage *)*state)->player, cloth);
    weft_weave again;
    weft_error error = {0};
    char path[32], folder[] = "weave_edit.XXXXXX";
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    weft_weave_edit_set(&edit, range_of("Twist"), -0.4);
    expect_ok(weft_weave_edit_save(&edit, path, &error), &error);
    assert_string_equal(path, "weft-001.wv");
    expect_ok(weft_weave_read(path, NULL, 0, &again, NULL, &error), &error);
    assert_true(fabs((double)again.yarn[0].segment.psi + 0.4) < 1e-6);
    assert_int_equal(again.yarn_count, edit.weave.yarn_count);
    weft_weave_free(&again);
    expect_ok(weft_weave_edit_save(&edit, path, &error), &error);
    assert_string_equal(path, "weft-002.wv");
    unlink("weft-001.wv");
    unlink("weft-002.wv");
    assert_int_equal(chdir(".."), 0);
    rmdir(folder);
    weft_weave_edit_free(&edit);
}

int test_weave_edit(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_value_reaches_the_yarns_that_were_alike_and_no_others),
        cmocka_unit_test(the_player_shows_a_changed_weave_laid_as_before),
        cmocka_unit_test(only_the_latest_of_many_changes_is_followed_to_the_end),
        cmocka_unit_test(a_change_during_the_exact_step_of_the_one_before_is_followed_to_the_end),
        cmocka_unit_test(a_change_that_comes_too_late_does_not_replace_another_weave),
        cmocka_unit_test(another_weave_takes_the_place_of_a_changed_one),
        cmocka_unit_test(what_cannot_be_read_is_told_once_and_leaves_nothing),
        cmocka_unit_test(a_saved_weave_reads_back_to_what_was_changed),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}
