/* Reading microcylinder files: the shipped ones are the reference cloths; a line and column for every mistake. */
#include "btf/direction/direction.h"
#include "reflectance/microcylinder/file.h"
#include "tests/reflectance/microcylinder/microcylinder_cloths.h"
#include "tests/reflectance/microcylinder/microcylinder_text.h"
#include "tests/reflectance/vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void expect_error(const char *from, const char *to, const char *message)
{
    char text[sizeof MICROCYLINDER_TEXT + 256];
    const char *at = strstr(MICROCYLINDER_TEXT, from);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - MICROCYLINDER_TEXT), MICROCYLINDER_TEXT, to, at + strlen(from));
    weft_microcylinder_description description;
    weft_error error = {0};
    assert_int_equal(weft_microcylinder_parse(text, "plain.mc", NULL, 0, &description, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, message);
}

static void expect_same_thread(const weft_cloth_thread *read, const weft_cloth_thread *wanted)
{
    assert_true(read->axis == wanted->axis && read->sample_count == wanted->sample_count);
    assert_true(read->point_count == wanted->point_count && read->area_share == wanted->area_share);
    assert_memory_equal(read->piece_length, wanted->piece_length, sizeof read->piece_length);
    for (int i = 0; i < read->point_count; i++)
        assert_true(fabs(read->tilt_rad[i] - wanted->tilt_rad[i]) < 1e-14);
    assert_true(read->optics.eta == wanted->optics.eta && read->optics.kd == wanted->optics.kd);
    assert_true(fabs(read->optics.gamma_s - wanted->optics.gamma_s) < 1e-15);
    assert_true(fabs(read->optics.gamma_v - wanted->optics.gamma_v) < 1e-15);
    assert_memory_equal(&read->optics.albedo, &wanted->optics.albedo, sizeof read->optics.albedo);
}

static void every_shipped_cloth_is_the_reference_cloth(void **state)
{
    (void)state;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    for (int i = 0; i < REFERENCE_CLOTHS; i++) {
        char path[512];
        weft_microcylinder_description description;
        weft_error error = {0};
        snprintf(path, sizeof path, "%s/microcylinder/%.31s.mc", WEFT_ASSETS, cloths[i].name);
        if (weft_microcylinder_read(path, NULL, 0, &description, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_true(fabs(description.cloth.sigma - cloths[i].prepared.cloth.sigma) < 1e-15);
        for (int j = 0; j < WEFT_CLOTH_THREADS; j++)
            expect_same_thread(&description.cloth.thread[j], &cloths[i].prepared.cloth.thread[j]);
    }
}

static void mistakes_are_named_with_line_and_column(void **state)
{
    (void)state;
    expect_error("microcylinder", "weave", "plain.mc:2:1: expected 'microcylinder', found 'weave'");
    expect_error("sigma = 20", "sigma = 0", "plain.mc:3:27: sigma = 0 is outside [0.01, 1000]");
    expect_error(", sigma = 20", "", "plain.mc:8:1: 'sigma' is missing in the block that ends here");
    expect_error("axis = x", "axis = z", "plain.mc:4:19: expected 'x' or 'y', found 'z'");
    expect_error("axis = x, ", "", "plain.mc:5:91: 'axis' is missing in the block that ends here");
    expect_error("{ -25, 0, 25 }", "{ -25, 0, 95 }", "plain.mc:4:38: tilt = 95 is outside [-90, 90]");
    expect_error("lengths { 1, 2 }", "lengths { 1 }",
                 "plain.mc:5:91: 3 tilts and 1 lengths: there must be 2 tilts at least and a length between each two");
    expect_error("samples = 4", "samples = 4.5", "plain.mc:5:91: samples = 4.5 is no whole number");
    expect_error("eta = 1.46", "eta = 1.46, eta = 1.5", "plain.mc:5:17: 'eta' is given twice");
    expect_error("area = 0.5 ", "area = 0.8 ",
                 "plain.mc:8:1: the model has no such cloth: areas that sum to 1.13, or threads of no length");
    expect_error("area = 0.5 }", "area = 0.5 }, thread", "plain.mc:7:91: a cloth has 2 threads");
    expect_error("kd = 0.3", "kd = $kd", "plain.mc:5:48: no value was given for '$kd'");
    expect_error("gammaS", "gamma", "plain.mc:5:17: unknown key 'gamma'");
    expect_error("}\n}", "}\n} x", "plain.mc:8:3: expected the end of the file, found 'x'");
}

static void more_control_points_than_there_is_room_for_are_refused(void **state)
{
    (void)state;
    expect_error("{ 0, 0 }", "{ 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0 }", "plain.mc:6:62: more than 16 control points");
}

static void names_stand_for_what_the_caller_gives(void **state)
{
    (void)state;
    char text[] = MICROCYLINDER_TEXT;
    memcpy(strstr(text, "{ 0.2, 0.8, 1 }"), "$colour        ", 15);
    const weft_parameter parameter = {"colour", {(weft_real)0.1, (weft_real)0.2, (weft_real)0.4}};
    weft_microcylinder_description description;
    weft_error error = {0};
    assert_int_equal(weft_microcylinder_parse(text, "plain.mc", &parameter, 1, &description, &error), WEFT_OK);
    assert_string_equal(description.name, "Plain");
    assert_true(description.cloth.thread[0].optics.albedo.b == (weft_real)0.4);
}

int test_microcylinder_parse(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shipped_cloth_is_the_reference_cloth),
        cmocka_unit_test(mistakes_are_named_with_line_and_column),
        cmocka_unit_test(more_control_points_than_there_is_room_for_are_refused),
        cmocka_unit_test(names_stand_for_what_the_caller_gives),
    };
    return cmocka_run_group_tests_name("microcylinder files", tests, NULL, NULL);
}
