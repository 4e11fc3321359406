/* What the user takes back and does again. */
#include "player/window/history.h"
#include "tests/support/cmocka_all.h"

#include <string.h>

enum { YARNS = 3 };

static weft_yarn yarns[YARNS];

static weft_weave_edit edited(void)
{
    memset(yarns, 0, sizeof yarns);
    weft_weave_edit edit = {.reads = 1, .weave = {.yarn_count = YARNS, .yarn = yarns}};
    for (int i = 0; i < YARNS; i++)
        yarns[i].segment.psi = (weft_real)(0.1 * i);
    return edit;
}

static void what_was_done_is_taken_back_in_order_and_done_again(void **state)
{
    (void)state;
    weft_history history = {0};
    weft_weave_edit weave = edited();
    weft_scene scene = weft_scene_default();
    double exposure = scene.exposure;
    bool changed;
    weft_history_note(&history, &scene, &weave);
    scene.exposure = 2 * exposure;
    weft_history_note(&history, &scene, &weave);
    yarns[1].segment.psi = 1;
    weft_history_note(&history, &scene, &weave);
    scene.light[0].direction.phi_rad += 1;

    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    assert_false(changed);
    assert_float_equal(scene.light[0].direction.phi_rad, weft_scene_default().light[0].direction.phi_rad, 0);
    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    assert_true(changed && weave.is_changed && weave.is_unsaved);
    assert_float_equal((double)yarns[1].segment.psi, 0.1, 1e-6);
    assert_float_equal(scene.exposure, 2 * exposure, 0);
    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    assert_float_equal(scene.exposure, exposure, 0);
    assert_false(weft_history_undo(&history, &scene, &weave, &changed));

    for (int i = 0; i < 3; i++)
        assert_true(weft_history_redo(&history, &scene, &weave, &changed));
    assert_false(weft_history_redo(&history, &scene, &weave, &changed));
    assert_float_equal((double)yarns[1].segment.psi, 1, 0);
    assert_float_equal(scene.light[0].direction.phi_rad, weft_scene_default().light[0].direction.phi_rad + 1, 0);
    weft_history_free(&history);
}

static void another_change_forgets_what_was_taken_back(void **state)
{
    (void)state;
    weft_history history = {0};
    weft_weave_edit weave = edited();
    weft_scene scene = weft_scene_default();
    bool changed;
    weft_history_note(&history, &scene, &weave);
    scene.exposure = 2;
    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    scene.exposure = 3;
    assert_false(weft_history_redo(&history, &scene, &weave, &changed));
    assert_float_equal(scene.exposure, 3, 0);
    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    assert_float_equal(scene.exposure, weft_scene_default().exposure, 0);
    weft_history_free(&history);
}

static void the_camera_is_no_change_and_stays(void **state)
{
    (void)state;
    weft_history history = {0};
    weft_weave_edit weave = edited();
    weft_scene scene = weft_scene_default();
    bool changed;
    weft_history_note(&history, &scene, &weave);
    weft_orbit_turn(&scene.orbit, 1, 0.1);
    weft_orbit turned = scene.orbit;
    assert_false(weft_history_undo(&history, &scene, &weave, &changed));
    scene.exposure = 2;
    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    assert_memory_equal(&scene.orbit, &turned, sizeof turned);
    weft_history_free(&history);
}

static void a_weave_that_was_read_since_is_left_alone(void **state)
{
    (void)state;
    weft_history history = {0};
    weft_weave_edit weave = edited();
    weft_scene scene = weft_scene_default();
    bool changed;
    weft_history_note(&history, &scene, &weave);
    yarns[0].segment.psi = 2;
    weave.reads++;
    assert_true(weft_history_undo(&history, &scene, &weave, &changed));
    assert_false(changed);
    assert_float_equal((double)yarns[0].segment.psi, 2, 0);
    weft_history_free(&history);
}

static void the_oldest_of_many_changes_is_forgotten(void **state)
{
    (void)state;
    weft_history history = {0};
    weft_weave_edit weave = edited();
    weft_scene scene = weft_scene_default();
    bool changed;
    int steps = 0;
    for (int i = 0; i < WEFT_HISTORY_LENGTH + 9; i++) {
        scene.exposure = i + 1;
        weft_history_note(&history, &scene, &weave);
    }
    while (weft_history_undo(&history, &scene, &weave, &changed))
        steps++;
    assert_int_equal(steps, WEFT_HISTORY_LENGTH - 1);
    assert_float_equal(scene.exposure, 10, 0);
    weft_history_free(&history);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_done_is_taken_back_in_order_and_done_again),
        cmocka_unit_test(another_change_forgets_what_was_taken_back),
        cmocka_unit_test(the_camera_is_no_change_and_stays),
        cmocka_unit_test(a_weave_that_was_read_since_is_left_alone),
        cmocka_unit_test(the_oldest_of_many_changes_is_forgotten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
