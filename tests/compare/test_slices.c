#include "base/text/csv.h"
#include "btf/direction/direction.h"
#include "compare/report/compare.h"
#include "tests/compare/fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A material and a dataset of the same reflectance, which tells light from view and u from v. */
static weft_rgb painted(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)y;
    return (weft_rgb){0.3 + 0.2 * light.x + 0.1 * x, 0.3 + 0.2 * light.y, 0.2 + 0.1 * view.x};
}

static weft_rgb grey(int x, int y)
{
    return (weft_rgb){0.2 + 0.1 * x, 0.3, 0.1 + 0.05 * y};
}

static void open_contenders(weft_contenders *contenders, weft_dataset **dataset)
{
    weft_error error = {0};
    weft_material material;
    fixture_far_dataset("slices.btf.h5", 2, 2, 4, painted, FIXTURE_MASK_NONE);
    fixture_diffuse_material("slices.weft", 2, 2, grey);
    expect_ok(weft_material_read("slices.weft", &material, &error), &error);
    expect_ok(weft_contenders_open("slices.btf.h5", "slices.weft", &material, WEFT_ASSETS "/weaves/cotton_denim.wv",
                                   NULL, contenders, &error),
              &error);
    expect_ok(weft_dataset_open("slices.btf.h5", dataset, &error), &error);
    weft_material_free(&material);
}

static void make_slices(weft_slices *slices, weft_contenders *contenders)
{
    weft_error error = {0};
    weft_dataset *dataset;
    open_contenders(contenders, &dataset);
    expect_ok(weft_slices_make(weft_dataset_get_layout(dataset), contenders, NULL, slices, &error), &error);
    weft_dataset_close(dataset);
}

static void every_value_is_that_of_the_model(void **state)
{
    (void)state;
    weft_slices slices;
    weft_contenders contenders;
    make_slices(&slices, &contenders);
    weft_error error = {0};
    assert_int_equal(slices.row_count, 3);
    assert_int_equal(slices.view_count, WEFT_SLICE_VIEWS);
    for (int row = 0; row < 3; row++) {
        for (int i = 0; i < WEFT_SLICE_VIEWS * WEFT_SLICE_LIGHTS; i += 17) {
            int view = i / WEFT_SLICE_LIGHTS, light = i % WEFT_SLICE_LIGHTS;
            const weft_query query = {.light = slices.light[light], .view = slices.view[view]};
            weft_rgb expected, value = weft_slices_values(&slices, row, view)[light];
            expect_ok(weft_model_brdf(contenders.contender[row].model, &query, &expected, &error), &error);
            assert_true(value.r == expected.r && value.g == expected.g && value.b == expected.b);
        }
    }
    weft_slices_free(&slices);
    weft_contenders_close(&contenders);
}

static void discs_have_u_to_the_right_and_v_up(void **state)
{
    (void)state;
    weft_slices slices;
    weft_contenders contenders;
    make_slices(&slices, &contenders);
    /* The reflectance is linear in the projected light: the plane between the directions is met within their spacing.
     */
    for (int i = 0; i < 25; i++) {
        double x = 0.3 * (i % 5 - 2), y = 0.3 * (i / 5 - 2);
        weft_rgb value = weft_slices_at(&slices, 0, 0, x, y);
        if (hypot(x, y) > sin(slices.largest_theta_rad)) {
            assert_true(isnan(value.r));
            continue;
        }
        assert_float_equal(WEFT_PI * value.r, 0.35 + 0.2 * x, 0.02);
        assert_float_equal(WEFT_PI * value.g, 0.3 + 0.2 * y, 0.02);
    }
    weft_slices_free(&slices);
    weft_contenders_close(&contenders);
}

static void a_picture_holds_the_values_of_its_directions(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    weft_slices slices;
    weft_contenders contenders;
    make_slices(&slices, &contenders);
    weft_error error = {0};
    weft_image image;
    uint8_t mask[SIZE * SIZE * WEFT_SLICE_VIEWS];
    expect_ok(weft_slices_picture(&slices, 2, SIZE, &image, mask, &error), &error);
    assert_int_equal(image.width, SIZE * WEFT_SLICE_VIEWS);
    assert_int_equal(mask[0], 1);
    int compared = 0;
    for (int view = 0; view < WEFT_SLICE_VIEWS; view++) {
        for (int light = 1; light < WEFT_SLICE_LIGHTS; light += 7) {
            weft_vec3 at = slices.light[light];
            int column = (int)((at.x + 1) / 2 * SIZE), line = (int)((1 - at.y) / 2 * SIZE);
            int pixel = line * image.width + view * SIZE + column;
            if (mask[pixel])
                continue;
            weft_rgb value = weft_slices_values(&slices, 2, view)[light];
            double shown = (double)image.pixels[3 * pixel + 2];
            double largest = fmax(WEFT_PI * value.b, 0.05);
            compared += fabs(shown - WEFT_PI * value.b) < 0.25 * largest;
        }
    }
    assert_true(compared > WEFT_SLICE_VIEWS * WEFT_SLICE_LIGHTS / 7 * 9 / 10);
    weft_image_free(&image);
    weft_slices_free(&slices);
    weft_contenders_close(&contenders);
}

static void the_table_says_again_what_was_evaluated(void **state)
{
    (void)state;
    weft_slices slices;
    weft_contenders contenders;
    make_slices(&slices, &contenders);
    weft_error error = {0};
    weft_csv table;
    expect_ok(weft_slices_write(&slices, "slices.csv", &error), &error);
    expect_ok(weft_csv_read("slices.csv", true, &table, &error), &error);
    int light_y = weft_csv_column(&table, "ly"), compressed = weft_csv_column(&table, "compressed_r");
    int analytic = weft_csv_column(&table, "analytic_b");
    assert_true(light_y >= 0 && compressed >= 0 && analytic >= 0);
    assert_int_equal(table.row_count, WEFT_SLICE_VIEWS * WEFT_SLICE_LIGHTS);
    for (int i = 0; i < table.row_count; i += 13) {
        int view = i / WEFT_SLICE_LIGHTS, light = i % WEFT_SLICE_LIGHTS;
        double number;
        expect_ok(weft_csv_number(&table, i, light_y, &number, &error), &error);
        assert_float_equal(number, slices.light[light].y, 1e-8);
        expect_ok(weft_csv_number(&table, i, compressed, &number, &error), &error);
        assert_float_equal(number, 0.25 / WEFT_PI, 1e-3);
        expect_ok(weft_csv_number(&table, i, analytic, &number, &error), &error);
        assert_float_equal(number, weft_slices_values(&slices, 2, view)[light].b, 1e-8);
    }
    weft_csv_free(&table);
    weft_slices_free(&slices);
    weft_contenders_close(&contenders);
}

static void few_photographs_have_no_slices(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_contenders contenders;
    weft_dataset *dataset;
    weft_slices slices;
    open_contenders(&contenders, &dataset);
    weft_dataset_layout few = *weft_dataset_get_layout(dataset);
    few.image_count = 9;
    expect_ok(weft_slices_make(&few, &contenders, NULL, &slices, &error), &error);
    assert_int_equal(slices.view_count, 0);
    weft_slices_free(&slices);
    weft_dataset_close(dataset);
    weft_contenders_close(&contenders);
}

int test_slices(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_is_that_of_the_model),
        cmocka_unit_test(discs_have_u_to_the_right_and_v_up),
        cmocka_unit_test(a_picture_holds_the_values_of_its_directions),
        cmocka_unit_test(the_table_says_again_what_was_evaluated),
        cmocka_unit_test(few_photographs_have_no_slices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
