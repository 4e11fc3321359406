/* weft tile --blend: the cut is the cheapest there is, and what is made tiles. */
#include "edit/blend/blend.h"
#include "edit/blend/steps.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double two_pi = 6.283185307179586;

/* A uniform deviate in 0 .. 1 (Steele, Lea and Flood 2014). */
static double uniform(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

/* ---- The cut ---- */

enum { ROWS = 6, COLUMNS = 5, PATHS = 5 * 3 * 3 * 3 * 3 * 3 };

/* The cheapest of all paths, one after another. */
static double cheapest_of_all(const float *cost, int low, int high, bool closed)
{
    double best = DBL_MAX;
    for (int path = 0; path < PATHS; path++) {
        int rest = path, start = rest % 5, x = start;
        bool is_allowed = true;
        double sum = 0;
        rest /= 5;
        for (int y = 0; y < ROWS; y++) {
            if (x < low || x > high) {
                is_allowed = false;
                break;
            }
            sum += cost[y * COLUMNS + x];
            if (y + 1 < ROWS)
                x += rest % 3 - 1;
            rest /= 3;
        }
        if (is_allowed && (!closed || abs(x - start) <= 1))
            best = fmin(best, sum);
    }
    return best;
}

static void no_path_is_cheaper(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int trial = 0; trial < 200; trial++) {
        float cost[ROWS * COLUMNS];
        int at[ROWS], low = trial % 2, high = COLUMNS - 1 - trial % 3 / 2;
        bool closed = trial % 5 > 1;
        double total;
        for (int i = 0; i < ROWS * COLUMNS; i++)
            cost[i] = (float)uniform(&seed);
        assert_int_equal(weft_cheapest_path(cost, ROWS, COLUMNS, low, high, closed, at, &total, NULL), WEFT_OK);
        assert_float_equal(total, cheapest_of_all(cost, low, high, closed), 1e-6);
        double sum = 0;
        for (int y = 0; y < ROWS; y++) {
            assert_in_range(at[y], low, high);
            assert_true(y == 0 ? !closed || abs(at[0] - at[ROWS - 1]) <= 1 : abs(at[y] - at[y - 1]) <= 1);
            sum += cost[y * COLUMNS + at[y]];
        }
        assert_float_equal(sum, total, 1e-6);
    }
}

/* Between the waves of this pattern a cut could wind without a step: they must fit all the same. */
static void a_cut_does_not_break_a_pattern(void **state)
{
    (void)state;
    weft_blend_pictures pictures;
    weft_cut cut;
    assert_int_equal(weft_blend_pictures_create(51, 52, &pictures, NULL), WEFT_OK);
    for (int y = 0; y < 52; y++)
        for (int x = 0; x < 51; x++)
            for (int i = 0; i < WEFT_BLEND_VALUES; i++)
                weft_blend_texel(&pictures, x, y)[i] =
                    (float)(sin(two_pi * y / 13) + sin(two_pi * x / 9) + sin(two_pi * (y / 13.0 + 2 * x / 9.0)));
    assert_int_equal(weft_cut_find(&pictures, true, &cut, NULL), WEFT_OK);
    assert_int_equal(cut.size, 45);
    weft_cut_free(&cut);
    weft_blend_pictures_free(&pictures);
}

/* ---- Materials ---- */

typedef double pattern(double x, double y);

static weft_material material_of(int width, int height, pattern value)
{
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_create(width, height, 0, 0, 0, 1, &material, &error), &error);
    for (int k = 0; k < material.level_count; k++) {
        const weft_material_level *level = &material.level[k];
        for (int i = 0; i < level->width * level->height; i++)
            for (int c = 0; c < 3; c++)
                level->diffuse[4 * i + c] = weft_half_of_float(
                    (float)value(ldexp(i % level->width + 0.5, k) - 0.5, ldexp(i / level->width + 0.5, k) - 0.5));
    }
    return material;
}

static weft_blend_report blended(const weft_material *material, weft_material *tile)
{
    weft_error error = {0};
    weft_blend_report report;
    expect_ok(weft_blend(material, tile, &report, &error), &error);
    return report;
}

static double periodic(double x, double y)
{
    return 0.4 + 0.1 * sin(two_pi * x / 13) + 0.1 * sin(two_pi * y / 9) + 0.1 * sin(two_pi * (x / 13 + y / 9));
}

static void cloth_that_repeats_is_cut_to_whole_repeats(void **state)
{
    (void)state;
    weft_material material = material_of(60, 50, periodic), tile;
    weft_blend_report report = blended(&material, &tile);
    assert_int_equal(report.width % 13, 0);
    assert_int_equal(report.height % 9, 0);
    assert_in_range(report.width, 30, 54);
    assert_in_range(report.height, 25, 44);
    assert_int_equal(tile.level[0].width, report.width);
    assert_true(report.before.mean_difference > 1.2);
    assert_true(report.after.above_99th <= 0.01 && report.after.mean_difference < 1.1 && report.after.strongest <= 1);
    weft_material_free(&tile);
    weft_material_free(&material);
}

/* Blots that never come back, and light that falls off to one side. */
static double blots(double x, double y)
{
    uint64_t seed = 7;
    double sum = 0.05 + 0.002 * x;
    for (int i = 0; i < 150; i++) {
        double dx = x - 80 * uniform(&seed), dy = y - 64 * uniform(&seed);
        sum += 0.2 * exp(-(dx * dx + dy * dy) / 9);
    }
    return sum;
}

static void what_never_repeats_tiles_all_the_same(void **state)
{
    (void)state;
    weft_material material = material_of(80, 64, blots), tile;
    weft_blend_report report = blended(&material, &tile);
    weft_seam seam;
    expect_ok(weft_seam_of_material(&material, &seam, NULL), NULL);
    assert_memory_equal(&seam, &report.before, sizeof seam);
    assert_true(report.before.mean_difference > 2);
    assert_true(report.after.mean_difference < 1.15);
    assert_true(report.after.above_99th <= 0.01 && report.after.strongest <= 1);
    assert_true(report.width >= 40 && report.height >= 32);
    weft_material_free(&tile);
    weft_material_free(&material);
}

/* ---- What the ends differ by is spread ---- */

/* Blots, twice as bright on the right as on the left: no cut makes these ends alike. */
static double brighter_on_the_right(double x, double y)
{
    return blots(x, y) * (1 + x / 80);
}

/* What every texel of a row of eight has on the average, over the mean of all: lowest and highest. */
static void find_range(const weft_material_level *level, double range[2])
{
    double all = 0;
    range[0] = DBL_MAX, range[1] = 0;
    for (int i = 0; i < level->width * level->height; i++)
        all += weft_float_of_half(level->diffuse[4 * i]) / (level->width * level->height);
    for (int x = 0; x < level->width; x++) {
        double sum = 0;
        for (int y = 0; y < level->height; y++)
            sum += weft_float_of_half(level->diffuse[4 * (y * level->width + x)]) / level->height / all;
        range[0] = fmin(range[0], sum);
        range[1] = fmax(range[1], sum);
    }
}

static void ends_of_another_brightness_meet(void **state)
{
    (void)state;
    weft_material material = material_of(80, 64, brighter_on_the_right), tile;
    weft_blend_report report = blended(&material, &tile);
    double before[2], after[2];
    find_range(&material.level[0], before);
    find_range(&tile.level[0], after);
    print_message(
        "after: %.4f above, %.2f strongest, %.3f mean; columns from %.2f to %.2f of the mean, before %.2f to %.2f\n",
        report.after.above_99th, report.after.strongest, report.after.mean_difference, after[0], after[1], before[0],
        before[1]);
    assert_true(report.after.above_99th <= 0.01 && report.after.strongest <= 1);
    assert_true(report.after.mean_difference < 1.15);
    weft_material_free(&tile);
    weft_material_free(&material);
}

/* Every texel beside the cut is one of the material, and the coarse levels are of the same place. */
static void levels_follow_their_texels(void **state)
{
    (void)state;
    weft_material material = material_of(80, 64, blots), tile;
    blended(&material, &tile);
    for (int k = 1; k < 3; k++) {
        double error = 0, spread = 0, mean = 0;
        const weft_material_level *fine = &tile.level[0], *coarse = &tile.level[k];
        int count = (fine->width >> k) * (fine->height >> k);
        for (int i = 0; i < fine->width * fine->height; i++)
            mean += weft_float_of_half(fine->diffuse[4 * i]) / (fine->width * fine->height);
        for (int y = 0; y < fine->height >> k; y++)
            for (int x = 0; x < fine->width >> k; x++) {
                double sum = 0;
                for (int j = 0; j < 1 << k; j++)
                    for (int i = 0; i < 1 << k; i++)
                        sum += weft_float_of_half(fine->diffuse[4 * (((y << k) + j) * fine->width + (x << k) + i)]);
                double own = weft_float_of_half(coarse->diffuse[4 * (y * coarse->width + x)]);
                error += pow(own - ldexp(sum, -2 * k), 2) / count;
                spread += pow(own - mean, 2) / count;
            }
        assert_true(sqrt(error) < 0.3 * k * sqrt(spread));
    }
    weft_material_free(&tile);
    weft_material_free(&material);
}

static void what_tiles_is_left_as_it_is(void **state)
{
    (void)state;
    weft_material material = material_of(52, 36, periodic), tile;
    weft_blend_report report = blended(&material, &tile);
    assert_int_equal(report.width, 52);
    assert_int_equal(report.height, 36);
    assert_int_equal(report.overlap_x + report.overlap_y, 0);
    for (int k = 0; k < material.level_count; k++)
        assert_memory_equal(tile.level[k].diffuse, material.level[k].diffuse,
                            (size_t)(8 * material.level[k].width * material.level[k].height));
    weft_material_free(&tile);
    weft_material_free(&material);
}

static double even(double x, double y)
{
    (void)x;
    (void)y;
    return 0.3;
}

static void a_material_without_any_pattern_is_no_trouble(void **state)
{
    (void)state;
    weft_material material = material_of(16, 40, even), tile;
    weft_blend_report report = blended(&material, &tile);
    assert_float_equal(report.after.above_99th, 0, 0);
    assert_true(isfinite(report.after.mean_difference) && isfinite(report.after.strongest));
    weft_material_free(&tile);
    weft_material_free(&material);
}

/* A glossy material, which every direction shows otherwise: no picture that judges is one that chose. */
static void a_cut_is_judged_by_directions_that_did_not_choose_it(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material;
    weft_blend_pictures chooses, judges;
    expect_ok(weft_material_create(16, 16, 1, 0, 0, 0, &material, &error), &error);
    for (int i = 0; i < 3 * 16 * 16; i++) {
        const double lobe[4] = {-0.9, -0.8, 1, 5};
        for (int c = 0; c < 4; c++)
            material.level[0].lobe[4 * i + c] = weft_half_of_float((float)lobe[c]);
    }
    expect_ok(weft_blend_pictures_make(&material, WEFT_BLEND_CHOOSES, &chooses, &error), &error);
    expect_ok(weft_blend_pictures_make(&material, WEFT_BLEND_JUDGES, &judges, &error), &error);
    for (int i = 0; i < WEFT_BLEND_PAIRS; i++)
        for (int j = 0; j < WEFT_BLEND_PAIRS; j++)
            assert_true(fabsf(chooses.value[4 * i] - judges.value[4 * j]) > 1e-4f);
    weft_blend_pictures_free(&judges);
    weft_blend_pictures_free(&chooses);
    weft_material_free(&material);
}

static void the_metadata_say_what_was_done(void **state)
{
    (void)state;
    weft_material material = material_of(60, 50, periodic), tile;
    free(material.metadata);
    material.metadata = strdup("{\"dataset\":{\"layout\":\"1\"},\"fit\":{\"lobes\":0}}");
    blended(&material, &tile);
    assert_non_null(strstr(tile.metadata, "\"fit\":{\"lobes\":0}"));
    assert_non_null(strstr(tile.metadata, "\"overlap_texels\":["));
    weft_material_free(&tile);
    weft_material_free(&material);
}

static void a_material_too_small_to_cut_is_refused(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material = material_of(15, 40, even), tile;
    weft_blend_report report;
    assert_int_equal(weft_blend(&material, &tile, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "15 x 40"));
    weft_material_free(&material);
}

int test_blend(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_path_is_cheaper),
        cmocka_unit_test(a_cut_does_not_break_a_pattern),
        cmocka_unit_test(cloth_that_repeats_is_cut_to_whole_repeats),
        cmocka_unit_test(what_never_repeats_tiles_all_the_same),
        cmocka_unit_test(ends_of_another_brightness_meet),
        cmocka_unit_test(levels_follow_their_texels),
        cmocka_unit_test(what_tiles_is_left_as_it_is),
        cmocka_unit_test(a_material_without_any_pattern_is_no_trouble),
        cmocka_unit_test(a_cut_is_judged_by_directions_that_did_not_choose_it),
        cmocka_unit_test(the_metadata_say_what_was_done),
        cmocka_unit_test(a_material_too_small_to_cut_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
