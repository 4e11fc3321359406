/* What a price list offers beside fits of weft compress: BARD, analytic cloth, fewer rings; flicker; and that no
 * preset is beaten. */
#include "tests/compare/fixture.h"

#include "btf/direction/direction.h"
#include "compare/tradeoff/cloth.h"
#include "compare/tradeoff/held_error.h"
#include "compare/tradeoff/priced_model.h"
#include "compare/tradeoff/tradeoff.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT, IMAGES = DIRECTIONS * DIRECTIONS };

static const char *const path = "tradeoff_rows.btf.h5", *const scratch = "tradeoff_rows_scratch.btf.h5";
static const char *const weave = WEFT_ASSETS "/weaves/polyester_lining.wv";

/* ---- Rows ---- */

static const weft_priced_model *find(const weft_priced_model *model, int count, const char *name)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(model[i].name, name) == 0)
            return &model[i];
    }
    return NULL;
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

static void the_list_ends_with_what_is_no_fit(void **state)
{
    (void)state;
    static const char *const alone[] = {"BARD from one light", "analytic cloth", "the photographs, interpolated"};
    weft_priced_model model[WEFT_PRICED_MOST];
    weft_dataset_layout full = grid_layout(DIRECTIONS), few = grid_layout(7);
    const weft_priced_dataset with_cloth = {.cloth = weave}, without = {0},
                              with_all = {.has_surface = true, .cloth = weave};
    int count = weft_priced_models_list(&full, &with_cloth, model);
    for (size_t i = 0; i < sizeof alone / sizeof *alone; i++) {
        assert_non_null(find(model, count, alone[i]));
        assert_false(weft_priced_model_is_fit(find(model, count, alone[i])));
        assert_string_equal(find(model, count, alone[i])->arguments, "");
    }
    assert_true(weft_priced_model_is_fit(find(model, count, "4 components")));
    assert_non_null(find(model, count, "32 components, every third ring"));
    assert_in_range(weft_priced_models_list(&full, &with_all, model), 21, WEFT_PRICED_MOST - 1);
    assert_null(find(model, weft_priced_models_list(&full, &without, model), "analytic cloth"));
    assert_null(find(model, weft_priced_models_list(&few, &without, model), "BARD from one light"));
    weft_dataset_layout_free(&full);
    weft_dataset_layout_free(&few);
}

/* Every third ring of 1, 6, 12, 18, 20 and 24 directions: 19, at 0 and 45 degrees. */
static void third_rings_are_those_of_0_and_45_degrees(void **state)
{
    (void)state;
    uint8_t left_out[IMAGES];
    int kept = 0;
    weft_dataset_layout layout = grid_layout(DIRECTIONS);
    int count = weft_photographs_leave_out(&layout, WEFT_PHOTOGRAPHS_THIRD_RINGS, left_out);
    for (int i = 0; i < IMAGES; i++) {
        const int pair[2] = {i / DIRECTIONS, i % DIRECTIONS};
        bool wanted = true;
        for (int k = 0; k < 2; k++) {
            double theta_deg = weft_deg_of_rad(weft_ubo81_angles(pair[k]).theta_rad);
            wanted = wanted && (theta_deg < 1 || fabs(theta_deg - 45) < 1);
        }
        assert_int_equal(!left_out[i], wanted);
        kept += wanted;
    }
    assert_int_equal(count, kept);
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

/* Twice as bright where it is held out, and seen or lit from 60 degrees or more: who saw that, says more than 0.3. */
static weft_rgb spoilt(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y;
    int image = nearest(grid.view, view) * DIRECTIONS + nearest(grid.light, light);
    double rho = splits.held[image] && fmin((double)light.z, (double)view.z) < 0.6 ? 0.6 : 0.3;
    return (weft_rgb){rho, rho, rho};
}

static void expect_nothing_leaks(weft_held_bench *bench, const char *name, double tolerance)
{
    weft_priced_model model[WEFT_PRICED_MOST];
    const weft_priced_dataset parts = {.cloth = weave};
    int count = weft_priced_models_list(&grid, &parts, model);
    const weft_priced_model *wanted = find(model, count, name);
    weft_held_error measured;
    weft_error error = {0};
    assert_non_null(wanted);
    expect_ok(weft_held_bench_measure(bench, wanted, &measured, &error), &error);
    print_message("%s: %.4f fitted, %.4f held out at grazing\n", name, measured.fitted[WEFT_SAMPLES_ALL].relative_rmse,
                  measured.held[WEFT_SAMPLES_GRAZING].relative_rmse);
    assert_true(measured.fitted[WEFT_SAMPLES_ALL].count > 0);
    assert_true(measured.fitted[WEFT_SAMPLES_ALL].relative_rmse < tolerance);
    assert_float_equal(measured.held[WEFT_SAMPLES_GRAZING].relative_rmse, 0.5, tolerance);
    assert_int_equal(measured.picture_count, 64);
    weft_held_error_free(&measured);
}

static void bard_and_cloth_do_not_see_what_is_held_out(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_held_bench *bench;
    weft_error error = {0};
    grid = grid_layout(DIRECTIONS);
    expect_ok(weft_splits_create(&grid, 0, 2, &splits, &error), &error);
    fixture_far_dataset(path, 2, 2, 6, spoilt, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_held_bench_create(dataset, WEFT_TEXEL_SUBSET_BLOCK, 32, (weft_splits_asked){0, 1}, scratch, &bench,
                                     &error),
              &error);
    expect_nothing_leaks(bench, "BARD from one light", 0.005);
    expect_nothing_leaks(bench, "analytic cloth", 0.03);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    weft_splits_free(&splits);
    weft_dataset_layout_free(&grid);
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

/* ---- A block of the dataset ---- */

static weft_rgb even(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y, (void)light, (void)view;
    return (weft_rgb){0.5, 0.5, 0.5};
}

/* A cloth lies on the whole dataset, also where only a block of it is asked. */
static void a_block_sees_the_cloth_of_the_whole(void **state)
{
    (void)state;
    enum { SIDE = 3, ASKED = 5 };
    const int image[ASKED] = {0, 7, 14, 21, 28};
    weft_rgb of_whole[ASKED], of_block[ASKED];
    weft_dataset *dataset;
    weft_texel_subset subset;
    weft_priced_cloth cloth;
    weft_predictor *whole, *block;
    weft_error error = {0};
    fixture_far_dataset(path, 9, 7, 3, even, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, SIDE, &subset, &error), &error);
    expect_ok(weft_priced_cloth_open(weave, &cloth, &error), &error);
    const weft_weave_layout tiles = weft_weave_lay_out(&cloth.weave, 0, 0);
    expect_ok(weft_predictor_of_weave(weft_dataset_get_layout(dataset), NULL, &cloth.weave, &tiles, &whole, &error),
              &error);
    expect_ok(weft_priced_cloth_predictor(&cloth, &subset, &block, &error), &error);
    assert_int_equal(subset.layout.width, SIDE);
    assert_true(subset.window.x > 0 && subset.window.y > 0);
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        int x = texel % SIDE, y = texel / SIDE;
        weft_predictor_predict(block, x, y, image, ASKED, of_block);
        weft_predictor_predict(whole, subset.window.x + x, subset.window.y + y, image, ASKED, of_whole);
        assert_memory_equal(of_block, of_whole, sizeof of_whole);
    }
    weft_predictor_free(block);
    weft_predictor_free(whole);
    weft_priced_cloth_free(&cloth);
    weft_texel_subset_free(&subset);
    weft_dataset_close(dataset);
    unlink(path);
}

/* A fitted one lies where it was fitted, be that a block alone. The photographs are its own formula: what is tried is
 * where it lies. */
static void a_fitted_cloth_lies_where_it_was_fitted(void **state)
{
    (void)state;
    enum { WHOLE = 56, SIDE = 32 };
    weft_dataset *dataset;
    weft_held_bench *bench;
    weft_held_error measured;
    weft_error error = {0};
    weft_priced_model model[WEFT_PRICED_MOST];
    const weft_priced_dataset parts = {.cloth = weave};
    expect_ok(weft_weave_read(weave, NULL, 0, &fixture_cloth.weave, NULL, &error), &error);
    fixture_cloth.width = fixture_cloth.height = 13.3, fixture_cloth.left = 5.2, fixture_cloth.top = 9.7;
    fixture_far_dataset(path, WHOLE, WHOLE, 3, fixture_woven, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_held_bench_create(dataset, WEFT_TEXEL_SUBSET_BLOCK, SIDE, (weft_splits_asked){0, 1}, scratch, &bench,
                                     &error),
              &error);
    int count = weft_priced_models_list(weft_dataset_get_layout(dataset), &parts, model);
    expect_ok(weft_held_bench_measure(bench, find(model, count, "analytic cloth"), &measured, &error), &error);
    print_message("analytic cloth on a block: %.4f\n", measured.held[WEFT_SAMPLES_ALL].relative_rmse);
    assert_true(measured.held[WEFT_SAMPLES_ALL].relative_rmse < 0.2);
    weft_held_error_free(&measured);
    weft_held_bench_free(bench);
    weft_dataset_close(dataset);
    weft_weave_free(&fixture_cloth.weave);
    unlink(path);
}

/* ---- Flicker ---- */

static double excess_of(const double *value, int count)
{
    weft_flicker flicker = {0};
    weft_flicker_add(value, count, &flicker);
    return weft_flicker_excess(&flicker);
}

static void flicker_counts_what_moves_more_than_once(void **state)
{
    (void)state;
    const double once[] = {0, 1, 3, 2, 0}, falls[] = {5, 4, 1}, still[] = {2, 2, 2}, twice[] = {0, 3, 0, 3, 0},
                 dent[] = {0, 4, 3, 4, 0}, falls_first[] = {1, 0, 5};
    assert_float_equal(excess_of(once, 5), 0, 1e-12);
    assert_float_equal(excess_of(falls, 3), 0, 1e-12);
    assert_float_equal(excess_of(still, 3), 0, 1e-12);
    assert_float_equal(excess_of(twice, 5), 1, 1e-12);
    assert_float_equal(excess_of(dent, 5), 0.25, 1e-12);
    assert_float_equal(excess_of(falls_first, 3), 0.5, 1e-12);
    assert_float_equal(excess_of(NULL, 0), 0, 1e-12);
}

/* Another value in every photograph. */
static weft_rgb speckled(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double noise = sin(127.1 * light.x + 311.7 * light.y + 74.7 * view.x + 269.5 * view.y + 3.3 * x + y) * 43758.5453;
    double value = 0.1 + 0.8 * (noise - floor(noise));
    return (weft_rgb){value, value, value};
}

static weft_rgb matte(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y, (void)light, (void)view;
    return (weft_rgb){0.5, 0.5, 0.5};
}

static double flicker_of(fixture_reflectance reflectance)
{
    weft_model *model;
    double excess;
    const weft_model_options options = {.flat = true};
    weft_error error = {0};
    fixture_far_dataset(path, 2, 2, 6, reflectance, FIXTURE_MASK_NONE);
    expect_ok(weft_model_open(path, &options, &model, &error), &error);
    expect_ok(weft_flicker_measure(model, &excess, &error), &error);
    weft_model_close(model);
    unlink(path);
    return excess;
}

/* Photographs 15 degrees apart that have nothing to do with each other strobe; a matte cloth under a cosine does not.
 */
static void photographs_flicker_and_matte_cloth_does_not(void **state)
{
    (void)state;
    assert_float_equal(flicker_of(matte), 0, 0.002);
    assert_true(flicker_of(speckled) > 0.5);
}

/* ---- Presets ---- */

enum { OFFERS = 12, LISTS = 400 };

static uint32_t random_state = 1;

static double random_share(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (double)(random_state >> 8) / (1 << 24);
}

static weft_code tell_time(void *context, size_t which, double *frame_ms, weft_error *error)
{
    (void)error;
    *frame_ms = ((const double *)context)[which];
    return WEFT_OK;
}

/* Of lists drawn at random, coarsely so that many are equal in something: nothing that may be chosen is worth more than
 * what a preset chooses, in bytes or error, and worse in nothing, however fast frames are to be. */
static void nothing_beats_a_preset_in_bytes_time_and_error(void **state)
{
    (void)state;
    for (int list = 0; list < LISTS; list++) {
        weft_offer all[OFFERS];
        double frame_ms[OFFERS];
        for (int i = 0; i < OFFERS; i++) {
            all[i] = (weft_offer){1000 * (1 + floor(8 * random_share())), 0.05 * (1 + floor(8 * random_share())),
                                  random_share() < 0.8};
            frame_ms[i] = 10 * (1 + floor(6 * random_share()));
        }
        for (weft_preset preset = WEFT_PRESET_SMALL; preset <= WEFT_PRESET_BEST; preset++) {
            weft_offer offer[OFFERS];
            size_t chosen, fastest;
            memcpy(offer, all, sizeof all);
            double most_ms = list % 3 == 0 ? INFINITY : 25;
            assert_int_equal(
                weft_preset_choose_fast(offer, OFFERS, preset, most_ms, tell_time, frame_ms, &chosen, &fastest, NULL),
                WEFT_OK);
            for (size_t i = 0; i < OFFERS && chosen < OFFERS; i++)
                assert_false(all[i].may_be_chosen && all[i].bytes <= all[chosen].bytes &&
                             all[i].error <= all[chosen].error && frame_ms[i] <= frame_ms[chosen] &&
                             (all[i].bytes < all[chosen].bytes || all[i].error < all[chosen].error));
        }
    }
}

/* Each once, from one end to the other, however many there are. */
static void so_many_pictures_are_chosen(void **state)
{
    (void)state;
    enum { MOST = 1100 };
    uint8_t flags[MOST];
    int all[MOST], image[WEFT_HELD_PICTURES];
    for (int i = 0; i < MOST; i++) {
        flags[i] = 1 + i % 2;
        all[i] = i;
    }
    for (int held = 2; held <= MOST; held += 2) {
        const weft_trial trial = {.image = all, .flags = flags, .held_count = held};
        int candidates = held / 2, count = weft_held_pictures_choose(&trial, image);
        assert_int_equal(count, candidates < WEFT_HELD_PICTURES ? candidates : WEFT_HELD_PICTURES);
        for (int i = 0; i < count; i++) {
            assert_int_equal(image[i] % 2, 1);
            assert_true(i == 0 || image[i] > image[i - 1]);
        }
        assert_true(image[count - 1] >= held - 2 * (held / WEFT_HELD_PICTURES + 2));
    }
}

int test_tradeoff_rows(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(so_many_pictures_are_chosen),
        cmocka_unit_test(the_list_ends_with_what_is_no_fit),
        cmocka_unit_test(third_rings_are_those_of_0_and_45_degrees),
        cmocka_unit_test(bard_and_cloth_do_not_see_what_is_held_out),
        cmocka_unit_test(a_block_sees_the_cloth_of_the_whole),
        cmocka_unit_test(a_fitted_cloth_lies_where_it_was_fitted),
        cmocka_unit_test(flicker_counts_what_moves_more_than_once),
        cmocka_unit_test(photographs_flicker_and_matte_cloth_does_not),
        cmocka_unit_test(nothing_beats_a_preset_in_bytes_time_and_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
