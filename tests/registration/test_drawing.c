#include "registration/pose/drawing.h"

#include "tests/registration/near.h"
#include "tests/support/cmocka_all.h"

#include <math.h>

static weft_target target;
static weft_drawing drawing;

static int draw(void **state)
{
    (void)state;
    target = weft_target_for_opening(32);
    return weft_drawing_create(&target, 0.05, &drawing, NULL);
}

static int discard(void **state)
{
    (void)state;
    weft_drawing_free(&drawing);
    return 0;
}

static weft_rectangle around(double x, double y, double reach)
{
    return (weft_rectangle){x - reach, y - reach, x + reach, y + reach};
}

static void the_middle_of_a_patch_has_its_reflectance(void **state)
{
    (void)state;
    weft_rectangle r = weft_target_reference(&target, 0);
    float seen = weft_drawing_at(&drawing, (float)(r.x0 + r.x1) / 2, (float)(r.y0 + r.y1) / 2);
    assert_near((double)seen, target.white_reflectance, 1e-6);
}

static void an_edge_lies_where_the_target_has_it(void **state)
{
    (void)state;
    /* Outer edge of a marker: half way between paper and ink. */
    weft_rectangle r = weft_target_marker(&target, 0);
    double middle = (target.paper_reflectance + target.ink_reflectance) / 2, y = (r.y0 + r.y1) / 2, low = r.x0 - 0.2,
           high = r.x0 + 0.2;
    for (int i = 0; i < 40; i++) {
        double x = (low + high) / 2;
        if ((double)weft_drawing_at(&drawing, (float)x, (float)y) > middle)
            low = x;
        else
            high = x;
    }
    assert_near(low, r.x0, 0.01);
}

static void opening_and_surroundings_are_excluded(void **state)
{
    (void)state;
    assert_true(weft_drawing_content_of(&drawing, around(0, 0, 1)).excluded);
    assert_true(weft_drawing_content_of(&drawing, around(16.5, 0, 1)).excluded);
    assert_true(weft_drawing_content_of(&drawing, around(0, 52, 1)).excluded);
    assert_true(weft_drawing_content_of(&drawing, around(1e9, 0, 1)).excluded);
    assert_true(weft_drawing_content_of(&drawing, around(NAN, 0, 1)).excluded);
    assert_false(weft_drawing_content_of(&drawing, around(38, 0, 1)).excluded);
}

static void content_is_uniform_where_and_only_where_no_edge_is(void **state)
{
    (void)state;
    weft_rectangle patch = weft_target_reference(&target, 0);
    assert_true(weft_drawing_content_of(&drawing, around((patch.x0 + patch.x1) / 2, 0, 2)).uniform);
    assert_false(weft_drawing_content_of(&drawing, around(patch.x1, 0, 0.5)).uniform);
}

static void a_target_without_size_is_refused(void **state)
{
    (void)state;
    weft_target nothing = weft_target_for_opening(0);
    weft_drawing none;
    weft_error error = {0};
    assert_int_equal(weft_drawing_create(&nothing, 0.05, &none, &error), WEFT_BAD_INPUT);
}

int test_drawing(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_middle_of_a_patch_has_its_reflectance),
        cmocka_unit_test(an_edge_lies_where_the_target_has_it),
        cmocka_unit_test(opening_and_surroundings_are_excluded),
        cmocka_unit_test(content_is_uniform_where_and_only_where_no_edge_is),
        cmocka_unit_test(a_target_without_size_is_refused),
    };
    return cmocka_run_group_tests(tests, draw, discard);
}
