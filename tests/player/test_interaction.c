#include "player/window/keys.h"
#include "tests/support/cmocka_all.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdio.h>
#include <string.h>

static weft_interaction fresh(void)
{
    return (weft_interaction){.scene = weft_scene_default(),
                              .start = weft_scene_default(),
                              .width = 800,
                              .height = 400,
                              .available = {true, true, false}};
}

static void drag(weft_interaction *i, int button, int modifiers, double x, double y)
{
    weft_interaction_press(i, button, true, modifiers, 100, 100);
    weft_interaction_move(i, 100 + x, 100 + y);
    weft_interaction_press(i, button, 0, modifiers, 100 + x, 100 + y);
}

static void a_left_drag_across_half_the_window_turns_half_way_round(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    double before = i.scene.orbit.azimuth_rad;
    weft_angles light = i.scene.light[0].direction;
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, 0, 400, 0);
    assert_float_equal(fabs(i.scene.orbit.azimuth_rad - before), WEFT_PI, 1e-9);
    assert_float_equal(i.scene.light[0].direction.phi_rad, light.phi_rad, 0);
    assert_true(i.changed);
}

static void a_right_or_shifted_drag_moves_only_the_light(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_orbit orbit = i.scene.orbit;
    double theta_rad = i.scene.light[0].direction.theta_rad;
    drag(&i, GLFW_MOUSE_BUTTON_RIGHT, 0, 0, 40);
    assert_float_equal(i.scene.light[0].direction.theta_rad - theta_rad, WEFT_PI / 10, 1e-9);
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_SHIFT, 0, -40);
    assert_float_equal(i.scene.light[0].direction.theta_rad, theta_rad, 1e-9);
    weft_keys_press(&i, GLFW_KEY_L, 0, false);
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, 0, 0, 40);
    assert_true(i.scene.light[0].direction.theta_rad > theta_rad);
    assert_memory_equal(&orbit, &i.scene.orbit, sizeof orbit);
}

static void expect_light(const weft_interaction *i, double x, double y, double z)
{
    weft_vec3 light = weft_direction_of_angles(i->scene.light[0].direction);
    assert_float_equal(light.x, x, 1e-6);
    assert_float_equal(light.y, y, 1e-6);
    assert_float_equal(light.z, z, 1e-6);
}

/* Seen from above the picture is a map of the hemisphere, of which 0.9 of the smaller side is the ball. */
static void the_light_of_one_view_goes_where_the_pointer_is(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    i.drag_moves_light = i.points_light = true;
    i.scene.orbit = (weft_orbit){.azimuth_rad = -WEFT_PI / 2, .elevation_rad = WEFT_PI / 2, .distance = 3};
    weft_orbit orbit = i.scene.orbit;
    weft_interaction_press(&i, GLFW_MOUSE_BUTTON_LEFT, true, 0, 400, 200);
    expect_light(&i, 0, 0, 1);
    assert_true(i.changed);
    weft_interaction_move(&i, 400 + 180 * 0.6, 200 - 180 * 0.48);
    expect_light(&i, 0.6, 0.48, 0.64);
    weft_interaction_move(&i, 10, 200);
    expect_light(&i, -sin(85 * WEFT_PI / 180), 0, cos(85 * WEFT_PI / 180));
    weft_interaction_press(&i, GLFW_MOUSE_BUTTON_LEFT, false, 0, 10, 200);
    weft_interaction_move(&i, 400, 200);
    expect_light(&i, -sin(85 * WEFT_PI / 180), 0, cos(85 * WEFT_PI / 180));
    assert_memory_equal(&orbit, &i.scene.orbit, sizeof orbit);
    weft_keys_press(&i, GLFW_KEY_L, 0, false);
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, 0, 100, 0);
    expect_light(&i, -sin(85 * WEFT_PI / 180), 0, cos(85 * WEFT_PI / 180));
    assert_true(i.scene.orbit.azimuth_rad != orbit.azimuth_rad);
}

static void without_a_light_the_environment_turns_instead_of_going_to_the_pointer(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    i.drag_moves_light = i.points_light = true;
    i.scene.light_count = 0;
    double turn_rad = i.scene.environment_turn_rad;
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, 0, 100, 0);
    assert_float_equal(i.scene.environment_turn_rad, turn_rad + WEFT_PI / 4, 1e-9);
}

static void a_move_without_a_button_changes_nothing(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, 0, 10, 10);
    i.changed = false;
    weft_scene scene = i.scene;
    weft_interaction_move(&i, 700, 300);
    assert_memory_equal(&scene, &i.scene, sizeof scene);
    assert_false(i.changed);
}

static void camera_and_light_stop_at_their_ends(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, 0, 0, 5000);
    assert_true(i.scene.orbit.elevation_rad < WEFT_PI / 2);
    drag(&i, GLFW_MOUSE_BUTTON_RIGHT, 0, 0, -5000);
    assert_float_equal(i.scene.light[0].direction.theta_rad, 0, 0);
    weft_interaction_scroll(&i, 1000);
    assert_true(i.scene.orbit.distance > 1);
    weft_interaction_scroll(&i, -1000);
    assert_true(i.scene.orbit.distance < 100);
}

static void mode_keys_show_what_is_there_and_ignore_what_is_not(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_1, 0, false);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_RAW);
    weft_keys_press(&i, GLFW_KEY_3, 0, false);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_RAW);
    weft_keys_press(&i, GLFW_KEY_S, 0, false);
    assert_int_equal(i.scene.pane_count, 2);
    weft_keys_press(&i, GLFW_KEY_2, 0, false);
    assert_int_equal(i.scene.pane_count, 1);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_COMPRESSED);
}

static void keys_toggle_and_undo_themselves(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    double exposure = i.scene.exposure;
    for (int choice = WEFT_LEVEL_NEAREST; choice <= WEFT_LEVEL_NONE; choice++) {
        weft_keys_press(&i, GLFW_KEY_M, 0, false);
        assert_int_equal(i.scene.level_choice, choice);
    }
    weft_keys_press(&i, GLFW_KEY_M, 0, false);
    assert_int_equal(i.scene.level_choice, WEFT_LEVEL_TRILINEAR);
    weft_keys_press(&i, GLFW_KEY_RIGHT_BRACKET, 0, false);
    assert_true(i.scene.exposure > exposure);
    weft_keys_press(&i, GLFW_KEY_LEFT_BRACKET, 0, false);
    assert_float_equal(i.scene.exposure, exposure, 1e-12);
    weft_keys_press(&i, GLFW_KEY_H, 0, false);
    assert_true(i.shows_help);
    weft_keys_press(&i, GLFW_KEY_H, 0, false);
    assert_false(i.shows_help);
}

/* The bounding sphere has radius 1: seen from d, its rim is asin(1 / d) from its centre. */
static void all_of_a_mesh_is_seen_from_where_the_camera_is(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_orbit_turn(&i.scene.orbit, 1, 0.2);
    weft_orbit before = i.scene.orbit;
    weft_orbit_pan(&i.scene.orbit, 0.5, -2);
    weft_orbit_zoom(&i.scene.orbit, 0.1);
    weft_keys_press(&i, GLFW_KEY_F, 0, false);
    assert_float_equal(tan(asin(1 / i.scene.orbit.distance)), weft_orbit_slope(), 1e-12);
    assert_true(i.scene.orbit.pan_right == 0 && i.scene.orbit.pan_up == 0);
    assert_true(i.scene.orbit.azimuth_rad == before.azimuth_rad && i.scene.orbit.elevation_rad == before.elevation_rad);
    assert_true(i.changed);
}

static void control_and_a_letter_undo_and_redo_where_the_letter_alone_does_not(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_Z, 0, false);
    assert_false(i.wants_undo);
    weft_keys_press(&i, GLFW_KEY_Z, GLFW_MOD_CONTROL, false);
    assert_true(i.wants_undo && !i.wants_redo);
    weft_keys_press(&i, GLFW_KEY_Y, GLFW_MOD_CONTROL, false);
    assert_true(i.wants_redo);
}

static void other_keys_are_wishes_for_the_caller(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_F12, 0, false);
    weft_keys_press(&i, GLFW_KEY_O, 0, false);
    weft_keys_press(&i, GLFW_KEY_ESCAPE, 0, false);
    assert_true(i.wants_screenshot);
    assert_string_equal(i.wants_mesh, "sphere");
    assert_true(i.wants_quit);
    assert_false(i.changed);
}

static void space_flips_between_the_last_two_modes(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_interaction_show(&i, WEFT_MODE_RAW);
    weft_interaction_show(&i, WEFT_MODE_COMPRESSED);
    weft_keys_press(&i, GLFW_KEY_SPACE, 0, false);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_RAW);
    weft_keys_press(&i, GLFW_KEY_SPACE, 0, false);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_COMPRESSED);
}

static void the_divider_of_a_wipe_follows_the_pointer_and_stays_in_the_picture(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_W, 0, false);
    assert_int_equal(i.scene.layout, WEFT_LAYOUT_WIPE);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_RAW);
    assert_int_equal(i.scene.pane[1], WEFT_MODE_COMPRESSED);
    weft_orbit orbit = i.scene.orbit;
    weft_interaction_press(&i, GLFW_MOUSE_BUTTON_LEFT, true, 0, 403, 100);
    weft_interaction_move(&i, 563, 100);
    assert_float_equal(i.scene.divider, 0.7, 1e-12);
    weft_interaction_move(&i, 5000, 100);
    assert_true(i.scene.divider < 1);
    assert_memory_equal(&orbit, &i.scene.orbit, sizeof orbit);
}

static void one_mode_alone_cannot_be_compared(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    i.available[WEFT_MODE_RAW] = false;
    weft_keys_press(&i, GLFW_KEY_X, 0, false);
    assert_int_equal(i.scene.layout, WEFT_LAYOUT_PANES);
    assert_int_equal(i.scene.pane_count, 1);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_COMPRESSED);
}

/* A point at the centre's distance moves with the pointer: the picture's height is 2 slope x distance radii. */
static void a_pan_moves_the_picture_with_the_pointer(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    drag(&i, GLFW_MOUSE_BUTTON_MIDDLE, 0, 0, 100);
    double height = 2 * weft_orbit_slope() * i.scene.orbit.distance;
    assert_float_equal(i.scene.orbit.pan_up, height / 4, 1e-12);
    assert_float_equal(i.scene.orbit.pan_right, 0, 0);
    drag(&i, GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_CONTROL, -100, 0);
    assert_float_equal(i.scene.orbit.pan_right, height / 4, 1e-12);
}

static void raw_is_shown_while_its_key_is_held_and_then_what_was_before(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_W, 0, false);
    const weft_scene before = i.scene;
    weft_keys_press(&i, GLFW_KEY_B, 0, false);
    weft_keys_press(&i, GLFW_KEY_B, 0, true);
    assert_int_equal(i.scene.layout, WEFT_LAYOUT_PANES);
    assert_int_equal(i.scene.pane_count, 1);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_RAW);
    i.scene.exposure = 2;
    weft_keys_release(&i, GLFW_KEY_B);
    assert_float_equal(i.scene.exposure, 2, 0);
    i.scene.exposure = before.exposure;
    assert_memory_equal(&before, &i.scene, sizeof before);
}

static void a_mode_that_is_chosen_while_raw_is_held_stays(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_W, 0, false);
    weft_keys_press(&i, GLFW_KEY_B, 0, false);
    weft_keys_press(&i, GLFW_KEY_2, 0, false);
    weft_keys_release(&i, GLFW_KEY_B);
    assert_int_equal(i.scene.layout, WEFT_LAYOUT_PANES);
    assert_int_equal(i.scene.pane[0], WEFT_MODE_COMPRESSED);
}

static void only_some_keys_repeat_while_they_are_held(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    double exposure = i.scene.exposure;
    weft_keys_press(&i, GLFW_KEY_C, 0, true);
    assert_false(i.scene.shadows);
    weft_keys_press(&i, GLFW_KEY_RIGHT_BRACKET, 0, true);
    assert_true(i.scene.exposure > exposure);
}

static void a_key_with_control_is_another_key(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_S, GLFW_MOD_CONTROL, false);
    assert_true(i.wants_screenshot);
    assert_int_equal(i.scene.pane_count, 1);
    weft_keys_press(&i, GLFW_KEY_W, GLFW_MOD_CONTROL, false);
    assert_int_equal(i.scene.layout, WEFT_LAYOUT_PANES);
}

static void a_key_that_can_do_nothing_says_what_is_missing(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_keys_press(&i, GLFW_KEY_3, 0, false);
    assert_non_null(strstr(i.message, "--weave"));
    weft_keys_press(&i, GLFW_KEY_E, 0, false);
    assert_non_null(strstr(i.message, "--environment"));
    assert_false(i.scene.environment);
    assert_false(i.changed);
}

static void a_key_that_changes_what_is_seen_says_so(void **state)
{
    static const struct {
        int code;
        const char *said;
    } press[] = {
        {GLFW_KEY_A, "turn by itself: on"},
        {GLFW_KEY_A, "turn by itself: off"},
        {GLFW_KEY_HOME, "camera as at the start"},
        {GLFW_KEY_0, "lights and exposure as at the start"},
        {GLFW_KEY_D, "drape"},
        {GLFW_KEY_O, "ball"},
        {GLFW_KEY_P, "plane"},
        {GLFW_KEY_W, "wipe"},
        {GLFW_KEY_SPACE, "wipe: compressed left, raw right"},
        {GLFW_KEY_X, "difference: second minus first"},
        {GLFW_KEY_SPACE, "difference: raw minus compressed"},
    };
    (void)state;
    weft_interaction i = fresh();
    for (size_t k = 0; k < sizeof press / sizeof *press; k++) {
        i.message[0] = 0;
        weft_keys_press(&i, press[k].code, 0, false);
        assert_string_equal(i.message, press[k].said);
    }
}

static void a_scene_whose_only_light_was_its_environment_gets_another(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    i.has_environment = i.scene.environment = true;
    i.scene.light_count = 0;
    drag(&i, GLFW_MOUSE_BUTTON_RIGHT, 0, 200, 0);
    assert_float_equal(i.scene.environment_turn_rad, WEFT_PI / 2, 1e-9);
    weft_keys_press(&i, GLFW_KEY_E, 0, false);
    assert_int_equal(i.scene.light_count, 1);
}

static void arrows_turn_what_a_plain_drag_turns(void **state)
{
    (void)state;
    weft_interaction i = fresh();
    weft_scene before = i.scene;
    weft_keys_press(&i, GLFW_KEY_RIGHT, 0, false);
    assert_true(i.scene.orbit.azimuth_rad < before.orbit.azimuth_rad);
    weft_keys_press(&i, GLFW_KEY_HOME, 0, false);
    assert_memory_equal(&i.scene.orbit, &before.orbit, sizeof before.orbit);
    weft_keys_press(&i, GLFW_KEY_L, 0, false);
    weft_keys_press(&i, GLFW_KEY_DOWN, 0, true);
    assert_true(i.scene.light[0].direction.theta_rad > before.light[0].direction.theta_rad);
    weft_keys_press(&i, GLFW_KEY_0, 0, false);
    assert_memory_equal(&i.scene, &before, sizeof before);
}

/* The table of docs/reference/keys.md is the table of the keys, line by line. */
static void the_docs_list_every_key_in_order(void **state)
{
    (void)state;
    static char page[65536];
    FILE *file = fopen(WEFT_TREE "/docs/reference/keys.md", "rb");
    assert_non_null(file);
    page[fread(page, 1, sizeof page - 1, file)] = 0;
    fclose(file);
    size_t count;
    const weft_key *key = weft_keys(&count);
    const char *at = page;
    for (size_t k = 0; k < count; k++) {
        char line[256];
        if (!key[k].name)
            continue;
        if (key[k].meaning)
            snprintf(line, sizeof line, "\n| %s | %s |\n", key[k].name, key[k].meaning);
        else
            snprintf(line, sizeof line, "\n| **%s** | |\n", key[k].name);
        const char *found = strstr(at, line);
        if (!found)
            fail_msg("docs/reference/keys.md lacks, or has in another place:%s", line);
        at = found + strlen(line) - 1;
    }
}

int test_interaction(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_left_drag_across_half_the_window_turns_half_way_round),
        cmocka_unit_test(a_right_or_shifted_drag_moves_only_the_light),
        cmocka_unit_test(the_light_of_one_view_goes_where_the_pointer_is),
        cmocka_unit_test(without_a_light_the_environment_turns_instead_of_going_to_the_pointer),
        cmocka_unit_test(a_move_without_a_button_changes_nothing),
        cmocka_unit_test(camera_and_light_stop_at_their_ends),
        cmocka_unit_test(mode_keys_show_what_is_there_and_ignore_what_is_not),
        cmocka_unit_test(keys_toggle_and_undo_themselves),
        cmocka_unit_test(all_of_a_mesh_is_seen_from_where_the_camera_is),
        cmocka_unit_test(control_and_a_letter_undo_and_redo_where_the_letter_alone_does_not),
        cmocka_unit_test(other_keys_are_wishes_for_the_caller),
        cmocka_unit_test(space_flips_between_the_last_two_modes),
        cmocka_unit_test(the_divider_of_a_wipe_follows_the_pointer_and_stays_in_the_picture),
        cmocka_unit_test(one_mode_alone_cannot_be_compared),
        cmocka_unit_test(a_pan_moves_the_picture_with_the_pointer),
        cmocka_unit_test(raw_is_shown_while_its_key_is_held_and_then_what_was_before),
        cmocka_unit_test(a_mode_that_is_chosen_while_raw_is_held_stays),
        cmocka_unit_test(only_some_keys_repeat_while_they_are_held),
        cmocka_unit_test(a_key_with_control_is_another_key),
        cmocka_unit_test(a_key_that_can_do_nothing_says_what_is_missing),
        cmocka_unit_test(a_key_that_changes_what_is_seen_says_so),
        cmocka_unit_test(a_scene_whose_only_light_was_its_environment_gets_another),
        cmocka_unit_test(arrows_turn_what_a_plain_drag_turns),
        cmocka_unit_test(the_docs_list_every_key_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
