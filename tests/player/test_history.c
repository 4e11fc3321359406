/* What the user takes back and does again. */
#include "player/window/history.h"
#include "tests/support/cmocka_all.h"

#include <string.h>

enum { YARNS = 3 };

static weft_yarn yarns[YARNS];

static weft_history history;
static weft_weave_edit weave;
static weft_scene scene;
static bool changed; /* the weave */

/* A scene that was noted once. */
static int begin(void **state)
{
    (void)state;
    memset(yarns, 0, sizeof yarns);
    for (int i = 0; i < YARNS; i++)
        yarns[i].segment.psi = (weft_real)(0.1 * i);
    weave = (weft_weave_edit){.reads = 1, .weave = {.yarn_count = YARNS, .yarn = yarns}};
    scene = weft_scene_default();
    history = (weft_history){0};
    weft_history_note(&history, &scene, &weave);
    return 0;
}

static int end(void **state)
{
    (void)state;
    weft_history_free(&history);
    return 0;
}

static bool undo(void)
{
    return weft_history_undo(&history, &scene, &weave, &changed);
}

static void what_was_done_is_taken_back_in_order_and_done_again(void **state)
{
    (void)state;
    double exposure = scene.exposure;
    scene.exposure = 2 * exposure;
    weft_history_note(&history, &scene, &weave);
    yarns[1].segment.psi = 1;
    weft_history_note(&history, &scene, &weave);
    scene.light[0].direction.phi_rad += 1;

    assert_true(undo());
    assert_false(changed);
    assert_float_equal(scene.light[0].direction.phi_rad, weft_scene_default().light[0].direction.phi_rad, 0);
    assert_true(undo());
    assert_true(changed && weave.is_changed && weave.is_unsaved);
    assert_float_equal((double)yarns[1].segment.psi, 0.1, 1e-6);
    assert_float_equal(scene.exposure, 2 * exposure, 0);
    assert_true(undo());
    assert_float_equal(scene.exposure, exposure, 0);
    assert_false(undo());

    for (int i = 0; i < 3; i++)
        assert_true(weft_history_redo(&history, &scene, &weave, &changed));
    assert_false(weft_history_redo(&history, &scene, &weave, &changed));
    assert_float_equal((double)yarns[1].segment.psi, 1, 0);
    assert_float_equal(scene.light[0].direction.phi_rad, weft_scene_default().light[0].direction.phi_rad + 1, 0);
}

static void another_change_forgets_what_was_taken_back(void **state)
{
    (void)state;
    scene.exposure = 2;
    assert_true(undo());
    scene.exposure = 3;
    assert_false(weft_history_redo(&history, &scene, &weave, &changed));
    assert_float_equal(scene.exposure, 3, 0);
    assert_true(undo());
    assert_float_equal(scene.exposure, weft_scene_default().exposure, 0);
}

static void the_camera_is_no_change_and_stays(void **state)
{
    (void)state;
    weft_orbit_turn(&scene.orbit, 1, 0.1);
    weft_orbit turned = scene.orbit;
    assert_false(undo());
    scene.exposure = 2;
    assert_true(undo());
    assert_memory_equal(&scene.orbit, &turned, sizeof turned);
}

static void a_weave_that_was_read_since_is_left_alone(void **state)
{
    (void)state;
    yarns[0].segment.psi = 2;
    weave.reads++;
    assert_true(undo());
    assert_false(changed);
    assert_float_equal((double)yarns[0].segment.psi, 2, 0);
}

static void the_oldest_of_many_changes_is_forgotten(void **state)
{
    (void)state;
    int steps = 0;
    for (int i = 0; i < WEFT_HISTORY_LENGTH + 9; i++) {
        scene.exposure = i + 1;
        weft_history_note(&history, &scene, &weave);
    }
    while (undo())
        steps++;
    assert_int_equal(steps, WEFT_HISTORY_LENGTH - 1);
    assert_float_equal(scene.exposure, 10, 0);
}

int test_history(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_was_done_is_taken_back_in_order_and_done_again, begin, end),
        cmocka_unit_test_setup_teardown(another_change_forgets_what_was_taken_back, begin, end),
        cmocka_unit_test_setup_teardown(the_camera_is_no_change_and_stays, begin, end),
        cmocka_unit_test_setup_teardown(a_weave_that_was_read_since_is_left_alone, begin, end),
        cmocka_unit_test_setup_teardown(the_oldest_of_many_changes_is_forgotten, begin, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
