/* Weaves fitted to datasets that nobody has cut. */
#include "btf/direction/direction.h"
#include "compress/weave_fit/fit_weave.h"
#include "tests/compare/fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const input = "fit.btf.h5";

enum { TEXELS = 40, RINGS = 3 };

static weft_weave read_weave(const char *name)
{
    char path[512];
    weft_weave weave;
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/weaves/%s", WEFT_ASSETS, name);
    expect_ok(weft_weave_read(path, NULL, 0, &weave, NULL, &error), &error);
    return weave;
}

/* The start of every fit: inclinations a fifth off. */
static weft_weave spoilt(const char *name)
{
    weft_weave weave = read_weave(name);
    for (int i = 0; i < weave.yarn_count; i++)
        weave.yarn[i].segment.umax *= 0.8;
    weft_weave_update(&weave);
    return weave;
}

static void fit(const char *name, bool whole, weft_fit_weave_source *source, weft_fit_weave_report *report)
{
    weft_dataset *dataset;
    weft_mean_brdf mean;
    weft_weave weave = spoilt(name);
    weft_error error = {0};
    expect_ok(weft_dataset_open(input, &dataset, &error), &error);
    if (whole) {
        expect_ok(weft_mean_brdf_of(dataset, NULL, NULL, &mean, &error), &error);
        expect_ok(weft_fit_weave(&mean, &weave, NULL, report, &error), &error);
        weft_mean_brdf_free(&mean);
    } else {
        expect_ok(weft_fit_weave_to_dataset(dataset, &weave, NULL, source, report, &error), &error);
    }
    weft_dataset_close(dataset);
    weft_weave_free(&weave);
}

static void expect_truth(const weft_fit_weave_report *report)
{
    for (int i = 0; i < report->group_count; i++) {
        const weft_fit_weave_group *found = &report->group[i];
        const weft_segment *truth = &fixture_cloth.weave.yarn[found->yarn].segment;
        print_message("  psi %.2f (%.2f), umax %.2f (%.2f)\n", found->psi_deg, weft_deg_of_rad(truth->psi),
                      found->umax_deg, weft_deg_of_rad(truth->umax));
        assert_true(fabs(found->umax_deg - weft_deg_of_rad(truth->umax)) < 2);
    }
}

/* 2.4 tiles along both axes: the mean of all texels counts some yarns thrice and others twice. */
static void whole_tiles_are_averaged_wherever_they_begin(void **state)
{
    (void)state;
    weft_fit_weave_source source;
    weft_fit_weave_report tiled, whole;
    fixture_cloth.weave = read_weave("polyester_lining.wv");
    fixture_cloth.width = fixture_cloth.height = 16.6, fixture_cloth.left = 5.2, fixture_cloth.top = 9.7;
    fixture_far_dataset(input, TEXELS, TEXELS, RINGS, fixture_woven, FIXTURE_MASK_NONE);
    fit("polyester_lining.wv", false, &source, &tiled);
    fit("polyester_lining.wv", true, &source, &whole);
    print_message("median relative error %.2f %% of whole tiles, %.2f %% of the whole material\n",
                  100 * tiled.after.median_relative, 100 * whole.after.median_relative);
    assert_true(source.tiled);
    assert_int_equal(source.tiles_x, 2);
    assert_int_equal(source.tiles_y, 2);
    assert_true(fabs(source.tile.tile.width - fixture_cloth.width) < 0.1 &&
                fabs(source.tile.tile.height - fixture_cloth.height) < 0.1);
    assert_true(tiled.after.median_relative < 0.5 * whole.after.median_relative);
    expect_truth(&tiled);
    weft_weave_free(&fixture_cloth.weave);
}

static int further_in(int at)
{
    return at < 2 ? 2 : at > TEXELS - 3 ? TEXELS - 3 : at;
}

/* What a registration makes of texels that the frame's print would leak into. */
static weft_rgb framed(int x, int y, weft_vec3 light, weft_vec3 view)
{
    return fixture_woven(further_in(x), further_in(y), light, view);
}

static void texels_beside_the_frame_do_not_count(void **state)
{
    (void)state;
    weft_fit_weave_source source;
    weft_fit_weave_report tiled, whole;
    fixture_cloth.weave = read_weave("polyester_lining.wv");
    fixture_cloth.width = fixture_cloth.height = TEXELS / 2.0, fixture_cloth.left = fixture_cloth.top = 0;
    fixture_far_dataset(input, TEXELS, TEXELS, RINGS, framed, FIXTURE_MASK_NONE);
    fit("polyester_lining.wv", false, &source, &tiled);
    fit("polyester_lining.wv", true, &source, &whole);
    print_message("median relative error %.2f %% of the tile, %.2f %% with what is beside the frame\n",
                  100 * tiled.after.median_relative, 100 * whole.after.median_relative);
    assert_true(tiled.after.median_relative < 0.5 * whole.after.median_relative);
    expect_truth(&tiled);
    weft_weave_free(&fixture_cloth.weave);
}

static void material_without_two_tiles_is_averaged_whole_and_says_why(void **state)
{
    (void)state;
    weft_fit_weave_source source;
    weft_fit_weave_report report;
    fixture_cloth.weave = read_weave("polyester_lining.wv");
    fixture_cloth.width = fixture_cloth.height = TEXELS, fixture_cloth.left = fixture_cloth.top = 0;
    fixture_far_dataset(input, TEXELS, TEXELS, RINGS, fixture_woven, FIXTURE_MASK_NONE);
    fit("polyester_lining.wv", false, &source, &report);
    print_message("%s\n", source.why_whole);
    assert_false(source.tiled);
    assert_true(source.why_whole[0]);
    expect_truth(&report);
    weft_weave_free(&fixture_cloth.weave);
}

static weft_rgb by_column(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)y, (void)light, (void)view;
    return (weft_rgb){x + 1, x + 1, x + 1};
}

static void a_window_counts_the_share_of_each_texel_inside(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_mean_brdf mean;
    weft_error error = {0};
    fixture_far_dataset(input, 8, 8, 1, by_column, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(input, &dataset, &error), &error);
    const weft_texel_window window = {.left = 1.25, .top = 2, .width = 2, .height = 3};
    expect_ok(weft_mean_brdf_of(dataset, &window, NULL, &mean, &error), &error);
    /* Columns 2, 3 and 4 with 0.75, 1 and 0.25. */
    assert_true(fabs(mean.value[0].r * WEFT_PI - (0.75 * 2 + 3 + 0.25 * 4) / 2) < 1e-3);
    weft_mean_brdf_free(&mean);
    weft_dataset_close(dataset);
}

static weft_rgb by_square(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)y, (void)light, (void)view;
    return (weft_rgb){x * x, x * x, x * x};
}

static void what_a_window_shows_twice_counts_once(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_mean_brdf mean;
    weft_error error = {0};
    fixture_far_dataset(input, 8, 8, 1, by_square, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(input, &dataset, &error), &error);
    const weft_texel_window window = {.left = 1, .top = 2, .width = 3.5, .height = 3, .period_x = 2};
    expect_ok(weft_mean_brdf_of(dataset, &window, NULL, &mean, &error), &error);
    /* Columns 1 and 3 are the same place, 2 and the first half of 4, too; the second half of 2 is seen once. */
    double expected = (0.5 * (1 + 9) + 0.5 * (4 + 16) / 2 + 0.5 * 4) / 2;
    assert_true(fabs(mean.value[0].r * WEFT_PI - expected) < 1e-3);
    weft_mean_brdf_free(&mean);
    weft_dataset_close(dataset);
}

static int remove_input(void **state)
{
    (void)state;
    return unlink(input);
}

int test_fit_weave_dataset(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(whole_tiles_are_averaged_wherever_they_begin, remove_input),
        cmocka_unit_test_teardown(texels_beside_the_frame_do_not_count, remove_input),
        cmocka_unit_test_teardown(material_without_two_tiles_is_averaged_whole_and_says_why, remove_input),
        cmocka_unit_test_teardown(a_window_counts_the_share_of_each_texel_inside, remove_input),
        cmocka_unit_test_teardown(what_a_window_shows_twice_counts_once, remove_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
