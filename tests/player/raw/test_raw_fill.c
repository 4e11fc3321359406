#include "btf/direction/direction.h"
#include "player/raw/stream.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { VIEWS = 3, LIGHTS = 3, IMAGES = VIEWS * LIGHTS };

static const double light_theta_deg[LIGHTS] = {0, 30, 75};
static const char *const path = "test_raw_fill.btf.h5";

static weft_vec3 direction(double theta_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), 0});
}

/* One texel; image i has the sample (i + 1) / 8 in all channels. */
static weft_dataset *make_dataset(const uint8_t mask[IMAGES])
{
    weft_error error = {0};
    weft_dataset_layout layout = {
        .width = 1, .height = 1, .image_count = IMAGES, .view_count = VIEWS, .texel_pitch_mm = 1};
    weft_dataset_writer *writer;
    weft_dataset *dataset;
    assert_int_equal(weft_dataset_layout_allocate(&layout, &error), WEFT_OK);
    for (int i = 0; i < IMAGES; i++) {
        layout.light[i] = direction(light_theta_deg[i % LIGHTS]);
        layout.view_of_image[i] = i / LIGHTS;
        layout.view[i / LIGHTS] = direction(20.0 * (i / LIGHTS));
    }
    assert_int_equal(weft_dataset_writer_create(path, &layout, &writer, &error), WEFT_OK);
    for (int i = 0; i < IMAGES; i++) {
        weft_half value = weft_half_of_float((float)(i + 1) / 8), sample[3] = {value, value, value};
        assert_int_equal(weft_dataset_writer_put_image(writer, i, sample, &mask[i], &error), WEFT_OK);
    }
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, &error), WEFT_OK);
    weft_dataset_layout_free(&layout);
    assert_int_equal(weft_dataset_open(path, &dataset, &error), WEFT_OK);
    unlink(path);
    return dataset;
}

static void fill(weft_dataset *dataset, const uint8_t mask[IMAGES], float value[3 * IMAGES])
{
    weft_error error = {0};
    weft_raw_images images;
    weft_half sample[3 * IMAGES];
    assert_int_equal(weft_raw_images_find(dataset, &images, &error), WEFT_OK);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, 1, 1, sample, NULL, &error), WEFT_OK);
    weft_raw_texel_fill(&images, weft_dataset_get_layout(dataset), 0, 0, sample, mask, value);
    weft_raw_images_free(&images);
}

static double reflectance(int image)
{
    return (image + 1) / 8.0 / cos(weft_rad_of_deg(light_theta_deg[image % LIGHTS]));
}

static void valid_samples_lose_the_cosine_of_their_light(void **state)
{
    (void)state;
    const uint8_t mask[IMAGES] = {0};
    float value[3 * IMAGES];
    weft_dataset *dataset = make_dataset(mask);
    fill(dataset, mask, value);
    for (int i = 0; i < 3 * IMAGES; i++)
        assert_float_equal(value[i], reflectance(i / 3), 1e-5);
    weft_dataset_close(dataset);
}

static void a_masked_sample_takes_the_nearest_valid_light_of_its_view(void **state)
{
    (void)state;
    const uint8_t none[IMAGES] = {0}, mask[IMAGES] = {WEFT_MASK_SATURATED, 0, 0, 0, 4, 0};
    float value[3 * IMAGES];
    weft_dataset *dataset = make_dataset(none);
    fill(dataset, mask, value);
    assert_float_equal(value[0], reflectance(1), 1e-5);
    assert_float_equal(value[3 * 4 + 2], reflectance(3), 1e-5);
    weft_dataset_close(dataset);
}

static void a_texel_that_a_view_does_not_see_takes_the_nearest_view_that_does(void **state)
{
    (void)state;
    const uint8_t none[IMAGES] = {0}, mask[IMAGES] = {1, 1, 1, 0, 0, WEFT_MASK_SATURATED};
    float value[3 * IMAGES];
    weft_dataset *dataset = make_dataset(none);
    fill(dataset, mask, value);
    assert_float_equal(value[3 * 0], reflectance(3), 1e-5);
    assert_float_equal(value[3 * 1 + 1], reflectance(4), 1e-5);
    assert_float_equal(value[3 * 2 + 2], reflectance(4), 1e-5); /* the nearest light there that is not saturated */
    assert_float_equal(value[3 * 7], reflectance(7), 1e-5);
    weft_dataset_close(dataset);
}

static void a_view_without_valid_samples_is_in_no_triangle(void **state)
{
    (void)state;
    const uint8_t mask[IMAGES] = {0, 0, 0, 1, 1, 1, 1, 1, 1};
    weft_error error = {0};
    weft_raw_images images;
    weft_direction_map map = {0};
    weft_dataset *dataset = make_dataset(mask);
    assert_int_equal(weft_raw_images_find(dataset, &images, &error), WEFT_OK);
    assert_int_equal(weft_raw_images_map(&images, weft_dataset_get_layout(dataset), &map, &error), WEFT_OK);
    assert_int_equal(map.interleave_count, 2);
    assert_float_equal(map.simplex[0].form[0][3], 1, 0);
    weft_direction_map_free(&map);
    weft_raw_images_free(&images);
    weft_dataset_close(dataset);
}

static void a_dataset_without_a_valid_sample_is_bad_input(void **state)
{
    (void)state;
    const uint8_t mask[IMAGES] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    weft_error error = {0};
    weft_raw_images images;
    weft_dataset *dataset = make_dataset(mask);
    assert_int_equal(weft_raw_images_find(dataset, &images, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no valid sample"));
    weft_raw_images_free(&images);
    weft_dataset_close(dataset);
}

int test_raw_fill(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(valid_samples_lose_the_cosine_of_their_light),
        cmocka_unit_test(a_masked_sample_takes_the_nearest_valid_light_of_its_view),
        cmocka_unit_test(a_texel_that_a_view_does_not_see_takes_the_nearest_view_that_does),
        cmocka_unit_test(a_view_without_valid_samples_is_in_no_triangle),
        cmocka_unit_test(a_dataset_without_a_valid_sample_is_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
