/* Reading weave files: the published ones, what each key becomes, and a line and column for every mistake. */
#include "btf/direction/direction.h"
#include "reflectance/weave/weave.h"
#include "tests/reflectance/weave_text.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* WEAVE_TEXT with the first `from` replaced by `to`; the caller frees. */
static char *edited(const char *from, const char *to)
{
    const char *at = strstr(WEAVE_TEXT, from);
    assert_non_null(at);
    char *text = malloc(sizeof WEAVE_TEXT + strlen(to));
    assert_non_null(text);
    size_t before = (size_t)(at - WEAVE_TEXT);
    memcpy(text, WEAVE_TEXT, before);
    sprintf(text + before, "%s%s", to, at + strlen(from));
    return text;
}

static void expect_error(const char *from, const char *to, const char *message)
{
    char *text = edited(from, to);
    weft_weave weave;
    weft_error error = {0};
    assert_int_equal(weft_weave_parse(text, "plain.wv", NULL, 0, &weave, NULL, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, message);
    free(text);
}

static void every_published_fabric_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        int width, height, yarns;
    } fabric[] = {{"cotton_denim", 3, 6, 8},     {"cotton_twill", 4, 8, 10}, {"polyester_lining", 2, 2, 4},
                  {"silk_charmeuse", 5, 10, 14}, {"silk_shantung", 6, 8, 5}, {"wool_gabardine", 6, 9, 7}};
    for (size_t i = 0; i < sizeof fabric / sizeof *fabric; i++) {
        char path[512], warning[WEFT_MESSAGE_SIZE];
        weft_weave weave;
        weft_error error = {0};
        snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, fabric[i].file);
        if (weft_weave_read(path, NULL, 0, &weave, warning, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_int_equal(weave.tile_width, fabric[i].width);
        assert_int_equal(weave.tile_height, fabric[i].height);
        assert_int_equal(weave.yarn_count, fabric[i].yarns);
        assert_true(weave.specular_scale > 0 && isfinite(weave.specular_scale));
        weft_weave_free(&weave);
    }
}

static void twill_warns_of_its_impossible_weft_and_keeps_its_diffuse_term(void **state)
{
    (void)state;
    char warning[WEFT_MESSAGE_SIZE];
    weft_weave weave;
    weft_error error = {0};
    assert_int_equal(weft_weave_read(WEFT_ASSETS "/weaves/cotton_twill.wv", NULL, 0, &weave, warning, &error), WEFT_OK);
    assert_non_null(strstr(warning, "cotton_twill.wv: the model has no such segment, highlight left out: yarn"));
    assert_non_null(strstr(warning, "width 2, length 1, umax 36"));
    assert_null(strchr(warning, '\n'));
    const weft_vec3 up = {0, 0, 1};
    for (int i = 0; i < weave.yarn_count; i++) {
        assert_int_equal(weave.yarn[i].admissible, weave.yarn[i].warp);
        weft_rgb f = weft_weave_brdf(&weave, &(weft_weave_point){.yarn = i, .intensity = 1}, up, up);
        if (!weave.yarn[i].admissible)
            assert_true(f.r == weave.yarn[i].kd.r * (1 / (weft_real)WEFT_PI));
    }
    weft_weave_free(&weave);
}

static void keys_reach_their_places(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    char warning[WEFT_MESSAGE_SIZE];
    assert_int_equal(weft_weave_parse(WEAVE_TEXT, "plain.wv", NULL, 0, &weave, warning, &error), WEFT_OK);
    assert_string_equal(warning, "");
    assert_string_equal(weave.name, "Plain");
    assert_int_equal(weave.yarn_count, 4);
    assert_true(weave.inclination_noise_deg[0] == 8 && weave.inclination_noise_deg[1] == 0);
    assert_true(weave.period == 50 && weave.fineness == 3);
    const int pattern[4] = {0, 2, 3, 1};
    assert_memory_equal(weave.pattern, pattern, sizeof pattern);
    const weft_yarn *first = &weave.yarn[0], *third = &weave.yarn[2];
    assert_true(first->warp && !third->warp);
    assert_true(fabs((double)first->segment.psi + 3.14159265358979 / 6) < 1e-6);
    assert_true(fabs((double)first->segment.umax - 3.14159265358979 / 6) < 1e-6);
    assert_true(first->segment.kappa == (weft_real)-0.5 && first->segment.beta == 3);
    assert_true(third->segment.delta == (weft_real)0.5 && third->segment.highlight_width == (weft_real)0.5);
    assert_true(first->kd.g == (weft_real)0.2 && first->ks.b == (weft_real)0.6);
    assert_true(first->area_weight == 2 && first->cell_fraction == (weft_real)0.25);
    assert_int_equal(weave.yarn[1].alike, 0);
    assert_int_equal(weave.yarn[3].alike, 2);
    weft_weave_free(&weave);
}

static void parameters_fill_in_numbers_and_colours(void **state)
{
    (void)state;
    char *text = edited("beta = 3", "beta = $sharpness"), *at = strstr(text, "kd = {0.1, 0.2, 0.3}");
    memcpy(at, "kd = $dye           ", strlen("kd = {0.1, 0.2, 0.3}"));
    const weft_parameter parameters[] = {{"sharpness", {7, 0, 0}},
                                         {"dye", {(weft_real)0.5, (weft_real)0.25, (weft_real)0.125}}};
    weft_weave weave;
    weft_error error = {0};
    assert_int_equal(weft_weave_parse(text, "plain.wv", parameters, 2, &weave, NULL, &error), WEFT_OK);
    assert_true(weave.yarn[0].segment.beta == 7 && weave.yarn[0].kd.b == (weft_real)0.125);
    weft_weave_free(&weave);
    assert_int_equal(weft_weave_parse(text, "plain.wv", parameters, 1, &weave, NULL, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "plain.wv:11:42: no value was given for '$dye'");
    free(text);
}

static void mistakes_are_named_with_line_and_column(void **state)
{
    (void)state;
    expect_error("weave {", "weaving {", "plain.wv:2:1: expected 'weave', found 'weaving'");
    expect_error("beta = 3", "beta 3", "plain.wv:5:22: expected '=', found '3'");
    expect_error("beta = 3", "bata = 3", "plain.wv:5:17: unknown key 'bata'");
    expect_error("beta = 3", "alpha = 3", "plain.wv:5:17: 'alpha' is given twice");
    expect_error("beta = 3, ", "", "plain.wv:18:1: 'beta' is missing in the block that ends here");
    expect_error("psi = -30, ", "", "plain.wv:11:80: 'psi' is missing in the block that ends here");
    expect_error("type = warp", "type = wrap", "plain.wv:10:17: expected 'warp' or 'weft', found 'wrap'");
    expect_error("ss = 0.5", "ss = 1.5", "plain.wv:5:32: ss = 1.5 is outside [0, 1]");
    expect_error("kd = {0.1,", "kd = {-0.1,", "plain.wv:11:43: kd = -0.1 is outside [0, 1e+06]");
    expect_error("kd = {0.1, 0.2, 0.3}", "kd = {0.1, 0.2}", "plain.wv:11:51: expected ',', found '}'");
    expect_error("4, 2 }", "4, 2, }", "plain.wv:9:19: expected a number, found '}'");
    expect_error("4, 2 }", "4 }", "plain.wv:8:3: the pattern has 3 cells, the tile 2 x 2 = 4");
    expect_error("4, 2 }", "5, 2 }", "plain.wv:9:13: yarn 5 does not exist, there are only 4");
    expect_error("4, 2 }", "0, 2 }", "plain.wv:9:13: yarn id = 0 is outside [1, 4096]");
    expect_error("4, 2 }", "1.5, 2 }", "plain.wv:9:13: a yarn id is a whole number from 1 to 4096");
    expect_error("tileWidth = 2", "tileWidth = 0", "plain.wv:4:15: tileWidth = 0 is outside [1, 4096]");
    expect_error("tileWidth = 2", "tileWidth = 9999", "plain.wv:4:15: tileWidth = 9999 is outside [1, 4096]");
    expect_error("tileWidth = 2", "tileWidth = 1.5", "plain.wv:18:1: the tile has 1.5 x 2 cells, not whole numbers");
    expect_error("/* plain weave */", "/* plain weave", "plain.wv:1:1: comment is not closed");
    expect_error("\"Plain\"", "\"Plain", "plain.wv:3:10: string is not closed on its line");
    expect_error("\"Plain\"", "Plain", "plain.wv:3:10: expected a name in quotes, found 'Plain'");
    expect_error("ks = {1, 1, 1} }\n}\n", "ks = {1, 1, 1} },\n}\n", "plain.wv:18:1: expected a key, found '}'");
}

static void a_layout_survives_being_written(void **state)
{
    (void)state;
    char *text =
        edited("tileWidth = 2,", "tilesU = 3.0123456789, tilesV = 2, cornerU = 0.1, cornerV = 0.7, tileWidth = 2,");
    weft_weave weave, again;
    weft_error error = {0};
    assert_int_equal(weft_weave_parse(WEAVE_TEXT, "plain.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    assert_true(weave.layout.tiles_u == 0 && weave.layout.tiles_v == 0);
    weft_weave_free(&weave);
    assert_int_equal(weft_weave_parse(text, "plain.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    assert_int_equal(weft_weave_write("layout.wv", &weave, NULL, &error), WEFT_OK);
    assert_int_equal(weft_weave_read("layout.wv", NULL, 0, &again, NULL, &error), WEFT_OK);
    const weft_weave_layout layout = {3.0123456789, 2, 0.1, 0.7};
    assert_memory_equal(&weave.layout, &layout, sizeof layout);
    assert_memory_equal(&again.layout, &layout, sizeof layout);
    weft_weave_free(&weave);
    weft_weave_free(&again);
    remove("layout.wv");
    free(text);
}

static void the_pitch_of_cells_survives_being_written(void **state)
{
    (void)state;
    weft_weave weave, again;
    weft_error error = {0};
    char *text = edited("tileWidth = 2,", "cellPitch = 0.123456789, tileWidth = 2,");
    assert_int_equal(weft_weave_parse(text, "pitch.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    assert_int_equal(weft_weave_write("pitch.wv", &weave, NULL, &error), WEFT_OK);
    assert_int_equal(weft_weave_read("pitch.wv", NULL, 0, &again, NULL, &error), WEFT_OK);
    assert_true(weft_weave_cell_pitch_mm(&weave) == 0.123456789 && again.cell_pitch_mm == 0.123456789);
    weft_weave_free(&weave);
    weft_weave_free(&again);
    remove("pitch.wv");
    free(text);
}

static void a_weave_without_a_pitch_has_the_default_one(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    assert_int_equal(weft_weave_parse(WEAVE_TEXT, "plain.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    assert_true(weave.cell_pitch_mm == 0 && weft_weave_cell_pitch_mm(&weave) == 0.25);
    weft_weave_free(&weave);
    expect_error("tileWidth = 2,", "cellPitch = -1, tileWidth = 2,",
                 "plain.wv:4:15: cellPitch = -1 is outside [0, 1e+06]");
}

static void half_a_layout_is_refused(void **state)
{
    (void)state;
    expect_error("tileWidth = 2,", "tilesU = 3, tileWidth = 2,",
                 "plain.wv:18:1: tilesU = 3 and tilesV = 0: both or neither are above 0");
    expect_error("tileWidth = 2,", "cornerV = 0.5, tileWidth = 2,",
                 "plain.wv:18:1: cornerU and cornerV mean nothing without tilesU and tilesV");
    expect_error("tileWidth = 2,", "tilesV = -1, tileWidth = 2,", "plain.wv:4:12: tilesV = -1 is outside [0, 1e+06]");
}

static void numbers_that_are_none_are_refused(void **state)
{
    (void)state;
    expect_error("beta = 3", "beta = nan", "plain.wv:5:24: expected a number, found 'nan'");
    expect_error("beta = 3", "beta = inf", "plain.wv:5:24: expected a number, found 'inf'");
    expect_error("beta = 3", "beta = -inf", "plain.wv:5:24: malformed number");
    expect_error("beta = 3", "beta = 0x10", "plain.wv:5:24: malformed number");
    expect_error("beta = 3", "beta = 1.2.3", "plain.wv:5:24: malformed number");
    expect_error("beta = 3", "beta = 3e", "plain.wv:5:24: malformed number");
    expect_error("beta = 3", "beta = .", "plain.wv:5:24: malformed number");
    expect_error("beta = 3", "beta = 1e999", "plain.wv:5:24: number out of range");
    expect_error("beta = 3", "beta = 1e9", "plain.wv:5:24: beta = 1e+09 is outside [-1e+06, 1e+06]");
    expect_error("beta = 3", "beta = 3.0000000000000000000000000000000000000000000000000000000000000000000000",
                 "plain.wv:5:24: number of 72 characters, at most 63");
    expect_error("beta = 3", "beta = $", "plain.wv:5:24: a name must follow '$'");
    expect_error("beta = 3", "beta = 3;", "plain.wv:5:25: unexpected character ';'");
    expect_error("beta = 3", "beta = \x01", "plain.wv:5:24: unexpected byte 1");
}

static void a_text_cut_anywhere_is_refused(void **state)
{
    (void)state;
    static char text[] = WEAVE_TEXT;
    /* The last two bytes are the closing brace and the end of its line. */
    for (size_t size = sizeof text - 3; size > 0; size--) {
        weft_weave weave;
        weft_error error = {0};
        text[size] = '\0';
        assert_int_equal(weft_weave_parse(text, "cut.wv", NULL, 0, &weave, NULL, &error), WEFT_BAD_INPUT);
        assert_int_equal(strncmp(error.message, "cut.wv:", 7), 0);
        assert_null(weave.yarn);
    }
}

static void files_that_are_no_weaves_are_refused(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    assert_int_equal(weft_class_of(weft_weave_read("no/such.wv", NULL, 0, &weave, NULL, &error)), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "cannot read 'no/such.wv': No such file or directory");
    FILE *file = fopen("zero.wv", "wb");
    assert_non_null(file);
    fwrite("weave\0{", 1, 7, file);
    fclose(file);
    assert_int_equal(weft_weave_read("zero.wv", NULL, 0, &weave, NULL, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "zero.wv: byte 5 is 0, not a text file");
    assert_int_equal(weft_weave_read("/dev/zero", NULL, 0, &weave, NULL, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "/dev/zero: more than 10485760 bytes, too long for a description of cloth");
    remove("zero.wv");
}

int test_weave_parse(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_published_fabric_is_read),
        cmocka_unit_test(twill_warns_of_its_impossible_weft_and_keeps_its_diffuse_term),
        cmocka_unit_test(keys_reach_their_places),
        cmocka_unit_test(parameters_fill_in_numbers_and_colours),
        cmocka_unit_test(mistakes_are_named_with_line_and_column),
        cmocka_unit_test(a_layout_survives_being_written),
        cmocka_unit_test(the_pitch_of_cells_survives_being_written),
        cmocka_unit_test(a_weave_without_a_pitch_has_the_default_one),
        cmocka_unit_test(half_a_layout_is_refused),
        cmocka_unit_test(numbers_that_are_none_are_refused),
        cmocka_unit_test(a_text_cut_anywhere_is_refused),
        cmocka_unit_test(files_that_are_no_weaves_are_refused),
    };
    return cmocka_run_group_tests_name("weave files", tests, NULL, NULL);
}
