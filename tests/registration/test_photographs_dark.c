/* What files say of themselves before their pixels are looked at. What is too dark to be read is not used: of the
 * paper, and of the sample. */
#include "btf/dataset/dataset.h"
#include "registration/lamp/evidence.h"
#include "registration/photographs/steps.h"

#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SIDE = 600 };

/* A level sheet under even light, seen from above: every pixel holds `step` steps of 8 bits. */
static void photograph_sheet(int step)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_image_create(SIDE, SIDE, &image, &error), &error);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        image.pixels[i] = (float)step / 255;
    expect_ok(weft_image_write("sheet.png", &image, NULL, &error), &error);
    weft_image_free(&image);
}

/* What becomes of the places of paper when the picture is taken to be one from `theta_deg` and `distance_mm`. */
static weft_paper_samples look_at_paper(double theta_deg, double distance_mm)
{
    weft_target target = weft_target_printed(40);
    weft_paper_places places;
    weft_paper_samples samples;
    weft_light_values values;
    weft_exif exif;
    weft_error error = {0};
    weft_tone_curve tone = weft_tone_srgb();
    weft_camera camera = {.width = SIDE, .height = SIDE, .fx = 1200, .fy = 1200, .cx = 299.5, .cy = 299.5};
    weft_pose pose = weft_pose_of_view((weft_angles){weft_rad_of_deg(theta_deg), 0.3}, distance_mm);
    weft_homography homography = weft_homography_of_pose(&camera, &pose);
    weft_plate_view view = weft_plate_view_of(&camera, &homography, &(weft_bend){0, 0, 0});
    expect_ok(weft_exif_read("sheet.png", &exif, &error), &error);
    weft_file_range range = weft_file_range_of(&exif, 250.0 / 255);
    expect_ok(weft_light_values_read("sheet.png", SIDE, SIDE, &tone, range, &values, &error), &error);
    expect_ok(weft_paper_places_create(&target, &places, &error), &error);
    expect_ok(weft_paper_sample_all(&places, &camera, &view, &values, &samples, &error), &error);
    free(samples.sample);
    weft_paper_places_free(&places);
    weft_light_values_free(&values);
    return samples;
}

static int places_seen(void)
{
    return look_at_paper(0, 400).count;
}

static void paper_below_five_steps_of_its_file_is_not_looked_at(void **state)
{
    (void)state;
    photograph_sheet(6);
    int seen = places_seen();
    assert_true(seen > 100);
    photograph_sheet(4);
    assert_int_equal(places_seen(), 0);
    photograph_sheet(120);
    assert_int_equal(places_seen(), seen);
}

static void expect_remark(const weft_paper_samples *paper, const char *words)
{
    weft_photographs_photograph photograph = {0};
    weft_photographs_say_paperless(paper, &photograph);
    assert_non_null(strstr(photograph.remark, words));
}

/* 3 pixels a millimetre are enough to 66 degrees. What is not seen says why. */
static void paper_is_seen_from_the_side_and_each_reason_against_it_is_its_own(void **state)
{
    (void)state;
    photograph_sheet(120);
    weft_paper_samples seen;
    for (double theta_deg = 50; theta_deg < 67; theta_deg += 8) {
        seen = look_at_paper(theta_deg, 400);
        print_message("%.0f degrees: %d seen, %d too small\n", theta_deg, seen.count, seen.fate[WEFT_PAPER_SMALL]);
        assert_true(seen.count > 600);
    }
    seen = look_at_paper(84, 400);
    assert_true(seen.count < 40);
    expect_remark(&seen, "too small in it, or seen too much from the side");
    seen = look_at_paper(0, 60);
    assert_true(seen.count < 40);
    expect_remark(&seen, "too little of the sheet is in the picture");
    photograph_sheet(255);
    seen = look_at_paper(0, 400);
    assert_int_equal(seen.count, 0);
    expect_remark(&seen, "overexposed");
    photograph_sheet(4);
    seen = look_at_paper(0, 400);
    assert_int_equal(seen.count, 0);
    expect_remark(&seen, "too dark to be read");
}

/* One step is a fifth of the value there, whatever the file. */
static void the_limit_follows_the_bits_of_the_file(void **state)
{
    (void)state;
    weft_exif eight = {.bits = 8}, sixteen = {.bits = 16}, half = {.bits = 16, .is_float = true};
    assert_float_equal(weft_file_range_of(&eight, 0.98).dark_at, 5.0 / 255, 1e-7);
    assert_float_equal(weft_file_range_of(&sixteen, 0.98).dark_at, 5.0 / 65535, 1e-9);
    assert_float_equal(weft_file_range_of(&half, 0.98).dark_at, 5.0 / 65535, 1e-9);
    assert_float_equal(weft_file_range_of(&eight, 0.98).clipped_at, 0.98, 1e-6);
    assert_true(isinf(weft_file_range_of(&half, 0.98).clipped_at));
}

/* A texel is dark where all of its channels are. What is masked already keeps its reason, and clipped ones are counted.
 */
static void dark_texels_are_masked_one_by_one(void **state)
{
    (void)state;
    enum { TEXELS = 6 };
    const float texel[3 * TEXELS] = {9, 9, 9, 11, 2, 1, 1, 2, 11, 9, 9, 9, 500, 400, 300, 9.9f, 0, -1};
    uint8_t mask[TEXELS] = {0, 0, 0, WEFT_MASK_MISSING, WEFT_MASK_SATURATED, 0};
    const uint8_t expected[TEXELS] = {WEFT_MASK_DARK, 0, 0, WEFT_MASK_MISSING, WEFT_MASK_SATURATED, WEFT_MASK_DARK};
    weft_photographs_photograph photograph = {.dark_texels = 77, .clipped_texels = 77};
    weft_photographs_mask_dark(texel, 10, TEXELS, mask, &photograph);
    assert_memory_equal(mask, expected, TEXELS);
    assert_int_equal(photograph.dark_texels, 2);
    assert_int_equal(photograph.clipped_texels, 1);
}

/* Ink that is nearly as bright as paper, paper that no lamp lights, highlights of other lamps. */
static void light_that_contradicts_itself_is_refused(void **state)
{
    (void)state;
    weft_photographs_settings settings = weft_photographs_defaults();
    const double usual = settings.target.ink_reflectance / settings.target.paper_reflectance;
    const struct {
        double ink, residual, ball_misfit, pin_misfit, size, size_error;
        const char *names;
    } light[] = {{usual, 0.01, 1, 1, 1, 0, NULL},
                 {usual, 0.01, 1, 1, 1.05, 0.02, NULL},
                 {usual, 0.01, 1, 1, 1.05, 0.01, "not printed at 100 %, and --opening is 47.6"},
                 {0.71, 0.01, 1, 1, 1, 0, "the ink comes out as 0.710 of the paper"},
                 {0.4 * usual, 0.01, 1, 1, 1, 0, "the ink comes out as 0.024 of the paper"},
                 {usual, 0.1, 1, 1, 1, 0, "bare paper is 10 % off"},
                 {usual, 0.01, 6, 1, 1, 0, "highlights on the balls lie 6"},
                 {usual, 0.01, 1, 6, 1, 0, "shadows of the pin lie 6"}};
    for (size_t i = 0; i < sizeof light / sizeof *light; i++) {
        weft_photographs_photograph photograph = {.name = "a", .lamp = {.residual = light[i].residual}};
        weft_photograph_set set = {.count = 1, .photograph = &photograph, .tone_found = true};
        weft_error error = {0};
        set.lamps.ink = light[i].ink;
        set.lamps.ball_misfit = light[i].ball_misfit;
        set.lamps.pin_misfit = light[i].pin_misfit;
        set.lamps.size = light[i].size;
        set.lamps.size_error = light[i].size_error;
        settings.force = false;
        weft_code code = weft_photographs_check_light("felt", &settings, &set, &error);
        assert_int_equal(code == WEFT_OK, !light[i].names);
        if (!light[i].names)
            continue;
        assert_int_equal(weft_class_of(code), WEFT_BAD_INPUT);
        assert_non_null(strstr(error.message, light[i].names));
        assert_non_null(strstr(error.message, "--force"));
        settings.force = true;
        expect_ok(weft_photographs_check_light("felt", &settings, &set, &error), &error);
        assert_int_equal(set.notes.count, 1);
        assert_non_null(strstr(set.notes.line[0], light[i].names));
        weft_lines_free(&set.notes);
    }
}

/* ---- What files say of themselves ---- */

enum { WIDTH = 64, HEIGHT = 48, COUNT = 4 };

static void put_photograph(const char *name, double f_number, double iso)
{
    weft_image image;
    weft_error error = {0};
    const weft_camera_notes notes = {.make = "M",
                                     .model = "N",
                                     .date = "2026:01:01 00:00:00",
                                     .orientation = 1,
                                     .exposure_s = 0.125,
                                     .f_number = f_number,
                                     .iso = iso,
                                     .focal_length_mm = 50};
    expect_ok(weft_image_create(WIDTH, HEIGHT, &image, &error), &error);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] = (float)(i % 101) / 101;
    expect_ok(weft_snapshot_write("a.jpg", &image, &notes, &error), &error);
    assert_int_equal(rename("a.jpg", name), 0);
    weft_image_free(&image);
}

static weft_photograph_set list_folder(double f_number, double last_f_number, double iso)
{
    weft_photograph_set set = {0};
    weft_error error = {0};
    mkdir("folder", 0755);
    for (int i = 0; i < COUNT; i++) {
        char name[32];
        snprintf(name, sizeof name, "folder/%d.%s", i, i == 1 ? "nef" : i == 2 ? "dng" : "jpg");
        put_photograph(name, i == COUNT - 1 ? last_f_number : f_number, iso);
    }
    expect_ok(weft_photographs_list("folder", &set, &error), &error);
    assert_int_equal(set.count, COUNT);
    for (int i = 0; i < COUNT; i++)
        assert_true(weft_photographs_used(&set.photograph[i]));
    return set;
}

static void assert_exposures(double f_number, double last_f_number, double iso, bool are_known, const char *note)
{
    weft_photograph_set set = list_folder(f_number, last_f_number, iso);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(weft_exif_exposure(&set.photograph[i].exif) > 0, are_known || i == COUNT - 1);
    assert_int_equal(set.notes.count, note ? 1 : 0);
    if (note)
        assert_string_equal(set.notes.line[0], note);
    weft_photographs_free(&set);
}

/* Lenses without contacts state no aperture; cameras write 0/0. */
static void an_aperture_that_nobody_states_is_the_same_in_all(void **state)
{
    (void)state;
    assert_exposures(8, 8, 100, true, NULL);
    assert_exposures(0, 0, 100, true, "no photograph states its aperture: it is taken as the same in all");
    assert_exposures(0, 0, 0, true,
                     "no photograph states its aperture and sensitivity: both are taken as the same in all");
    assert_exposures(0, 8, 100, false, NULL);
}

static void a_jpeg_named_as_raw_is_not_linear(void **state)
{
    (void)state;
    weft_photograph_set set = list_folder(8, 8, 100);
    for (int i = 0; i < COUNT; i++)
        assert_false(set.photograph[i].exif.is_linear);
    weft_photographs_free(&set);
}

int test_photographs_dark(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_aperture_that_nobody_states_is_the_same_in_all),
        cmocka_unit_test(a_jpeg_named_as_raw_is_not_linear),
        cmocka_unit_test(paper_below_five_steps_of_its_file_is_not_looked_at),
        cmocka_unit_test(paper_is_seen_from_the_side_and_each_reason_against_it_is_its_own),
        cmocka_unit_test(the_limit_follows_the_bits_of_the_file),
        cmocka_unit_test(dark_texels_are_masked_one_by_one),
        cmocka_unit_test(light_that_contradicts_itself_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
