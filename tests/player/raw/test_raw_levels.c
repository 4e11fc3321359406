/* Rows that go in as texels come out as blocks, on every level. */
#include "base/half.h"
#include "base/integers.h"
#include "player/raw/stream.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { IMAGES = 5, COMPONENTS = 3, MAX_SIDE = 24 };

/* The texture, as the strips fill it: half floats of every image. */
typedef struct picture {
    const weft_raw_plan *plan;
    int strips;
    weft_half texel[IMAGES + 1][MAX_SIDE][MAX_SIDE][4];
} picture;

static weft_raw_plan make_plan(int width, int height, weft_raw_format format)
{
    weft_raw_plan plan;
    weft_error error;
    const weft_dataset_layout layout = {.width = width, .height = height, .image_count = IMAGES, .view_count = IMAGES};
    const weft_raw_limits limits = {SIZE_MAX, SIZE_MAX, 4096, COMPONENTS, true, format};
    assert_int_equal(weft_raw_plan_make(&layout, true, "cloth", &limits, &plan, &error), WEFT_OK);
    return plan;
}

static weft_code take(void *context, const weft_raw_strip *strip, weft_error *error)
{
    (void)error;
    picture *p = context;
    weft_mip_area area = p->plan->layout.area[strip->level];
    int width = (int)(strip->bytes / 8 / COMPONENTS / WEFT_RAW_BLOCK);
    assert_int_equal(width, (area.width + WEFT_RAW_BLOCK) / WEFT_RAW_BLOCK * WEFT_RAW_BLOCK);
    const weft_half(*texel)[4] = strip->texels;
    for (int layer = 0; layer < COMPONENTS; layer++) {
        for (int y = 0; y < WEFT_RAW_BLOCK; y++, texel += width)
            memcpy(p->texel[strip->column * COMPONENTS + layer][area.y + strip->row * WEFT_RAW_BLOCK + y][area.x],
                   texel, (size_t)width * sizeof *texel);
    }
    p->strips++;
    free(strip->texels);
    return WEFT_OK;
}

static float value_of(int x, int y, int channel, int image)
{
    return (float)(1 + x + 8 * y + 64 * channel + 256 * image) / 8;
}

static void push_all(const weft_raw_plan *plan, int width, int height, picture *p)
{
    weft_raw_levels *levels;
    weft_error error;
    p->plan = plan;
    assert_int_equal(weft_raw_levels_create(plan, WEFT_RAW_SAMPLES, width, height, take, p, &levels, &error), WEFT_OK);
    for (int y = 0; y < height; y++) {
        float *row = weft_raw_levels_row(levels, y);
        for (int i = 0; i < width * 3 * IMAGES; i++)
            row[i] = value_of(i / (3 * IMAGES), y, i / IMAGES % 3, i % IMAGES);
        assert_int_equal(weft_raw_levels_push(levels, y, &error), WEFT_OK);
    }
    weft_raw_levels_free(levels);
}

/* Box means of value_of, which is linear in x and y; at an odd edge the last texel counts twice. */
static double mean_of(int level, int x, int y, int width, int height, int channel, int image)
{
    if (level == 0)
        return (double)value_of(x, y, channel, image);
    double sum = 0;
    int finer_width = width, finer_height = height;
    for (int k = 1; k < level; k++) {
        finer_width = (finer_width + 1) / 2;
        finer_height = (finer_height + 1) / 2;
    }
    for (int i = 0; i < 4; i++)
        sum += mean_of(level - 1, weft_smaller(2 * x + i % 2, finer_width - 1),
                       weft_smaller(2 * y + i / 2, finer_height - 1), width, height, channel, image);
    return sum / 4;
}

static void expect_level(const picture *p, int level, int width, int height)
{
    weft_mip_area area = p->plan->layout.area[level];
    for (int i = 0; i < (area.height + 1) * (area.width + 1) * IMAGES * 3; i++) {
        int c = i % 3, image = i / 3 % IMAGES, x = i / 3 / IMAGES % (area.width + 1);
        int y = i / 3 / IMAGES / (area.width + 1);
        double expected =
            mean_of(level + p->plan->skipped_levels, x % area.width, y % area.height, width, height, c, image);
        assert_float_equal(weft_float_of_half(p->texel[image][area.y + y][area.x + x][c]), expected, 2e-3 * expected);
    }
}

static void every_level_is_the_mean_and_begins_again_at_its_end(void **state)
{
    (void)state;
    const int size[][2] = {{8, 8}, {1, 1}, {5, 3}, {4, 7}, {11, 2}};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        weft_raw_plan plan = make_plan(size[i][0], size[i][1], WEFT_RAW_HALF);
        assert_true(plan.layout.width <= MAX_SIDE && plan.layout.height <= MAX_SIDE);
        picture *p = calloc(1, sizeof *p);
        assert_non_null(p);
        push_all(&plan, size[i][0], size[i][1], p);
        for (int level = 0; level < plan.layout.level_count; level++)
            expect_level(p, level, size[i][0], size[i][1]);
        free(p);
    }
}

static void levels_that_do_not_fit_are_not_given(void **state)
{
    (void)state;
    weft_raw_plan plan = make_plan(8, 8, WEFT_RAW_HALF);
    plan.skipped_levels = 1;
    plan.layout = weft_mip_layout_of(4, 4, 3, 1, WEFT_RAW_BLOCK);
    picture *p = calloc(1, sizeof *p);
    assert_non_null(p);
    push_all(&plan, 8, 8, p);
    for (int level = 0; level < 3; level++)
        expect_level(p, level, 8, 8);
    assert_int_equal(p->strips, 2 * (2 + 1 + 1));
    free(p);
}

/* ---- Formats ---- */

static float shared_exponent_value(uint32_t bits, int channel)
{
    return (float)(bits >> 9 * channel & 511) * exp2f((float)(bits >> 27) - 24);
}

static void a_shared_exponent_keeps_nine_bits_of_the_largest(void **state)
{
    (void)state;
    const float largest[] = {0, 1e-9f, 3e-5f, 0.499f, 0.9999f, 1, 1.5f, 700, 65408};
    for (size_t i = 0; i < sizeof largest / sizeof *largest; i++) {
        const float texel[3] = {largest[i], largest[i] / 3, -1};
        const weft_raw_rows rows = {{texel, texel, texel, texel}, 1, 3, 1};
        uint32_t result[16];
        weft_raw_store(WEFT_RAW_SHARED_EXPONENT, &rows, 0, 1, 1, result);
        float expected = largest[i];
        for (int t = 0; t < 16; t++) {
            assert_float_equal(shared_exponent_value(result[t], 0), expected, 0.002 * (double)expected + 4e-8);
            assert_float_equal(shared_exponent_value(result[t], 1), expected / 3, 0.002 * (double)expected + 4e-8);
            assert_float_equal(shared_exponent_value(result[t], 2), 0, 0);
        }
    }
}

static void opacity_takes_a_byte(void **state)
{
    (void)state;
    const float opacity[4] = {0, 1, 0.5f, 0.25f}; /* 2 texels of 2 views */
    const weft_raw_rows rows = {{opacity, opacity, opacity, opacity}, 2, 1, 2};
    uint8_t result[2][4][4];
    weft_raw_store(WEFT_RAW_EIGHT_BITS, &rows, 0, 2, 1, result);
    const uint8_t expected[2][4] = {{0, 128, 0, 0}, {255, 64, 255, 255}};
    for (int view = 0; view < 2; view++) {
        for (int y = 0; y < 4; y++)
            assert_memory_equal(result[view][y], expected[view], 4);
    }
}

int test_raw_levels(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_is_the_mean_and_begins_again_at_its_end),
        cmocka_unit_test(levels_that_do_not_fit_are_not_given),
        cmocka_unit_test(a_shared_exponent_keeps_nine_bits_of_the_largest),
        cmocka_unit_test(opacity_takes_a_byte),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
