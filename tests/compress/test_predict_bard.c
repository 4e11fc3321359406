/* weft bard on datasets whose truth is known. */
#include "btf/direction/direction.h"
#include "compress/bard/predict.h"
#include "compress/bard/texel_table.h"
#include "tests/compare/fixture.h"
#include "tests/support/run_weft.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 5, HEIGHT = 3 };

/* ---- Truth ---- */

static weft_triangulation *views;

static const char *const input = "bard.btf.h5", *const output = "bard.bard.h5";

/* BRDF x pi under light along the normal: 0 in the normal, so that the diffuse share is known. */
static weft_real table_value(int x, int y, weft_vec3 view)
{
    return (1 - view.z) * (2 + view.x) * (x + 2 * y + 1) / 10;
}

/* Diffuse plus a table over the views of ubo81. */
static weft_rgb made_by_the_model(int x, int y, weft_vec3 light, weft_vec3 view)
{
    weft_bard_mix mix = weft_bard_mix_views(WEFT_BARD_IN_PLANE, views, light, view);
    weft_real sum = 0;
    for (int k = 0; k < 3 && mix.at.index[k] >= 0; k++)
        sum += mix.at.weight[k] * table_value(x, y, weft_direction_of_angles(weft_ubo81_angles(mix.at.index[k])));
    weft_real f = (weft_real)0.25 + mix.gain * sum;
    return (weft_rgb){f, f / 2, f / 4};
}

static weft_rgb lambertian(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)light, (void)view;
    return (weft_rgb){0.5, 0.25, 0.1 * (x + y + 1)};
}

/* ---- Running ---- */

static weft_bard_report predict(const weft_bard_options *options)
{
    weft_dataset *dataset;
    weft_bard_report report;
    weft_error error = {0};
    expect_ok(weft_dataset_open(input, &dataset, &error), &error);
    expect_ok(weft_bard_predict(dataset, output, options, NULL, &report, &error), &error);
    weft_dataset_close(dataset);
    return report;
}

typedef struct loaded {
    weft_half *samples;
    uint8_t *mask;
    size_t count; /* texels times images */
} loaded;

static loaded load(const char *path)
{
    weft_dataset *dataset;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t count = (size_t)layout->width * (size_t)layout->height * (size_t)layout->image_count;
    loaded all = {malloc(3 * count * sizeof(weft_half)), malloc(count), count};
    expect_ok(weft_dataset_read_block(dataset, 0, 0, layout->width, layout->height, all.samples, all.mask, &error),
              &error);
    weft_dataset_close(dataset);
    return all;
}

static void unload(loaded all)
{
    free(all.samples);
    free(all.mask);
}

/* Largest |p - s| / max(s, 0.01), over the samples that are valid in both. */
static double largest_difference(void)
{
    loaded s = load(input), p = load(output);
    assert_int_equal(s.count, p.count);
    double largest = 0;
    for (size_t i = 0; i < 3 * s.count; i++) {
        double sample = (double)weft_float_of_half(s.samples[i]);
        double difference = fabs((double)weft_float_of_half(p.samples[i]) - sample);
        if (!s.mask[i / 3] && !p.mask[i / 3])
            largest = fmax(largest, difference / fmax(sample, 0.01));
    }
    unload(s);
    unload(p);
    return largest;
}

static void forget_files(void)
{
    unlink(input);
    unlink(output);
}

/* ---- Tests ---- */

static void a_dataset_made_by_the_model_is_reproduced(void **state)
{
    (void)state;
    weft_bard_options options = weft_bard_defaults();
    fixture_far_dataset(input, WIDTH, HEIGHT, 6, made_by_the_model, FIXTURE_MASK_NONE);
    weft_bard_report report = predict(&options);
    assert_int_equal(report.photograph_count, WEFT_UBO81_COUNT);
    assert_int_equal(report.image_count, WEFT_UBO81_COUNT * WEFT_UBO81_COUNT);
    assert_int_equal(report.filled_count, 0);
    assert_int_equal(report.all.count, 3L * WIDTH * HEIGHT * WEFT_UBO81_COUNT * (WEFT_UBO81_COUNT - 1));
    assert_int_equal(report.by_light[0].count, 0);
    assert_true(report.all.relative_rmse < 1e-3);
    assert_true(report.by_light[5].median_relative < 1e-3);
    /* Table and samples are rounded to half floats. */
    assert_true(largest_difference() < 5e-3);
    options.map = WEFT_BARD_PRINTED;
    assert_true(predict(&options).all.relative_rmse > 0.1);
    forget_files();
}

static void a_lambertian_dataset_is_reproduced_only_when_its_diffuse_part_is_kept(void **state)
{
    (void)state;
    weft_bard_options options = weft_bard_defaults();
    fixture_far_dataset(input, WIDTH, HEIGHT, 6, lambertian, FIXTURE_MASK_NONE);
    assert_true(predict(&options).all.relative_rmse < 1e-3);
    assert_true(largest_difference() < 2e-3);
    /* All of it mapped: too bright by the gain, 1 / cos^2 75 = 14.93. */
    options.diffuse_share = 0;
    weft_bard_report report = predict(&options);
    assert_true(fabs(report.by_light[5].relative_rmse - 13.93) < 0.02);
    assert_true(fabs(report.by_light[1].median_relative - 0.0718) < 0.002);
    forget_files();
}

/* Image 0 of texel (0, 0) is view and light along the normal. */
static void a_masked_photograph_is_filled_from_the_nearest_view(void **state)
{
    (void)state;
    weft_bard_options options = weft_bard_defaults();
    fixture_far_dataset(input, WIDTH, HEIGHT, 6, lambertian, FIXTURE_MASK_ONE);
    weft_bard_report report = predict(&options);
    assert_int_equal(report.filled_count, 1);
    assert_int_equal(report.empty_texel_count, 0);
    assert_true(report.all.relative_rmse < 1e-3);
    loaded p = load(output);
    assert_int_equal(p.mask[0], 0);
    assert_true(fabs((double)weft_float_of_half(p.samples[0]) - 0.5) < 1e-3);
    unload(p);
    forget_files();
}

static void photographs_that_were_used_are_kept_bit_by_bit(void **state)
{
    (void)state;
    weft_bard_options options = {.map = WEFT_BARD_IN_PLANE, .diffuse_share = 0};
    fixture_far_dataset(input, WIDTH, HEIGHT, 3, made_by_the_model, FIXTURE_MASK_NONE);
    assert_int_equal(predict(&options).photograph_count, 19);
    loaded s = load(input), p = load(output);
    for (size_t i = 0; i < s.count; i++) {
        if (i % 19 == 0)
            assert_memory_equal(s.samples + 3 * i, p.samples + 3 * i, 3 * sizeof(weft_half));
    }
    unload(s);
    unload(p);
    forget_files();
}

/* ---- What cannot be used ---- */

/* Three views; lights at the given inclination, and one more at 60 degrees. */
static void write_tilted(double tilt_deg, int view_count)
{
    weft_dataset_layout layout = {.width = 2,
                                  .height = 1,
                                  .image_count = 2 * view_count,
                                  .view_count = view_count,
                                  .values = WEFT_REFLECTANCE,
                                  .distance = WEFT_FAR,
                                  .texel_pitch_mm = 1};
    const weft_half samples[6] = {0x3800, 0x3800, 0x3800, 0x3800, 0x3800, 0x3800};
    weft_error error = {0};
    weft_dataset_writer *writer;
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int i = 0; i < layout.image_count; i++) {
        weft_real theta = weft_rad_of_deg(i % 2 ? 60 : tilt_deg);
        layout.view_of_image[i] = i / 2;
        layout.view[i / 2] = weft_direction_of_angles((weft_angles){(weft_real)0.5, i / 2});
        layout.light[i] = weft_direction_of_angles((weft_angles){theta, 1});
    }
    expect_ok(weft_dataset_writer_create(input, &layout, &writer, &error), &error);
    /* Without its first photograph texel (1, 0) is complete and texel (0, 0) empty under the high light. */
    for (int i = 0; i < layout.image_count; i++) {
        const uint8_t mask[2] = {i % 2 ? 0 : WEFT_MASK_MISSING, 0};
        expect_ok(weft_dataset_writer_put_image(writer, i, samples, mask, &error), &error);
    }
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    weft_dataset_layout_free(&layout);
}

static void expect_refusal(const char *to, weft_code expected, const char *what)
{
    weft_bard_options options = weft_bard_defaults();
    weft_dataset *dataset;
    weft_bard_report report;
    weft_error error = {0};
    expect_ok(weft_dataset_open(input, &dataset, &error), &error);
    assert_int_equal(weft_bard_predict(dataset, to, &options, NULL, &report, &error), expected);
    weft_dataset_close(dataset);
    if (!strstr(error.message, what) || !strstr(error.message, input))
        fail_msg("'%s' does not say '%s'", error.message, what);
    assert_int_not_equal(access(output, F_OK), 0);
}

static void datasets_that_cannot_make_a_table_are_refused(void **state)
{
    (void)state;
    fixture_near_dataset(input, 4, 5, lambertian);
    expect_refusal(output, WEFT_BAD_INPUT, "near lights");
    write_tilted(12, 3);
    expect_refusal(output, WEFT_BAD_INPUT, "12.0 degrees from it");
    write_tilted(0, 2);
    expect_refusal(output, WEFT_BAD_INPUT, "only 2 views");
    write_tilted(0, 3);
    expect_refusal(input, WEFT_BAD_USAGE, "is the dataset itself");
    forget_files();
}

static void a_texel_without_a_table_is_missing_and_a_tilted_light_will_do(void **state)
{
    (void)state;
    weft_bard_options options = weft_bard_defaults();
    write_tilted(4, 3);
    weft_bard_report report = predict(&options);
    assert_int_equal(report.photograph_count, 3);
    assert_int_equal(report.empty_texel_count, 1);
    assert_true(fabs(report.largest_tilt_deg - 4) < 1e-9);
    loaded p = load(output);
    for (size_t i = 0; i < 6; i++) {
        assert_int_equal(p.mask[i], WEFT_MASK_MISSING);
        assert_int_equal(p.mask[6 + i], 0);
        assert_int_equal(p.samples[3 * (6 + i)], 0x3800);
    }
    unload(p);
    forget_files();
}

static void the_file_says_how_it_was_made(void **state)
{
    (void)state;
    weft_bard_options options = weft_bard_defaults();
    fixture_far_dataset(input, 2, 2, 2, lambertian, FIXTURE_MASK_NONE);
    predict(&options);
    weft_dataset *dataset;
    weft_error error = {0};
    expect_ok(weft_dataset_open(output, &dataset, &error), &error);
    const char *provenance = weft_dataset_get_layout(dataset)->provenance;
    assert_non_null(strstr(provenance, "\"source\":\"fixture\""));
    assert_non_null(strstr(provenance, "\"photographs_used\":7,\"images\":49"));
    weft_dataset_close(dataset);
    expect_ok(weft_bard_check(output, &error), &error);
    assert_int_equal(weft_bard_check(input, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, input));
    forget_files();
}

/* ---- The command ---- */

static void a_full_disk_is_an_error_that_leaves_nothing(void **state)
{
    (void)state;
    fixture_far_dataset(input, 40, 40, 3, lambertian, FIXTURE_MASK_NONE);
    expect_weft_after("ulimit -f 2048;", "bard bard.btf.h5 -o bard.bard.h5", WEFT_SYSTEM, "bard.bard.h5");
    assert_int_not_equal(access(output, F_OK), 0);
    forget_files();
}

static void the_command_predicts_and_names_what_is_wrong(void **state)
{
    (void)state;
    fixture_far_dataset(input, 4, 4, 3, lambertian, FIXTURE_MASK_NONE);
    expect_weft("bard bard.btf.h5 -o bard.bard.h5", 0, "predicted from 19 photographs of 361");
    expect_weft("bard bard.btf.h5 -o bard.bard.h5 --json --diffuse 0.5 --map printed", 0, "\"event\":\"prediction\"");
    unlink(output);
    expect_weft("bard none.btf.h5 -o bard.bard.h5", 1, "none.btf.h5");
    expect_weft("bard bard.btf.h5", 2, "-o");
    expect_weft("bard bard.btf.h5 -o bard.bard.h5 --diffuse 2", 2, "--diffuse");
    expect_weft("bard bard.btf.h5 -o bard.bard.h5 --map round", 2, "--map");
    expect_weft("bard bard.btf.h5 -o no-folder/bard.bard.h5", 3, "no-folder");
    expect_weft("bard bard.btf.h5 -o bard.btf.h5", 2, "would overwrite");
    expect_weft("bard --help", 0, "Example: weft bard");
    assert_int_equal(truncate(input, 5000), 0);
    expect_weft("bard bard.btf.h5 -o bard.bard.h5", 1, "bard.btf.h5");
    assert_int_not_equal(access(output, F_OK), 0);
    forget_files();
}

static int make_views(void **state)
{
    (void)state;
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    return weft_triangulation_build(direction, WEFT_UBO81_COUNT, &views, NULL) == WEFT_OK ? 0 : -1;
}

static int free_views(void **state)
{
    (void)state;
    weft_triangulation_free(views);
    return 0;
}

int test_predict_bard(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dataset_made_by_the_model_is_reproduced),
        cmocka_unit_test(a_lambertian_dataset_is_reproduced_only_when_its_diffuse_part_is_kept),
        cmocka_unit_test(a_masked_photograph_is_filled_from_the_nearest_view),
        cmocka_unit_test(photographs_that_were_used_are_kept_bit_by_bit),
        cmocka_unit_test(datasets_that_cannot_make_a_table_are_refused),
        cmocka_unit_test(a_texel_without_a_table_is_missing_and_a_tilted_light_will_do),
        cmocka_unit_test(the_file_says_how_it_was_made),
        cmocka_unit_test(a_full_disk_is_an_error_that_leaves_nothing),
        cmocka_unit_test(the_command_predicts_and_names_what_is_wrong),
    };
    return cmocka_run_group_tests_name("bard", tests, make_views, free_views);
}
