/* What is chosen for datasets of every size, and where their levels lie. */
#include "player/raw/plan.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>
#include <string.h>

enum { IMAGES = 6561, VIEWS = 81 };

static const size_t mebibyte = (size_t)1 << 20;

static weft_raw_limits card(weft_raw_format format)
{
    return (weft_raw_limits){512 * mebibyte, 1000 * mebibyte, 16384, 2048, true, format};
}

static weft_code make(int width, int height, bool has_opacity, weft_raw_limits limits, weft_raw_plan *plan)
{
    weft_error error = {0};
    const weft_dataset_layout layout = {
        .width = width, .height = height, .image_count = IMAGES, .view_count = VIEWS, .texel_pitch_mm = 1};
    weft_code code = weft_raw_plan_make(&layout, has_opacity, "cloth", &limits, plan, &error);
    assert_true(code == WEFT_OK || error.message[0]);
    return code;
}

static void expect(int side, weft_raw_limits limits, weft_raw_format format, int skipped_levels)
{
    weft_raw_plan plan;
    assert_int_equal(make(side, side, false, limits, &plan), WEFT_OK);
    assert_int_equal(plan.tiles[WEFT_RAW_SAMPLES].format, format);
    assert_int_equal(plan.skipped_levels, skipped_levels);
    assert_true(weft_raw_plan_bytes(&plan, format) <= limits.bytes);
}

static void the_best_format_that_fits_is_chosen(void **state)
{
    (void)state;
    expect(64, card(WEFT_RAW_FITTING), WEFT_RAW_HALF, 0);
    expect(128, card(WEFT_RAW_FITTING), WEFT_RAW_SHARED_EXPONENT, 0);
    expect(256, card(WEFT_RAW_FITTING), WEFT_RAW_BC6H, 0);
}

static void finest_levels_go_only_where_no_format_fits(void **state)
{
    (void)state;
    weft_raw_limits limits = card(WEFT_RAW_FITTING);
    expect(512, limits, WEFT_RAW_BC6H, 1);
    limits.has_bc6h = false;
    expect(256, limits, WEFT_RAW_SHARED_EXPONENT, 1);
}

static void a_wanted_format_is_kept_whatever_fits_better(void **state)
{
    (void)state;
    expect(16, card(WEFT_RAW_BC6H), WEFT_RAW_BC6H, 0);
    expect(16, card(WEFT_RAW_SHARED_EXPONENT), WEFT_RAW_SHARED_EXPONENT, 0);
    expect(80, card(WEFT_RAW_HALF), WEFT_RAW_HALF, 0);
    expect(80, card(WEFT_RAW_FITTING), WEFT_RAW_SHARED_EXPONENT, 0);
    expect(256, card(WEFT_RAW_HALF), WEFT_RAW_HALF, 2);
}

static void a_format_that_the_driver_lacks_is_an_error(void **state)
{
    (void)state;
    weft_raw_plan plan;
    weft_raw_limits limits = card(WEFT_RAW_BC6H);
    limits.has_bc6h = false;
    assert_int_equal(make(16, 16, false, limits, &plan), WEFT_SYSTEM);
}

static void opacity_has_a_tile_for_each_view_and_counts(void **state)
{
    (void)state;
    weft_raw_plan plain, holes;
    assert_int_equal(make(64, 64, false, card(WEFT_RAW_FITTING), &plain), WEFT_OK);
    assert_int_equal(make(64, 64, true, card(WEFT_RAW_FITTING), &holes), WEFT_OK);
    size_t texels = (size_t)holes.layout.width * (size_t)holes.layout.height;
    assert_int_equal(plain.tiles[WEFT_RAW_OPACITY].count, 0);
    assert_int_equal(holes.tiles[WEFT_RAW_OPACITY].layers, VIEWS);
    assert_int_equal(weft_raw_plan_bytes(&holes, WEFT_RAW_BC6H),
                     weft_raw_plan_bytes(&plain, WEFT_RAW_BC6H) + texels * VIEWS);
}

static void every_image_has_a_tile_within_the_limits(void **state)
{
    (void)state;
    weft_raw_plan plan;
    weft_raw_limits limits = card(WEFT_RAW_FITTING);
    limits.layers = 256;
    limits.size = 1024;
    assert_int_equal(make(40, 40, false, limits, &plan), WEFT_OK);
    const weft_raw_tiles *tiles = &plan.tiles[WEFT_RAW_SAMPLES];
    assert_true(tiles->layers <= limits.layers && plan.layout.width * tiles->columns <= limits.size);
    assert_true(tiles->layers * tiles->columns >= IMAGES);
    assert_true(plan.skipped_levels > 0);
}

static int rounded_up(int size)
{
    return (size + WEFT_RAW_BLOCK) / WEFT_RAW_BLOCK * WEFT_RAW_BLOCK;
}

static bool overlap(weft_mip_area a, weft_mip_area b)
{
    return a.x < b.x + rounded_up(b.width) && b.x < a.x + rounded_up(a.width) && a.y < b.y + rounded_up(b.height) &&
           b.y < a.y + rounded_up(a.height);
}

static void levels_begin_at_blocks_and_share_none(void **state)
{
    (void)state;
    const int size[][2] = {{64, 64}, {1, 1}, {3, 5}, {100, 7}, {7, 100}, {31, 64}, {63, 65}};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        weft_raw_plan plan;
        assert_int_equal(make(size[i][0], size[i][1], false, card(WEFT_RAW_BC6H), &plan), WEFT_OK);
        const weft_mip_layout *layout = &plan.layout;
        for (int k = 0; k < layout->level_count; k++) {
            weft_mip_area a = layout->area[k];
            assert_true(a.x % WEFT_RAW_BLOCK == 0 && a.y % WEFT_RAW_BLOCK == 0);
            assert_true(a.x + rounded_up(a.width) <= layout->width && a.y + rounded_up(a.height) <= layout->height);
            for (int j = 0; j < k; j++)
                assert_false(overlap(a, layout->area[j]));
        }
    }
}

int test_raw_plan(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_format_that_fits_is_chosen),
        cmocka_unit_test(finest_levels_go_only_where_no_format_fits),
        cmocka_unit_test(a_wanted_format_is_kept_whatever_fits_better),
        cmocka_unit_test(a_format_that_the_driver_lacks_is_an_error),
        cmocka_unit_test(opacity_has_a_tile_for_each_view_and_counts),
        cmocka_unit_test(every_image_has_a_tile_within_the_limits),
        cmocka_unit_test(levels_begin_at_blocks_and_share_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
