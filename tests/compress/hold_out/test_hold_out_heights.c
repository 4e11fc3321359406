/* Whether components are to be seen through heights, and what photographs and price lists say through them: by what was
 * held out, on a pattern that is printed below the plane of the texels. What a view sees is found by a search of its
 * own on the formula of the surface. */
#include "tests/compare/fixture.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"
#include "compare/tradeoff/held_error.h"
#include "compare/tradeoff/prediction.h"
#include "compare/tradeoff/tradeoff.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 52, HEIGHT = 16, LEVELS = 3, DEEP = 6 }; /* wider than what is measured */

static int width = WIDTH, rings = 4;

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
static void write_masked_dataset(bool hilly, double factor, fixture_mask masked)
{
    weft_error error = {0};
    is_hilly = hilly;
    weft_dataset_heights heights = {2 * width, 2 * HEIGHT, LEVELS,
                                    malloc(sizeof(float) * 4 * (size_t)(width * HEIGHT))};
    for (int i = 0; i < 4 * width * HEIGHT; i++)
        heights.value[i] = (float)(factor * surface((i % (2 * width) + 0.5) / 2, HEIGHT - (i / (2 * width) + 0.5) / 2));
    fixture_far_dataset(path, width, HEIGHT, rings, printed, masked);
    expect_ok(weft_dataset_put_relief(path, path, -DEEP * factor, hilly ? &heights : NULL, "{}", &error), &error);
    weft_dataset_heights_free(&heights);
}

static void write_dataset(bool hilly, double factor)
{
    write_masked_dataset(hilly, factor, FIXTURE_MASK_NONE);
}

/* ---- Measuring ---- */

static weft_compress_options eight_components(void)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 8;
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

/* The photographs are played through their heights, whatever the material is. */
static void expect_photographs(const weft_hold_out *result, double least_part, double most_part)
{
    double through = result->photographs.all.relative_rmse;
    printf("photographs %.3f, without heights %.3f, of views %.3f\n", through, result->photographs_flat,
           result->photographs.view.relative_rmse);
    assert_true(through > least_part * result->photographs_flat && through < most_part * result->photographs_flat);
}

static void components_are_seen_through_the_heights_that_are_there(void **state)
{
    (void)state;
    weft_compress_options options = eight_components();
    write_dataset(true, 1);
    weft_hold_out through = measure(&options);
    expect_used(&through);
    expect_photographs(&through, 0, 0.3);
    double whole = through.photographs_flat;
    write_dataset(false, 1);
    through = measure(&options);
    expect_used(&through);
    expect_photographs(&through, 0, 0.3);
    /* Photographs know a texel through heights where without them all that they would take is masked, and the other
     * way. */
    write_masked_dataset(true, 1, FIXTURE_MASK_FIFTH);
    through = measure(&options);
    expect_used(&through);
    expect_photographs(&through, 0, 0.4);
    assert_true(through.photographs_flat < 2 * whole);
    unlink(path);
}

/* They are fitted to the middle alone. A table of views tells what each sees, under every light. */
static void lobes_are_asked_where_they_are_fitted(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.lobe_count = 1;
    options.component_count = 0;
    write_dataset(true, 1);
    weft_hold_out lobes = measure(&options);
    assert_true(lobes.material.light.relative_rmse < 0.05);
    assert_true(lobes.fitted.relative_rmse < 0.05);
    unlink(path);
}

static void what_does_not_fit_into_memory_is_not_read(void **state)
{
    (void)state;
    weft_compress_options options = eight_components();
    weft_dataset *dataset;
    weft_hold_out result;
    weft_error error = {0};
    write_dataset(true, 1);
    options.memory_bytes = 1 << 20;
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    assert_int_equal(weft_hold_out_measure(dataset, &options, 1, scratch, NULL, &result, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "the images that are held out"));
    weft_dataset_close(dataset);
    unlink(path);
}

static void heights_that_are_not_there_are_refused(void **state)
{
    (void)state;
    weft_compress_options options = eight_components();
    write_dataset(true, -1);
    weft_hold_out wrong = measure(&options);
    assert_true(wrong.heights.asked && !wrong.heights.used);
    assert_true(wrong.heights.with > wrong.heights.without);
    assert_float_equal(wrong.material.all.relative_rmse, wrong.heights.without, 0.02);
    expect_certificate_of(&wrong, wrong.heights.without);
    options.heights = false;
    weft_hold_out unasked = measure(&options);
    assert_false(unasked.heights.asked || unasked.heights.used);
    expect_photographs(&unasked, 1.05, 10);
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
        weft_compress_options options = eight_components();
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

/* ---- Prices ---- */

static weft_priced_model model_of(const weft_dataset *dataset, const char *name)
{
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_priced_dataset parts = weft_priced_dataset_of(dataset);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &parts, model);
    for (int i = 0; i < count; i++)
        if (strcmp(model[i].name, name) == 0)
            return model[i];
    fail_msg("no model '%s'", name);
    return (weft_priced_model){0};
}

static weft_held_error ask(weft_held_bench *bench, const weft_dataset *dataset, const char *name)
{
    weft_priced_model model = model_of(dataset, name);
    weft_held_error measured;
    weft_error error = {0};
    expect_ok(weft_held_bench_measure(bench, &model, &measured, &error), &error);
    printf("%s: %.3f of %ld\n", name, measured.held[0].relative_rmse, measured.held[0].count);
    weft_image_free(&measured.sample);
    weft_image_free(&measured.predicted);
    return measured;
}

static double error_of(const weft_held_error *measured)
{
    return measured->held[WEFT_SAMPLES_ALL].relative_rmse;
}

/* Fewer photographs of one repeat. */
static int make_smaller(void **state)
{
    (void)state;
    width = 26;
    rings = 3;
    return 0;
}

/* Every model for the same samples, those that are known through the heights; components may choose other views where
 * several are as near. */
static void prices_are_of_what_is_played(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_held_bench *bench;
    weft_error error = {0};
    write_dataset(true, 1);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_held_bench_create(dataset, WEFT_TEXEL_SUBSET_BLOCK, 20, (weft_splits_asked){0, 1}, scratch, &bench,
                                     &error),
              &error);
    weft_held_error lobe = ask(bench, dataset, "1 lobe"), flat = ask(bench, dataset, "8 components, without heights"),
                    through = ask(bench, dataset, "8 components, through heights"),
                    raw_flat = ask(bench, dataset, "the photographs, without heights"),
                    raw = ask(bench, dataset, "the photographs, through heights");
    assert_true(raw.held[0].count > 0 && lobe.held[0].count == raw.held[0].count);
    assert_true(flat.held[0].count == raw.held[0].count && through.held[0].count > 9 * raw.held[0].count / 10);
    assert_true(raw_flat.held[0].count == raw.held[0].count);
    assert_true(error_of(&through) < 0.92 * error_of(&flat) && error_of(&raw) < 0.3 * error_of(&raw_flat));
    assert_true(through.interval_width < 0.95 * flat.interval_width);
    double heights = weft_weight_scaled(&through.weight, width, HEIGHT, true) -
                     weft_weight_scaled(&flat.weight, width, HEIGHT, true);
    assert_true(heights > 4 * width * HEIGHT && heights < 1.1 * 4 * width * HEIGHT + 100);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    unlink(path);
}

static double priced_bytes(weft_dataset *dataset, const weft_priced_model *model, int side)
{
    weft_price_shop *shop;
    weft_price price;
    weft_error error = {0};
    expect_ok(weft_price_shop_open(dataset, side, scratch, NULL, &shop, &error), &error);
    expect_ok(weft_price_ask(shop, model, &price, &error), &error);
    weft_price_shop_close(shop);
    return price.bytes;
}

static double file_bytes(weft_dataset *dataset, const weft_compress_options *options)
{
    weft_material material;
    weft_error error = {0};
    expect_ok(weft_compress(dataset, options, NULL, &material, NULL, &error), &error);
    assert_int_equal(material.heights != NULL, options->heights);
    expect_ok(weft_material_write("heights.weft", &material, &error), &error);
    weft_material_free(&material);
    double bytes = (double)weft_file_bytes("heights.weft");
    unlink("heights.weft");
    return bytes;
}

/* Also of a block, which has its part of the heights. */
static void heights_have_their_price(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_error error = {0};
    double file[2], whole[2], part[2];
    write_dataset(true, 1);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    for (int through = 0; through < 2; through++) {
        weft_priced_model model =
            model_of(dataset, through ? "8 components, through heights" : "8 components, without heights");
        file[through] = file_bytes(dataset, &model.options);
        whole[through] = priced_bytes(dataset, &model, 40);
        part[through] = priced_bytes(dataset, &model, 20);
    }
    assert_float_equal(whole[0], file[0], 0);
    assert_float_equal(whole[1], file[1], 0);
    assert_float_equal(part[1] - part[0], file[1] - file[0], 0.35 * (file[1] - file[0]));
    weft_dataset_close(dataset);
    unlink(path);
}

static void heights_are_chosen_where_compress_keeps_them(void **state)
{
    (void)state;
    assert_true(weft_priced_heights_are_kept(0.4, 0.37));
    assert_false(weft_priced_heights_are_kept(0.4, 0.39));
    weft_dataset *dataset;
    weft_prediction prediction;
    weft_compress_options options = weft_compress_default_options();
    weft_error error = {0};
    width = 13;
    write_dataset(false, 1);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    const weft_preset_wish wish = {.preset = WEFT_PRESET_BEST};
    expect_ok(weft_preset_predict(dataset, &wish, scratch, NULL, &options, &prediction, &error), &error);
    printf("best: %s, %.3f\n", prediction.arguments, prediction.error);
    assert_true(options.component_count > 0 && options.heights);
    weft_dataset_close(dataset);
    unlink(path);
}

int test_hold_out_heights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_are_seen_through_the_heights_that_are_there),
        cmocka_unit_test(lobes_are_asked_where_they_are_fitted),
        cmocka_unit_test(what_does_not_fit_into_memory_is_not_read),
        cmocka_unit_test(heights_that_are_not_there_are_refused),
        cmocka_unit_test(a_material_has_the_heights_of_its_dataset),
        cmocka_unit_test_setup(prices_are_of_what_is_played, make_smaller),
        cmocka_unit_test_setup(heights_have_their_price, make_smaller),
        cmocka_unit_test_setup(heights_are_chosen_where_compress_keeps_them, make_smaller),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
