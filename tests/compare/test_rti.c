/* The models of reflectance transformation imaging: what they carry to other lamps without an error, what they only
 * come near, and that they do not see what is held out. */
#include "tests/compare/fixture.h"

#include "base/half.h"
#include "base/picture/colour.h"
#include "compare/rti/rti.h"
#include "compare/tradeoff/held_error.h"
#include "compare/tradeoff/tradeoff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LAMPS = 40, ASKED = 7, SIDE = 4 };

static const char *const path = "rti.btf.h5", *const scratch = "rti_scratch.btf.h5";

/* ---- Lamps ---- */

/* On a spiral from the zenith down to z = lowest. */
static weft_vec3 lamp_of(int i, int count, double lowest, double turn)
{
    double z = 1 - (1 - lowest) * (i + 0.5) / count, phi = 2.399963 * i + turn, r = sqrt(1 - z * z);
    return (weft_vec3){r * cos(phi), r * sin(phi), z};
}

typedef double (*function_of_light)(weft_vec3 light);

/* The largest error under lamps between those that are fitted, which lie from the zenith to z = lowest. */
static double error_of(weft_rti_model model, double lowest, function_of_light function)
{
    weft_vec3 light[LAMPS], asked[ASKED];
    double weight[ASKED][LAMPS], worst = 0;
    weft_error error = {0};
    for (int i = 0; i < LAMPS; i++)
        light[i] = lamp_of(i, LAMPS, lowest, 0);
    for (int i = 0; i < ASKED; i++)
        asked[i] = lamp_of(i, ASKED, lowest, 0.7);
    expect_ok(weft_rti_weights(model, light, LAMPS, asked, ASKED, &weight[0][0], &error), &error);
    for (int a = 0; a < ASKED; a++) {
        double sum = 0;
        for (int i = 0; i < LAMPS; i++)
            sum += weight[a][i] * function(light[i]);
        worst = fmax(worst, fabs(sum - function(asked[a])));
    }
    return worst;
}

/* ---- Functions ---- */

static double plane(weft_vec3 l)
{
    return 0.4 + 0.3 * l.x - 0.2 * l.y;
}

static double quadratic(weft_vec3 l)
{
    return plane(l) + 0.5 * l.x * l.x - 0.6 * l.x * l.y - 0.1 * l.y * l.y;
}

/* A matt sheet, flat. */
static double matt(weft_vec3 l)
{
    return 0.8 * l.z;
}

/* A matt place whose normal is (3, -2, 6) / 7. */
static double matt_slope(weft_vec3 l)
{
    return fmax((3 * l.x - 2 * l.y + 6 * l.z) / 7, 0);
}

/* One hemispherical harmonic of order l and degree m, without its factor: P_lm(2 z - 1) cos(m phi) written out. */
static double order_2_degree_2(weft_vec3 l)
{
    return l.z * (l.x * l.x - l.y * l.y) / (1 + l.z);
}

static double order_2_degree_1(weft_vec3 l)
{
    return sqrt(l.z / (1 + l.z)) * (2 * l.z - 1) * l.y;
}

static double order_3_degree_3(weft_vec3 l)
{
    return pow(l.z / (1 + l.z), 1.5) * (l.x * l.x * l.x - 3 * l.x * l.y * l.y);
}

static double order_3_degree_1(weft_vec3 l)
{
    double t = 2 * l.z - 1;
    return sqrt(l.z / (1 + l.z)) * (5 * t * t - 1) * l.x;
}

static void what_a_model_spans_is_exact(void **state)
{
    (void)state;
    const double exact = 1e-6;
    assert_true(error_of(WEFT_RTI_PTM, 0.1, quadratic) < exact);
    const function_of_light second[] = {matt, order_2_degree_1, order_2_degree_2};
    const function_of_light third[] = {order_3_degree_1, order_3_degree_3};
    for (int i = 0; i < 3; i++) {
        assert_true(error_of(WEFT_RTI_HSH_2, 0.1, second[i]) < exact);
        assert_true(error_of(WEFT_RTI_HSH_3, 0.1, second[i]) < exact);
        assert_true(error_of(WEFT_RTI_PTM, 0.1, second[i]) > 0.005);
    }
    for (int i = 0; i < 2; i++) {
        assert_true(error_of(WEFT_RTI_HSH_3, 0.1, third[i]) < exact);
        assert_true(error_of(WEFT_RTI_HSH_2, 0.1, third[i]) > 0.01);
    }
    assert_true(error_of(WEFT_RTI_RBF, 0.1, plane) < exact);
    assert_true(error_of(WEFT_RTI_RBF, 0.1, quadratic) > 1e-4);
}

/* A matt slope under lamps that all of it sees is a plane of the light, of which each model knows some. */
static void a_matt_slope_is_nearly_known(void **state)
{
    (void)state;
    for (weft_rti_model model = 0; model < WEFT_RTI_MODELS; model++) {
        double error = error_of(model, 0.55, matt_slope);
        print_message("%s: %.4f\n", weft_rti_name(model), error);
        assert_true(error < 0.025);
    }
    assert_true(error_of(WEFT_RTI_HSH_3, 0.55, matt_slope) < error_of(WEFT_RTI_HSH_2, 0.55, matt_slope));
}

/* ---- The spline ---- */

static double thin_plate(weft_vec3 a, weft_vec3 b)
{
    double r = hypot(a.x - b.x, a.y - b.y);
    return r > 0 ? r * r * log(r) : 0;
}

/* Gauss and Jordan with row exchanges: right [n] becomes the solution. */
static void eliminate(int n, double *matrix, double *right)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k; i < n; i++)
            pivot = fabs(matrix[i * n + k]) > fabs(matrix[pivot * n + k]) ? i : pivot;
        for (int j = 0; j <= n; j++) {
            double *a = j < n ? &matrix[k * n + j] : &right[k], *b = j < n ? &matrix[pivot * n + j] : &right[pivot];
            double kept = *a;
            *a = *b, *b = kept;
        }
        for (int i = 0; i < n; i++) {
            double factor = i == k ? 0 : matrix[i * n + k] / matrix[k * n + k];
            for (int j = 0; j < n; j++)
                matrix[i * n + j] -= factor * matrix[k * n + j];
            right[i] -= factor * right[k];
        }
    }
    for (int k = 0; k < n; k++)
        right[k] /= matrix[k * n + k];
}

/* The system of textbooks, [K P; P' 0] (w; c) = (k; p), is not definite, and is solved in another way. */
static void the_spline_is_that_of_textbooks(void **state)
{
    (void)state;
    enum { COUNT = 12, SIZE = COUNT + 3 };
    weft_vec3 light[COUNT], asked = lamp_of(2, 5, 0.2, 0.4);
    double matrix[SIZE][SIZE] = {{0}}, right[SIZE], weight[COUNT];
    weft_error error = {0};
    for (int i = 0; i < COUNT; i++)
        light[i] = lamp_of(i, COUNT, 0.1, 0);
    for (int i = 0; i < COUNT; i++) {
        const double p[3] = {1, light[i].x, light[i].y};
        for (int j = 0; j < COUNT; j++)
            matrix[i][j] = thin_plate(light[i], light[j]);
        for (int f = 0; f < 3; f++)
            matrix[i][COUNT + f] = matrix[COUNT + f][i] = p[f];
        right[i] = thin_plate(asked, light[i]);
    }
    memcpy(right + COUNT, (double[]){1, asked.x, asked.y}, 3 * sizeof *right);
    eliminate(SIZE, &matrix[0][0], right);
    expect_ok(weft_rti_weights(WEFT_RTI_RBF, light, COUNT, &asked, 1, weight, &error), &error);
    for (int i = 0; i < COUNT; i++)
        assert_float_equal(weight[i], right[i], 1e-6);
    expect_ok(weft_rti_weights(WEFT_RTI_RBF, light, COUNT, &light[5], 1, weight, &error), &error);
    for (int i = 0; i < COUNT; i++)
        assert_float_equal(weight[i], i == 5, 1e-6);
}

/* ---- Lamps that say little ---- */

static void a_ring_of_lamps_gives_bounded_weights(void **state)
{
    (void)state;
    weft_vec3 light[LAMPS];
    double weight[LAMPS];
    weft_error error = {0};
    for (int i = 0; i < LAMPS; i++)
        light[i] = (weft_vec3){0.8 * cos(0.157 * i), 0.8 * sin(0.157 * i), 0.6};
    for (weft_rti_model model = 0; model < WEFT_RTI_MODELS; model++) {
        expect_ok(weft_rti_weights(model, light, LAMPS, &light[3], 1, weight, &error), &error);
        for (int i = 0; i < LAMPS; i++)
            assert_true(fabs(weight[i]) < 1.01);
    }
    light[4].x = NAN;
    assert_int_equal(weft_rti_weights(WEFT_RTI_PTM, light, LAMPS, light, 1, weight, &error), WEFT_BAD_INPUT);
}

/* ---- Texels ---- */

static weft_dataset_layout one_view(int lamps, weft_values values)
{
    weft_dataset_layout layout = {
        .width = SIDE, .height = SIDE, .image_count = lamps, .view_count = 1, .values = values, .texel_pitch_mm = 1};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    layout.view[0] = (weft_vec3){0, 0, 1};
    for (int i = 0; i < lamps; i++) {
        layout.light[i] = lamp_of(i, lamps, 0.15, 0);
        layout.view_of_image[i] = 0;
    }
    return layout;
}

/* Its coded value is a quadratic, of another brightness at every texel. */
static weft_half sample_of(const weft_dataset_layout *layout, int texel, int image, int channel)
{
    double coded = (0.3 + 0.02 * texel + 0.1 * channel) * quadratic(layout->light[image]);
    double cosine = layout->values == WEFT_REFLECTANCE ? layout->light[image].z : 1;
    return weft_half_of_float(weft_linear_of_srgb((float)coded) / (float)cosine);
}

/* What is masked and what is held out may be anything, in either quantity. */
static void texels_are_predicted_from_what_is_fitted(void **state)
{
    (void)state;
    enum { TEXELS = 3, VALUES = 3 * LAMPS };
    for (weft_values values = WEFT_REFLECTANCE_COSINE; values <= WEFT_REFLECTANCE; values++) {
        weft_dataset_layout layout = one_view(LAMPS, values);
        weft_half truth[TEXELS][VALUES], samples[TEXELS][VALUES], predicted[TEXELS][VALUES];
        uint8_t left_out[LAMPS] = {0}, mask[TEXELS][LAMPS] = {{0}};
        weft_error error = {0};
        for (int t = 0; t < TEXELS; t++)
            for (int i = 0; i < VALUES; i++)
                truth[t][i] = sample_of(&layout, t, i / 3, i % 3);
        memcpy(samples, truth, sizeof truth);
        for (int i = 0; i < LAMPS; i++) {
            left_out[i] = i % 5 == 2;
            mask[1][i] = i % 7 == 3 ? WEFT_MASK_SATURATED : 0;
            mask[2][i] = i > 3 ? WEFT_MASK_MISSING : 0;
            for (int t = 0; t < TEXELS; t++)
                for (int c = 0; c < 3 && (left_out[i] || mask[t][i]); c++)
                    samples[t][3 * i + c] = weft_half_of_float(9);
        }
        expect_ok(weft_rti_predict_texels(&layout, left_out, WEFT_RTI_PTM, &samples[0][0], &mask[0][0], TEXELS,
                                          &predicted[0][0], &error),
                  &error);
        for (int t = 0; t < 2; t++)
            for (int i = 0; i < VALUES; i++) {
                double wanted = (double)weft_float_of_half(truth[t][i]);
                assert_float_equal((double)weft_float_of_half(predicted[t][i]), wanted, 0.004 * wanted + 1e-4);
            }
        for (int i = 0; i < VALUES; i++)
            assert_true(isnan(weft_float_of_half(predicted[2][i])));
        weft_dataset_layout_free(&layout);
    }
}

/* ---- The price list ---- */

static int count_rti(const weft_dataset_layout *layout, weft_priced_model *model)
{
    const weft_priced_dataset flat = {0};
    int count = weft_priced_models_list(layout, &flat, model), of_rti = 0;
    for (int i = 0; i < count; i++) {
        if (model[i].family == WEFT_PRICED_RTI)
            model[of_rti++] = model[i];
    }
    return of_rti;
}

static void one_view_under_enough_lamps_is_offered_them(void **state)
{
    (void)state;
    static const int lamps[] = {40, 20, 19, 7, 4};
    static const int offered[] = {4, 4, 3, 1, 1};
    weft_priced_model model[WEFT_PRICED_MOST];
    for (int i = 0; i < 5; i++) {
        weft_dataset_layout layout = one_view(lamps[i], WEFT_REFLECTANCE_COSINE);
        assert_int_equal(count_rti(&layout, model), offered[i]);
        layout.distance = WEFT_NEAR;
        assert_int_equal(count_rti(&layout, model), 0);
        layout.distance = WEFT_FAR;
        layout.view_count = 2;
        assert_int_equal(count_rti(&layout, model), 0);
        layout.view_count = 1;
        weft_dataset_layout_free(&layout);
    }
}

static void write_dataset(const weft_dataset_layout *layout)
{
    weft_dataset_writer *writer;
    weft_half samples[SIDE * SIDE][3];
    weft_error error = {0};
    expect_ok(weft_dataset_writer_create(path, layout, &writer, &error), &error);
    for (int image = 0; image < layout->image_count; image++) {
        for (int i = 0; i < 3 * SIDE * SIDE; i++)
            samples[i / 3][i % 3] = sample_of(layout, i / 3, image, i % 3);
        expect_ok(weft_dataset_writer_put_image(writer, image, &samples[0][0], NULL, &error), &error);
    }
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
}

/* Photographs whose coded values are a quadratic are what PTM says, also of lamps that it did not see. */
static void rows_have_their_errors_and_bytes(void **state)
{
    (void)state;
    weft_dataset_layout layout = one_view(LAMPS, WEFT_REFLECTANCE_COSINE);
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_dataset *dataset;
    weft_held_bench *bench;
    weft_price_shop *shop;
    weft_error error = {0};
    write_dataset(&layout);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_held_bench_create(dataset, WEFT_TEXEL_SUBSET_BLOCK, SIDE, (weft_splits_asked){0, 1}, scratch, &bench,
                                     &error),
              &error);
    expect_ok(weft_price_shop_open(dataset, SIDE, scratch, NULL, &shop, &error), &error);
    int count = count_rti(weft_dataset_get_layout(dataset), model);
    static const int bytes_a_texel[] = {18, 27, 48, 3 * LAMPS};
    assert_int_equal(count, WEFT_RTI_MODELS);
    for (int i = 0; i < count; i++) {
        weft_held_error measured;
        weft_price price;
        expect_ok(weft_held_bench_measure(bench, &model[i], &measured, &error), &error);
        expect_ok(weft_price_ask(shop, &model[i], &price, &error), &error);
        double held = measured.held[WEFT_SAMPLES_ALL].relative_rmse;
        print_message("%s: %.4f\n", model[i].name, held);
        assert_true((held < 0.002) == (model[i].rti == WEFT_RTI_PTM));
        assert_float_equal(price.bytes, SIDE * SIDE * bytes_a_texel[i], 0);
        assert_int_equal(price.photograph_count, LAMPS);
        assert_true(measured.picture_count > 0);
        weft_held_error_free(&measured);
    }
    weft_price_shop_close(shop);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    unlink(path);
}

int test_rti(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_model_spans_is_exact),
        cmocka_unit_test(a_matt_slope_is_nearly_known),
        cmocka_unit_test(the_spline_is_that_of_textbooks),
        cmocka_unit_test(a_ring_of_lamps_gives_bounded_weights),
        cmocka_unit_test(texels_are_predicted_from_what_is_fitted),
        cmocka_unit_test(one_view_under_enough_lamps_is_offered_them),
        cmocka_unit_test(rows_have_their_errors_and_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
