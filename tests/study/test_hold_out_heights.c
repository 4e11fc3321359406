/* Whether layers are to be seen through heights: decided by what was held out, on a pattern that is printed below the
 * plane of the texels. What a view sees is found by a search of its own on the formula of the surface. */
#include "fixture.h"

#include "btf/direction/direction.h"
#include "compress/compress.h"
#include "study/hold_out/hold_out.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { WIDTH = 52, HEIGHT = 16, RINGS = 4, LEVELS = 3, DEEP = 6 }; /* wider than what is measured */

static const char *const path = "hold_out_heights.btf.h5";
static const char *const scratch = "hold_out_heights_scratch.btf.h5";

/* ---- The surface ---- */

/* Of a place in mm, x to the right and y up; it repeats with the material. */
static double hills(double x, double y)
{
    return -DEEP + 1.2 * sin(2 * WEFT_PI * x / 26) * cos(2 * WEFT_PI * y / 16);
}

static bool is_hilly; /* else it is a plane */

static double surface(double x, double y)
{
    return is_hilly ? hills(x, y) : -DEEP;
}

/* Where the sight line through (x, y) meets it: the slopes are gentle, so that stepping to the height below converges.
 */
static void meet(double *x, double *y, weft_vec3 view)
{
    double height = 0, x0 = *x, y0 = *y;
    for (int i = 0; i < 60; i++) {
        *x = x0 + height * (double)(view.x / view.z);
        *y = y0 + height * (double)(view.y / view.z);
        height += 0.5 * (surface(*x, *y) - height);
    }
}

static weft_rgb seen(int column, int row, weft_vec3 view)
{
    double x = column + 0.5, y = HEIGHT - row - 0.5;
    meet(&x, &y, view);
    double red = sin(2 * WEFT_PI * x / 13) * sin(2 * WEFT_PI * y / 8), green = cos(2 * WEFT_PI * (x / 13 + y / 8));
    return (weft_rgb){0.4 + 0.3 * red, 0.4 + 0.3 * green, 0.3};
}

/* Under every light alike: of one view after the other. */
static weft_rgb printed(int column, int row, weft_vec3 light, weft_vec3 view)
{
    static weft_rgb of_view[HEIGHT][WIDTH];
    static bool was_hilly;
    static weft_vec3 last;
    (void)light;
    bool is_same = was_hilly == is_hilly && last.x == view.x && last.y == view.y && last.z == view.z;
    for (int i = 0; i < WIDTH * HEIGHT && !is_same; i++)
        of_view[i / WIDTH][i % WIDTH] = seen(i % WIDTH, i / WIDTH, view);
    was_hilly = is_hilly;
    last = view;
    return of_view[row][column];
}

/* A dataset of the pattern that says of itself to lie at `factor` times its heights. */
static void write_dataset(bool hilly, double factor)
{
    weft_error error = {0};
    is_hilly = hilly;
    weft_dataset_heights heights = {2 * WIDTH, 2 * HEIGHT, LEVELS, malloc(sizeof(float) * 4 * WIDTH * HEIGHT)};
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        heights.value[i] = (float)(factor * surface((i % (2 * WIDTH) + 0.5) / 2, HEIGHT - (i / (2 * WIDTH) + 0.5) / 2));
    fixture_far_dataset(path, WIDTH, HEIGHT, RINGS, printed, 0);
    expect_ok(weft_dataset_put_relief(path, path, -DEEP * factor, hilly ? &heights : NULL, "{}", &error), &error);
    weft_dataset_heights_free(&heights);
}

/* ---- Measuring ---- */

static weft_compress_options eight_layers(void)
{
    weft_compress_options options = weft_compress_default_options();
    options.lobe_count = 0;
    options.table = false;
    options.layer_count = 8;
    return options;
}

static weft_hold_out measure(const weft_compress_options *options)
{
    weft_dataset *dataset;
    weft_hold_out result;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_hold_out_measure(dataset, options, 1, scratch, NULL, &result, &error), &error);
    weft_dataset_close(dataset);
    printf("with %.3f, without %.3f, of views %.3f, of lights %.3f on %ld texels\n", result.heights.with,
           result.heights.without, result.material.view.relative_rmse, result.material.light.relative_rmse,
           result.texel_count);
    return result;
}

/* Near the normal, where errors are rather less than over all, nineteen of twenty are within some standard errors. */
static void expect_certificate_of(const weft_hold_out *result, double relative_rmse)
{
    const weft_certificate *c = &result->certificate;
    weft_vec3 direction = weft_direction_of_angles((weft_angles){weft_rad_of_deg(30), 0});
    assert_true(result->has_certificate);
    double half_width = weft_certificate_half_width(c, 0, c->mean, direction, direction) / c->mean;
    printf("certified to %.3f where the error is %.3f\n", half_width, relative_rmse);
    assert_true(half_width > 0.4 * relative_rmse && half_width < 3.5 * relative_rmse);
}

static void expect_used(const weft_hold_out *result)
{
    assert_true(result->heights.asked && result->heights.used);
    assert_true(result->heights.with < 0.8 * result->heights.without);
    assert_true(result->material.view.relative_rmse < 0.065); /* 0.115 without */
    assert_float_equal(result->material.all.relative_rmse, result->heights.with, 1e-3);
    assert_true(result->texel_count < (long)WIDTH * HEIGHT);
    expect_certificate_of(result, result->heights.with);
}

static void layers_are_seen_through_the_heights_that_are_there(void **state)
{
    (void)state;
    weft_compress_options options = eight_layers();
    write_dataset(true, 1);
    weft_hold_out through = measure(&options);
    expect_used(&through);
    write_dataset(false, 1);
    through = measure(&options);
    expect_used(&through);
    unlink(path);
}

static void heights_that_are_not_there_are_refused(void **state)
{
    (void)state;
    weft_compress_options options = eight_layers();
    write_dataset(true, -1);
    weft_hold_out wrong = measure(&options);
    assert_true(wrong.heights.asked && !wrong.heights.used);
    assert_true(wrong.heights.with > wrong.heights.without);
    assert_float_equal(wrong.material.all.relative_rmse, wrong.heights.without, 0.02);
    expect_certificate_of(&wrong, wrong.heights.without);
    options.heights = false;
    weft_hold_out unasked = measure(&options);
    assert_false(unasked.heights.asked || unasked.heights.used);
    unlink(path);
}

/* ---- Compressing ---- */

static void a_material_has_the_heights_of_its_dataset(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_dataset *dataset;
    weft_material material;
    write_dataset(true, 1);
    for (int wanted = 0; wanted < 2; wanted++) {
        weft_compress_options options = eight_layers();
        options.heights = wanted;
        expect_ok(weft_dataset_open(path, &dataset, &error), &error);
        expect_ok(weft_compress(dataset, &options, NULL, &material, NULL, &error), &error);
        assert_int_equal(material.heights != NULL, wanted);
        if (material.heights) {
            assert_int_equal(material.heights->width, 2 * WIDTH);
            assert_int_equal(material.heights->level_count, LEVELS);
            assert_float_equal(material.heights->size_mm[0], WIDTH, 1e-9);
            assert_float_equal(weft_material_height_mm(material.heights, 37, 11), hills(18.75, HEIGHT - 5.75), 0.006);
        }
        weft_material_free(&material);
        weft_dataset_close(dataset);
    }
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_seen_through_the_heights_that_are_there),
        cmocka_unit_test(heights_that_are_not_there_are_refused),
        cmocka_unit_test(a_material_has_the_heights_of_its_dataset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
