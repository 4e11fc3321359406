/* Files of Bonn: what the options do to them, and files that end too early. What they hold is the golden files' to say
 * (tests/golden/bonn.sh). */
#include "import/bonn/file.h"
#include "tests/support/scratch_folder.h"
#include "weft/import.h"

#include "btf/direction/direction.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define GOOD WEFT_GOLDEN "/good/bonn/"
#define BAD WEFT_GOLDEN "/bad/bonn/"

/* Of the images in the good files: 3 views, 4 lights, 6 x 3 texels. */
enum { VIEWS = 3, LIGHTS = 4, IMAGES = VIEWS * LIGHTS, WIDTH = 6, HEIGHT = 3 };

typedef struct result {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    weft_half *samples; /* [height][width][image][3] */
    uint8_t *mask;
    weft_import_report report;
} result;

static result import(const char *path, const weft_import_options *options)
{
    result made = {0};
    weft_error error = {0};
    weft_import_options defaults = weft_import_defaults();
    if (weft_import(path, "out.btf.h5", options ? options : &defaults, NULL, &made.report, &error) != WEFT_OK ||
        weft_dataset_open("out.btf.h5", &made.dataset, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    made.layout = weft_dataset_get_layout(made.dataset);
    size_t count = (size_t)made.layout->width * (size_t)made.layout->height * (size_t)made.layout->image_count;
    made.samples = malloc(3 * count * sizeof *made.samples);
    made.mask = malloc(count);
    assert_int_equal(weft_dataset_read_block(made.dataset, 0, 0, made.layout->width, made.layout->height, made.samples,
                                             made.mask, &error),
                     WEFT_OK);
    return made;
}

static void drop(result *made)
{
    weft_dataset_close(made->dataset);
    weft_import_report_free(&made->report);
    free(made->samples);
    free(made->mask);
    assert_int_equal(unlink("out.btf.h5"), 0);
}

static double sample(const result *made, int x, int y, int image, int channel)
{
    size_t at = ((size_t)y * (size_t)made->layout->width + (size_t)x) * (size_t)made->layout->image_count;
    return (double)weft_float_of_half(made->samples[3 * (at + (size_t)image) + (size_t)channel]);
}

static bool notes(const result *made, const char *words)
{
    for (int i = 0; i < made->report.notes.count; i++) {
        if (strstr(made->report.notes.line[i], words))
            return true;
    }
    return false;
}

static int image_at(const result *made, weft_angles light, weft_angles view)
{
    weft_vec3 to_light = weft_direction_of_angles(light), to_view = weft_direction_of_angles(view);
    for (int i = 0; i < made->layout->image_count; i++) {
        if (weft_dot(made->layout->light[i], to_light) > 1 - 1e-9 &&
            weft_dot(made->layout->view[made->layout->view_of_image[i]], to_view) > 1 - 1e-9)
            return i;
    }
    fail_msg("there is no such image");
    return -1;
}

static void a_picture_stands_where_the_file_has_it(void **state)
{
    (void)state;
    result made = import(GOOD "log_y_ratio.btf", NULL);
    weft_angles light = {weft_rad_of_deg(15), weft_rad_of_deg(300)}, view = {weft_rad_of_deg(60), weft_rad_of_deg(250)};
    int image = image_at(&made, light, view);
    assert_int_equal(made.layout->image_count, IMAGES);
    assert_int_equal(made.layout->view_count, VIEWS);
    assert_int_equal(made.layout->distance, WEFT_FAR);
    /* Second of the lights, third of the views: the highlight at the top right is far above 1. */
    double x = 5, y = 0, v = 2, l = 1, shine = 170 + 16 * l + 3 * v;
    assert_float_equal(sample(&made, 5, 0, image, 0), (9 + 4 * x + 7 * y + 2 * v + 2 + 14 * 0 + shine) / 64, 1e-9);
    assert_float_equal(sample(&made, 5, 0, image, 2), (18 + 5 * x + y + 2 * v * l + 20 * l) / 64, 1e-9);
    assert_float_equal(sample(&made, 0, 2, image, 2), (18 + 0 + 2 + 2 * v * l) / 64, 1e-9);
    drop(&made);
}

static void images_are_reduced_by_averages_of_areas(void **state)
{
    (void)state;
    weft_import_options options = weft_import_defaults();
    options.width = 2;
    result whole = import(GOOD "rgb.btf", NULL);
    double expected[IMAGES][2][3] = {{{0}}};
    for (int i = 0; i < IMAGES * WIDTH * HEIGHT * 3; i++) {
        int image = i / 3 % IMAGES, x = i / 3 / IMAGES % WIDTH, y = i / 3 / IMAGES / WIDTH;
        expected[image][x / 3][i % 3] += sample(&whole, x, y, image, i % 3) / 9;
    }
    drop(&whole);
    result made = import(GOOD "rgb.btf", &options);
    assert_int_equal(made.layout->width, 2);
    assert_int_equal(made.layout->height, 1);
    assert_float_equal(made.layout->texel_pitch_mm, 0.75, 1e-12);
    for (int i = 0; i < IMAGES * 2 * 3; i++)
        assert_float_equal(sample(&made, i / 3 % 2, 0, i / 6, i % 3), expected[i / 6][i / 3 % 2][i % 3], 2e-3);
    drop(&made);
    weft_import_report report;
    options.width = 4;
    assert_int_equal(weft_import(GOOD "rgb.btf", "out.btf.h5", &options, NULL, &report, NULL), WEFT_OK);
    weft_import_report_free(&report);
    assert_int_equal(unlink("out.btf.h5"), 0);
    options.width = 7;
    assert_int_equal(weft_import(GOOD "rgb.btf", "out.btf.h5", &options, NULL, &report, NULL), WEFT_BAD_USAGE);
}

static void frames_are_averaged_as_well(void **state)
{
    (void)state;
    weft_import_options options = weft_import_defaults();
    options.width = 2;
    result made = import(GOOD "rgb_frames.btf", &options);
    float frame[2][6];
    assert_true(weft_dataset_has_frames(made.dataset));
    assert_int_equal(weft_dataset_read_frames(made.dataset, 0, 1, &frame[0][0], NULL), WEFT_OK);
    weft_vec3 sum = {0, 0, 0};
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        weft_angles angles = {weft_rad_of_deg(20 + 3.0 * i), weft_rad_of_deg(40 + 88.0 * i)};
        if (i % WIDTH < 3)
            sum = weft_add(sum, weft_direction_of_angles(angles));
    }
    sum = weft_unit(sum);
    assert_float_equal(frame[0][0], sum.x, 1e-5);
    assert_float_equal(frame[0][1], sum.y, 1e-5);
    assert_float_equal(frame[0][2], sum.z, 1e-5);
    drop(&made);
}

static void the_user_knows_better_than_the_file(void **state)
{
    (void)state;
    result made = import(GOOD "rgb.btf", NULL);
    assert_int_equal(made.layout->values, WEFT_REFLECTANCE);
    assert_float_equal(made.layout->texel_pitch_mm, 0.25, 1e-12);
    drop(&made);
    made = import(GOOD "rgb_cosine.btf", NULL);
    assert_int_equal(made.layout->values, WEFT_REFLECTANCE_COSINE);
    drop(&made);
    weft_import_options options = weft_import_defaults();
    options.texel_pitch_mm = 3;
    options.values = WEFT_REFLECTANCE_COSINE;
    made = import(GOOD "rgb.btf", &options);
    assert_int_equal(made.layout->values, WEFT_REFLECTANCE_COSINE);
    assert_float_equal(made.layout->texel_pitch_mm, 3, 1e-12);
    float whole = sample(&made, 1, 1, 2, 1);
    drop(&made);
    options.white = 2;
    made = import(GOOD "rgb.btf", &options);
    assert_float_equal(sample(&made, 1, 1, 2, 1), whole / 2, 1e-3 * whole);
    drop(&made);
    options.white = 1;
    options.values = WEFT_REFLECTANCE;
    made = import(GOOD "rgb_cosine.btf", &options);
    assert_int_equal(made.layout->values, WEFT_REFLECTANCE);
    drop(&made);
}

static void what_is_left_out_is_told(void **state)
{
    (void)state;
    result made = import(GOOD "joint_log.btf", NULL);
    assert_true(notes(&made, "a map of 3 x 2 heights"));
    drop(&made);
    made = import(GOOD "rgb.btf", NULL);
    assert_int_equal(made.report.notes.count, 0);
    assert_non_null(strstr(made.layout->provenance, "\"setup\":\"Dome 1\""));
    assert_non_null(strstr(made.layout->provenance, "\"source\":\"rgb.btf\""));
    drop(&made);
}

/* A copy of a good file with `size` bytes at `at` exchanged. */
static const char *changed(const char *path, size_t at, const void *bytes, size_t size)
{
    size_t whole;
    unsigned char *copy = scratch_load(path, &whole);
    memcpy(copy + at, bytes, size);
    scratch_store("changed.btf", copy, whole);
    free(copy);
    return "changed.btf";
}

static void a_size_and_a_scale_that_say_nothing_are_told(void **state)
{
    (void)state;
    const size_t pixels_per_mm = 10 + 8 + 240;
    result made = import(changed(GOOD "rgb.btf", pixels_per_mm, (float[]){0}, 4), NULL);
    assert_float_equal(made.layout->texel_pitch_mm, 1, 0);
    assert_true(notes(&made, "1 mm assumed"));
    drop(&made);
    made = import(changed(GOOD "rgb.btf", pixels_per_mm + 4, (float[]){2, 1, 0.5}, 12), NULL);
    assert_true(notes(&made, "2 1 0.5: not applied"));
    result plain = made;
    assert_float_equal(sample(&plain, 0, 0, 0, 2), 22.0 / 64, 1e-9);
    drop(&made);
}

static void images_that_cannot_be_stored_are_masked_on_demand(void **state)
{
    (void)state;
    weft_import_options options = weft_import_defaults();
    options.skip_bad = true;
    result made = import(BAD "too_bright.btf", &options);
    assert_int_equal(made.report.skipped_count, 1);
    assert_int_equal(made.layout->image_count, 2);
    assert_int_equal(made.mask[0] + made.mask[1], WEFT_MASK_MISSING);
    drop(&made);
    made = import(BAD "light_twice.btf", &options);
    assert_int_equal(made.layout->image_count, 1);
    drop(&made);
}

static void lamps_of_another_file_are_refused(void **state)
{
    (void)state;
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_error error = {0};
    options.lights = "dirs.lp";
    assert_int_equal(weft_import(GOOD "rgb.btf", "out.btf.h5", &options, NULL, &report, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "--lights"));
}

/* Every beginning of a file is refused in words that name it, and nothing is written. */
static void refuse_beginnings(const char *path)
{
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    int entries = scratch_folder_entries();
    for (size_t kept = 0; kept < size; kept++) {
        weft_import_options options = weft_import_defaults();
        weft_import_report report;
        weft_error error = {0};
        scratch_store("cut.btf", bytes, kept);
        weft_code code = weft_import("cut.btf", "out.btf.h5", &options, NULL, &report, &error);
        assert_int_equal(weft_class_of(code), WEFT_BAD_INPUT);
        assert_true(code == WEFT_DAMAGED || !strstr(error.message, " ends in its "));
        if (!strstr(error.message, "'cut.btf'"))
            fail_msg("%zu bytes: %s", kept, error.message);
    }
    assert_int_equal(unlink("cut.btf"), 0);
    assert_int_equal(scratch_folder_entries(), entries);
    free(bytes);
}

static void files_cut_anywhere_are_refused(void **state)
{
    (void)state;
    refuse_beginnings(GOOD "rgb_frames.btf");
    refuse_beginnings(GOOD "joint_log.btf");
    refuse_beginnings(GOOD "rgb_half.btf");
}

int test_import_bonn(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_stands_where_the_file_has_it),
        cmocka_unit_test(images_are_reduced_by_averages_of_areas),
        cmocka_unit_test(frames_are_averaged_as_well),
        cmocka_unit_test(the_user_knows_better_than_the_file),
        cmocka_unit_test(what_is_left_out_is_told),
        cmocka_unit_test(a_size_and_a_scale_that_say_nothing_are_told),
        cmocka_unit_test(images_that_cannot_be_stored_are_masked_on_demand),
        cmocka_unit_test(lamps_of_another_file_are_refused),
        cmocka_unit_test(files_cut_anywhere_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
