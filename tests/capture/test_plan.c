#include "capture/plan.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>
#include <string.h>

static weft_angles degrees(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

static double angle_deg(weft_angles a, weft_angles b)
{
    weft_vec3 p = weft_direction_of_angles(a), q = weft_direction_of_angles(b);
    return weft_deg_of_rad(atan2(weft_length(weft_cross(p, q)), weft_dot(p, q)));
}

static weft_code read_text(const char *text, weft_plan *plan, weft_error *error)
{
    scratch_store("plan.csv", text, strlen(text));
    return weft_plan_read("plan.csv", plan, error);
}

static void assert_refused(const char *text, const char *message)
{
    weft_plan plan;
    weft_error error = {0};
    assert_int_equal(read_text(text, &plan, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, message));
}

#define HEADER "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"

static void ubo81_has_all_pairs_and_moves_the_camera_once_per_view(void **state)
{
    (void)state;
    weft_plan plan;
    assert_int_equal(weft_plan_read("ubo81", &plan, NULL), WEFT_OK);
    assert_int_equal(plan.shot_count, 81 * 81);
    for (int i = 0; i < plan.shot_count; i++) {
        assert_true(angle_deg(plan.shot[i].view, weft_ubo81_angles(i / 81)) < 1e-9);
        assert_true(angle_deg(plan.shot[i].light, weft_ubo81_angles(i % 81)) < 1e-9);
    }
    weft_plan_free(&plan);
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(a, b);
}

/* Half a degree does not fit into names: no two photographs may have the same for all that. */
static void ubo151_has_all_pairs_and_names_of_their_own(void **state)
{
    (void)state;
    enum { SHOTS = 151 * 151, LENGTH = 64 };
    static char path[SHOTS][LENGTH];
    weft_plan plan;
    assert_int_equal(weft_plan_read("ubo151", &plan, NULL), WEFT_OK);
    assert_int_equal(plan.shot_count, SHOTS);
    const weft_session session = {.folder = "", .shot = plan.shot, .shot_count = SHOTS};
    for (int i = 0; i < SHOTS; i++)
        weft_session_photograph_path(&session, i, path[i], LENGTH);
    qsort(path, SHOTS, LENGTH, compare_paths);
    for (int i = 1; i < SHOTS; i++)
        assert_string_not_equal(path[i], path[i - 1]);
    assert_true(angle_deg(plan.shot[SHOTS - 1].view, degrees(75, 345)) < 1e-9);
    assert_true(angle_deg(plan.shot[1].light, degrees(11, 15)) < 1e-9);
    weft_plan_free(&plan);
}

static void a_plan_file_is_grouped_by_view_and_keeps_its_order(void **state)
{
    (void)state;
    weft_plan plan;
    assert_int_equal(read_text(HEADER "10,0,45,0\n10,0,0,0\n20,-90,45,0\n20,0,0,0\n", &plan, NULL), WEFT_OK);
    const double expected[4][3] = {{10, 0, 45}, {20, 270, 45}, {10, 0, 0}, {20, 0, 0}};
    for (int i = 0; i < 4; i++) {
        assert_true(angle_deg(plan.shot[i].light, degrees(expected[i][0], expected[i][1])) < 1e-9);
        assert_true(angle_deg(plan.shot[i].view, degrees(expected[i][2], 0)) < 1e-9);
    }
    weft_plan_free(&plan);
}

static void a_full_turn_is_no_turn(void **state)
{
    (void)state;
    weft_plan plan;
    assert_int_equal(read_text(HEADER "10,0,45,0\n20,-360,45,360\n", &plan, NULL), WEFT_OK);
    assert_true(plan.shot[1].view.phi_rad == plan.shot[0].view.phi_rad);
    assert_true(plan.shot[1].light.phi_rad == 0);
    weft_plan_free(&plan);
    assert_refused(HEADER "10,0,45,0\n10,0,45,360\n", "plan.csv:3");
}

static void a_bad_plan_file_is_refused_with_file_and_line(void **state)
{
    (void)state;
    assert_refused(HEADER "10,0,45,0\n10,x,0,0\n", "plan.csv:3");
    assert_refused(HEADER "10,0,45,0\n95,0,0,0\n", "plan.csv:3");
    assert_refused(HEADER "10,0,45,0\n10,nan,0,0\n", "plan.csv:3");
    assert_refused(HEADER "10,0,45,0\n10,400,45,0\n", "plan.csv:3");
    assert_refused(HEADER, "no shots");
    assert_refused("theta_light_deg,phi_light_deg,theta_view_deg\n10,0,45\n", "phi_view_deg");
    weft_plan plan;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_plan_read("missing.csv", &plan, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "missing.csv"));
}

static void shots_whose_photographs_would_share_a_name_are_refused(void **state)
{
    (void)state;
    assert_refused(HEADER "10.2,0,45,0\n30,0,45,0\n9.8,0.4,45.3,0\n", "plan.csv:4");
}

static void all_81_coincident_lights_step_aside_and_no_other(void **state)
{
    (void)state;
    weft_plan plan;
    assert_int_equal(weft_plan_read("ubo81", &plan, NULL), WEFT_OK);
    weft_plan_avoid_camera(&plan, weft_rad_of_deg(4));
    for (int i = 0; i < plan.shot_count; i++) {
        const weft_shot *shot = &plan.shot[i];
        double moved_deg = angle_deg(shot->light, shot->light_driven);
        if (i % 81 != i / 81)
            assert_true(moved_deg == 0);
        else
            assert_true(fabs(moved_deg - 4) < 1e-6 && fabs(angle_deg(shot->view, shot->light_driven) - 4) < 1e-6);
    }
    weft_plan_free(&plan);
}

static void a_light_near_the_camera_moves_no_farther_than_it_must(void **state)
{
    (void)state;
    weft_angles view = degrees(45, 30);
    weft_angles driven = weft_light_beside_camera(degrees(47, 30), view, weft_rad_of_deg(4));
    assert_true(angle_deg(driven, degrees(49, 30)) < 1e-6);
    driven = weft_light_beside_camera(view, view, weft_rad_of_deg(4));
    assert_true(angle_deg(driven, degrees(41, 30)) < 1e-6);
}

static void a_light_at_the_horizon_stays_above_it(void **state)
{
    (void)state;
    weft_angles view = degrees(86, 100), light = degrees(88, 100);
    weft_angles driven = weft_light_beside_camera(light, view, weft_rad_of_deg(4));
    assert_true(driven.theta_rad <= weft_rad_of_deg(89));
    assert_true(fabs(angle_deg(driven, view) - 4) < 1e-6);
    /* The direct way would end at 90 degrees; the nearest free place is beside it, not on the zenith's side. */
    assert_true(angle_deg(driven, light) < 4);
}

int test_plan(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ubo81_has_all_pairs_and_moves_the_camera_once_per_view),
        cmocka_unit_test(ubo151_has_all_pairs_and_names_of_their_own),
        cmocka_unit_test(a_plan_file_is_grouped_by_view_and_keeps_its_order),
        cmocka_unit_test(a_full_turn_is_no_turn),
        cmocka_unit_test(a_bad_plan_file_is_refused_with_file_and_line),
        cmocka_unit_test(shots_whose_photographs_would_share_a_name_are_refused),
        cmocka_unit_test(all_81_coincident_lights_step_aside_and_no_other),
        cmocka_unit_test(a_light_near_the_camera_moves_no_farther_than_it_must),
        cmocka_unit_test(a_light_at_the_horizon_stays_above_it),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
