/* What weft compress predicts of a model that a preset chooses, or that was asked for. */
#include "tests/compare/fixture.h"

#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "compare/tradeoff/component_count.h"
#include "compare/tradeoff/frame_timer.h"
#include "compare/tradeoff/prediction.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"
#include "compress/run/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const path = "prediction.btf.h5";
static const char *const scratch = "prediction_scratch.btf.h5";

/* Another value at every texel, and another colour from every view. */
static weft_rgb rough(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double noise = sin(12.9898 * x + 78.233 * y) * 43758.5453;
    double value = 0.1 + 0.3 * (noise - floor(noise)) + 0.1 * light.x * view.y;
    return (weft_rgb){value * (1 + 0.6 * view.x), value * (1 - 0.6 * view.x), value};
}

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
    int splits;
    weft_material material;
    weft_error error = {0};
    uint64_t bytes;
    expect_ok(weft_hold_out_enough_splits(weft_dataset_get_layout(dataset), &splits, &error), &error);
    expect_ok(weft_hold_out_measure(dataset, options, splits, scratch, NULL, held_out, &error), &error);
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
    options.component_count = options.lobe_count = 0;
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
    fixture_far_dataset(path, 10, 9, 3, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    weft_compress_options options = weft_compress_default_options();
    weft_prediction prediction;
    weft_hold_out held_out;
    options.weights = WEFT_WEIGHTS_SCREEN;
    const weft_preset_wish wish = {.preset = WEFT_PRESET_SMALL, .times_frames = true};
    expect_ok(weft_preset_predict(dataset, &wish, scratch, NULL, &options, &prediction, &error), &error);
    expect_speed(prediction);
    assert_int_equal(options.weights, WEFT_WEIGHTS_SCREEN);
    double bytes = compress_as_chosen(dataset, &options, &prediction, &held_out);
    assert_float_equal(prediction.bytes, bytes, 0.02 * bytes);
    double measured = held_out.material.all.relative_rmse;
    print_message("error: predicted %.9f, is %.9f\n", prediction.error, measured);
    assert_float_equal(prediction.error, measured, 0.1 * measured);
    assert_true(fabs(prediction.error - measured) > 1e-3 * measured); /* of the same directions it would be 3e-4 */
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
    options.component_count = 0;
    options.lobe_count = 1;
    expect_ok(weft_prediction_find_costs(dataset, &options, scratch, NULL, &prediction, &error), &error);
    double bytes = compress_as_chosen(dataset, &options, &prediction, &held_out);
    print_message("predicted %.0f bytes, is %.0f\n", prediction.bytes, bytes);
    assert_float_equal(prediction.bytes, bytes, 0.05 * bytes);
    weft_dataset_close(dataset);
    unlink(path);
    assert_int_not_equal(access(scratch, F_OK), 0);
}

/* All texels are in the prediction, too: it holds to the length of the metadata. */
static void components_are_chosen_by_size(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_error error = {0};
    fixture_far_dataset(path, 16, 12, 3, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    weft_compress_options options = weft_compress_default_options();
    weft_component_count of_size;
    expect_ok(weft_components_for_size(dataset, &options, 1, scratch, NULL, &of_size, &error), &error);
    assert_true(!of_size.is_met && of_size.count == 4);
    uint64_t budget = (uint64_t)(1.5 * of_size.bytes);
    expect_ok(weft_components_for_size(dataset, &options, budget, scratch, NULL, &of_size, &error), &error);
    assert_true(of_size.is_met && of_size.bytes <= (double)budget && of_size.count < 64);
    weft_prediction prediction = {.model = "components", .arguments = "--components 8", .error = 0.123456789};
    weft_hold_out held_out;
    options.component_count = of_size.count;
    double bytes = compress_as_chosen(dataset, &options, &prediction, &held_out);
    print_message("%d components: predicted %.0f bytes, is %.0f\n", of_size.count, of_size.bytes, bytes);
    assert_float_equal(of_size.bytes, bytes, 0.02 * bytes);
    weft_dataset_close(dataset);
    unlink(path);
}

/* One that cannot be met is asked for in the test of the command, of fewer images. */
static void components_are_chosen_by_error(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_error error = {0};
    weft_component_count chosen;
    weft_compress_options options = weft_compress_default_options();
    fixture_far_dataset(path, 3, 2, 4, noisy, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_components_for_error(dataset, &options, 0.9, 1, scratch, NULL, &chosen, &error), &error);
    assert_true(chosen.is_met && chosen.count == 4 && chosen.held_out.split_count == 1);
    weft_dataset_close(dataset);
    unlink(path);
}

int test_prediction(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_say_how_long_a_frame_takes),
        cmocka_unit_test(a_prediction_keeps_to_the_memory_that_is_allowed),
        cmocka_unit_test(a_preset_predicts_size_and_error),
        cmocka_unit_test(size_is_that_of_all_texels),
        cmocka_unit_test(components_are_chosen_by_size),
        cmocka_unit_test(components_are_chosen_by_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
