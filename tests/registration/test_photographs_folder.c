/* What files say of themselves before their pixels are looked at. */
#include "registration/photographs/steps.h"

#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

int test_photographs_folder(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_aperture_that_nobody_states_is_the_same_in_all),
        cmocka_unit_test(a_jpeg_named_as_raw_is_not_linear),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
