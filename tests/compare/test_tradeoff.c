/* What is on a price list, and what it says of models on images that they were not fitted to. */
#include "tests/compare/fixture.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/plot.h"
#include "compare/tradeoff/preset.h"
#include "compare/tradeoff/tradeoff.h"
#include "compare/tradeoff/variant.h"
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

static weft_rgb smooth(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double gloss = pow(fmax(0, light.z * view.z - 0.5 * (light.x * view.x + light.y * view.y)), 4);
    return (weft_rgb){0.1 + 0.02 * x + 0.3 * gloss, 0.1 + 0.02 * y + 0.3 * gloss, 0.2};
}

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
    assert_in_range(count, 25, WEFT_PRICED_MOST);
    static const char *const wanted[] = {"diffuse",
                                         "3 lobes",
                                         "diffuse, T",
                                         "2 lobes, T",
                                         "2 lobes, T in 4 bits",
                                         "2 lobes, T, S",
                                         "64 components",
                                         "64 components, rounded",
                                         "16 components over the light",
                                         "16 components over the half vector",
                                         "32 components, 21 views",
                                         "the photographs, interpolated"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        assert_non_null(find(model, count, wanted[i]));
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < i; j++)
            assert_string_not_equal(model[i].name, model[j].name);
        if (model[i].table_bits > 0 || model[i].first_components > 0 || model[i].fewer_texels ||
            model[i].options.rounded)
            assert_true(weft_priced_models_share_fit(&model[i], &model[i - 1]));
    }
    assert_false(weft_priced_models_share_fit(find(model, count, "1 lobe"), find(model, count, "1 lobe, T")));
    assert_string_equal(find(model, count, "16 components, rounded")->arguments, "--components 16 --rounding on");
    count = weft_priced_models_list(&few, &flat, model);
    assert_non_null(find(model, count, "2 lobes"));
    assert_null(find(model, count, "2 lobes, T"));
    assert_null(find(model, count, "3 lobes"));
    assert_null(find(model, count, "32 components, 21 views"));
    weft_dataset_layout_free(&full);
    weft_dataset_layout_free(&few);
}

/* A row of either kind is of that kind, whichever predicts better, and neither is the fit of the other. */
static void maps_are_of_the_kind_asked_for(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        bool over_light;
    } row[] = {{"16 components over the light", true}, {"16 components over the half vector", false}};
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, 4, 4, 4, smooth, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &flat, model);
    for (int i = 0; i < 2; i++) {
        weft_material material;
        const weft_priced_model *asked = find(model, count, row[i].name);
        expect_ok(weft_compress(dataset, &asked->options, NULL, &material, NULL, &error), &error);
        assert_int_equal(material.components->kind == WEFT_COMPONENTS_OF_LIGHT, row[i].over_light);
        assert_string_equal(asked->arguments, "");
        weft_material_free(&material);
    }
    assert_false(weft_priced_models_share_fit(find(model, count, row[0].name), find(model, count, row[1].name)));
    weft_dataset_close(dataset);
    unlink(path);
}

static int views_left(const weft_dataset_layout *layout, const uint8_t *left_out)
{
    int views = 0;
    for (int view = 0; view < layout->view_count; view++)
        views += !left_out[view * DIRECTIONS];
    return views;
}

/* 81 directions are 1, 6, 12, 18, 20 and 24 of six rings. */
static void fewer_photographs_are_spread(void **state)
{
    (void)state;
    uint8_t left_out[IMAGES];
    int count;
    weft_dataset_layout layout = grid_layout(DIRECTIONS);
    int of_ring[WEFT_RING_COUNT] = {0}, kept = 0;
    for (int i = 0; i < DIRECTIONS; i++)
        of_ring[weft_ubo81_ring(weft_ubo81_angles(i).theta_rad)]++;
    for (int ring = 0; ring < WEFT_RING_COUNT; ring += 2)
        kept += of_ring[ring];
    assert_int_equal(weft_photographs_leave_out(&layout, WEFT_PHOTOGRAPHS_ALL, left_out, &count, NULL), WEFT_OK);
    assert_int_equal(count, IMAGES);
    assert_int_equal(weft_photographs_leave_out(&layout, WEFT_PHOTOGRAPHS_SECOND_RINGS, left_out, &count, NULL),
                     WEFT_OK);
    assert_int_equal(count, kept * kept);
    assert_int_equal(weft_photographs_leave_out(&layout, WEFT_PHOTOGRAPHS_21_VIEWS, left_out, &count, NULL), WEFT_OK);
    assert_int_equal(count, 21 * DIRECTIONS);
    assert_int_equal(views_left(&layout, left_out), 21);
    assert_false(left_out[0]);
    int quadrant[4] = {0};
    for (int view = 1; view < DIRECTIONS; view++) {
        if (!left_out[view * DIRECTIONS])
            quadrant[(int)(weft_ubo81_angles(view).phi_rad / (WEFT_PI / 2)) % 4]++;
    }
    for (int q = 0; q < 4; q++)
        assert_in_range(quadrant[q], 3, 8);
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
    expect_ok(
        weft_held_bench_create(*dataset, WEFT_EXCERPT_BLOCK, 32, (weft_splits_asked){0, 1}, scratch, &bench, &error),
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

/* A diffuse term that saw 0.3 alone misses half of 0.6. Nothing else is as bright, and nothing held out leaks. */
static void errors_are_told_apart_where_eyes_look(void **state)
{
    (void)state;
    weft_dataset *dataset;
    write_grid(2, spoilt);
    weft_held_bench *bench = open_bench(&dataset);
    weft_held_error m = measure(bench, "diffuse");
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
    assert_int_equal(m.picture_pixels[WEFT_SAMPLES_ALL], 4 * 64);
    assert_int_equal(m.picture_pixels[WEFT_SAMPLES_GRAZING], 4 * count_held_twice_at_grazing());
    assert_true(m.quality[WEFT_SAMPLES_GRAZING].psnr_db < 20 && m.quality[WEFT_SAMPLES_HIGHLIGHTS].psnr_db < 20);
    assert_true(m.quality[WEFT_SAMPLES_SHADOWS].psnr_db > 40 && m.quality[WEFT_SAMPLES_SHADOWS].flip < 0.01);
    assert_true(m.quality[WEFT_SAMPLES_GRAZING].flip > 0.1 && m.quality[WEFT_SAMPLES_HIGHLIGHTS].flip > 0.1);
    assert_true(m.quality[WEFT_SAMPLES_GRAZING].flip > 1.1 * m.quality[WEFT_SAMPLES_ALL].flip);
    assert_int_equal(m.sample.width, 2);
    weft_held_error_free(&m);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    forget_grid();
}

/* Rounded tables, and half of the texels, come from the fit of the model before. */
static void variants_are_made_of_the_same_fit(void **state)
{
    (void)state;
    weft_dataset *dataset;
    write_grid(4, rough);
    weft_held_bench *bench = open_bench(&dataset);
    weft_held_error whole = measure(bench, "2 lobes, T"), rounded = measure(bench, "2 lobes, T in 4 bits"),
                    coarse = measure(bench, "2 lobes, T, half the texels a side"), other = measure(bench, "diffuse");
    assert_true(rounded.fit_s <= whole.fit_s && rounded.fit_s >= whole.fit_s);
    assert_true(coarse.fit_s <= whole.fit_s && coarse.fit_s >= whole.fit_s);
    assert_true(rounded.fitted[0].relative_rmse > 1.01 * whole.fitted[0].relative_rmse);
    assert_true(rounded.fitted[0].relative_rmse < 0.1);
    assert_true(coarse.fitted[0].relative_rmse > 0.2 && coarse.fitted[0].relative_rmse < 0.6);
    assert_true(other.fit_s < whole.fit_s || other.fit_s > whole.fit_s);
    weft_held_error_free(&whole);
    weft_held_error_free(&rounded);
    weft_held_error_free(&coarse);
    weft_held_error_free(&other);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    forget_grid();
}

/* The pictures of a bench that is asked for these alone: the same, by the same fit, and fewer texels after it. */
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
    expect_ok(weft_held_bench_picture(bench, find(model, count, "2 lobes, T"), &alone, &error), &error);
    weft_held_error coarse = measure(bench, "2 lobes, T, half the texels a side"), both = measure(other, "2 lobes, T"),
                    coarse_of_both = measure(other, "2 lobes, T, half the texels a side");
    size_t bytes = 3 * (size_t)both.sample.width * (size_t)both.sample.height * sizeof *both.sample.pixels;
    assert_int_equal(alone.held[0].count, 0);
    assert_int_equal(alone.picture_count, both.picture_count);
    assert_memory_equal(alone.quality, both.quality, sizeof both.quality);
    assert_memory_equal(alone.picture_pixels, both.picture_pixels, sizeof both.picture_pixels);
    assert_int_equal(alone.worst_image, both.worst_image);
    assert_memory_equal(alone.sample.pixels, both.sample.pixels, bytes);
    assert_memory_equal(alone.predicted.pixels, both.predicted.pixels, bytes);
    assert_memory_equal(coarse.held, coarse_of_both.held, sizeof coarse.held);
    weft_held_error_free(&alone);
    weft_held_error_free(&both);
    weft_held_error_free(&coarse);
    weft_held_error_free(&coarse_of_both);
    weft_held_bench_free(bench);
    weft_held_bench_free(other);
    weft_dataset_close(dataset);
    weft_dataset_close(again);
    forget_grid();
}

/* One brightness a texel under one reflectance is rank 1: two components say all of it. Of as many colours as texels
 * they say less than four. */
static weft_rgb tinted(int x, int y, weft_vec3 light, weft_vec3 view)
{
    weft_rgb value = rough(0, 0, light, view);
    double a = x % 2, b = y % 2, c = (x / 2 + y / 2) % 2;
    return (weft_rgb){value.r * (0.2 + a * (double)light.x * (double)light.x),
                      value.g * (0.2 + b * (double)view.y * (double)view.y), value.b * (0.2 + c * (double)light.z)};
}

static void two_layers_are_the_first_of_four(void **state)
{
    (void)state;
    const char *const names[] = {"4 components", "2 components, the first of 4"};
    double error[2][2];
    for (int colours = 0; colours < 2; colours++) {
        weft_dataset *dataset;
        write_grid(4, colours ? tinted : rough);
        weft_held_bench *bench = open_bench(&dataset);
        for (int i = 0; i < 2; i++) {
            weft_held_error measured = measure(bench, names[i]);
            error[colours][i] = measured.fitted[0].relative_rmse;
            weft_held_error_free(&measured);
        }
        print_message("4 components %.4f, 2 of them %.4f\n", error[colours][0], error[colours][1]);
        weft_held_bench_free(bench);
        weft_dataset_close(dataset);
        forget_grid();
    }
    assert_true(error[0][1] < 1.1 * error[0][0] + 0.01);
    assert_true(error[1][1] > 1.3 * error[1][0] && error[1][1] < 0.8);
}

/* ---- Prices ---- */

static weft_price ask(weft_price_shop *shop, const weft_priced_model *model)
{
    weft_price price;
    bool has_parts;
    weft_error error = {0};
    expect_ok(weft_price_ask(shop, model, &price, &has_parts, &error), &error);
    assert_true(has_parts);
    return price;
}

/* What is fitted whole has the bytes of its file; of a block they are found in proportion. */
static void bytes_are_those_of_the_file(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_price_shop *whole, *part, *small;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_material material;
    weft_error error = {0};
    fixture_far_dataset(path, 24, 24, 4, rough, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &flat, model);
    const weft_priced_model *wanted = find(model, count, "1 lobe, T");
    expect_ok(weft_price_shop_open(dataset, (weft_price_sides){64, 64}, scratch, NULL, &whole, &error), &error);
    weft_price price = ask(whole, wanted);
    expect_ok(weft_compress(dataset, &wanted->options, NULL, &material, NULL, &error), &error);
    expect_ok(weft_material_write("tradeoff.weft", &material, &error), &error);
    assert_float_equal(price.bytes, weft_file_bytes("tradeoff.weft"), 0);
    assert_float_equal(price.bits_a_texel, 8 * price.bytes / (24 * 24), 1e-9);
    assert_int_equal(price.photograph_count, weft_dataset_get_layout(dataset)->image_count);
    assert_true(price.evaluations_a_second > 100);
    assert_int_equal(price.fetches.reads, 8 * (1 + 2 + 3));
    assert_true((price.frame_ms > 0) != (weft_price_shop_why_not_drawn(whole)[0] != 0));
    expect_ok(weft_price_shop_open(dataset, (weft_price_sides){20, 16}, scratch, NULL, &part, &error), &error);
    assert_int_equal(weft_price_shop_texels(part, false), 20 * 20);
    assert_int_equal(weft_price_shop_texels(part, true), 16 * 16);
    assert_float_equal(ask(part, wanted).bytes, price.bytes, 0.15 * price.bytes);
    expect_ok(weft_price_shop_open(dataset, (weft_price_sides){16, 20}, scratch, NULL, &small, &error), &error);
    const weft_priced_model *costly = find(model, count, "2 lobes, T by 4 components");
    assert_true(ask(part, wanted).bytes < ask(small, wanted).bytes);
    assert_true(ask(part, costly).bytes > ask(small, costly).bytes);
    weft_price_shop_close(small);
    weft_price_shop_close(whole);
    weft_price_shop_close(part);
    weft_material_free(&material);
    weft_dataset_close(dataset);
    unlink("tradeoff.weft");
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

/* What differs in its numbers alone takes as long to draw; half of the texels are drawn by themselves. */
static void rounded_numbers_are_drawn_once(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_price_shop *shop;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_error error = {0};
    fixture_far_dataset(path, 8, 8, 4, rough, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &flat, model);
    expect_ok(weft_price_shop_open(dataset, (weft_price_sides){8, 8}, scratch, NULL, &shop, &error), &error);
    bool draws = weft_price_shop_why_not_drawn(shop)[0] == 0;
    weft_price exact = ask(shop, find(model, count, "2 lobes, T")),
               rounded = ask(shop, find(model, count, "2 lobes, T in 4 bits")),
               coarse = ask(shop, find(model, count, "2 lobes, T, half the texels a side")),
               other = ask(shop, find(model, count, "4 components"));
    assert_memory_equal(&rounded.frame_ms, &exact.frame_ms, sizeof exact.frame_ms);
    assert_memory_equal(&rounded.large_frame_ms, &exact.large_frame_ms, sizeof exact.large_frame_ms);
    if (draws) {
        assert_memory_not_equal(&coarse.large_frame_ms, &exact.large_frame_ms, sizeof exact.large_frame_ms);
        assert_memory_not_equal(&other.large_frame_ms, &coarse.large_frame_ms, sizeof coarse.large_frame_ms);
    }
    weft_price_shop_close(shop);
    weft_dataset_close(dataset);
    unlink(path);
}

/* ---- Rounded components ---- */

/* Nobody can predict more than a fifth of it. */
static weft_rgb noisy(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double noise =
        sin(127.1 * light.x + 311.7 * light.y + 74.7 * view.x + 269.5 * view.y + 3.3 * x + 7.9 * y) * 43758.5453;
    double factor = 0.7 + 0.6 * (noise - floor(noise));
    weft_rgb value = rough(x, y, light, view);
    return (weft_rgb){factor * value.r, factor * value.g, factor * value.b};
}

static void expect_same_components(const weft_components *a, const weft_components *b)
{
    assert_memory_equal(a->value, b->value, 3 * (size_t)a->image_count * (size_t)a->component_count * sizeof *a->value);
    assert_memory_equal(a->scale, b->scale, (size_t)a->component_count * sizeof *a->scale);
    for (int k = 0; k < a->level_count; k++)
        assert_memory_equal(a->level[k].coefficient, b->level[k].coefficient,
                            (size_t)a->level[k].width * (size_t)a->level[k].height * (size_t)a->component_count);
}

/* A row of rounded components is made of the fit of exact ones, and is what weft compress --rounding on makes. */
static void rounded_layers_are_those_of_the_command(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_price_shop *shop;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_material fitted, made, variant;
    weft_compress_report report;
    weft_error error = {0};
    fixture_far_dataset(path, 16, 12, 4, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &flat, model);
    const weft_priced_model *exact = find(model, count, "8 components"),
                            *rounded = find(model, count, "8 components, rounded");
    expect_ok(weft_compress(dataset, &exact->options, NULL, &fitted, &report, &error), &error);
    expect_ok(weft_compress(dataset, &rounded->options, NULL, &made, NULL, &error), &error);
    expect_ok(weft_variant_make(&fitted, rounded, report.components.rounding_step, "variant.weft", &variant, &error),
              &error);
    assert_true(weft_components_have_differences(variant.components));
    expect_same_components(variant.components, made.components);
    expect_ok(weft_material_write("tradeoff.weft", &made, &error), &error);
    double bytes = (double)weft_file_bytes("tradeoff.weft");
    expect_ok(weft_price_shop_open(dataset, (weft_price_sides){64, 64}, scratch, NULL, &shop, &error), &error);
    weft_price of_exact = ask(shop, exact), of_rounded = ask(shop, rounded);
    print_message("%.0f bytes, rounded %.0f, as the command makes it %.0f\n", of_exact.bytes, of_rounded.bytes, bytes);
    assert_true(of_rounded.fit_s <= of_exact.fit_s && of_rounded.fit_s >= of_exact.fit_s);
    assert_float_equal(of_rounded.bytes, bytes, 128); /* other digits of the error in the metadata */
    assert_true(of_rounded.bytes < 0.7 * of_exact.bytes);
    assert_int_equal(of_rounded.fetches.reads, of_exact.fetches.reads);
    weft_price_shop_close(shop);
    weft_material_free(&fitted);
    weft_material_free(&made);
    weft_material_free(&variant);
    weft_dataset_close(dataset);
    unlink("tradeoff.weft");
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_list_has_what_the_photographs_carry),
        cmocka_unit_test(maps_are_of_the_kind_asked_for),
        cmocka_unit_test(fewer_photographs_are_spread),
        cmocka_unit_test(errors_are_told_apart_where_eyes_look),
        cmocka_unit_test(variants_are_made_of_the_same_fit),
        cmocka_unit_test(pictures_alone_are_those_beside_errors),
        cmocka_unit_test(two_layers_are_the_first_of_four),
        cmocka_unit_test(bytes_are_those_of_the_file),
        cmocka_unit_test(rounded_numbers_are_drawn_once),
        cmocka_unit_test(rounded_layers_are_those_of_the_command),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
