/* Which directions were measured. */
#include "btf/dataset/measured.h"
#include "btf/direction/direction.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>

static weft_vec3 direction(double theta_deg, double phi_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)});
}

/* Four images, each from a view of its own. */
static weft_dataset_layout list(weft_distance distance, const weft_vec3 light[4], const weft_vec3 view[4])
{
    weft_dataset_layout layout = {
        .width = 10, .height = 10, .image_count = 4, .view_count = 4, .distance = distance, .texel_pitch_mm = 2};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int i = 0; i < 4; i++) {
        layout.light[i] = light[i];
        layout.view[i] = view[i];
        layout.view_of_image[i] = i;
    }
    return layout;
}

static void a_cone_holds_what_was_measured_and_no_more(void **state)
{
    (void)state;
    const weft_vec3 light[4] = {direction(30, 0), direction(30, 90), direction(30, 180), direction(30, 270)};
    const weft_vec3 view[4] = {direction(50, 100), direction(40, 100), direction(45, 93), direction(45, 107)};
    weft_dataset_layout layout = list(WEFT_FAR, light, view);
    weft_measured measured = weft_measured_of(&layout);
    assert_float_equal(weft_deg_of_rad(measured.light.angle_rad), 30, 1e-9);
    for (int i = 0; i < 4; i++) {
        assert_true(weft_cone_holds(&measured.light, light[i]));
        assert_true(weft_cone_holds(&measured.view, weft_scale(view[i], 300)));
    }
    assert_true(weft_cone_holds(&measured.light, direction(0, 0)));
    assert_false(weft_cone_holds(&measured.light, direction(31, 45)));
    assert_false(weft_cone_holds(&measured.view, direction(45, 280)));
    assert_false(weft_cone_holds(&measured.view, direction(51, 100)));
    weft_dataset_layout_free(&layout);
}

/* Above the middle, 10 mm away: from the far corner of 20 mm x 20 mm a camera stands at 52 degrees. */
static void near_cones_reach_the_corners(void **state)
{
    (void)state;
    const weft_vec3 place[4] = {{0, 0, 10}, {0, 0, 10}, {0, 0, 10}, {0, 0, 10}};
    weft_dataset_layout layout = list(WEFT_NEAR, place, place);
    weft_measured measured = weft_measured_of(&layout);
    assert_float_equal(measured.view.axis.z, 1, 1e-12);
    assert_float_equal(weft_deg_of_rad(measured.view.angle_rad), weft_deg_of_rad(atan2(9 * sqrt(2), 10)), 1e-9);
    weft_dataset_layout_free(&layout);
}

/* The one in the middle of the list mirrors. */
static void the_first_image_is_one_of_them_and_does_not_glare(void **state)
{
    (void)state;
    const weft_vec3 light[4] = {direction(40, 180), direction(20, 60), direction(60, 180), direction(45, 185)};
    const weft_vec3 view[4] = {direction(40, 0), direction(45, 40), direction(70, 0), direction(46, 4)};
    weft_dataset_layout layout = list(WEFT_FAR, light, view);
    weft_measured measured = weft_measured_of(&layout);
    assert_memory_equal(&measured.first_light, &light[1], sizeof light[1]);
    assert_memory_equal(&measured.first_view, &view[1], sizeof view[1]);
    weft_dataset_layout_free(&layout);
}

static void metadata_keep_it_and_others_say_nothing(void **state)
{
    (void)state;
    const weft_vec3 light[4] = {direction(10, 0), direction(30, 90), direction(50, 180), direction(30, 270)};
    weft_dataset_layout layout = list(WEFT_FAR, light, light);
    weft_measured measured = weft_measured_of(&layout), again;
    json_t *object = json_pack("{s:o}", "measured", weft_measured_pack(&measured));
    char *text = json_dumps(object, JSON_REAL_PRECISION(17));
    bool known;
    assert_int_equal(weft_measured_parse(text, &known, &again, NULL), WEFT_OK);
    assert_true(known);
    assert_float_equal(again.light.angle_rad, measured.light.angle_rad, 1e-12);
    assert_true(weft_length(weft_subtract(again.first_view, measured.first_view)) < 1e-12);
    assert_true(weft_length(weft_subtract(again.view.axis, measured.view.axis)) < 1e-12);
    static const char no_unit[] = "{\"measured\": {\"view\": [0, 0, 5, 10], \"light\": [0, 0, 1, 10], "
                                  "\"first_view\": [0, 0, 1], \"first_light\": [0, 0, 1]}}";
    static const char part[] = "{\"measured\": {\"view\": [0, 0, 1, 10]}}";
    const char *const silent[] = {NULL, "", "{}", "[1]", "{\"measured\": 3}", part, no_unit};
    for (size_t i = 0; i < sizeof silent / sizeof *silent; i++)
        assert_true(weft_measured_parse(silent[i], &known, &again, NULL) == WEFT_OK && !known);
    free(text);
    json_decref(object);
    weft_dataset_layout_free(&layout);
}

int test_measured(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_holds_what_was_measured_and_no_more),
        cmocka_unit_test(near_cones_reach_the_corners),
        cmocka_unit_test(the_first_image_is_one_of_them_and_does_not_glare),
        cmocka_unit_test(metadata_keep_it_and_others_say_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
