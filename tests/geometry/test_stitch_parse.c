/* Reading stitch files: what each key becomes, and a line and column for every mistake. */
#include "geometry/stitch/stitch.h"
#include "tests/geometry/stitch_text.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void expect_refusal(const char *text, const char *message)
{
    weft_stitch stitch;
    weft_error error = {0};
    assert_int_equal(weft_stitch_parse(text, "plain.stitch", &stitch, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, message))
        fail_msg("'%s' does not hold '%s'", error.message, message);
    assert_null(stitch.yarn);
}

/* STITCH_TEXT with the first `from` replaced by `to` is refused. */
static void expect_error(const char *from, const char *to, const char *message)
{
    const char *at = strstr(STITCH_TEXT, from);
    assert_non_null(at);
    char *text = malloc(sizeof STITCH_TEXT + strlen(to));
    assert_non_null(text);
    sprintf(text, "%.*s%s%s", (int)(at - STITCH_TEXT), STITCH_TEXT, to, at + strlen(from));
    expect_refusal(text, message);
    free(text);
}

static void keys_reach_their_places(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_error error = {0};
    if (weft_stitch_parse(STITCH_TEXT, "plain.stitch", &stitch, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_string_equal(stitch.name, "Plain");
    assert_true(stitch.width == 2 && stitch.height == 1 && stitch.resolution == 20 && stitch.blend == 0.01);
    assert_int_equal(stitch.yarn_count, 2);
    const weft_stitch_yarn *first = &stitch.yarn[0], *second = &stitch.yarn[1];
    assert_true(first->radius_side == 0.2 && first->radius_up == 0.18 && first->plies == 2);
    assert_true(first->twist == 0.6 && first->fibre_twist == 0.5);
    assert_true(first->fibre.specular.b == 0.3 && first->fibre.refractive_index == 1.5);
    assert_true(fabs(first->fibre.highlight_rad - 10 * WEFT_PI / 180) < 1e-15);
    assert_true(first->point_count == 3 && first->copy_count == 1 && first->tiles_x == 1 && first->tiles_y == 0);
    assert_true(first->place[1].line == 6 && first->place[1].column == 27);
    assert_true(second->radius_side == 0.2 && second->radius_up == 0.2 && second->plies == 1);
    assert_true(second->copy_count == 2 && second->copy[1].x == 1 && second->tiles_x == 0 && second->tiles_y == 1);
    weft_stitch_free(&stitch);
}

static void mistakes_are_named_with_line_and_column(void **state)
{
    (void)state;
    expect_error("radius = 0.2", "radius = 0", "plain.stitch:9:47: the radius of the yarn that ends here is zero");
    expect_error("{2, 0.5, 0} }", "{1.9, 0.5, 0} }",
                 "plain.stitch:6:42: the yarn is not periodic: from its first to its "
                 "last point it goes (1.9, 0, 0) mm, not whole tiles of 2 x 1 mm");
    expect_error("tile = {2, 1}", "tile = 0", "plain.stitch:2:26: tile = 0 is outside [0.001, 1000]");
    expect_error("plies = 2", "plies = 2.5", "plain.stitch:7:3: the yarn that ends here has 2.5 plies");
    expect_error("{0.5, 0.4, 0.3}", "{0.95, 0.4, 0.3}",
                 "plain.stitch:7:3: diffuse + specular of the yarn that ends here "
                 "is 1.05, at most 1 can be reflected");
    expect_error("resolution = 20", "resolution = 5",
                 "plain.stitch:6:14: the radius 0.18 mm of this yarn is less than 1.5 "
                 "cells of 0.4 mm");
    expect_error("{1, 0.5, 0.2}", "{0, 0.5, 0}", "plain.stitch:6:27: two control points in one place");
    expect_error("fibreTwist", "fibretwist", "plain.stitch:4:51: unknown key 'fibretwist'");
    expect_error("points { {0.5", "points { 0.5", "plain.stitch:9:14: expected '{', found '0.5'");
    expect_error("stitch {", "weave {", "plain.stitch:1:1: expected 'stitch', found 'weave'");
    expect_error("tile = {2, 1}, ", "", "'tile' is missing in the block that ends here");
}

static void yarns_that_are_no_solids_are_refused(void **state)
{
    (void)state;
    expect_error("{0.5, 0, -0.6}, {0.5, 1, -0.6}", "{0.5, 0, 0.05}, {0.5, 1, 0.05}", "runs through another: at (");
    expect_error("{1, 0.5, 0.2}", "{1, 0.5, 0.2}, {1.05, 0.6, 0.2}, {1.1, 0.5, 0.2}",
                 "mm thick there and crosses itself");
    expect_error("{1, 0.5, 0.2}", "{0.9, 0.5, 0.2}, {0.9, 0.5, 1.2}, {1.3, 0.5, 1.2}, {1.3, 0.5, 0.2}",
                 "plain.stitch:6:27: after this point the yarn stands upright at (");
    /* A knot: out, round, and back through where it was. */
    expect_refusal(
        "stitch { tile = {4, 4}, resolution = 64, yarn { radius = 0.1, diffuse = {0, 0, 0}, points {\n"
        "{0, 2, 0}, {2, 2, 0}, {3, 2.7, 0}, {2.4, 3.2, 0}, {2, 2.6, 0}, {2.3, 1.5, 0}, {3, 1, 0}, {4, 2, 0} } } }",
        "the yarn runs through itself: at (");
}

static void a_million_control_points_are_refused(void **state)
{
    (void)state;
    enum { POINTS = 1000000 };
    char *text = malloc(POINTS * 9 + 200), *at = text;
    assert_non_null(text);
    at +=
        sprintf(at, "stitch { tile = 1, resolution = 20, yarn { radius = 0.2, diffuse = {0, 0, 0}, points {\n{0,0,0}");
    for (int i = 1; i < POINTS; i++)
        at += sprintf(at, ",\n{%d,0,0}", i % 10);
    sprintf(at, "} } }");
    expect_refusal(text, "plain.stitch:4098:1: more than 4096 control points");
    free(text);
}

static void a_text_cut_anywhere_is_refused(void **state)
{
    (void)state;
    /* The last character is the end of the line. */
    for (size_t length = 0; length + 2 < sizeof STITCH_TEXT - 1; length++) {
        char text[sizeof STITCH_TEXT];
        snprintf(text, sizeof text, "%.*s", (int)length, STITCH_TEXT);
        expect_refusal(text, "plain.stitch:");
    }
}

static void numbers_that_are_none_are_refused(void **state)
{
    (void)state;
    expect_error("radius = 0.2,", "radius = nan,", "plain.stitch:8:19: expected '{', found 'nan'");
    expect_error("radius = 0.2,", "radius = inf,", "plain.stitch:8:19: expected '{', found 'inf'");
    expect_error("radius = 0.2,", "radius = -0.2,", "plain.stitch:8:19: radius = -0.2 is outside");
    expect_error("{1, 0.5, 0.2}", "{1, 1e999, 0.2}", "plain.stitch:6:31: ");
    expect_error("{1, 0.5, 0.2}", "{1, 1e5, 0.2}", "plain.stitch:6:31: ");
}

static void deep_nesting_is_refused_at_its_second_brace(void **state)
{
    (void)state;
    enum { DEPTH = 5000000 };
    char *text = malloc(DEPTH + 32);
    assert_non_null(text);
    memset(text, '{', DEPTH + 31);
    memcpy(text, "stitch ", 7);
    text[DEPTH + 31] = '\0';
    expect_refusal(text, "plain.stitch:1:9: ");
    free(text);
}

static void files_that_are_no_stitches_are_refused(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_stitch_read("absent.stitch", &stitch, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "absent.stitch"));
    FILE *file = fopen("binary.stitch", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite("stitch {\0}", 1, 10, file), 10);
    fclose(file);
    assert_int_equal(weft_stitch_read("binary.stitch", &stitch, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "binary.stitch: byte 8 is 0, not a text file");
    remove("binary.stitch");
    assert_int_equal(weft_stitch_read(WEFT_ASSETS "/weaves/cotton_twill.wv", &stitch, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "expected 'stitch', found 'weave'"));
}

int test_stitch_parse(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_reach_their_places),
        cmocka_unit_test(mistakes_are_named_with_line_and_column),
        cmocka_unit_test(yarns_that_are_no_solids_are_refused),
        cmocka_unit_test(a_million_control_points_are_refused),
        cmocka_unit_test(a_text_cut_anywhere_is_refused),
        cmocka_unit_test(numbers_that_are_none_are_refused),
        cmocka_unit_test(deep_nesting_is_refused_at_its_second_brace),
        cmocka_unit_test(files_that_are_no_stitches_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
