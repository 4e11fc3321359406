/* What is on a price list, and what it says of models on images that they were not fitted to. */
#include "tests/compare/fixture.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/prediction.h"
#include "compare/tradeoff/tradeoff.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"
#include "compress/run/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT, IMAGES = DIRECTIONS * DIRECTIONS };

static const char *const path = "tradeoff.btf.h5";
static const char *const scratch = "tradeoff_scratch.btf.h5";

/* ---- Models ---- */

static const weft_priced_dataset flat = {0};

static weft_dataset_layout grid_layout(int directions)
{
    weft_dataset_layout layout = {
        .width = 1, .height = 1, .image_count = directions * directions, .view_count = directions};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int i = 0; i < layout.image_count; i++) {
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % directions));
        layout.view_of_image[i] = i / directions;
        layout.view[i / directions] = weft_direction_of_angles(weft_ubo81_angles(i / directions));
    }
    return layout;
}

static const weft_priced_model *find(const weft_priced_model *model, int count, const char *name)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(model[i].name, name) == 0)
            return &model[i];
    }
    return NULL;
}

static void the_list_has_what_the_photographs_carry(void **state)
{
    (void)state;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_dataset_layout full = grid_layout(DIRECTIONS), few = grid_layout(7);
    int count = weft_priced_models_list(&full, &flat, model);
    assert_in_range(count, 14, WEFT_PRICED_MOST);
    static const char *const wanted[] = {"1 lobe", "3 lobes", "64 components", "32 components, every second ring",
                                         "the photographs, interpolated"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        assert_non_null(find(model, count, wanted[i]));
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < i; j++)
            assert_string_not_equal(model[i].name, model[j].name);
    }
    assert_false(weft_priced_models_share_fit(find(model, count, "1 lobe"), find(model, count, "2 lobes")));
    assert_string_equal(find(model, count, "2 lobes")->arguments, "--lobes 2");
    assert_non_null(strstr(find(model, count, "16 components")->arguments, "--components 16"));
    count = weft_priced_models_list(&few, &flat, model);
    assert_non_null(find(model, count, "2 lobes"));
    assert_null(find(model, count, "3 lobes"));
    assert_null(find(model, count, "32 components, every second ring"));
    weft_dataset_layout_free(&full);
    weft_dataset_layout_free(&few);
}

/* 81 directions are 1, 6, 12, 18, 20 and 24 of six rings. */
static void fewer_photographs_are_whole_rings(void **state)
{
    (void)state;
    uint8_t left_out[IMAGES];
    weft_dataset_layout layout = grid_layout(DIRECTIONS);
    int of_ring[WEFT_RING_COUNT] = {0}, kept = 0;
    for (int i = 0; i < DIRECTIONS; i++)
        of_ring[weft_ubo81_ring(weft_ubo81_angles(i).theta_rad)]++;
    for (int ring = 0; ring < WEFT_RING_COUNT; ring += 2)
        kept += of_ring[ring];
    assert_int_equal(weft_photographs_leave_out(&layout, WEFT_PHOTOGRAPHS_ALL, left_out), IMAGES);
    assert_int_equal(weft_photographs_leave_out(&layout, WEFT_PHOTOGRAPHS_SECOND_RINGS, left_out), kept * kept);
    weft_dataset_layout_free(&layout);
}

/* ---- Errors ---- */

static weft_dataset_layout grid;
static weft_splits splits;

static int nearest(const weft_vec3 *direction, weft_vec3 wanted)
{
    int best = 0;
    for (int i = 1; i < DIRECTIONS; i++)
        best = weft_dot(direction[i], wanted) > weft_dot(direction[best], wanted) ? i : best;
    return best;
}

static bool grazes(weft_vec3 light, weft_vec3 view)
{
    double theta = fmax(weft_angles_of_direction(light).theta_rad, weft_angles_of_direction(view).theta_rad);
    return weft_deg_of_rad(theta) > 52;
}

/* What is held out is as bright again as all else where it grazes. */
static weft_rgb spoilt(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y;
    int image = nearest(grid.view, view) * DIRECTIONS + nearest(grid.light, light);
    double rho = splits.held[image] && grazes(light, view) ? 0.6 : 0.3;
    return (weft_rgb){rho, rho, rho};
}

/* Another value at every texel, and another colour from every view. */
static weft_rgb rough(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double noise = sin(12.9898 * x + 78.233 * y) * 43758.5453;
    double value = 0.1 + 0.3 * (noise - floor(noise)) + 0.1 * light.x * view.y;
    return (weft_rgb){value * (1 + 0.6 * view.x), value * (1 - 0.6 * view.x), value};
}

static void write_grid(int side, fixture_reflectance reflectance)
{
    weft_error error = {0};
    grid = grid_layout(DIRECTIONS);
    expect_ok(weft_splits_create(&grid, 0, 2, &splits, &error), &error);
    fixture_far_dataset(path, side, side, 6, reflectance, FIXTURE_MASK_NONE);
}

static void forget_grid(void)
{
    weft_splits_free(&splits);
    weft_dataset_layout_free(&grid);
    unlink(path);
}

static long count_held(bool grazing)
{
    long count = 0;
    for (int i = 0; i < IMAGES; i++)
        count += splits.held[i] && (!grazing || grazes(grid.light[i], grid.view[i / DIRECTIONS]));
    return count;
}

static long count_held_twice_at_grazing(void)
{
    long count = 0;
    for (int i = 0; i < IMAGES; i++)
        count +=
            splits.held[i] == (WEFT_HELD_VIEW | WEFT_HELD_LIGHT) && grazes(grid.light[i], grid.view[i / DIRECTIONS]);
    return count;
}

static weft_held_bench *open_bench(weft_dataset **dataset)
{
    weft_held_bench *bench;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, dataset, &error), &error);
    expect_ok(weft_held_bench_create(*dataset, WEFT_TEXEL_SUBSET_BLOCK, 32, (weft_splits_asked){0, 1}, scratch, &bench,
                                     &error),
              &error);
    return bench;
}

static weft_held_error measure(weft_held_bench *bench, const char *name)
{
    weft_priced_model model[WEFT_PRICED_MOST];
    int count = weft_priced_models_list(&grid, &flat, model);
    const weft_priced_model *wanted = find(model, count, name);
    weft_held_error measured;
    weft_error error = {0};
    assert_non_null(wanted);
    expect_ok(weft_held_bench_measure(bench, wanted, &measured, &error), &error);
    return measured;
}

/* A lobe that saw 0.3 alone misses half of 0.6. Nothing else is as bright, and nothing held out leaks. */
static void errors_are_told_apart_where_eyes_look(void **state)
{
    (void)state;
    weft_dataset *dataset;
    write_grid(2, spoilt);
    weft_held_bench *bench = open_bench(&dataset);
    weft_held_error m = measure(bench, "1 lobe");
    assert_int_equal(m.held[WEFT_SAMPLES_ALL].count, 3 * 4 * count_held(false));
    assert_int_equal(m.held[WEFT_SAMPLES_GRAZING].count, 3 * 4 * count_held(true));
    assert_float_equal(m.held[WEFT_SAMPLES_GRAZING].relative_rmse, 0.5, 0.002);
    assert_float_equal(m.held[WEFT_SAMPLES_HIGHLIGHTS].relative_rmse, 0.5, 0.002);
    assert_true(m.held[WEFT_SAMPLES_SHADOWS].relative_rmse < 0.01);
    assert_in_range(m.held[WEFT_SAMPLES_HIGHLIGHTS].count, 3 * 4 * 300, 3 * 4 * count_held(true));
    assert_true(m.held[WEFT_SAMPLES_ALL].relative_rmse < 0.499);
    for (int kind = 0; kind < WEFT_SAMPLE_KINDS; kind++)
        assert_true(m.fitted[kind].relative_rmse < 0.01);
    assert_int_equal(m.picture_count, 64);
    assert_int_equal(m.picture_pixels, 4 * 64);
    double spoilt_share = count_held_twice_at_grazing() / 64.0;
    assert_true(m.quality.psnr_db < 99 - (99 - 20) * spoilt_share);
    assert_true(m.quality.flip > 0.1 * spoilt_share);
    assert_int_equal(m.sample.width, 2);
    weft_held_error_free(&m);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    forget_grid();
}

/* The pictures of a bench that is asked for these alone: the same, by the same fit. */
static void pictures_alone_are_those_beside_errors(void **state)
{
    (void)state;
    weft_dataset *dataset, *again;
    weft_held_error alone;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_error error = {0};
    write_grid(4, rough);
    weft_held_bench *bench = open_bench(&dataset), *other = open_bench(&again);
    int count = weft_priced_models_list(&grid, &flat, model);
    expect_ok(weft_held_bench_picture(bench, find(model, count, "2 lobes"), &alone, &error), &error);
    weft_held_error both = measure(other, "2 lobes");
    size_t bytes = 3 * (size_t)both.sample.width * (size_t)both.sample.height * sizeof *both.sample.pixels;
    assert_int_equal(alone.held[0].count, 0);
    assert_int_equal(alone.picture_count, both.picture_count);
    assert_memory_equal(&alone.quality, &both.quality, sizeof both.quality);
    assert_int_equal(alone.picture_pixels, both.picture_pixels);
    assert_int_equal(alone.worst_image, both.worst_image);
    assert_memory_equal(alone.sample.pixels, both.sample.pixels, bytes);
    assert_memory_equal(alone.predicted.pixels, both.predicted.pixels, bytes);
    weft_held_error_free(&alone);
    weft_held_error_free(&both);
    weft_held_bench_free(bench);
    weft_held_bench_free(other);
    weft_dataset_close(dataset);
    weft_dataset_close(again);
    forget_grid();
}

/* ---- Prices ---- */

static weft_price ask(weft_price_shop *shop, const weft_priced_model *model)
{
    weft_price price;
    weft_error error = {0};
    expect_ok(weft_price_ask(shop, model, &price, &error), &error);
    return price;
}

/* What is fitted whole has the bytes of its file; of a block they are found in proportion. */
static void bytes_are_those_of_the_file(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_price_shop *whole, *part;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_material material;
    weft_error error = {0};
    fixture_far_dataset(path, 24, 24, 4, rough, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &flat, model);
    const weft_priced_model *wanted = find(model, count, "1 lobe");
    expect_ok(weft_price_shop_open(dataset, 64, scratch, NULL, &whole, &error), &error);
    weft_price price = ask(whole, wanted);
    expect_ok(weft_compress(dataset, &wanted->options, NULL, &material, NULL, &error), &error);
    expect_ok(weft_material_write("tradeoff.weft", &material, &error), &error);
    assert_float_equal(price.bytes, weft_file_bytes("tradeoff.weft"), 0);
    assert_float_equal(price.bits_a_texel, 8 * price.bytes / (24 * 24), 1e-9);
    assert_int_equal(price.photograph_count, weft_dataset_get_layout(dataset)->image_count);
    assert_true(price.evaluations_a_second > 100);
    assert_true((price.frame_ms > 0) != (weft_price_shop_why_not_drawn(whole)[0] != 0));
    expect_ok(weft_price_shop_open(dataset, 20, scratch, NULL, &part, &error), &error);
    assert_int_equal(weft_price_shop_texels(part), 20 * 20);
    assert_float_equal(ask(part, wanted).bytes, price.bytes, 0.15 * price.bytes);
    weft_price_shop_close(whole);
    weft_price_shop_close(part);
    weft_material_free(&material);
    weft_dataset_close(dataset);
    unlink("tradeoff.weft");
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

int test_tradeoff(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_list_has_what_the_photographs_carry),
        cmocka_unit_test(fewer_photographs_are_whole_rings),
        cmocka_unit_test(errors_are_told_apart_where_eyes_look),
        cmocka_unit_test(pictures_alone_are_those_beside_errors),
        cmocka_unit_test(bytes_are_those_of_the_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
