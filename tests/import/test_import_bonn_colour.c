/* The colour models of the files of Bonn, from nearly black to far above white: what three colours are encoded as here,
 * in double, is decoded. */
#include "import/bonn/colour.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const double offset = 1e-5;
static const double mean[3] = {0.25, 0.5, 0.125};

typedef struct matrix {
    double at[3][3]; /* [result][of] */
} matrix;

static const matrix rgb_of_yuv = {{{1, 0, 1.13983}, {1, -0.39465, -0.5806}, {1, 2.03211, 0}}};
static const matrix rgb_of_ycocg = {{{1, 1, -1}, {1, 0, 1}, {1, -1, -1}}};
static const matrix rgb_of_axes = {{{0.5, -0.5, 0.25}, {0.5, 0.25, -0.5}, {0.25, 0.5, 1}}};

static double determinant(const matrix *m)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += m->at[0][i] *
               (m->at[1][(i + 1) % 3] * m->at[2][(i + 2) % 3] - m->at[1][(i + 2) % 3] * m->at[2][(i + 1) % 3]);
    return sum;
}

/* By Cramer's rule. */
static void solve(const matrix *m, const double rgb[3], double x[3])
{
    for (int column = 0; column < 3; column++) {
        matrix replaced = *m;
        for (int i = 0; i < 3; i++)
            replaced.at[i][column] = rgb[i];
        x[column] = determinant(&replaced) / determinant(m);
    }
}

static double signed_log(double value)
{
    return copysign(log(fabs(value)) - log(offset), value);
}

static void encode_yuv(int model, const double rgb[3], double channel[3])
{
    double yuv[3];
    solve(&rgb_of_yuv, rgb, yuv);
    channel[0] = model == WEFT_BONN_YUV ? yuv[0] : log(yuv[0] + offset);
    for (int i = 1; i < 3; i++)
        channel[i] = model == WEFT_BONN_LOG_YUV       ? signed_log(yuv[i])
                     : model == WEFT_BONN_LOG_Y_RATIO ? yuv[i] / (yuv[0] + offset)
                                                      : yuv[i];
}

static void encode(int model, const double rgb[3], double channel[3])
{
    double rest[3], sum = rgb[0] + rgb[1] + rgb[2];
    for (int i = 0; i < 3; i++) {
        channel[i] = model == WEFT_BONN_LOG_RGB ? log(rgb[i] + offset) : rgb[i];
        rest[i] = rgb[i] - mean[i];
    }
    switch (model) {
    case WEFT_BONN_RGB:
    case WEFT_BONN_LOG_RGB:
        break;
    case WEFT_BONN_PCA:
        solve(&rgb_of_axes, rest, channel);
        break;
    case WEFT_BONN_YCOCG:
        solve(&rgb_of_ycocg, rgb, channel);
        break;
    case WEFT_BONN_SUM:
        channel[0] = sum;
        channel[1] = rgb[1] / sum;
        channel[2] = rgb[2] / sum;
        break;
    default:
        encode_yuv(model, rgb, channel);
    }
}

static weft_bonn_colour colour_of(int model)
{
    weft_bonn_colour colour = {.model = model};
    for (int i = 0; i < 9; i++) {
        colour.mean[i % 3] = (float)mean[i % 3];
        colour.axis[i / 3][i % 3] = (float)rgb_of_axes.at[i % 3][i / 3];
    }
    return colour;
}

static void check_model(int model)
{
    static const double scale[] = {1e-4, 1e-3, 0.1, 1, 40};
    static const double hue[][3] = {{1, 0.6, 0.2}, {0.1, 0.5, 1.1}, {0.5, 1.5, 0.25}};
    enum { COUNT = 15, STRIDE = 20 };
    float channels[3 * STRIDE];
    for (int i = 0; i < 3 * STRIDE; i++)
        channels[i] = 7;
    for (int i = 0; i < COUNT; i++) {
        double rgb[3], channel[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = scale[i / 3] * hue[i % 3][c];
        encode(model, rgb, channel);
        for (int c = 0; c < 3; c++)
            channels[c * STRIDE + i] = (float)channel[c];
    }
    const weft_bonn_colour colour = colour_of(model);
    assert_int_equal(weft_bonn_colour_check(&colour, "file", NULL), WEFT_OK);
    weft_bonn_colour_restore(&colour, channels, STRIDE, COUNT);
    for (int i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++) {
            double expected = scale[i / 3] * hue[i % 3][c], found = (double)channels[c * STRIDE + i];
            if (fabs(found - expected) > 3e-6 * scale[i / 3] * 4 + 1e-7)
                fail_msg("model %d: %g for %g", model, found, expected);
        }
    }
    for (int c = 0; c < 3; c++)
        assert_float_equal(channels[c * STRIDE + COUNT], 7, 0);
}

static void what_was_encoded_is_decoded(void **state)
{
    (void)state;
    static const int models[] = {0, 1, 3, 4, 5, 9, 10, 11, 12};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++)
        check_model(models[i]);
}

static void black_is_black(void **state)
{
    (void)state;
    for (int model = WEFT_BONN_LOG_Y; model <= WEFT_BONN_LOG_RGB; model++) {
        float black = (float)log(offset), channels[3] = {black, 0, 0};
        const weft_bonn_colour colour = colour_of(model);
        if (model == WEFT_BONN_LOG_RGB)
            channels[1] = channels[2] = black;
        weft_bonn_colour_restore(&colour, channels, 1, 1);
        for (int c = 0; c < 3; c++)
            assert_float_equal(channels[c], 0, 1e-10);
    }
}

static void models_that_are_not_understood_are_refused(void **state)
{
    (void)state;
    static const int models[] = {-1, 2, 6, 7, 8, 13, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        const weft_bonn_colour colour = colour_of(models[i]);
        assert_int_equal(weft_class_of(weft_bonn_colour_check(&colour, "file", NULL)), WEFT_BAD_INPUT);
    }
}

int test_import_bonn_colour(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_encoded_is_decoded),
        cmocka_unit_test(black_is_black),
        cmocka_unit_test(models_that_are_not_understood_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
