/* What is on a price list, what it says of models on images that they were not fitted to, and what it chooses. */
#include "fixture.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"
#include "btf/material/metadata.h"
#include "compress/compress.h"
#include "compress/run/memory.h"
#include "study/hold_out/record.h"
#include "study/tradeoff/frame_timer.h"
#include "study/tradeoff/plot.h"
#include "study/tradeoff/preset.h"
#include "study/tradeoff/tradeoff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT, IMAGES = DIRECTIONS * DIRECTIONS };

static const char *const path = "tradeoff.btf.h5";
static const char *const scratch = "tradeoff_scratch.btf.h5";

/* ---- Choices ---- */

static const weft_offer offers[] = {
    {1000, 0.40, true}, {2000, 0.20, true},   {2100, 0.39, true}, {4000, 0.05, true}, {8000, 0.045, true},
    {9000, 0.04, true}, {3000, 0.001, false}, {500, 0.5, false},  {2000, 0.20, true},
};
enum { OFFERS = sizeof offers / sizeof *offers };

static void offers_are_beaten_by_what_can_be_had(void **state)
{
    (void)state;
    const bool beaten[OFFERS] = {false, false, true, false, false, false, false, false, true};
    for (size_t i = 0; i < OFFERS; i++)
        assert_int_equal(weft_offer_is_beaten(offers, OFFERS, i), beaten[i]);
}

/* Errors of at most sqrt(0.04 x 0.40) = 0.126 are small enough: 4000 bytes are the fewest of these. */
static void presets_choose_by_their_rules(void **state)
{
    (void)state;
    assert_int_equal(weft_preset_choose(offers, OFFERS, WEFT_PRESET_BEST), 5);
    assert_int_equal(weft_preset_choose(offers, OFFERS, WEFT_PRESET_SMALL), 3);
    assert_int_equal(weft_preset_choose(offers, OFFERS, WEFT_PRESET_BALANCED), 3);
}

/* Between 100 bytes of error 0.2 and 10000 of 0.02 a straight line has 0.0632 at 1000. */
static void balanced_is_the_bend(void **state)
{
    (void)state;
    weft_offer curve[] = {
        {10, 1, true}, {100, 0.1, true}, {1000, 0.04, true}, {3000, 0.0325, true}, {10000, 0.01, true}};
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_SMALL), 1);
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 1);
    curve[2].error = 0.028;
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 2);
    curve[3].error = 0.0125;
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 3);
    curve[2].may_be_chosen = curve[3].may_be_chosen = false;
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 1);
}

/* A file ten times as large for half a hundredth less error is not better. */
static void a_hundredth_is_not_worth_any_bytes(void **state)
{
    (void)state;
    weft_offer near[] = {{100, 0.3, true}, {1000, 0.1005, true}, {10000, 0.1, true}};
    assert_int_equal(weft_preset_choose(near, 3, WEFT_PRESET_BEST), 1);
    near[1].error = 0.102;
    assert_int_equal(weft_preset_choose(near, 3, WEFT_PRESET_BEST), 2);
    near[0].error = 0.1002;
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++)
        assert_int_equal(weft_preset_choose(near, 3, preset), 0);
}

static void nothing_is_chosen_of_nothing(void **state)
{
    (void)state;
    const weft_offer none[] = {{1, 1, false}};
    for (weft_preset preset = WEFT_PRESET_SMALL; preset <= WEFT_PRESET_BEST; preset++)
        assert_int_equal(weft_preset_choose(none, 1, preset), 1);
}

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
                                         "64 layers",
                                         "16 layers over the light",
                                         "16 layers over the half vector",
                                         "32 layers, 21 views",
                                         "the photographs, interpolated"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        assert_non_null(find(model, count, wanted[i]));
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < i; j++)
            assert_string_not_equal(model[i].name, model[j].name);
        if (model[i].table_bits > 0 || model[i].first_layers > 0 || model[i].fewer_texels)
            assert_true(weft_priced_models_share_fit(&model[i], &model[i - 1]));
    }
    assert_false(weft_priced_models_share_fit(find(model, count, "1 lobe"), find(model, count, "1 lobe, T")));
    count = weft_priced_models_list(&few, &flat, model);
    assert_non_null(find(model, count, "2 lobes"));
    assert_null(find(model, count, "2 lobes, T"));
    assert_null(find(model, count, "3 lobes"));
    assert_null(find(model, count, "32 layers, 21 views"));
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
    } row[] = {{"16 layers over the light", true}, {"16 layers over the half vector", false}};
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
        assert_int_equal(material.layers->kind == WEFT_LAYERS_OF_LIGHT, row[i].over_light);
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
    expect_ok(weft_held_bench_create(*dataset, WEFT_EXCERPT_BLOCK, 32, 0, scratch, &bench, &error), &error);
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

/* One brightness a texel under one reflectance is rank 1: two layers say all of it. Of as many colours as texels they
 * say less than four. */
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
    const char *const names[] = {"4 layers", "2 layers, the first of 4"};
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
        print_message("4 layers %.4f, 2 of them %.4f\n", error[colours][0], error[colours][1]);
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
    weft_price_shop *whole, *part;
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_material material;
    weft_error error = {0};
    fixture_far_dataset(path, 24, 24, 4, rough, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    const weft_priced_model *wanted =
        find(model, weft_priced_models_list(weft_dataset_get_layout(dataset), &flat, model), "1 lobe, T");
    expect_ok(weft_price_shop_open(dataset, 64, scratch, NULL, &whole, &error), &error);
    weft_price price = ask(whole, wanted);
    expect_ok(weft_compress(dataset, &wanted->options, NULL, &material, NULL, &error), &error);
    expect_ok(weft_material_write("tradeoff.weft", &material, &error), &error);
    assert_float_equal(price.bytes, weft_file_bytes("tradeoff.weft"), 0);
    assert_float_equal(price.bits_a_texel, 8 * price.bytes / (24 * 24), 1e-9);
    assert_int_equal(price.photograph_count, weft_dataset_get_layout(dataset)->image_count);
    assert_true(price.evaluations_a_second > 100);
    assert_int_equal(price.fetches.reads, 8 * (1 + 2 + 3));
    assert_true((price.frame_ms > 0) != (weft_price_shop_why_not_drawn(whole)[0] != 0));
    expect_ok(weft_price_shop_open(dataset, 16, scratch, NULL, &part, &error), &error);
    assert_int_equal(weft_price_shop_texels(part), 256);
    assert_float_equal(ask(part, wanted).bytes, price.bytes, 0.15 * price.bytes);
    weft_price_shop_close(whole);
    weft_price_shop_close(part);
    weft_material_free(&material);
    weft_dataset_close(dataset);
    unlink("tradeoff.weft");
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

/* ---- Presets ---- */

/* Nobody can predict more than a fifth of it. */
static weft_rgb noisy(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double noise =
        sin(127.1 * light.x + 311.7 * light.y + 74.7 * view.x + 269.5 * view.y + 3.3 * x + 7.9 * y) * 43758.5453;
    double factor = 0.7 + 0.6 * (noise - floor(noise));
    weft_rgb value = rough(x, y, light, view);
    return (weft_rgb){factor * value.r, factor * value.g, factor * value.b};
}

/* The file that weft compress would write, with what it was measured to be. */
static double compress_as_chosen(weft_dataset *dataset, const weft_compress_options *options,
                                 const weft_prediction *prediction, weft_hold_out *held_out)
{
    weft_material material;
    weft_error error = {0};
    uint64_t bytes;
    expect_ok(weft_hold_out_measure(dataset, options, 1, scratch, NULL, held_out, &error), &error);
    expect_ok(weft_compress(dataset, options, NULL, &material, NULL, &error), &error);
    expect_ok(weft_hold_out_store(held_out, &material, &error), &error);
    expect_ok(weft_material_put_metadata(&material, "predicted", weft_prediction_to_json(prediction), &error), &error);
    expect_ok(weft_material_size(&material, &bytes, &error), &error);
    weft_material_free(&material);
    return (double)bytes;
}

/* The file says it where it was wished for; those who look on hear it wherever a frame was drawn. */
static void events_say_how_long_a_frame_takes(void **state)
{
    (void)state;
    weft_prediction prediction = {.preset = WEFT_PRESET_SMALL, .bytes = 1, .error = 1, .frame_ms = 12.5};
    json_t *kept = weft_prediction_to_json(&prediction), *event = weft_prediction_to_event(&prediction);
    assert_null(json_object_get(kept, "frame_ms"));
    assert_float_equal(json_real_value(json_object_get(event, "frame_ms")), 12.5, 0);
    json_decref(kept);
    json_decref(event);
    prediction.frame_ms = 0;
    event = weft_prediction_to_event(&prediction);
    assert_null(json_object_get(event, "frame_ms"));
    json_decref(event);
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
        count++;
    return count;
}

/* A model that all presets choose is named once, with why each does. */
static void page_names_a_chosen_model_once(void **state)
{
    (void)state;
    static weft_tradeoff tradeoff;
    char *page;
    size_t size;
    weft_error error = {0};
    tradeoff.row_count = 1;
    tradeoff.row[0] = (weft_tradeoff_row){.model = {.name = "8 layers", .arguments = "--layers 8"}};
    for (weft_preset preset = WEFT_PRESET_NONE; preset < WEFT_PRESET_COUNT; preset++)
        tradeoff.row[0].is_chosen[preset] = true;
    expect_ok(weft_tradeoff_write_page(&tradeoff, "one.btf.h5", "one-model", &error), &error);
    expect_ok(weft_read_file("one-model/index.html", 1 << 20, &page, &size, &error), &error);
    assert_int_equal(count_of(page, "<a href=\"#model-1\">8 layers</a>"), 1);
    assert_int_equal(count_of(page, "<b>small</b>, <b>balanced</b>, <b>best</b>"), 1);
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++)
        assert_int_equal(count_of(page, weft_preset_reason(preset)), 1);
    free(page);
}

/* It is written where it was wished for. */
static void expect_speed(weft_prediction prediction)
{
    prediction.least_fps = 10;
    json_t *object = weft_prediction_to_json(&prediction);
    assert_float_equal(json_real_value(json_object_get(object, "frame_ms")), prediction.frame_ms, 0);
    assert_float_equal(json_real_value(json_object_get(object, "least_fps")), 10, 0);
    json_decref(object);
    weft_frame_timer *timer;
    assert_int_equal(weft_frame_timer_open(&timer, NULL), WEFT_OK);
    assert_true(prediction.frame_ms > 0 ? weft_frame_timer_why_not(timer)[0] == 0 : prediction.frame_ms >= 0);
    weft_frame_timer_close(timer);
}

/* The texels by which a size is predicted are held twice, as they are read and as they are written: memory for one and
 * a half of them does not do. */
static void a_prediction_keeps_to_the_memory_that_is_allowed(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, SIDE, SIDE, 4, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    uint64_t once = 7ull * SIDE * SIDE * (uint64_t)weft_dataset_get_layout(dataset)->image_count;
    weft_memory_budget now = weft_memory_budget_begin(0);
    weft_compress_options options = weft_compress_default_options();
    weft_prediction prediction = {.model = "diffuse", .error = 0.5};
    options.layer_count = options.lobe_count = 0;
    options.table = false;
    options.memory_bytes = weft_memory_budget_taken(&now) + once + once / 2;
    assert_int_equal(weft_prediction_find_costs(dataset, &options, scratch, NULL, &prediction, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "the texels by which its size is predicted"));
    assert_int_not_equal(access(scratch, F_OK), 0);
    options.memory_bytes += 256ull << 20;
    expect_ok(weft_prediction_find_costs(dataset, &options, scratch, NULL, &prediction, &error), &error);
    weft_dataset_close(dataset);
    unlink(path);
}

/* All texels are measured both times, but other directions. */
static void a_preset_predicts_size_and_error(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, 10, 9, 4, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    weft_compress_options options = weft_compress_default_options();
    weft_prediction prediction;
    weft_hold_out held_out;
    options.weights = WEFT_WEIGHTS_SCREEN;
    const weft_preset_wish wish = {.preset = WEFT_PRESET_SMALL, .times_frames = true};
    expect_ok(weft_preset_predict(dataset, &wish, scratch, NULL, &options, &prediction, &error), &error);
    expect_speed(prediction);
    assert_int_equal(options.weights, WEFT_WEIGHTS_SCREEN);
    assert_false(options.light_table);
    double bytes = compress_as_chosen(dataset, &options, &prediction, &held_out);
    assert_float_equal(prediction.bytes, bytes, 0.02 * bytes);
    double measured = held_out.material.all.relative_rmse;
    assert_float_equal(prediction.error, measured, 0.1 * measured);
    assert_true(fabs(prediction.error - measured) > 1e-6 * measured);
    weft_dataset_close(dataset);
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

/* ---- What is asked for ---- */

/* The middle is even, and the rest is not: a block of the middle alone weighs a third of what its share is. */
static weft_rgb even_in_the_middle(int x, int y, weft_vec3 light, weft_vec3 view)
{
    bool is_middle = abs(x - 48) < 32 && abs(y - 40) < 32;
    double share = is_middle ? 0.5 : fmod(0.618 * (x + 1) * (y + 3), 1), gloss = pow(fmax(light.z * view.z, 0), 6);
    return (weft_rgb){0.1 + share * gloss, 0.1 + 0.5 * share * gloss, 0.2};
}

static void size_is_that_of_all_texels(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, 96, 80, 2, even_in_the_middle, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    weft_compress_options options = weft_compress_default_options();
    weft_prediction prediction = {.model = "1 lobe", .arguments = "--lobes 1", .error = 0.123456789};
    weft_hold_out held_out;
    options.layer_count = 0;
    options.lobe_count = 1;
    options.table = false;
    expect_ok(weft_prediction_find_costs(dataset, &options, scratch, NULL, &prediction, &error), &error);
    double bytes = compress_as_chosen(dataset, &options, &prediction, &held_out);
    print_message("predicted %.0f bytes, is %.0f\n", prediction.bytes, bytes);
    assert_float_equal(prediction.bytes, bytes, 0.05 * bytes);
    weft_dataset_close(dataset);
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

/* All texels are in the prediction, too: it holds to the length of the metadata. */
static void what_is_asked_for_is_predicted(void **state)
{
    (void)state;
    static const struct {
        double target;
        uint64_t budget;
        const char *arguments;
    } row[] = {{0.2, 0, "--error 20"}, {0, 26000, "--budget 0.026"}};
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, 16, 12, 4, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    for (int i = 0; i < 2; i++) {
        weft_compress_options options = weft_compress_default_options();
        weft_prediction prediction;
        weft_hold_out held_out;
        uint64_t own;
        options.target_error = row[i].target;
        options.budget_bytes = row[i].budget;
        options.layer_count = 0;
        const weft_preset_wish wish = {.preset = WEFT_PRESET_NONE};
        expect_ok(weft_preset_predict(dataset, &wish, scratch, NULL, &options, &prediction, &error), &error);
        assert_string_equal(prediction.arguments, row[i].arguments);
        expect_ok(weft_prediction_added_bytes(dataset, &options, &prediction, &own, &error), &error);
        options.added_bytes = own;
        double bytes = compress_as_chosen(dataset, &options, &prediction, &held_out);
        double measured = held_out.material.all.relative_rmse;
        print_message("%s: predicted %.0f bytes, is %.0f; error %.4f, is %.4f\n", row[i].arguments, prediction.bytes,
                      bytes, prediction.error, measured);
        assert_float_equal(prediction.bytes, bytes, 0.02 * bytes);
        assert_float_equal(prediction.error, measured, 0.1 * measured);
        assert_true(row[i].budget == 0 || bytes <= (double)row[i].budget);
        json_t *kept = weft_prediction_to_json(&prediction);
        assert_null(json_object_get(kept, "preset"));
        json_decref(kept);
    }
    weft_dataset_close(dataset);
    unlink(path);
}

/* Nobody knows the time of what is not asked for. */
typedef struct times {
    const double *frame_ms;
    int asked;
} times;

static weft_code tell_time(void *context, size_t which, double *frame_ms, weft_error *error)
{
    (void)error;
    times *t = context;
    t->asked++;
    *frame_ms = t->frame_ms[which];
    return WEFT_OK;
}

static void frames_that_are_too_slow_are_not_chosen(void **state)
{
    (void)state;
    const weft_offer all[] = {{1000, 0.5, true}, {2000, 0.3, true}, {4000, 0.2, true}, {8000, 0.1, true}};
    const double frame_ms[] = {12, 30, 20, 50};
    static const struct {
        double most_ms;
        size_t chosen, fastest;
        int asked;
    } row[] = {{50, 3, 4, 1}, {49, 2, 3, 2}, {19, 0, 2, 4}, {11, 4, 0, 4}, {INFINITY, 3, 4, 1}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        weft_offer offer[4];
        memcpy(offer, all, sizeof all);
        times t = {frame_ms, 0};
        size_t chosen, fastest;
        assert_int_equal(
            weft_preset_choose_fast(offer, 4, WEFT_PRESET_BEST, row[i].most_ms, tell_time, &t, &chosen, &fastest, NULL),
            WEFT_OK);
        assert_int_equal(chosen, row[i].chosen);
        assert_int_equal(fastest, row[i].fastest);
        assert_int_equal(t.asked, row[i].asked);
    }
}

/* ---- Plots ---- */

static int find_discs(const char *svg, double x[], double y[], int most)
{
    int count = 0;
    for (const char *at = svg; (at = strstr(at, "<circle cx=\"")) && count < most; at++, count++)
        assert_int_equal(sscanf(at, "<circle cx=\"%lf\" cy=\"%lf\"", &x[count], &y[count]), 2);
    return count;
}

static void points_lie_on_logarithmic_axes(void **state)
{
    (void)state;
    const weft_plot_point point[] = {{1, 100, 1, 0, "first & <last>", NULL, "a", false, true},
                                     {10, 10, 2, 1, "b", NULL, "b", false, true},
                                     {100, 1, 3, 2, "c", "c.png", "c", true, true},
                                     {0, 5, 4, 2, "absent", NULL, "d", false, false}};
    const weft_plot plot = {"title", "x", "y", 4, point};
    weft_page page;
    weft_error error = {0};
    double x[4], y[4];
    expect_ok(weft_page_begin("tradeoff-plot", "plot", &page, &error), &error);
    expect_ok(weft_plot_write(&page, &plot, &error), &error);
    fflush(page.html);
    assert_int_equal(find_discs(page.bytes, x, y, 4), 3);
    assert_float_equal(x[1], (x[0] + x[2]) / 2, 0.11);
    assert_float_equal(y[1], (y[0] + y[2]) / 2, 0.11);
    assert_true(x[0] > 60 && x[2] > x[0] + 400 && x[2] < 745);
    assert_true(y[0] > 30 && y[2] > y[0] + 250 && y[2] < 390);
    assert_non_null(strstr(page.bytes, "first &amp; &lt;last&gt;"));
    assert_null(strstr(page.bytes, "absent"));
    assert_non_null(strstr(page.bytes, "href=\"c.png\""));
    weft_page_abandon(&page);
    rmdir("tradeoff-plot");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(offers_are_beaten_by_what_can_be_had),
        cmocka_unit_test(presets_choose_by_their_rules),
        cmocka_unit_test(balanced_is_the_bend),
        cmocka_unit_test(page_names_a_chosen_model_once),
        cmocka_unit_test(events_say_how_long_a_frame_takes),
        cmocka_unit_test(a_hundredth_is_not_worth_any_bytes),
        cmocka_unit_test(nothing_is_chosen_of_nothing),
        cmocka_unit_test(the_list_has_what_the_photographs_carry),
        cmocka_unit_test(maps_are_of_the_kind_asked_for),
        cmocka_unit_test(fewer_photographs_are_spread),
        cmocka_unit_test(errors_are_told_apart_where_eyes_look),
        cmocka_unit_test(variants_are_made_of_the_same_fit),
        cmocka_unit_test(two_layers_are_the_first_of_four),
        cmocka_unit_test(bytes_are_those_of_the_file),
        cmocka_unit_test(a_prediction_keeps_to_the_memory_that_is_allowed),
        cmocka_unit_test(a_preset_predicts_size_and_error),
        cmocka_unit_test(size_is_that_of_all_texels),
        cmocka_unit_test(what_is_asked_for_is_predicted),
        cmocka_unit_test(frames_that_are_too_slow_are_not_chosen),
        cmocka_unit_test(points_lie_on_logarithmic_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
