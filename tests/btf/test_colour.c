#include "btf/session/colour.h"
#include "btf/session/session.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const weft_colour matrix = {
    WEFT_COLOUR_LINEAR_TERMS, {{1.5, -0.4, -0.1}, {-0.2, 1.3, -0.1}, {0.05, -0.55, 1.5}}, {1.25, 4.5}, {1.75, 6.5}};
static const weft_colour roots = {
    WEFT_COLOUR_ROOT_TERMS,
    {{0.5, -0.5, 0.1, 1.2, 0.1, -0.4}, {0, 0.9, -0.2, -0.1, 0.5, -0.1}, {0, 0, 1, 0, 0, 0}},
    {1, 2},
    {3, 4}};

static void write(const weft_colour *colour, const char *path)
{
    weft_error error = {0};
    json_t *record = json_pack("{ss}", "chart", "classic");
    expect_ok(weft_colour_write(path, colour, record, &error), &error);
    json_decref(record);
}

static void what_is_no_number_is_named(void **state)
{
    (void)state;
    weft_colour colour = roots;
    weft_error error = {0};
    colour.matrix[2][5] = NAN;
    assert_int_equal(weft_colour_write("none.json", &colour, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'none.json' was not written: 'matrix' is not a finite"));
    colour = matrix;
    colour.left_out.worst = INFINITY;
    assert_int_equal(weft_colour_write("none.json", &colour, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'none.json' was not written: 'left_out' is not a finite"));
}

static void assert_same(const weft_colour *a, const weft_colour *b)
{
    assert_int_equal(a->terms, b->terms);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < a->terms; k++)
            assert_true(fabs(a->matrix[i][k] - b->matrix[i][k]) < 1e-11);
    assert_true(a->fitted.mean == b->fitted.mean && a->fitted.worst == b->fitted.worst);
    assert_true(a->left_out.mean == b->left_out.mean && a->left_out.worst == b->left_out.worst);
}

static void what_is_written_is_read(void **state)
{
    (void)state;
    const weft_colour *const colours[] = {&matrix, &roots};
    for (int i = 0; i < 2; i++) {
        weft_colour back;
        weft_error error = {0};
        write(colours[i], "colour.json");
        expect_ok(weft_colour_read("colour.json", &back, &error), &error);
        assert_same(colours[i], &back);
    }
}

/* The products worked out by hand. */
static void a_colour_is_a_matrix_times_its_terms(void **state)
{
    (void)state;
    float rgb[6] = {0.25f, 0.64f, 0.09f, 1, 1, 1}, kept[3] = {0.25f, 0.64f, 0.09f};
    const weft_colour none = {0};
    weft_colour_apply(&matrix, rgb, 2);
    assert_true(fabsf(rgb[0] - (1.5f * 0.25f - 0.4f * 0.64f - 0.1f * 0.09f)) < 1e-6f);
    assert_true(fabsf(rgb[2] - (0.05f * 0.25f - 0.55f * 0.64f + 1.5f * 0.09f)) < 1e-6f);
    assert_true(rgb[2] < 0); /* a colour outside sRGB is kept */
    assert_true(fabsf(rgb[3] - 1) < 1e-6f && fabsf(rgb[4] - 1) < 1e-6f && fabsf(rgb[5] - 1) < 1e-6f);
    weft_colour_apply(&none, kept, 1);
    assert_true(kept[0] == 0.25f && kept[1] == 0.64f && kept[2] == 0.09f);
    /* sqrt(rg) = 0.4, sqrt(gb) = 0.24, sqrt(rb) = 0.15 */
    float bright[3] = {0.25f, 0.64f, 0.09f};
    weft_colour_apply(&roots, bright, 1);
    assert_true(fabsf(bright[0] - (0.125f - 0.32f + 0.009f + 1.2f * 0.4f + 0.1f * 0.24f - 0.4f * 0.15f)) < 1e-6f);
    assert_true(fabsf(bright[1] - (0.576f - 0.018f - 0.04f + 0.12f - 0.015f)) < 1e-6f);
}

/* Root polynomials do not depend on the exposure, and noise below black has no root. */
static void twice_the_light_is_twice_the_colour(void **state)
{
    (void)state;
    float dim[3] = {0.1f, 0.3f, 0.05f}, bright[3] = {0.8f, 2.4f, 0.4f}, dark[3] = {-0.01f, -0.02f, 0.1f};
    weft_colour_apply(&roots, dim, 1);
    weft_colour_apply(&roots, bright, 1);
    for (int c = 0; c < 3; c++)
        assert_true(fabsf(bright[c] - 8 * dim[c]) < 1e-5f);
    weft_colour_apply(&roots, dark, 1);
    assert_true(fabsf(dark[0] - (0.5f * -0.01f - 0.5f * -0.02f + 0.1f * 0.1f)) < 1e-6f);
}

/* ---- In a session ---- */

static void a_session_keeps_a_colour(void **state)
{
    (void)state;
    weft_shot shot = {0};
    weft_shot_record record = {0};
    weft_session session = {.folder = ".", .rig = "test", .sample = "felt", .rig_settings = "{}", .bits = 12};
    weft_session back;
    weft_error error = {0};
    session.camera = (weft_camera){.width = 8, .height = 8, .fx = 9, .fy = 9};
    session.camera_distance_mm = session.light_distance_mm = 500;
    session.target = weft_target_for_opening(32);
    session.shot_count = 1;
    session.shot = &shot;
    session.record = &record;
    session.colour = roots;
    expect_ok(weft_session_create(&session, &error), &error);
    expect_ok(weft_session_open(".", &back, &error), &error);
    assert_same(&roots, &back.colour);
    weft_session_free(&back);
    session.colour = (weft_colour){0};
    expect_ok(weft_session_create(&session, &error), &error);
    expect_ok(weft_session_open(".", &back, &error), &error);
    assert_int_equal(back.colour.terms, 0);
    weft_session_free(&back);
    session.colour = matrix;
    session.colour.matrix[1][1] += 1;
    expect_ok(weft_session_create(&session, &error), &error);
    assert_int_equal(weft_session_open(".", &back, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "session.json': row 2 of the colour matrix"));
}

/* ---- Bad files ---- */

static void assert_refused(const char *text, const char *word)
{
    weft_colour colour;
    weft_error error = {0};
    scratch_store("bad.json", text, strlen(text));
    assert_int_equal(weft_class_of(weft_colour_read("bad.json", &colour, &error)), WEFT_BAD_INPUT);
    if (!strstr(error.message, word) || !strstr(error.message, "bad.json"))
        fail_msg("'%s' does not say '%s'", error.message, word);
}

#define HEAD                                                                                                           \
    "{\"weft_colour\": 1, \"ciede2000\": {\"fitted\": {\"mean\": 1, \"worst\": 1}, \"left_out\": {\"mean\": 1, "       \
    "\"worst\": 1}}, "

static void a_bad_file_is_refused_with_its_fault(void **state)
{
    (void)state;
    assert_refused("{}", "is no colour file");
    assert_refused("[1]", "is no colour file");
    assert_refused("{\"weft_lens\": 1}", "is no colour file");
    assert_refused("{\"weft_colour\": 2}", "version 2");
    assert_refused("{\"weft_colour\": 1}", "lacks a field");
    assert_refused(HEAD "\"model\": \"cubic\", \"matrix\": []}", "'cubic'");
    assert_refused(HEAD "\"model\": 3, \"matrix\": []}", "wrong type");
    assert_refused(HEAD "\"model\": \"linear\", \"matrix\": [[1, 0, 0]]}", "1 rows, not 3");
    assert_refused(HEAD "\"model\": \"linear\", \"matrix\": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}", "the sum 2");
    assert_refused(HEAD "\"model\": \"linear\", \"matrix\": [[1, 0, 0], [0, 1, 0], [0, 0, 1, 0]]}", "row 3");
    assert_refused(HEAD "\"model\": \"linear\", \"matrix\": [[1, 0, 0], [0, 1, 0], [0, \"0\", 1]]}", "row 3");
    assert_refused(HEAD "\"model\": \"linear\", \"matrix\": [[1, 0, 0], [0, 1, 0], [2000, -2000, 1]]}", "row 3");
    assert_refused(HEAD "\"model\": \"linear\", \"matrix\": [[1, 0, 0], [1, 0, 0], [0, 0, 1]]}", "singular");
    assert_refused(HEAD
                   "\"model\": \"root\", \"matrix\": [[0, 0, 0, 1, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, 0, 0]]}",
                   "singular");
}

int test_colour(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(what_is_no_number_is_named),
        cmocka_unit_test(a_colour_is_a_matrix_times_its_terms),
        cmocka_unit_test(twice_the_light_is_twice_the_colour),
        cmocka_unit_test(a_session_keeps_a_colour),
        cmocka_unit_test(a_bad_file_is_refused_with_its_fault),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
