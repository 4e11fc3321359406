/* PSNR, SSIM and FLIP against programs of others, and where their values are known. */
#include "compare/pictures/picture_quality.h"
#include "tests/support/expect_ok.h"

#include <math.h>

enum { WIDTH = 24, HEIGHT = 20 };

static weft_image uniform(float r, float g, float b)
{
    weft_image image;
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, &image, NULL), WEFT_OK);
    const float rgb[3] = {r, g, b};
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] = rgb[i % 3];
    return image;
}

static weft_picture_quality compare(weft_image a, weft_image b)
{
    weft_picture_quality quality;
    weft_error error = {0};
    expect_ok(weft_picture_quality_measure(&a, &b, &quality, &error), &error);
    weft_image_free(&a);
    weft_image_free(&b);
    return quality;
}

static weft_image waves(double shift, double green, int step, double contrast)
{
    weft_image image;
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, &image, NULL), WEFT_OK);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH, y = i / WIDTH, square = ((x + step) / 4 + y / 4) % 2;
        image.pixels[3 * i] = (float)(0.5 + 0.4 * sin(0.7 * x + shift));
        image.pixels[3 * i + 1] = (float)(green + 0.3 * cos(0.5 * y + 0.2 * x));
        image.pixels[3 * i + 2] = (float)(0.5 + contrast * (square - 0.5));
    }
    return image;
}

/* Computed in numpy: FLIP by the steps of its authors' Python program, SSIM by the article's formula, both with loops
 * over all pixels instead of filters of a library. */
static void pictures_differ_as_other_programs_say(void **state)
{
    (void)state;
    weft_picture_quality quality = compare(waves(0, 0.5, 0, 0.6), waves(0.4, 0.45, 1, 0.5));
    assert_float_equal(quality.flip, 0.3106595461667269, 1e-5);
    assert_float_equal(quality.ssim, 0.7834655298739802, 1e-5);
    assert_float_equal(quality.psnr_db, 15.079872784278107, 1e-4);
}

static void equal_pictures_do_not_differ(void **state)
{
    (void)state;
    weft_picture_quality quality = compare(waves(0, 0.5, 0, 0.6), waves(0, 0.5, 0, 0.6));
    assert_float_equal(quality.flip, 0, 1e-12);
    assert_float_equal(quality.ssim, 1, 1e-12);
    assert_true(isinf(quality.psnr_db));
}

/* FLIP takes green and blue as the colours that differ most. */
static void green_and_blue_differ_most(void **state)
{
    (void)state;
    assert_float_equal(compare(uniform(0, 1, 0), uniform(0, 0, 1)).flip, 1, 1e-9);
    assert_true(compare(uniform(1, 0, 0), uniform(0, 0, 1)).flip < 0.99);
}

/* The published CIELAB of sRGB green and blue, and lightnesses of two greys, by hand. */
static void greys_differ_by_their_lightness(void **state)
{
    (void)state;
    double green[3] = {87.737, -86.185 * 0.87737, 83.181 * 0.87737};
    double blue[3] = {32.303, 79.197 * 0.32303, -107.864 * 0.32303};
    double most = pow(green[0] - blue[0] + hypot(green[1] - blue[1], green[2] - blue[2]), 0.7);
    double dark = 116 * cbrt(0.21404114) - 16, bright = 116 * cbrt(0.31854678) - 16;
    weft_picture_quality quality = compare(uniform(0.5f, 0.5f, 0.5f), uniform(0.6f, 0.6f, 0.6f));
    assert_float_equal(quality.flip, 0.95 / (0.4 * most) * pow(bright - dark, 0.7), 2e-3);
    assert_float_equal(quality.psnr_db, 20, 1e-4);
    assert_float_equal(quality.ssim, (2 * 0.3 + 1e-4) / (0.25 + 0.36 + 1e-4), 1e-6);
}

/* The left half is as it was, the right one a tenth brighter; far from the line between them SSIM knows no better. */
static void regions_are_told_apart(void **state)
{
    (void)state;
    weft_image a = uniform(0.5f, 0.5f, 0.5f), b = uniform(0.5f, 0.5f, 0.5f);
    uint8_t regions[WIDTH * HEIGHT];
    weft_picture_quality quality[4], whole;
    weft_error error = {0};
    long pixels[4];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH;
        for (int c = 0; x >= WIDTH / 2 && c < 3; c++)
            b.pixels[3 * i + c] = 0.6f;
        regions[i] = (uint8_t)(1 | (x < WIDTH / 2) << 1 | (x >= WIDTH - 4) << 2);
    }
    expect_ok(weft_picture_quality_by_region(&a, &b, regions, 4, quality, pixels, &error), &error);
    expect_ok(weft_picture_quality_measure(&a, &b, &whole, &error), &error);
    const long expected[] = {WIDTH * HEIGHT, WIDTH * HEIGHT / 2, 4 * HEIGHT, 0};
    for (int k = 0; k < 4; k++)
        assert_int_equal(pixels[k], expected[k]);
    assert_float_equal(quality[0].psnr_db, whole.psnr_db, 1e-9);
    assert_float_equal(quality[0].ssim, whole.ssim, 1e-9);
    assert_float_equal(quality[0].flip, whole.flip, 1e-9);
    assert_float_equal(whole.psnr_db, 20 + 10 * log10(2), 1e-4);
    assert_true(isinf(quality[1].psnr_db));
    assert_float_equal(quality[2].psnr_db, 20, 1e-4);
    assert_float_equal(quality[2].ssim, (2 * 0.3 + 1e-4) / (0.25 + 0.36 + 1e-4), 1e-6);
    assert_true(quality[1].flip < 0.5 * quality[2].flip);
    assert_float_equal(quality[3].flip + quality[3].ssim + quality[3].psnr_db, 0, 1e-12);
    weft_image_free(&a);
    weft_image_free(&b);
}

static void pictures_of_different_sizes_are_refused(void **state)
{
    (void)state;
    weft_image a = uniform(0, 0, 0), b;
    weft_picture_quality quality;
    assert_int_equal(weft_image_create(3, 2, &b, NULL), WEFT_OK);
    assert_int_equal(weft_picture_quality_measure(&a, &b, &quality, NULL), WEFT_BAD_USAGE);
    weft_image_free(&a);
    weft_image_free(&b);
}

int test_picture_quality(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_differ_as_other_programs_say),
        cmocka_unit_test(equal_pictures_do_not_differ),
        cmocka_unit_test(green_and_blue_differ_most),
        cmocka_unit_test(greys_differ_by_their_lightness),
        cmocka_unit_test(regions_are_told_apart),
        cmocka_unit_test(pictures_of_different_sizes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
